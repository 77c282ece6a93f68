//! `yrcx shift-data` (4.3.4).

use crate::numbered_tables::{Kind, Numbered, all_zero, mm as mm_of};
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;

table_commands! {
    /// Commands for shifts.
    ShiftData of Numbered<Shifts> {}
}

/// The shifts of the controller.
#[derive(Debug)]
pub struct Shifts;

impl Kind for Shifts {
    type Value = Shift;
    const WORDS: TableWords = TableWords {
        nouns: ["shift", "shifts"],
        placeholder: "SHIFT",
        range: "Shifts (0 to 39), such as 5, 0..39 or 1,5",
        reading: None,
        writing: None,
    };
    const IDS: Ids = ids!("yrcx.shift-data");
    const READ: (Command, Key) = (Command::ShiftGet, Key::Shift);
    const WRITE: Command = Command::ShiftSet;
    const NUMBERS: &'static [&'static str] = &["0..39"];
    const FIELDS: &'static [(&'static str, Key, &'static str)] = &[
        ("axis_1_mm", Key::Axis1, "axis 1 (mm)"),
        ("axis_2_mm", Key::Axis2, "axis 2 (mm)"),
        ("axis_3_mm", Key::Axis3, "axis 3 (mm)"),
        ("axis_4_mm", Key::Axis4, "axis 4 (mm)"),
    ];

    fn value(values: &Values) -> Option<Shift> {
        Some(Shift { shift_mm: Key::AXES.map(|key| mm_of(values, key)) })
    }

    fn is_blank(values: &Values) -> bool {
        all_zero(values, &Key::AXES)
    }
}

/// Data of a shift.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Shift {
    /// Shift of axes 1 to 4 in mm, or degrees for rotary axes.
    shift_mm: [f64; 4],
}
