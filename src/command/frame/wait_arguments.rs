//! `--wait` and `--no-wait`: whether a command waits for the end of the action that it started.

use std::time::Duration;

use clap::Args;

use crate::settings::duration;

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
    /// Wait until the program has ended, at most TIME; with --repeat for each run
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

#[cfg(test)]
mod tests {
    use clap::{Command, CommandFactory as _};

    use crate::cli::Cli;

    /// Commands in which `--wait TIME` is a response timeout.
    const OTHERS: [&str; 2] = ["armctl yerc file cmos", "armctl robots discover"];

    /// Finds subcommands that accept only one of the two options.
    fn selectors(command: &Command, path: &str, found: &mut Vec<String>) {
        let has = |long: &str| command.get_arguments().any(|argument| argument.get_long() == Some(long));
        if has("wait") != has("no-wait") && !OTHERS.contains(&path) {
            found.push(path.to_owned());
        }
        for verb in command.get_subcommands() {
            selectors(verb, &format!("{path} {}", verb.get_name()), found);
        }
    }

    #[test]
    fn offers_both_flags_together() {
        let mut found = Vec::new();
        selectors(&Cli::command(), "armctl", &mut found);
        assert!(found.is_empty(), "{found:?}");
    }

    #[test]
    fn last_flag_wins_and_repeated_starts_wait() {
        let parses = |line: &str| Cli::command().try_get_matches_from(line.split(' ')).is_ok();
        assert!(parses("armctl toyo home --no-wait --wait") && parses("armctl toyo run easy 1 --wait 5s"));
        assert!(
            !parses("armctl toyo run easy 1 --repeat 2 --no-wait") && !parses("armctl yerc job start --wait --no-wait")
        );
    }
}
