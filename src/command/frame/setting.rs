//! Settings as words of a command line: `NAME=VALUE`.

use clap::{Arg, Command};

/// Where a verb takes a name and its value as words of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pair {
    /// Which of its words is the name.
    pub name: usize,
    /// Whether there may be several values, with commas between them.
    pub is_list: bool,
}

impl Pair {
    /// Of a verb that sets something by a name and a value: the last two of its words. What takes `NAME=VALUE` itself has no
    /// two, and four are coordinates, or the numbers of an object.
    pub fn of(verb: &Command) -> Option<Self> {
        let words: Vec<&Arg> = verb.get_positionals().collect();
        let ([_, value] | [_, _, value]) = words[..] else { return None };
        let is_list = value.get_num_args().is_some_and(|count| count.max_values() > 1)
            || matches!(value.get_action(), clap::ArgAction::Append);
        (verb.get_name() == "set").then_some(Self { name: words.len() - 2, is_list })
    }
}
