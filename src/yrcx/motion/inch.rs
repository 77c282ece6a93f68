//! `yrcx inch` (4.2.7): move by the inching distance.

use super::{Motion, MotionReport};
use crate::arguments::{Direction, System};
use crate::position::Unit;
use crate::prelude::*;

use armctl_controller::yrcx::table::Command;

/// Moves by the inching distance.
#[derive(Debug, Args)]
#[command(
    after_help = "`yrcx inch-distance` sets the distance, `yrcx info inch` reads it. The speed is the manual speed."
)]
pub struct Inch {
    /// Coordinate system
    system: System,
    /// Axis, 1 to 4
    axis: String,
    /// Direction
    direction: Direction,
}

impl Motion for Inch {
    type Report = MotionReport;
    const ID: &'static str = "yrcx.inch";
    const VERB: [&'static str; 3] = ["inch", "inching", "inched"];

    fn command(&self) -> Command {
        match self.system {
            System::Pulse => Command::InchPulse,
            System::Cartesian => Command::InchCartesian,
            System::Tool => Command::InchTool,
        }
    }

    fn fill(&self, draft: Draft) -> Result<Draft> {
        Ok(draft.with(Key::Axes, self.axis.as_str()).with(Key::Direction, self.direction.value()))
    }

    fn axis(&self) -> Option<String> {
        Some(format!("axis {}", self.axis))
    }

    fn target(&self) -> String {
        format!("{}{}", self.direction.describe(), self.system.describe())
    }

    fn axes_and_speed(&self) -> String {
        "by the inching distance, at the manual speed".to_owned()
    }

    fn usual_unit(&self) -> Option<Unit> {
        Some(self.system.unit())
    }
}
