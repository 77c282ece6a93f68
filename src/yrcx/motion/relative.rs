//! `yrcx movei` (4.2.2): move by the distances of a point, or by typed distances.

use clap::ArgGroup;

use super::{Motion, MotionReport, Target, targets};
use crate::arguments::{Axes, Hand, Ramps, SpeedArguments};
use crate::position::Unit;
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;

/// Moves by distances.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("distance").required(true), after_help = "If you repeat a stopped relative motion, the \
    robot moves to the old target, unless the controller's \"MOVEI/DRIVEI start position\" is Reset.")]
pub struct Movei {
    /// Point that contains the distances
    #[arg(long, value_name = "POINT", group = "distance")]
    point: Option<String>,
    /// Distances in mm: of all four axes, or of the axes in --axes in that order, or with the axis numbers, for example
    /// 1=-5,3=10
    #[arg(
        long,
        value_name = "[AXIS=]MM,…",
        group = "distance",
        value_delimiter = ',',
        allow_hyphen_values = true,
        conflicts_with = "linear"
    )]
    by: Vec<String>,
    /// Distances in pulses, in the same form as --by
    #[arg(
        long,
        value_name = "[AXIS=]PULSES,…",
        group = "distance",
        value_delimiter = ',',
        allow_hyphen_values = true,
        conflicts_with = "linear"
    )]
    by_pulse: Vec<String>,
    /// Move in a straight line; --speed may be in mm/s
    #[arg(long)]
    linear: bool,
    #[command(flatten)]
    axes: Axes,
    #[command(flatten)]
    pace: SpeedArguments,
    #[command(flatten)]
    ramps: Ramps,
    /// Hand system at the end of --by
    #[arg(long, value_name = "HAND", conflicts_with_all = ["point", "by_pulse"])]
    hand: Option<Hand>,
}

impl Motion for Movei {
    type Report = MotionReport;
    const ID: &'static str = "yrcx.movei";

    fn command(&self) -> Command {
        match self {
            Self { by, .. } if !by.is_empty() => Command::MoveiMm,
            Self { by_pulse, .. } if !by_pulse.is_empty() => Command::MoveiPulse,
            Self { linear: true, .. } => Command::MoveiLinear,
            _ => Command::MoveiPtp,
        }
    }

    fn fill(&self, draft: Draft) -> Result<Draft> {
        let draft = match &self.point {
            Some(point) => self.axes.apply_to(draft).with(Key::Point, point.as_str()),
            None => self.axes.apply_numbers(draft, if self.by.is_empty() { &self.by_pulse } else { &self.by })?,
        };
        let draft = if self.linear { self.pace.apply_linear(draft) } else { self.pace.apply_to(draft)? };
        Ok(self.ramps.apply_to(draft, self.command())?.with_some(Key::HandSystem, self.hand.map(Hand::of_target)))
    }

    fn target(&self) -> String {
        let way = if self.linear { " in a straight line" } else { "" };
        match (&self.point, &self.by[..]) {
            (Some(point), _) => format!("by the distances of point {point}{way}"),
            (None, []) => format!("by {}", self.axes.describe_numbers(&self.by_pulse, Unit::Pulse)),
            (None, by) => format!("by {}", self.axes.describe_numbers(by, Unit::Mm)),
        }
    }

    fn axes_and_speed(&self) -> String {
        let axes = self.axes.describe(if self.by.is_empty() { &self.by_pulse } else { &self.by });
        format!("{axes}, {}", self.pace.describe())
    }

    fn targets(&self) -> Vec<Target> {
        targets(&self.axes, &self.by, &self.by_pulse)
    }
}
