//! `--wait` and `--no-wait`: whether a command ends with what it has set in motion.

use std::time::Duration;

use clap::Args;

use crate::settings::duration;

/// Of a motion: it is waited for, unless told not to.
#[derive(Debug, Clone, Copy, Args)]
#[group(skip)]
pub struct MotionEnd {
    /// Wait until the motion has ended, as without a flag
    #[arg(long, overrides_with = "no_wait", hide_short_help = true)]
    wait: bool,
    /// Return as soon as the controller has accepted the motion
    #[arg(long)]
    no_wait: bool,
}

impl MotionEnd {
    /// Whether it is not waited for.
    pub const fn no_wait(self) -> bool {
        self.no_wait
    }
}

/// Of a program: it is not waited for, unless told to.
#[derive(Debug, Clone, Copy, Args)]
#[group(skip)]
pub struct ProgramEnd {
    /// Wait until the program has ended, at most TIME; with --repeat each run
    #[arg(long, value_name = "TIME", num_args = 0..=1, value_parser = duration::parse)]
    #[expect(clippy::option_option, reason = "absent, without a limit, with one")]
    wait: Option<Option<Duration>>,
    /// Return as soon as the controller has accepted the start, as without a flag
    #[arg(long, conflicts_with_all = ["wait", "repeat"], hide_short_help = true)]
    no_wait: bool,
}

impl ProgramEnd {
    /// How long it is waited for, if it is.
    #[expect(clippy::option_option, reason = "absent, without a limit, with one")]
    pub const fn limit(self) -> Option<Option<Duration>> {
        self.wait
    }
}
