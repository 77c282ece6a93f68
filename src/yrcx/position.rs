//! Positions in millimeters or pulses.

use clap::ValueEnum;

use armctl_controller::yrcx::value::{Key, Values};
use armctl_frame::robot::position::{Joint, Position};

/// Unit of a position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Unit {
    /// Millimeters, or degrees for rotary axes
    Mm,
    /// Encoder pulses
    Pulse,
}

impl Unit {
    /// Returns the value of the field that selects the position output (bits 15 and 14 of WI1).
    pub fn report(self) -> i32 {
        match self {
            Self::Pulse => 1,
            Self::Mm => 2,
        }
    }

    /// Returns the symbol of the unit that follows a number.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Pulse => "pulses",
            Self::Mm => "mm",
        }
    }
}

/// Takes the position from an answer in this unit, with the hand system if the answer has one; `None` if the answer has
/// no position.
pub fn position(values: &Values, unit: Unit) -> Option<Position> {
    let axes = values.axes()?;
    let names = ["1", "2", "3", "4"].map(ToOwned::to_owned);
    if unit == Unit::Pulse {
        let joint = |(axis, pulses): (String, i32)| Joint { axis, pulses: Some(pulses), ..Joint::default() };
        let joints = names.into_iter().zip(axes).map(joint).collect();
        let text = Some(format!("--pulse {}", axes.map(|axis| axis.to_string()).join(",")));
        return Some(Position { frame: "joint".to_owned(), joints, text, ..Position::default() });
    }
    let mm = mm(values)?;
    let hand = match values.int(Key::HandSystem) {
        Some(1) => Some("right"),
        Some(2) => Some("left"),
        _ => None,
    };
    let flag = hand.map(|hand| format!(" --hand {hand}")).unwrap_or_default();
    let [x, y, z, _] = mm;
    Some(Position {
        x_mm: Some(x),
        y_mm: Some(y),
        z_mm: Some(z),
        form: hand.map(ToOwned::to_owned),
        text: Some(format!("--mm {}{flag}", mm.map(|axis| format!("{axis:.3}")).join(","))),
        ..Position::of_axes(names, mm, 3)
    })
}

/// Unit of a point.
pub(super) fn unit_of(point: &Values) -> Unit {
    if point.int(Key::Unit) == Some(1) { Unit::Mm } else { Unit::Pulse }
}

/// Returns axes 1 to 4 in millimeters, or degrees for rotary axes.
pub fn mm(values: &Values) -> Option<[f64; 4]> {
    values.axes().map(|axes| axes.map(|steps| f64::from(steps) / 1000.0))
}

/// Name of the robot that a position belongs to, as `--unit` accepts it.
pub fn group(robot: Option<i32>) -> String {
    format!("unit {}", robot.filter(|robot| *robot > 0).unwrap_or(1))
}
