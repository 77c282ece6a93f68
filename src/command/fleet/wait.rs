//! `armctl wait`: waits until robots of any family are in a state.

use std::time::Duration;

use clap::Args;

use crate::command::frame::condition::Condition;
use crate::command::frame::run::Repeat;
use crate::failure::Failure;
use crate::settings::duration;

const EVERY: Duration = Duration::from_millis(200);

/// Wait until a condition is true for all selected robots, and print their state
#[derive(Debug, Args)]
#[command(after_help = "Conditions: idle, running, held, faulted, homed, servo-on; NAME=VALUE with a key of `armctl \
                        status`; or a jq filter over its JSON that begins with a dot. For signals and variables: \
                        `armctl yerc io get clamp --until clamp=on`.")]
pub struct Wait {
    /// The condition: idle, servo-on, fault_code=4315, '.data.position.z_mm > 100'
    condition: String,
    /// Longest wait, then exit code 8 [default: no limit]
    #[arg(long = "for", value_name = "TIME", value_parser = duration::parse_some)]
    within: Option<Duration>,
}

impl Wait {
    /// Repetition of `status` for this condition.
    pub fn repeat(&self, given: &Repeat) -> Result<Repeat, Failure> {
        let until = Some(Condition::new(&self.condition)?);
        let every = given.every.or(Some(EVERY));
        Ok(Repeat { every, count: given.count, until, within: self.within, is_quiet: true, ..Repeat::default() })
    }
}
