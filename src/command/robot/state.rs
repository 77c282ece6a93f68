//! How a robot stands: the same keys in the status of every family, in `armctl status`, `top`, metrics and topics.

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::robot::alarm::Alarm;
use crate::failure::Failure;
use crate::settings::{Robot, alarms};

/// What is the same of every robot. Null: the protocol does not tell, or it was not asked.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct State {
    /// Where it is false, all that follows is null.
    pub reachable: bool,
    /// Who moves the robot (ISO 10218): a person, or its program.
    pub mode: Option<Mode>,
    /// The controller's own word: `teach`, `play` (yerc); `auto`, `manual` (yrcx); `automatic`, `step`, `program` (toyo).
    pub controller_mode: Option<&'static str>,
    /// Servo power, or motor power.
    pub servo_on: Option<bool>,
    /// A job or program runs, or an axis moves.
    pub running: Option<bool>,
    /// Held or paused.
    pub held: Option<bool>,
    /// The origin is known.
    pub homed: Option<bool>,
    /// In emergency stop.
    pub emergency_stop: Option<bool>,
    /// What is wrong.
    #[serde(flatten)]
    pub fault: Fault,
    /// The program or job that is selected or runs.
    pub program: Option<String>,
    /// Of all speeds.
    pub speed_override_percent: Option<f64>,
    /// The first robot in base coordinates.
    pub position: Option<PositionMm>,
}

/// Who moves the robot (ISO 10218-1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// A person: teaching, jogging, single steps.
    Manual,
    /// A program.
    Automatic,
}

impl Mode {
    /// Automatic or not.
    pub const fn automatic(is_so: bool) -> Self {
        if is_so { Self::Automatic } else { Self::Manual }
    }

    /// As JSON has it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Manual => "manual",
            Self::Automatic => "automatic",
        }
    }
}

/// What is wrong with a controller.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, JsonSchema)]
pub struct Fault {
    /// Whether an alarm or error is present; null if that is not known.
    pub faulted: Option<bool>,
    /// Its code as the controller writes it, such as `4315`, `12.600` or `28`; null without one, or where it was not told.
    pub fault_code: Option<String>,
    /// What it says, or what `alarms.toml` has for the code; null like the code.
    pub fault_text: Option<String>,
}

impl Fault {
    /// Whether there is one, and the first of those that are present, where it was told.
    pub fn new(is_present: bool, first: Option<&Alarm>) -> Self {
        let first = first.filter(|_| is_present);
        Self {
            faulted: Some(is_present),
            fault_code: first.and_then(|alarm| alarm.code.clone()),
            fault_text: first.and_then(|alarm| alarm.text.clone()),
        }
    }

    /// Takes the text that the operator's `alarms.toml` has for the code, if it has one.
    pub fn explain(&mut self, robot: &Robot) -> Result<(), Failure> {
        if let Some(code) = &self.fault_code
            && let Some(explained) = alarms::find(robot, code)?
        {
            self.fault_text = Some(explained.text);
        }
        Ok(())
    }

    /// Code and text, as far as they are known.
    pub fn describe(&self) -> Option<String> {
        let parts = [&self.fault_code, &self.fault_text];
        let told = parts.into_iter().flatten().map(String::as_str).collect::<Vec<_>>().join(" ");
        Some(told).filter(|told| !told.is_empty())
    }
}

/// A place in base coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct PositionMm {
    /// X.
    pub x_mm: f64,
    /// Y.
    pub y_mm: f64,
    /// Z.
    pub z_mm: f64,
}

impl PositionMm {
    /// Of a robot whose axes 1, 2 and 3 are X, Y and Z.
    pub fn of_axes([x_mm, y_mm, z_mm, _]: [f64; 4]) -> Self {
        Self { x_mm, y_mm, z_mm }
    }
}
