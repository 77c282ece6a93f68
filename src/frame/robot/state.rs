//! Robot state: common keys of the status in every family, `armctl status`, `top`, metrics and topics.

use crate::prelude::basics::*;
use crate::robot::alarm::Alarm;
use crate::settings::alarms;

/// State that is common to all robots. A field is null if the protocol does not report it, or if it was not read.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct State {
    /// Whether the robot answers; if false, all following fields are null.
    pub reachable: bool,
    /// Operating mode (ISO 10218): manual or automatic.
    pub mode: Option<Mode>,
    /// Mode in the terms of the controller: `teach`, `play` (yerc); `auto`, `manual` (yrcx); `automatic`, `step`,
    /// `program` (toyo).
    pub controller_mode: Option<&'static str>,
    /// Whether servo power, or motor power, is on.
    pub servo_on: Option<bool>,
    /// Whether a job or program is running, or an axis is moving.
    pub running: Option<bool>,
    /// Whether the work is held or paused.
    pub held: Option<bool>,
    /// Whether the origin is known.
    pub homed: Option<bool>,
    /// Whether the emergency stop is active.
    pub emergency_stop: Option<bool>,
    /// Fault.
    #[serde(flatten)]
    pub fault: Fault,
    /// Selected or running program or job.
    pub program: Option<String>,
    /// Override of all speeds, in percent.
    pub speed_override_percent: Option<f64>,
    /// Position of the first robot in base coordinates.
    pub position: Option<PositionMm>,
}

/// Operating mode (ISO 10218-1).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// Motion by a person: teaching, jogging, single steps.
    Manual,
    /// Motion by a program.
    Automatic,
}

impl Mode {
    /// `Automatic` if `is_so` is true, otherwise `Manual`.
    pub const fn automatic(is_so: bool) -> Self {
        if is_so { Self::Automatic } else { Self::Manual }
    }

    /// Name in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Manual => "manual",
            Self::Automatic => "automatic",
        }
    }
}

/// Fault of a controller.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, JsonSchema)]
pub struct Fault {
    /// Whether an alarm or error is present; null if unknown.
    pub faulted: Option<bool>,
    /// Code in the notation of the controller, such as `4315`, `12.600` or `28`; null if there is none or it was not
    /// read.
    pub fault_code: Option<String>,
    /// Text of the controller, or of `alarms.toml` for the code; null if there is no code.
    pub fault_text: Option<String>,
}

impl Fault {
    /// Fault from its presence and the first present alarm, if read.
    pub fn new(is_present: bool, first: Option<&Alarm>) -> Self {
        let first = first.filter(|_| is_present);
        Self {
            faulted: Some(is_present),
            fault_code: first.and_then(|alarm| alarm.code.clone()),
            fault_text: first.and_then(|alarm| alarm.text.clone()),
        }
    }

    /// Replaces the text with the text of the operator's `alarms.toml`, if the file has one for the code.
    pub fn explain(&mut self, robot: &Robot) -> Result<()> {
        if let Some(code) = &self.fault_code
            && let Some(explained) = alarms::find(robot, code)?
        {
            self.fault_text = Some(explained.text);
        }
        Ok(())
    }

    /// Code and text, as far as known.
    pub fn describe(&self) -> Option<String> {
        let parts = [&self.fault_code, &self.fault_text];
        let described = parts.into_iter().flatten().map(String::as_str).collect::<Vec<_>>().join(" ");
        Some(described).filter(|told| !told.is_empty())
    }
}

/// Position in base coordinates.
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
    /// Position of a robot whose axes 1, 2 and 3 are X, Y and Z.
    pub fn of_axes([x_mm, y_mm, z_mm, _]: [f64; 4]) -> Self {
        Self { x_mm, y_mm, z_mm }
    }
}
