//! Confirmation of a motion. It shows each axis with target and unit, and the current value if it can be compared.

use std::borrow::Cow;

use super::arguments::{Speed, Values, base_is_given, describe};
use super::execution::Goal;
use crate::position::{axis_names, in_a_line};
use crate::prelude::*;
use armctl_controller::units::{self, Unit};
use armctl_controller::yerc::payload::SpeedClass;
use armctl_frame::gate::data_changed;

/// Parts of the text that describes a motion.
#[derive(Debug)]
pub(super) struct Question<'a> {
    /// What moves, such as `move R1 in a straight line`.
    pub(super) what: String,
    /// `to`, or `by` for a distance.
    pub(super) preposition: &'static str,
    /// Type of the position values.
    pub(super) kind: PositionKind,
    /// Values of the robot axes.
    pub(super) robot: Option<Vec<i32>>,
    /// Values of the base, and their unit.
    pub(super) base: (Option<&'a Values>, Unit),
    /// Values of the station axes.
    pub(super) station: Option<Cow<'a, Values>>,
    /// Further conditions, such as `in base coordinates, tool 0`; may be empty.
    pub(super) manner: String,
    pub(super) speed: Speed,
}

impl Question<'_> {
    /// Text in one line, if nothing was read from the robot.
    pub(super) fn in_a_line(&self) -> String {
        let base = base_is_given(self.base.0, self.base.1);
        let place = describe(self.kind, self.robot.as_deref(), base, self.station.as_deref());
        let how = if self.manner.is_empty() { String::new() } else { format!(" {}", self.manner) };
        let place = if place.is_empty() { place } else { format!(" {} {place}", self.preposition) };
        format!("{}{place}{how} at {}", self.what, self.speed)
    }

    /// One line per axis, with its current value if `start` can be compared with the goal. `per_degree` contains the
    /// pulses per degree of each axis, for as many axes as they are known.
    pub(super) fn change(&self, group: Group, start: Option<&Position>, goal: &Goal, per_degree: &[f64]) -> Change {
        let mut change = Change::new(format!("{} at {}", self.what, self.speed));
        match (goal, start) {
            (Goal::Base(target, tool), Some(start)) if start.tool == *tool && start.kind == PositionKind::Base => {
                change = compared(change, group, start, target, &[]);
                let [x, y, z] = [0, 1, 2].map(|axis| describe_distance(start, target, axis));
                let way = (x * x + y * y + z * z).sqrt() / 1000.0;
                change = change.note(format!("The target is {way:.3} mm away{}.", self.time(way)));
            }
            (Goal::Pulses(target), Some(start)) if start.kind == PositionKind::Pulse => {
                change = compared(change, group, start, target, per_degree);
                if let Some(farthest) = longest_distance(group, start, target, per_degree) {
                    change = change.note(farthest);
                }
            }
            _ => {
                let robot = (self.robot.as_deref().unwrap_or_default(), self.kind);
                let station = (self.station.as_ref().map_or(&[][..], |axes| &axes.0), PositionKind::Pulse);
                for (axes, kind) in [robot, station] {
                    for (at, (name, value)) in axis_names(kind, group).iter().zip(axes).enumerate() {
                        change = change.item(format!("{name}: {} {}", self.preposition, shown(kind, at, *value)));
                    }
                }
            }
        }
        if let Some(base) = base_is_given(self.base.0, self.base.1) {
            change = change.item(format!("base: {} {base}", self.preposition));
        }
        match self.manner.trim_end_matches(',').strip_prefix("in ") {
            Some(how) => change.note(format!("In {how}.")),
            None => change,
        }
    }

    /// Text with the minimum duration, for a speed along the path.
    fn time(&self, way_mm: f64) -> String {
        if self.speed.class != SpeedClass::Linear {
            return String::new();
        }
        format!(": {:.1} s at least", way_mm / (f64::from(self.speed.word) / 10.0))
    }
}

/// Adds each axis with its old and new value.
pub(crate) fn compared(change: Change, group: Group, start: &Position, target: &[i32], per_degree: &[f64]) -> Change {
    let axes = axis_names(start.kind, group).into_iter().zip(start.axes.as_slice().iter().zip(target)).enumerate();
    axes.fold(change, |change, (at, (name, (old, new)))| {
        let degrees = per_degree.get(at).map(|per| [old, new].map(|pulses| f64::from(*pulses) / per));
        let degrees = degrees.map(|[old, new]| format!(" ({old:.3} -> {new:.3} deg)")).unwrap_or_default();
        let new = format!("{}{degrees}", shown(start.kind, at, *new));
        change.replaces(name, start.kind.unit(at).show(*old).to_string().as_str(), &new)
    })
}

/// Text with the largest rotation of an axis, if degrees are known.
fn longest_distance(group: Group, start: &Position, target: &[i32], per_degree: &[f64]) -> Option<String> {
    let distances = axis_names(start.kind, group).into_iter().zip(per_degree).enumerate();
    let ways = distances.map(|(at, (name, per))| (name, (describe_distance(start, target, at) / per).abs()));
    let (name, degrees) = ways.max_by(|(_, one), (_, other)| one.total_cmp(other))?;
    Some(format!("Largest rotation: {name}, {degrees:.3} deg."))
}

/// Value with its unit.
fn shown(kind: PositionKind, axis: usize, value: i32) -> String {
    let unit = kind.unit(axis);
    let symbol = if unit == units::PULSE { "pulses" } else { unit.symbol };
    format!("{} {symbol}", unit.show(value))
}

/// Distance of an axis in protocol units.
fn describe_distance(start: &Position, target: &[i32], axis: usize) -> f64 {
    let of = |axes: &[i32]| axes.get(axis).copied().map_or(0.0, f64::from);
    of(target) - of(start.axes.as_slice())
}

/// Failure: the robot moved between the question and the answer.
pub(crate) fn moved_during_question(group: Group, now: &Position) -> Failure {
    let place = in_a_line(now.kind, now.axes.as_slice(), matches!(group, Group::Robot(_)));
    data_changed(format!("{group} moved after the confirmation, to {place}; nothing was sent"))
}
