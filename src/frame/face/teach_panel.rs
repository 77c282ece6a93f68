//! Command lines of `armctl teach` for a family: each key corresponds to a command line that a person could type.

use serde_json::Value;

/// Command lines of the panel keys, without the family name.
#[derive(Debug, Clone, Copy)]
pub struct Panel {
    /// Coordinate systems.
    pub systems: &'static [System],
    /// Command that reads the position, for [`Step::from`].
    pub position: &'static [&'static str],
    /// Command that stops the robot.
    pub stop: &'static [&'static str],
    /// Command that enables motion after a stop, and may continue a stopped motion; `None` if the controller needs no
    /// such command.
    pub release: Option<&'static [&'static str]>,
    /// Command that reads a point.
    pub stored: fn(point: u32) -> Vec<String>,
    /// Command that stores the current position as a point.
    pub store: fn(point: u32, system: &System) -> Vec<String>,
    /// Command that moves to a point.
    pub go: fn(point: u32, system: &System, speed: u32) -> Vec<String>,
    /// Name of a point: `P5`, `point 5`.
    pub point: fn(u32) -> String,
    /// Inching step that is set in the controller, if there is one.
    pub small_step: Option<SmallStep>,
}

/// Inching step of a controller.
#[derive(Debug, Clone, Copy)]
pub struct SmallStep {
    /// Command that reads the inching step.
    pub words: &'static [&'static str],
    /// Step size of an axis, found in the answer to this command. The axes are counted from 0.
    pub size: fn(&Value, usize) -> Option<f64>,
}

/// A coordinate system.
#[derive(Debug, Clone, Copy)]
pub struct System {
    /// Name: `base`, `tool`, `axes`.
    pub name: &'static str,
    /// Axes, with the unit of their steps.
    pub axes: &'static [(&'static str, &'static str)],
    /// Step sizes, the smallest first. The last size is the maximum per key press.
    pub steps: &'static [f64],
    /// Speeds, the lowest first; empty if the controller has its own speed for inching.
    pub speeds: &'static [u32],
    /// Unit of speeds: `mm/s, deg/s`, `%`.
    pub speed_unit: &'static str,
    /// Command that moves an axis by a step.
    pub step: fn(&Step<'_>) -> Option<Vec<String>>,
}

/// A step to execute.
#[derive(Debug, Clone, Copy)]
pub struct Step<'a> {
    /// Index of the axis in [`System::axes`].
    pub axis: usize,
    /// Signed distance.
    pub by: f64,
    /// Speed.
    pub speed: u32,
    /// Current position: the data of [`Panel::position`], read for this step.
    pub from: &'a Value,
}

/// Words of a command line.
pub fn words(text: &str) -> Vec<String> {
    text.split(' ').map(str::to_owned).collect()
}
