//! `yerc stop` and `yerc job stop`.

use crate::link::Yerc;
use crate::prelude::*;
use armctl_controller::yerc::query::{self, Query as _};

/// Stops the running job and all motion: HOLD on, like `yerc hold on` (FS and DX 3.3.20).
#[derive(Debug, Args)]
pub struct Stop {}

impl Command for Stop {
    type Family = Yerc;
    type Report = SetReport;
    const ID: &'static str = "yerc.job.stop";

    fn risk(&self) -> Risk {
        query::Hold(true).risk()
    }

    fn is_stop(&self) -> bool {
        true
    }

    async fn run(&self, context: Context<'_, Yerc>) -> Result<SetReport, Failure> {
        hold(context).await
    }
}

/// Stops all motion. This is the command `yerc stop`.
#[derive(Debug, Args)]
pub struct Halt {}

impl Command for Halt {
    type Family = Yerc;
    type Report = SetReport;
    const ID: &'static str = "yerc.stop";

    fn risk(&self) -> Risk {
        query::Hold(true).risk()
    }

    fn is_stop(&self) -> bool {
        true
    }

    async fn run(&self, context: Context<'_, Yerc>) -> Result<SetReport, Failure> {
        hold(context).await
    }
}

async fn hold(context: Context<'_, Yerc>) -> Result<SetReport, Failure> {
    context.link.ask(&query::Hold(true)).await?;
    let words = "HOLD is on and the job is stopped; to continue it, use `yerc hold off` and `yerc job start`";
    // A stop must not be delayed by a read, so the old value is not read, as in `hold on`.
    Ok(NewValue::of("held", true, words).replaces(Old::UNREAD))
}
