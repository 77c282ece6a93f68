//! Motions: common keys of the reports of moves, jogs, homing and runs to a point in every family.

use super::position::Position;
use crate::prelude::basics::*;

/// A motion. A field is null if the protocol does not report it, if it does not follow from the command, or if the
/// command did not wait.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct Motion {
    /// Whether the controller accepted the command.
    pub accepted: bool,
    /// Moving group: `R1` (yerc), `unit 1` (yrcx, toyo).
    pub group: Option<String>,
    /// Start position.
    pub from: Option<Position>,
    /// Target position.
    pub to: Option<Position>,
    /// Named axes with their targets.
    pub targets: Vec<Target>,
    /// Commanded speed.
    pub speed: Option<Speed>,
    /// Whether the target is reached.
    pub reached: Option<bool>,
    /// Position at the end.
    pub position: Option<Position>,
    /// Time in ms from acceptance to the end.
    pub elapsed_ms: Option<u64>,
}

/// The target of one axis.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct Target {
    /// Axis name or number.
    pub axis: String,
    /// Start position.
    pub from: Option<f64>,
    /// Target position, or distance.
    pub to: Option<f64>,
    /// `mm`, `deg` or `pulses`.
    pub unit: &'static str,
}

/// A speed with its unit.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Speed {
    /// Value.
    pub value: f64,
    /// `%`, `mm/s` or `deg/s`.
    pub unit: &'static str,
}
