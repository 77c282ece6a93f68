//! Command `yrcx jog` (4.2.6): moves an axis until it is stopped. armctl stops the axis at every end of the command.

use super::{Live, MotionReport};
use crate::arguments::{Direction, EndOptions, System, UnitArgument};
use crate::position::Unit;
use crate::prelude::*;

/// Jogs an axis.
#[derive(Debug, Args)]
#[command(
    after_help = "The axis moves at the manual speed. The stop input SI(06) stops it after the time of --for or at \
                  Ctrl-C. SI(06) stays off if the controller does not report the end. If armctl or its computer fails, \
                  the connection drops and the controller stops the robot. A soft limit stops the axis with an alarm."
)]
pub struct Jog {
    /// Coordinate system
    system: System,
    /// Axis, 1 to 4
    axis: String,
    /// Direction
    direction: Direction,
    /// Time after which the jog stops [default: until Ctrl-C]
    #[arg(long = "for", value_name = "TIME", value_parser = duration::parse_some)]
    within: Option<Duration>,
    /// Report the end position in this unit [default: the unit of the axes]
    #[arg(long, value_name = "UNIT")]
    report: Option<Unit>,
    #[command(flatten)]
    which: UnitArgument,
}

impl Jog {
    fn command(&self) -> table::Command {
        match self.system {
            System::Pulse => table::Command::JogPulse,
            System::Cartesian => table::Command::JogCartesian,
            System::Tool => table::Command::JogTool,
        }
    }

    /// Describes direction and coordinate system, to complete "jog axis 1 …".
    fn describe(&self) -> String {
        format!("{}{}", self.direction.describe(), self.system.describe())
    }
}

impl Command for Jog {
    type Family = Yrcx;
    type Report = MotionReport;
    const ID: &'static str = "yrcx.jog";
    const JOGS: bool = true;

    fn risk(&self) -> Risk {
        self.command().row().risk
    }

    fn intent(&self) -> String {
        let until = match self.within {
            Some(time) => format!("for {}", duration::display(time)),
            None => "until Ctrl-C".to_owned(),
        };
        format!("jog axis {} of {} {} ({until}, at the manual speed)", self.axis, self.which.name(), self.describe())
    }

    fn moves_until_stopped(&self) -> bool {
        self.within.is_none()
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<MotionReport> {
        let link = context.link;
        let unit = self.report.unwrap_or(self.system.unit());
        let draft = link.draft(self.command())?.with(Key::Axes, self.axis.as_str());
        let order =
            EndOptions::apply_to(draft.with(Key::Direction, self.direction.value()), Some(unit)).valid_order()?;
        let object = format!("axis {} {}", self.axis, self.describe());
        let live = Live::new(link, context.screen, &format!("jogging {object}"));
        let done = link.jog(&order, self.within).await;
        live.end();
        Ok(MotionReport::new(format!("jogged {object}"), &order, Some(&done?), Some(unit)))
    }
}

#[cfg(test)]
mod tests;
