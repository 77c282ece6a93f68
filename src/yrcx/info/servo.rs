//! `yrcx info servo` (4.7.3).

use crate::prelude::*;
use crate::single_command::{format_field, one_row};
use armctl_controller::yrcx::table::Command;

one_row! {
    /// Reads the states of the servos.
    Servo(self) "yrcx.info.servo" -> Servos {}
    gives Command::ServoStatus,
    done as answer => Servos { axes: servos(&answer.values) };
}

/// Servos of a robot.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Servos {
    axes: Vec<AxisServo>,
}

/// The servo of an axis.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct AxisServo {
    /// Axis number, 1 to 4.
    #[serde(rename = "axis_number")]
    pub axis: usize,
    /// State: `servo` (servo on), `brake` (servo off, brake applied), `free` (servo off, brake released).
    pub state: String,
}

/// Servos of the axes that exist.
pub fn servos(values: &Values) -> Vec<AxisServo> {
    let states = Key::AXES.into_iter().map(|key| format_field(Command::ServoStatus, values, key));
    let states = (1..).zip(states).filter_map(|(axis, state)| Some(AxisServo { axis, state: state? }));
    states.filter(|servo| servo.state != "no axis").collect()
}

impl AxisServo {
    /// Returns the state as a cell in its color.
    pub fn cell(&self) -> Cell {
        let tone = match &self.state[..] {
            "servo" => Tone::Good,
            "free" => Tone::Warning,
            _ => Tone::Plain,
        };
        Cell::from(self.state.as_str()).tone(tone)
    }
}

impl Report for Servos {
    fn view(&self) -> View {
        let mut table = Table::new(&["axis", "servo"], "this robot has no axes");
        for servo in &self.axes {
            table.row([servo.axis.into(), servo.cell()]);
        }
        View::table(table)
    }
}
