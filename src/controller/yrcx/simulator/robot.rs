//! A robot: axes, selections, position.

use std::collections::BTreeMap;

use super::alarms::{AlarmSource, Fault, SOFT_LIMIT};
use super::geometry::{Arm, FourValues, Geometry, Kind};
use super::motion::{End, Motion, Owner};
use crate::Now;
use crate::simulator::run_options::MotionLog;
use crate::yrcx::image::Words;

/// Maximum number of axes.
pub(super) const AXES: usize = 4;
/// Mask for all axes, one bit per axis.
pub(super) const ALL: u8 = 0b1111;
/// Distance in pulses between two absolute reset positions: a quarter turn of a motor with 16384 pulses (4.2.10).
pub(super) const RESET_PITCH: f64 = 4096.0;
/// Ratio of the maximum torque to the rated torque.
pub(super) const MAX_OF_RATED: i32 = 5;
/// Default torque limit, in percent of the maximum torque.
pub(super) const FULL_TORQUE: i32 = 100;
/// Torque of a moving axis in addition to its load, in percent of the maximum.
const MOVING_TORQUE: i32 = 10;

/// Position detector of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Motor {
    Incremental,
    Absolute,
    SemiAbsolute,
}

/// How the origin of an axis is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Method {
    Mark,
    Sensor,
    Stroke,
}

/// Servo state of an axis (4.7.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Servo {
    #[serde(rename = "servo")]
    On,
    Brake,
    Free,
}

impl Servo {
    pub(super) fn code(self) -> i32 {
        match self {
            Self::Brake => 0,
            Self::On => 1,
            Self::Free => 2,
        }
    }
}

#[derive(Debug, Clone)]
pub(super) struct Axis {
    /// Model number of the axis in the answer of 4.7.2.
    pub(super) model: u16,
    pub(super) motor: Motor,
    pub(super) method: Method,
    /// Pulses per mm or degree.
    pub(super) per_unit: f64,
    /// Soft limits in pulses.
    pub(super) limits: (f64, f64),
    /// Full speed in mm/s or degrees/s.
    pub(super) speed: f64,
    pub(super) pulses: f64,
    pub(super) servo: Servo,
    pub(super) origin: bool,
    /// Torque limit in percent of the maximum torque. Power off resets the limit.
    pub(super) torque_limit: i32,
    /// Holding torque in percent of the maximum.
    pub(super) load: i32,
    /// Position of an obstacle in pulses.
    pub(super) obstacle: Option<f64>,
    pub(super) parameters: BTreeMap<u16, i32>,
}

impl Axis {
    pub(super) fn is_within(&self, pulses: f64) -> bool {
        // Tolerance for rounding errors.
        (self.limits.0 - 1e-6..=self.limits.1 + 1e-6).contains(&pulses)
    }

    pub(super) fn parameter(&self, number: u16) -> i32 {
        self.parameters.get(&number).copied().unwrap_or_default()
    }
}

/// An interrupted relative motion. It continues if the same command follows (4.2.2, 4.2.4).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ResumableMotion {
    pub(super) words: Words,
    pub(super) target: FourValues,
}

#[derive(Debug, Clone)]
pub(super) struct Robot {
    pub(super) kind: Kind,
    /// Model number of the robot in the answer of 4.7.2.
    pub(super) model: u16,
    pub(super) axes: Vec<Axis>,
    pub(super) max_payload_g: i32,
    pub(super) payload_g: i32,
    pub(super) auto_speed: i32,
    pub(super) manual_speed: i32,
    pub(super) program_speed: i32,
    pub(super) inching: i32,
    pub(super) shift: usize,
    pub(super) hand: Option<usize>,
    pub(super) arm: Arm,
    pub(super) motion: Option<Motion>,
    /// Motions that have ended. An entry stays until the owner of the motion removes it.
    pub(super) ended: Vec<(Owner, End)>,
    /// Axis of the last push, and its torque in percent of the rated torque.
    pub(super) pushing: Option<(usize, i32)>,
    /// Axes whose origin becomes known when the motion ends, one bit per axis.
    pub(super) homing: u8,
    pub(super) kept: Option<ResumableMotion>,
    /// Log of the motions, and the index of this robot.
    pub(super) log: Option<(usize, MotionLog)>,
}

impl Robot {
    /// Axis positions in pulses; 0 for missing axes.
    pub(super) fn pulses(&self) -> FourValues {
        std::array::from_fn(|axis| self.axes.get(axis).map_or(0.0, |axis| axis.pulses))
    }

    /// Existing axes, one bit per axis.
    pub(super) fn mask(&self) -> u8 {
        (0..self.axes.len()).fold(0, |mask, axis| mask | 1 << axis)
    }

    /// Kinematics with this hand.
    pub(super) fn geometry(&self, hand: Option<[i32; 4]>) -> Geometry {
        let per_unit = std::array::from_fn(|axis| self.axes.get(axis).map_or(1.0, |axis| axis.per_unit));
        Geometry { kind: self.kind, per_unit, hand }
    }

    /// Index of the first axis outside its soft limits.
    pub(super) fn beyond(&self, pulses: &FourValues) -> Option<usize> {
        self.axes.iter().zip(pulses).position(|(axis, pulses)| !axis.is_within(*pulses))
    }

    /// Refuses a position outside of the soft limits. `robot` is the index of this robot.
    pub(super) fn check_limits(&self, robot: usize, pulses: &FourValues) -> Result<(), Fault> {
        match self.beyond(pulses) {
            Some(axis) => Err(over_limit(robot, axis)),
            None => Ok(()),
        }
    }

    /// Time in seconds that the slowest axis needs at full speed.
    pub(super) fn seconds(&self, from: &FourValues, to: &FourValues) -> f64 {
        let ways = self.axes.iter().zip(from.iter().zip(to));
        ways.map(|(axis, (from, to))| (to - from).abs() / (axis.per_unit * axis.speed)).fold(0.0, f64::max)
    }

    /// Advances the motion to `now`.
    pub(super) fn advance(&mut self, now: Now) {
        let Some(motion) = &mut self.motion else { return };
        let (place, end) = motion.advance(now);
        let owner = motion.owner;
        if let Some(place) = place {
            for (axis, pulses) in self.axes.iter_mut().zip(place) {
                axis.pulses = pulses;
            }
        }
        if let Some(end) = end {
            self.log_motion(!matches!(end, End::Stopped(_)));
            self.motion = None;
            self.pushing = None;
            if end == End::Arrived {
                self.kept = None;
            }
            let homing = std::mem::take(&mut self.homing);
            for (at, axis) in self.axes.iter_mut().enumerate() {
                axis.origin |= end == End::Arrived && homing >> at & 1 == 1;
            }
            self.ended.push((owner, end));
        }
    }

    /// Ends the motion at once because power is off.
    pub(super) fn halt(&mut self, fault: &Fault) {
        self.log_motion(false);
        if let Some(motion) = self.motion.take() {
            self.ended.push((motion.owner, End::Stopped(fault.clone())));
        }
        self.pushing = None;
        self.homing = 0;
    }

    fn log_motion(&self, reached: bool) {
        if let (Some((number, log)), Some(motion)) = (&self.log, &self.motion) {
            log.push(motion.entry(*number, self.axes.len(), &self.pulses(), reached));
        }
    }

    /// Removes and returns the end of a motion of `owner`.
    pub(super) fn take_end(&mut self, owner: Owner) -> Option<End> {
        let at = self.ended.iter().position(|(other, _)| *other == owner)?;
        Some(self.ended.remove(at).1)
    }

    /// Signed torque of an axis in percent of the maximum.
    pub(super) fn torque(&self, number: usize) -> i32 {
        let Some(axis) = self.axes.get(number).filter(|axis| axis.servo == Servo::On) else { return 0 };
        let moving = self.motion.as_ref().map_or(0.0, |motion| motion.direction()[number]);
        let torque = match self.pushing {
            Some((pushed, force)) if pushed == number => force / MAX_OF_RATED,
            _ if moving > 0.0 => axis.load + MOVING_TORQUE,
            _ if moving < 0.0 => axis.load - MOVING_TORQUE,
            _ => axis.load,
        };
        torque.clamp(-axis.torque_limit, axis.torque_limit)
    }

    /// Whether the origin of all axes is known.
    pub(super) fn is_at_home(&self) -> bool {
        self.axes.iter().all(|axis| axis.origin)
    }
}

pub(super) fn over_limit(robot: usize, axis: usize) -> Fault {
    let why = format!("axis {} would be outside its soft limits", axis + 1);
    Fault::new(SOFT_LIMIT, AlarmSource::Axis(robot, axis), why)
}
