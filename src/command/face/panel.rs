//! What `armctl teach` types for a family: each key is a command line that a person could type as well.

use serde_json::Value;

/// The command lines behind the keys of the panel, without the word of the family.
#[derive(Debug, Clone, Copy)]
pub struct Panel {
    /// Ways in which the axes move.
    pub systems: &'static [System],
    /// What tells where the robot stands, for [`Step::from`].
    pub position: &'static [&'static str],
    /// What stops the robot.
    pub stop: &'static [&'static str],
    /// What lets the robot go on after that, and may let a motion that was stopped go on; nothing where none is needed.
    pub release: Option<&'static [&'static str]>,
    /// Asks what is stored in a point.
    pub stored: fn(point: u32) -> Vec<String>,
    /// Stores the place of the robot in a point.
    pub store: fn(point: u32, system: &System) -> Vec<String>,
    /// Goes to a point.
    pub go: fn(point: u32, system: &System, speed: u32) -> Vec<String>,
    /// How points are named: `P5`, `point 5`.
    pub point: fn(u32) -> String,
    /// The small step of a controller that moves by its own.
    pub small_step: Option<SmallStep>,
}

/// What a small step of the controller is.
#[derive(Debug, Clone, Copy)]
pub struct SmallStep {
    /// What asks for it.
    pub words: &'static [&'static str],
    /// Its size in the answer, for axis 0, 1 and so on.
    pub size: fn(&Value, usize) -> Option<f64>,
}

/// A way in which axes move.
#[derive(Debug, Clone, Copy)]
pub struct System {
    /// In a word: `base`, `tool`, `axes`.
    pub name: &'static str,
    /// What moves, with the unit of its steps.
    pub axes: &'static [(&'static str, &'static str)],
    /// Steps, the smallest first; the last one is the most that a key moves.
    pub steps: &'static [f64],
    /// Speeds, the lowest first; empty where the controller has its own for small steps.
    pub speeds: &'static [u32],
    /// What a speed is: `mm/s, deg/s`, `%`.
    pub speed_unit: &'static str,
    /// Moves an axis by a step.
    pub step: fn(&Step<'_>) -> Option<Vec<String>>,
}

/// A step to be taken.
#[derive(Debug, Clone, Copy)]
pub struct Step<'a> {
    /// Number of the axis in [`System::axes`].
    pub axis: usize,
    /// How far; signed.
    pub by: f64,
    /// How fast.
    pub speed: u32,
    /// Where the robot stands: the data of [`Panel::position`], asked for this step.
    pub from: &'a Value,
}

/// Words of a command line.
pub fn words(text: &str) -> Vec<String> {
    text.split(' ').map(str::to_owned).collect()
}
