//! `yrcx origin` (4.2.12): return to origin, of robots or of one axis.

use super::{MotionReport, execute_motion};
use crate::arguments::UnitArgument;
use crate::prelude::*;
use armctl_frame::wait_arguments::MotionEnd;

/// Returns robots or one axis to origin.
#[derive(Debug, Args)]
#[command(after_help = "Without --unit and --axis, all robots of the controller return to origin. Semi-absolute axes \
                        search for their position. Axes of the absolute mark type need `yrcx abs-reset` first.")]
pub struct Origin {
    /// Return only this axis of one robot, 1 to 4
    #[arg(long, value_name = "AXIS", conflicts_with = "only")]
    axis: Option<String>,
    /// Return only the axes of this type
    #[arg(long, value_name = "KIND")]
    only: Option<Kind>,
    #[command(flatten)]
    end: MotionEnd,
    #[command(flatten)]
    which: UnitArgument,
}

/// Axis types.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// Axes of the incremental type
    Incremental,
    /// Axes of the absolute type
    Absolute,
    /// Axes whose origin is not known
    Incomplete,
}

impl Kind {
    /// Value of the field: one bit per type.
    fn value(self) -> i32 {
        match self {
            Self::Incremental => 1,
            Self::Absolute => 2,
            Self::Incomplete => 4,
        }
    }
}

impl Origin {
    fn command(&self) -> table::Command {
        if self.axis.is_some() { table::Command::OriginAxis } else { table::Command::OriginRobot }
    }

    /// Describes the axes, for example `axis 1 of robot 1`.
    fn describe(&self) -> String {
        if let Some(axis) = &self.axis {
            return format!("axis {axis} of {}", self.which.name());
        }
        let axes = match self.only {
            None => "all axes",
            Some(Kind::Incremental) => "the incremental axes",
            Some(Kind::Absolute) => "the absolute axes",
            Some(Kind::Incomplete) => "the axes without known origin",
        };
        format!("{axes} of {}", self.which.name_or_all())
    }
}

impl Command for Origin {
    type Family = Yrcx;
    type Report = MotionReport;
    const ID: &'static str = "yrcx.origin";

    fn risk(&self) -> Risk {
        self.command().row().risk
    }

    fn intent(&self) -> String {
        format!("return {} to origin", self.describe())
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<MotionReport> {
        let draft = context.link.draft(self.command())?;
        let draft = draft.with_some(Key::Axes, self.axis.clone());
        let order = draft.with_some(Key::OriginAxes, self.only.map(Kind::value)).valid_order()?;
        let doing = format!("returning {} to origin", self.describe());
        let done = execute_motion(context.link, context.screen, &order, self.end.no_wait(), &doing).await?;
        let has_done = format!("returned {} to origin", self.describe());
        Ok(MotionReport::new(if done.is_some() { has_done } else { doing }, &order, done.as_ref(), None))
    }
}
