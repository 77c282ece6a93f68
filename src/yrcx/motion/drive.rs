//! `yrcx drive` (4.2.3) and `yrcx drivei` (4.2.4): absolute and relative moves of one axis.

use clap::ArgGroup;

use super::{Motion, MotionReport, Target, single_target};
use crate::arguments::SpeedArguments;
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;

/// Target of one axis; `yrcx push` uses it too.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("destination").required(true))]
pub struct Destination {
    /// Point whose coordinate of this axis is the target
    #[arg(long, value_name = "POINT", group = "destination")]
    point: Option<String>,
    /// Position in mm, or degrees for a rotary axis
    #[arg(long, value_name = "MM", group = "destination", allow_hyphen_values = true)]
    to: Option<String>,
    /// Position in pulses
    #[arg(long, value_name = "PULSES", group = "destination", allow_hyphen_values = true)]
    to_pulse: Option<String>,
}

impl Destination {
    /// Returns the command for the kind of target: a point, mm, or pulses.
    pub fn choose(&self, [point, mm, pulse]: [Command; 3]) -> Command {
        match self {
            Self { point: Some(_), .. } => point,
            Self { to: Some(_), .. } => mm,
            _ => pulse,
        }
    }

    /// Sets the fields of the target.
    pub fn apply_to(&self, draft: Draft) -> Draft {
        draft
            .with_some(Key::Point, self.point.clone())
            .with_some(Key::Target, self.to.clone().or(self.to_pulse.clone()))
    }

    /// Describes the target, for example `point 100` or `5.000 mm`.
    pub fn describe(&self) -> String {
        describe("point", [&self.point, &self.to, &self.to_pulse].map(Option::as_deref))
    }
}

/// Distance of one axis.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("distance").required(true))]
struct Distance {
    /// Point whose coordinate of this axis is the distance
    #[arg(long, value_name = "POINT", group = "distance")]
    point: Option<String>,
    /// Distance in mm, or degrees for a rotary axis
    #[arg(long, value_name = "MM", group = "distance", allow_hyphen_values = true)]
    by: Option<String>,
    /// Distance in pulses
    #[arg(long, value_name = "PULSES", group = "distance", allow_hyphen_values = true)]
    by_pulse: Option<String>,
}

/// Describes the target or distance that the user gave: a point, mm or pulses.
fn describe(name: &str, given: [Option<&str>; 3]) -> String {
    match given {
        [Some(point), ..] => format!("{name} {point}"),
        [_, Some(mm), _] => format!("{mm} mm"),
        [_, _, pulses] => format!("{} pulses", pulses.unwrap_or_default()),
    }
}

/// Moves one axis to an absolute position.
#[derive(Debug, Args)]
pub struct Drive {
    /// Axis to move, 1 to 4
    #[arg(long, value_name = "AXIS")]
    axis: String,
    #[command(flatten)]
    destination: Destination,
    #[command(flatten)]
    pace: SpeedArguments,
}

impl Motion for Drive {
    type Report = MotionReport;
    const ID: &'static str = "yrcx.drive";

    fn command(&self) -> Command {
        self.destination.choose([Command::DrivePoint, Command::DriveMm, Command::DrivePulse])
    }

    fn fill(&self, draft: Draft) -> Result<Draft> {
        self.pace.apply_to(self.destination.apply_to(draft.with(Key::Axes, self.axis.as_str())))
    }

    fn axis(&self) -> Option<String> {
        Some(format!("axis {}", self.axis))
    }

    fn target(&self) -> String {
        format!("to {}", self.destination.describe())
    }

    fn axes_and_speed(&self) -> String {
        self.pace.describe()
    }

    fn targets(&self) -> Vec<Target> {
        let Destination { to, to_pulse, .. } = &self.destination;
        single_target(&self.axis, to.as_ref(), to_pulse.as_ref())
    }
}

/// Moves one axis by a relative distance.
#[derive(Debug, Args)]
#[command(after_help = "If you repeat a stopped relative motion, the robot moves to the old target, unless the \
                        controller's \"MOVEI/DRIVEI start position\" is Reset.")]
pub struct Drivei {
    /// Axis to move, 1 to 4
    #[arg(long, value_name = "AXIS")]
    axis: String,
    #[command(flatten)]
    distance: Distance,
    #[command(flatten)]
    pace: SpeedArguments,
}

impl Motion for Drivei {
    type Report = MotionReport;
    const ID: &'static str = "yrcx.drivei";

    fn command(&self) -> Command {
        match &self.distance {
            Distance { point: Some(_), .. } => Command::DriveiPoint,
            Distance { by: Some(_), .. } => Command::DriveiMm,
            Distance { .. } => Command::DriveiPulse,
        }
    }

    fn fill(&self, draft: Draft) -> Result<Draft> {
        let Distance { point, by, by_pulse } = &self.distance;
        let draft = draft.with(Key::Axes, self.axis.as_str()).with_some(Key::Point, point.clone());
        self.pace.apply_to(draft.with_some(Key::Distance, by.clone().or(by_pulse.clone())))
    }

    fn axis(&self) -> Option<String> {
        Some(format!("axis {}", self.axis))
    }

    fn target(&self) -> String {
        let Distance { point, by, by_pulse } = &self.distance;
        format!("by {}", describe("the distance of point", [point, by, by_pulse].map(Option::as_deref)))
    }

    fn axes_and_speed(&self) -> String {
        self.pace.describe()
    }

    fn targets(&self) -> Vec<Target> {
        let Distance { by, by_pulse, .. } = &self.distance;
        single_target(&self.axis, by.as_ref(), by_pulse.as_ref())
    }
}
