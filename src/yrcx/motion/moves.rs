//! `yrcx move` (4.2.1): move to one or two points, or to coordinates.

use clap::ArgGroup;

use super::{Motion, MotionReport, Target, targets};
use crate::arguments::{Arch, Axes, Hand, Ramps, SpeedArguments};
use crate::position::Unit;
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;

/// Moves to a point, or to coordinates.
#[derive(Debug, Args)]
#[command(
    group = ArgGroup::new("destination").required(true),
    after_help = "Without --speed the robot moves at the program speed. A SCARA also moves axes 1 and 2 if you type \
                  only other axes (4.2.1). With --to, armctl first reads the current position of axes 1 and 2 and \
                  sends that position, so that these axes do not move. With --point, axes 1 and 2 may move to the \
                  point."
)]
pub struct Move {
    /// Target point; with --circular, two points, for example 100,101
    #[arg(long, value_name = "POINT", group = "destination", value_delimiter = ',')]
    point: Vec<String>,
    /// Coordinates in mm: of all four axes, or of the axes in --axes in that order, or with the axis numbers, for
    /// example 1=300,3=10
    #[arg(long, value_name = "[AXIS=]MM,…", group = "destination", value_delimiter = ',', allow_hyphen_values = true,
        conflicts_with_all = ["linear", "circular", "peak"])]
    to: Vec<String>,
    /// Coordinates in pulses, in the same form as --to
    #[arg(long, value_name = "[AXIS=]PULSES,…", group = "destination", value_delimiter = ',', allow_hyphen_values = true,
        conflicts_with_all = ["linear", "circular", "peak"])]
    to_pulse: Vec<String>,
    /// Move in a straight line; --speed may be in mm/s
    #[arg(long, group = "way")]
    linear: bool,
    /// Move in an arc through the first point to the second; --speed may be in mm/s
    #[arg(long, group = "way", conflicts_with = "axes")]
    circular: bool,
    #[command(flatten)]
    arch: Arch,
    #[command(flatten)]
    axes: Axes,
    #[command(flatten)]
    pace: SpeedArguments,
    #[command(flatten)]
    ramps: Ramps,
    /// Hand system of the coordinates of --to
    #[arg(long, value_name = "HAND", conflicts_with_all = ["point", "to_pulse"])]
    hand: Option<Hand>,
}

impl Motion for Move {
    type Report = MotionReport;
    const ID: &'static str = "yrcx.move";

    fn command(&self) -> Command {
        match self {
            Self { to, .. } if !to.is_empty() => Command::MoveMm,
            Self { to_pulse, .. } if !to_pulse.is_empty() => Command::MovePulse,
            Self { linear: true, .. } => Command::MoveLinear,
            Self { circular: true, .. } => Command::MoveCircular,
            Self { arch, .. } if arch.is_wanted() => Command::MoveArch,
            _ => Command::MovePtp,
        }
    }

    fn fill(&self, draft: Draft) -> Result<Draft> {
        let draft = match (&self.point[..], self.circular) {
            ([], _) => self.axes.apply_numbers(draft, [&self.to, &self.to_pulse][usize::from(self.to.is_empty())])?,
            ([point], false) => self.axes.apply_to(draft).with(Key::Point, point.as_str()),
            ([first, second], true) => draft.with(Key::Point, first.as_str()).with(Key::Point2, second.as_str()),
            (_, true) => {
                return Err(
                    Failure::usage("an arc needs two points").hint("type both points: --point 100,101 --circular")
                );
            }
            (_, false) => {
                return Err(
                    Failure::usage("this move needs one point").hint("type one point, or add --circular for an arc")
                );
            }
        };
        let draft =
            if self.linear || self.circular { self.pace.apply_linear(draft) } else { self.pace.apply_to(draft)? };
        let draft = self.arch.apply_to(self.ramps.apply_to(draft, self.command())?);
        Ok(draft.with_some(Key::HandSystem, self.hand.map(Hand::of_target)))
    }

    fn target(&self) -> String {
        let place = match (&self.point[..], &self.to[..], &self.to_pulse[..]) {
            ([first, second], ..) => format!("over point {first} to point {second}"),
            ([point, ..], ..) => format!("to point {point}"),
            (_, [_, ..], _) => format!("to {}", self.axes.describe_numbers(&self.to, Unit::Mm)),
            _ => format!("to {}", self.axes.describe_numbers(&self.to_pulse, Unit::Pulse)),
        };
        let way = match self.command() {
            Command::MoveLinear => " in a straight line".to_owned(),
            Command::MoveCircular => " in an arc".to_owned(),
            _ => self.arch.describe(),
        };
        format!("{place}{way}")
    }

    fn axes_and_speed(&self) -> String {
        let axes = self.axes.describe(if self.to.is_empty() { &self.to_pulse } else { &self.to });
        let along = match (&self.stays()[..], self.axes.omits_axis(&self.point)) {
            ([], false) => "",
            ([], true) => ", but a SCARA may also move axes 1 and 2 to the point",
            ([1], _) => ", axis 1 does not move",
            ([2], _) => ", axis 2 does not move",
            _ => ", axes 1 and 2 do not move",
        };
        format!("{axes}{along}, {}", self.pace.describe())
    }

    fn stays(&self) -> Vec<usize> {
        self.axes.unnamed_axes(&self.to)
    }

    fn targets(&self) -> Vec<Target> {
        targets(&self.axes, &self.to, &self.to_pulse)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::testing::{Reply, Scripted, frames, run_on};

    #[test]
    fn unnamed_axes_do_not_move() {
        let line = ["move", "--to", "4=90"];
        let mut place = [0; 16];
        (place[0], place[4], place[6], place[7]) = (0x0200, 1000, 0xF830, 0xFFFF);
        let mut end = [0; 16];
        end[0] = 0x0200;
        let (moved, peer) = run_on(Scripted::new([Reply::AddressPair(1, place), Reply::AddressPair(1, end)]), &line);
        assert_eq!(peer.taken[0][0], 0x0506, "the present position");
        assert_eq!(peer.taken[1][..11], [0x0006, 1, 8, 0, 1000, 0, 0xF830, 0xFFFF, 0, 0, 0x5F90]);
        assert_eq!(moved.unwrap()["targets"], json!([{"axis": "4", "from": null, "to": 90.0, "unit": "mm"}]));
        let noted = frames(&line).unwrap();
        assert_eq!((&noted[0]["about"], noted.len()), (&json!("current position"), 2));
        // Nothing moves if the position is unknown.
        let mut no = [0; 16];
        no[..3].copy_from_slice(&[0x4000, 5, 1]);
        let (refused, peer) = run_on(Scripted::new([Reply::AddressPair(1, no)]), &line);
        assert!(refused.unwrap_err().message.starts_with("the robot did not move"));
        assert_eq!(peer.taken.len(), 1);
        assert_eq!(frames(&["move", "--to", "1=1,2=2"]).unwrap().len(), 1);
    }
}
