//! Motions: the same keys in what moves, jogs, homes and runs to a point report in every family.

use schemars::JsonSchema;
use serde::Serialize;

use super::position::Position;

/// A motion. Null: the protocol does not report it, it does not follow from the order, or nobody waited for the end.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct Motion {
    /// Whether the controller took the order.
    pub accepted: bool,
    /// What moves: `R1` (yerc), `unit 1` (yrcx, toyo).
    pub group: Option<String>,
    /// Where it started.
    pub from: Option<Position>,
    /// The target.
    pub to: Option<Position>,
    /// Axes that were named, with their own targets.
    pub targets: Vec<Target>,
    /// The speed that was ordered.
    pub speed: Option<Speed>,
    /// Whether the target is reached.
    pub reached: Option<bool>,
    /// Where it stands at the end.
    pub position: Option<Position>,
    /// From the acceptance to the end.
    pub elapsed_ms: Option<u64>,
}

/// The target of one axis.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct Target {
    /// Its name, or its number.
    pub axis: String,
    /// Where it started.
    pub from: Option<f64>,
    /// Where it moves to, or by how much.
    pub to: Option<f64>,
    /// `mm`, `deg` or `pulses`.
    pub unit: &'static str,
}

/// A speed with its unit.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Speed {
    /// The number.
    pub value: f64,
    /// `%`, `mm/s` or `deg/s`.
    pub unit: &'static str,
}
