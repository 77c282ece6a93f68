//! `yrcx abs-reset` (4.2.10, 4.2.11): absolute reset of an axis of the mark type.

use super::{MotionReport, execute_motion};
use crate::arguments::{Direction, UnitArgument};
use crate::confirmed_write::confirmation;
use crate::prelude::*;
use armctl_frame::wait_arguments::MotionEnd;

/// Resets the absolute position of an axis of the mark type.
#[derive(Debug, Args)]
#[command(
    after_help = "First use `--move +` or `--move -` to move to the nearest reset position. There are four reset \
                  positions per motor turn. Check the marks: a reset at the wrong position shifts the origin. Then \
                  run the command without --move."
)]
pub struct AbsReset {
    /// The axis, 1 to 4
    #[arg(long, value_name = "AXIS")]
    axis: String,
    /// Do not reset: only move in this direction to the nearest reset position
    #[arg(long = "move", value_name = "DIRECTION", allow_hyphen_values = true)]
    direction: Option<Direction>,
    #[command(flatten)]
    end: MotionEnd,
    #[command(flatten)]
    which: UnitArgument,
}

impl AbsReset {
    fn command(&self) -> table::Command {
        match self.direction {
            Some(_) => table::Command::AbsoluteResetMove,
            None => table::Command::AbsoluteReset,
        }
    }

    /// Names the axis, for example `axis 2 of robot 1`.
    fn axis(&self) -> String {
        format!("axis {} of {}", self.axis, self.which.name())
    }
}

impl Command for AbsReset {
    type Family = Yrcx;
    type Report = MotionReport;
    const ID: &'static str = "yrcx.abs-reset";

    fn risk(&self) -> Risk {
        self.command().row().risk
    }

    fn intent(&self) -> String {
        let axis = self.axis();
        match self.direction {
            Some(direction) => format!("move {axis} {} to the nearest reset position", direction.describe()),
            None => format!("set the current position of {axis} as its reset position, which defines its origin"),
        }
    }

    fn confirmation(&self) -> Confirmation {
        confirmation(self.command())
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<MotionReport> {
        let draft = context.link.draft(self.command())?.with(Key::Axes, self.axis.as_str());
        let Some(direction) = self.direction else {
            if self.end.no_wait() {
                return Err(Failure::usage("--no-wait needs --move").hint("remove --no-wait"));
            }
            let order = draft.valid_order()?;
            let done = context.link.ask(&order).await?;
            let words = format!("reset the absolute position of {}", self.axis());
            return Ok(MotionReport::new(words, &order, Some(&done), None));
        };
        let order = draft.with(Key::Direction, direction.value()).valid_order()?;
        let way = format!("{} {} to a reset position", self.axis(), direction.describe());
        let done =
            execute_motion(context.link, context.screen, &order, self.end.no_wait(), &format!("moving {way}")).await?;
        let verb = if done.is_some() { "moved" } else { "moving" };
        Ok(MotionReport::new(format!("{verb} {way}"), &order, done.as_ref(), None))
    }
}
