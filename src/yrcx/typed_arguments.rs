//! Arguments of a command line, with the names of the arguments that the user typed. A typed argument that does not fit
//! the other choices is rejected, and not ignored.

use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches, Id};

/// Arguments of a command line, with the names of the typed arguments.
#[derive(Debug)]
pub struct TypedArguments<A> {
    /// Values, including defaults.
    pub arguments: A,
    typed: Vec<Id>,
}

impl<A> TypedArguments<A> {
    /// Whether the argument was typed.
    pub fn has(&self, argument: &Id) -> bool {
        self.typed.contains(argument)
    }
}

impl<A: Args> FromArgMatches for TypedArguments<A> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Self::from_arg_matches_mut(&mut matches.clone())
    }

    fn from_arg_matches_mut(matches: &mut ArgMatches) -> Result<Self, clap::Error> {
        let is_typed = |id: &&Id| matches.value_source(id.as_str()) == Some(ValueSource::CommandLine);
        let typed = matches.ids().filter(is_typed).cloned().collect();
        Ok(Self { arguments: A::from_arg_matches_mut(matches)?, typed })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl<A: Args> Args for TypedArguments<A> {
    fn augment_args(command: Command) -> Command {
        A::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        A::augment_args_for_update(command)
    }
}
