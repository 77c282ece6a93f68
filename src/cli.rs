//! Command line: the global flags and the first word.

use std::fmt;

use clap::{ArgMatches, Command, FromArgMatches, Parser, Subcommand};

use crate::command::common;
use crate::command::families::{self, FAMILIES};
use crate::command::fleet::teach::Teach;
use armctl_frame::batch::{Batch, Rehearse};
use armctl_frame::face::family_command::FamilyLine;
use armctl_frame::flags::Globals;
use armctl_frame::repl::Repl;
use armctl_frame::settings::target::Family;

/// Output of `-V`.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Output of `--version`.
pub const LONG_VERSION: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    "\ncommit: ",
    env!("BUILT_COMMIT"),
    "\ndate:   ",
    env!("BUILT_DATE"),
    "\ntarget: ",
    env!("BUILT_TARGET")
);

/// Talk to industrial robot controllers from a terminal or a script.
///
/// If you have no robot, add --sim: every family has a built-in simulator.
#[derive(Debug, Parser)]
#[command(
    name = "armctl",
    version = VERSION,
    long_version = LONG_VERSION,
    disable_help_subcommand = true,
    arg_required_else_help = true,
    subcommand_required = true,
    max_term_width = 100,
    after_help = "Exit codes, targets, output, safety and scripting: `armctl help TOPIC`."
)]
pub struct Words<C: Subcommand> {
    /// Flags that every command has.
    #[command(flatten)]
    pub globals: Globals,
    /// The command.
    #[command(subcommand)]
    pub command: C,
}

/// A complete command line.
pub type Cli = Words<Top>;

/// The first word of a command line.
#[derive(Debug, Subcommand)]
pub enum Top {
    /// A family
    #[command(flatten)]
    Family(FamilyWord),
    /// Interactive prompt on one open connection
    Repl(Repl),
    /// Run commands from a file
    Batch(Batch),
    /// Run commands on simulators of a backup, and report what they would change
    Rehearse(Rehearse),
    /// Full-screen jog and teach panel
    Teach(Teach),
    /// Commands that all families share
    #[command(flatten)]
    Common(common::Common),
}

/// Name of a family, and the words after it.
pub struct FamilyWord {
    /// Family.
    pub family: Family,
    /// Words after the name of the family.
    pub typed: FamilyLine,
}

impl fmt::Debug for FamilyWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.family.name())
    }
}

impl Subcommand for FamilyWord {
    fn augment_subcommands(command: Command) -> Command {
        command.subcommands(FAMILIES.map(|face| (face.augment)(Command::new(face.family.name()))))
    }

    fn augment_subcommands_for_update(command: Command) -> Command {
        Self::augment_subcommands(command)
    }

    fn has_subcommand(name: &str) -> bool {
        name.parse::<Family>().is_ok()
    }
}

impl FromArgMatches for FamilyWord {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Self::from_arg_matches_mut(&mut matches.clone())
    }

    fn from_arg_matches_mut(matches: &mut ArgMatches) -> Result<Self, clap::Error> {
        let (family, mut matches) = families::by_name(matches)?;
        Ok(Self { family, typed: (families::of(family).read)(&mut matches)? })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use clap::{Command, CommandFactory as _};

    use super::Cli;

    /// Commands in which `--wait TIME` is a response timeout.
    const WAIT_IS_TIMEOUT: [&str; 2] = ["armctl yerc file cmos", "armctl robots discover"];

    /// Finds subcommands that accept only one of the two options.
    fn selectors(command: &Command, path: &str, found: &mut Vec<String>) {
        let has = |long: &str| command.get_arguments().any(|argument| argument.get_long() == Some(long));
        if has("wait") != has("no-wait") && !WAIT_IS_TIMEOUT.contains(&path) {
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
