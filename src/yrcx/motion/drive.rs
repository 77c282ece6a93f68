//! `yrcx drive` (4.2.3) and `yrcx drivei` (4.2.4): absolute and relative moves of one axis.

use clap::{ArgGroup, Args};

use super::{Motion, MotionReport, Target, single_target};
use crate::arguments::Pace;
use armctl_controller::yrcx::order::Draft;
use armctl_controller::yrcx::table::Command;
use armctl_controller::yrcx::value::Key;
use armctl_frame::failure::Failure;

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
    pub fn put(&self, draft: Draft) -> Draft {
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
    pace: Pace,
}

impl Motion for Drive {
    type Report = MotionReport;
    const ID: &'static str = "yrcx.drive";

    fn command(&self) -> Command {
        self.destination.choose([Command::DrivePoint, Command::DriveMm, Command::DrivePulse])
    }

    fn fill(&self, draft: Draft) -> Result<Draft, Failure> {
        self.pace.put(self.destination.put(draft.with(Key::Axes, self.axis.as_str())))
    }

    fn axis(&self) -> Option<String> {
        Some(format!("axis {}", self.axis))
    }

    fn target(&self) -> String {
        format!("to {}", self.destination.describe())
    }

    fn manner(&self) -> String {
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
    pace: Pace,
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

    fn fill(&self, draft: Draft) -> Result<Draft, Failure> {
        let Distance { point, by, by_pulse } = &self.distance;
        let draft = draft.with(Key::Axes, self.axis.as_str()).with_some(Key::Point, point.clone());
        self.pace.put(draft.with_some(Key::Distance, by.clone().or(by_pulse.clone())))
    }

    fn axis(&self) -> Option<String> {
        Some(format!("axis {}", self.axis))
    }

    fn target(&self) -> String {
        let Distance { point, by, by_pulse } = &self.distance;
        format!("by {}", describe("the distance of point", [point, by, by_pulse].map(Option::as_deref)))
    }

    fn manner(&self) -> String {
        self.pace.describe()
    }

    fn targets(&self) -> Vec<Target> {
        let Distance { by, by_pulse, .. } = &self.distance;
        single_target(&self.axis, by.as_ref(), by_pulse.as_ref())
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{intent, objection, rejects, words};

    #[test]
    fn one_axis_to_a_place_or_by_a_distance() {
        let sent = words(&["drive", "--axis", "4", "--to", "-0.001", "--unit", "2", "--speed-of-max", "100"]).unwrap();
        assert_eq!(sent[0][..6], ["0x2012", "0x0003", "0x0008", "0x2710", "0xFFFF", "0xFFFF"]);
        let sent = words(&["drivei", "--axis", "1", "--by-pulse", "-5"]).unwrap();
        assert_eq!(sent[0][..6], ["0x0017", "0x0001", "0x0001", "0x0000", "0xFFFB", "0xFFFF"]);
        assert_eq!(
            intent(&["drive", "--axis", "3", "--to", "5.000", "--speed", "50", "--unit", "4"]),
            "move axis 3 of robot 4 to 5.000 mm (at 50 %)"
        );
        assert_eq!(
            intent(&["drivei", "--axis", "3", "--point", "7"]),
            "move axis 3 of robot 1 by the distance of point 7 (at the program speed)"
        );
    }

    #[test]
    fn what_cannot_be_meant_is_rejected() {
        rejects([
            ("drive --axis 1,2 --to 5", "axes: 2 named; name exactly 1"),
            ("drive --axis 5 --to 5", "must be from 1 to 4"),
            ("drive --axis X --to 5", "'X' is not a valid list"),
            ("drive --axis 1 --point 30000", "allowed: 0 to 29999"),
            ("drive --axis 1 --to 3000000", "target"),
            ("drivei --axis 1 --by 0.0001", "distance"),
            ("drivei --axis 1 --by 1 --speed 0", "allowed: 1 to 100 %"),
            ("drivei --axis 1 --by 1 --speed 10mm/s", "a linear or circular move"),
        ]);
        for line in [&["drive", "--to", "5"][..], &["drive", "--axis", "1"], &["drivei", "--axis", "1", "--to", "5"]] {
            assert!(objection(line).starts_with("error"), "{line:?}");
        }
    }
}
