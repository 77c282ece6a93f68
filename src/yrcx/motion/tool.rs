//! `yrcx movet` (4.2.21): move to a point in tool coordinates.

use super::{Motion, MotionReport};
use crate::arguments::{Axes, Ramps, SpeedArguments};
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;

/// Moves a robot to a point in tool coordinates. The coordinates of the point are along the axes of the tool.
#[derive(Debug, Args)]
pub struct Movet {
    /// Point to move to
    #[arg(long, value_name = "POINT")]
    point: String,
    /// Move in a straight line; --speed may be in mm/s
    #[arg(long)]
    linear: bool,
    #[command(flatten)]
    axes: Axes,
    #[command(flatten)]
    pace: SpeedArguments,
    #[command(flatten)]
    ramps: Ramps,
}

impl Motion for Movet {
    type Report = MotionReport;
    const ID: &'static str = "yrcx.movet";

    fn command(&self) -> Command {
        if self.linear { Command::MovetLinear } else { Command::MovetPtp }
    }

    fn fill(&self, draft: Draft) -> Result<Draft> {
        let draft = self.axes.apply_to(draft).with(Key::Point, self.point.as_str());
        let draft = if self.linear { self.pace.apply_linear(draft) } else { self.pace.apply_to(draft)? };
        self.ramps.apply_to(draft, self.command())
    }

    fn target(&self) -> String {
        let way = if self.linear { " in a straight line" } else { "" };
        format!("to point {} in tool coordinates{way}", self.point)
    }

    fn axes_and_speed(&self) -> String {
        format!("{}, {}", self.axes.describe(&[]), self.pace.describe())
    }
}
