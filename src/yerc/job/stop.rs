//! `yerc stop` and `yerc job stop`.

use crate::prelude::*;
use armctl_controller::yerc::query::{self, Query as _};

/// Stops the running job and all motion: HOLD on, like `yerc hold on` (FS and DX 3.3.20). It is `yerc job stop`, and
/// `yerc stop` for all motion.
#[derive(Debug, Args)]
pub struct Stop<const IS_OF_JOB: bool> {}

impl<const IS_OF_JOB: bool> Command for Stop<IS_OF_JOB> {
    type Family = Yerc;
    type Report = SetReport;
    const ID: &'static str = if IS_OF_JOB { "yerc.job.stop" } else { "yerc.stop" };

    fn risk(&self) -> Risk {
        query::Hold(true).risk()
    }

    fn is_stop(&self) -> bool {
        true
    }

    async fn run(&self, context: Context<'_, Yerc>) -> Result<SetReport> {
        context.link.ask(&query::Hold(true)).await?;
        let words = "HOLD is on and the job is stopped; to continue it, use `yerc hold off` and `yerc job start`";
        // A stop must not be delayed by a read, so the old value is not read, as in `hold on`.
        Ok(NewValue::of("held", true, words).replaces(Old::UNREAD))
    }
}
