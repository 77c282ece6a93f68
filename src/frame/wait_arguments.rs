//! `--wait` and `--no-wait`: whether a command waits for the end of the action that it started.

use crate::prelude::basics::*;

/// Wait option of a motion or another long action. By default, the command waits.
#[derive(Debug, Clone, Copy, Args)]
#[group(skip)]
pub struct MotionEnd {
    /// Wait until the motion has ended (default)
    #[arg(long, overrides_with = "no_wait", hide_short_help = true)]
    wait: bool,
    /// Return as soon as the controller has accepted the command
    #[arg(long)]
    no_wait: bool,
}

impl MotionEnd {
    /// Whether the command returns without waiting.
    pub const fn no_wait(self) -> bool {
        self.no_wait
    }
}

/// Wait option of a program. By default, the command does not wait.
#[derive(Debug, Clone, Copy, Args)]
#[group(skip)]
pub struct ProgramEnd {
    /// Wait until the program has ended, but at most TIME. With --repeat, TIME applies to each run
    #[arg(long, value_name = "TIME", num_args = 0..=1, value_parser = duration::parse)]
    #[expect(clippy::option_option, reason = "absent, without a limit, with one")]
    wait: Option<Option<Duration>>,
    /// Return as soon as the controller has accepted the start (default)
    #[arg(long, conflicts_with_all = ["wait", "repeat"], hide_short_help = true)]
    no_wait: bool,
}

impl ProgramEnd {
    /// Time limit of the wait; `None` if the command does not wait.
    pub const fn limit(self) -> Option<Option<Duration>> {
        self.wait
    }
}
