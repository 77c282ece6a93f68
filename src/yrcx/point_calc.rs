//! `yrcx point-calc` (4.4.3, 4.4.4): calculations with points and shifts in the controller.

use clap::ArgGroup;

use super::confirmed_write::StoredReport;
use super::number_arguments::single;
use super::single_command::one_row;
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;

commands! {
    /// Calculations with points and shifts.
    pub enum PointCalc {
        /// Copy a point, for example `100 --to 1`
        Copy(Copy),
        /// Add a point to another point, for example `100 --to 1`
        Add(Add),
        /// Subtract a point from another point: `100 --from 1` changes point 1
        Sub(Sub),
        /// Copy a pallet position to a point, for example `2 --place 133 --to 100`
        Pallet(Pallet),
        /// Set one element of a point, for example `1 --element 4 --mm 1.0`
        Element(Element),
        /// Set one element of a shift, for example `1 --element 2 --mm 1.0`
        ShiftElement(ShiftElement),
    }
}

fn point(text: &str) -> Result<i32, String> {
    single(Command::PointCopy, Key::Point, text)
}

one_row! {
    /// Copies a point.
    Copy(self) "yrcx.point-calc.copy" -> StoredReport {
        /// Point to copy, 0 to 29999
        #[arg(value_name = "POINT", value_parser = point)]
        point: i32,
        /// Point to write
        #[arg(long, value_name = "POINT", value_parser = point)]
        to: i32,
    }
    gives Command::PointCopy,
    with draft => draft.with(Key::Point, self.to).with(Key::Point2, self.point),
    done format!("P{} = P{}", self.to, self.point);

    /// Adds a point to another point, axis by axis.
    Add(self) "yrcx.point-calc.add" -> StoredReport {
        /// Point to add, 0 to 29999
        #[arg(value_name = "POINT", value_parser = point)]
        point: i32,
        /// Point that changes
        #[arg(long, value_name = "POINT", value_parser = point)]
        to: i32,
    }
    gives Command::PointAdd,
    with draft => draft.with(Key::Point, self.to).with(Key::Point2, self.point),
    done format!("P{to} = P{to} + P{}", self.point, to = self.to);

    /// Subtracts a point from another point, axis by axis.
    Sub(self) "yrcx.point-calc.sub" -> StoredReport {
        /// Point to subtract, 0 to 29999
        #[arg(value_name = "POINT", value_parser = point)]
        point: i32,
        /// Point that changes
        #[arg(long, value_name = "POINT", value_parser = point)]
        from: i32,
    }
    gives Command::PointSub,
    with draft => draft.with(Key::Point, self.from).with(Key::Point2, self.point),
    done format!("P{from} = P{from} - P{}", self.point, from = self.from);

    /// Copies a pallet position to a point.
    Pallet(self) "yrcx.point-calc.pallet" -> StoredReport {
        /// Pallet, 0 to 39
        #[arg(value_name = "PALLET", value_parser = |text: &str| single(Command::PointPallet, Key::Pallet, text))]
        pallet: i32,
        /// Pallet position, starting with 1
        #[arg(long, value_name = "N", value_parser = |text: &str| single(Command::PointPallet, Key::WorkPosition, text))]
        place: i32,
        /// Point to write
        #[arg(long, value_name = "POINT", value_parser = point)]
        to: i32,
    }
    gives Command::PointPallet,
    with draft => {
        let draft = draft.with(Key::Point, self.to).with(Key::Pallet, self.pallet);
        draft.with(Key::WorkPosition, self.place)
    },
    done format!("P{} = position {} of pallet {}", self.to, self.place, self.pallet);

    /// Sets one element of a point, in the unit of the point.
    #[command(group = ArgGroup::new("value").required(true))]
    Element(self) "yrcx.point-calc.element" -> StoredReport {
        /// Point, 0 to 29999
        #[arg(value_name = "POINT", value_parser = point)]
        point: i32,
        /// Element: the number of the axis, 1 to 6
        #[arg(long, value_name = "N", value_parser = |text: &str| single(Command::PointElementMm, Key::Element, text))]
        element: i32,
        /// New value in mm, for a point in mm
        #[arg(long, value_name = "MM", group = "value", allow_negative_numbers = true)]
        mm: Option<String>,
        /// New value in pulses, for a point in pulses
        #[arg(long, value_name = "PULSES", group = "value", allow_negative_numbers = true)]
        pulse: Option<String>,
    }
    gives if self.mm.is_some() { Command::PointElementMm } else { Command::PointElementPulse },
    with draft => {
        let value = self.mm.clone().or_else(|| self.pulse.clone());
        draft.with(Key::Point, self.point).with(Key::Element, self.element).with_some(Key::Value, value)
    },
    done {
        let (value, unit) = match &self.mm {
            Some(value) => (Some(value), "mm"),
            None => (self.pulse.as_ref(), "pulses"),
        };
        let value = value.map_or("", String::as_str);
        format!("element {} of P{} = {value} {unit}", single_bit_number(self.element), self.point)
    };

    /// Sets one element of a shift.
    ShiftElement(self) "yrcx.point-calc.shift-element" -> StoredReport {
        /// Shift, 0 to 39
        #[arg(value_name = "SHIFT", value_parser = |text: &str| single(Command::ShiftElement, Key::Shift, text))]
        shift: i32,
        /// Element: the number of the axis, 1 to 4
        #[arg(long, value_name = "N", value_parser = |text: &str| single(Command::ShiftElement, Key::Element, text))]
        element: i32,
        /// New value in mm
        #[arg(long, value_name = "MM", allow_negative_numbers = true)]
        mm: String,
    }
    gives Command::ShiftElement,
    with draft => {
        let draft = draft.with(Key::Shift, self.shift).with(Key::Element, self.element);
        draft.with(Key::Value, self.mm.as_str())
    },
    done format!("element {} of shift {} = {} mm", single_bit_number(self.element), self.shift, self.mm);
}

/// Returns the number of the only bit that is set, counted from 1.
fn single_bit_number(bits: i32) -> u32 {
    bits.trailing_zeros() + 1
}
