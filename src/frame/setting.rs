//! Arguments of the form `NAME=VALUE`.

use clap::{Arg, Command};

/// Positional arguments of a command for a name and its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pair {
    /// Position of the name among the positional arguments.
    pub name: usize,
    /// Whether the value can be a comma-separated list.
    pub is_list: bool,
}

impl Pair {
    /// Finds the name and the value of a command that sets a named value. They are the last two positional arguments of
    /// the command. A command with `NAME=VALUE` arguments has no pair. A command with four arguments has no pair
    /// either, because its arguments are coordinates or the numbers of an object.
    pub fn of(verb: &Command) -> Option<Self> {
        let words: Vec<&Arg> = verb.get_positionals().collect();
        let ([_, value] | [_, _, value]) = words[..] else { return None };
        let is_list = value.get_num_args().is_some_and(|count| count.max_values() > 1)
            || matches!(value.get_action(), clap::ArgAction::Append);
        (verb.get_name() == "set").then_some(Self { name: words.len() - 2, is_list })
    }
}
