//! Words of a command line, divided into the words of the command and the rest.

use std::ffi::OsString;

use clap::{Arg, Command};

/// Words of a command line, without flags and their values.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct TypedLine<'a> {
    /// Words of the command. An alias is replaced by the primary name.
    pub path: Vec<&'a str>,
    /// Words of the command as the user typed them. They may be aliases.
    pub typed_path: Vec<&'a str>,
    /// Positions of the command's words in the line.
    pub path_positions: Vec<usize>,
    /// Words after the command.
    pub rest: Vec<&'a str>,
    /// Positions of the words after the command in the line.
    pub rest_positions: Vec<usize>,
}

impl<'a> TypedLine<'a> {
    /// Analyzes a line that includes the program name.
    pub fn new(args: &'a [OsString], whole: &'a Command) -> Self {
        let mut typed = Self::default();
        let mut commands = vec![whole];
        let mut words = args.iter().enumerate().skip(1).filter_map(|(at, word)| Some((at, word.to_str()?)));
        while let Some((at, word)) = words.next().filter(|(_, word)| *word != "--") {
            if word.starts_with('-') && word.len() > 1 {
                if has_value_after(word, &commands) {
                    words.next();
                }
                continue;
            }
            let below = commands.last().and_then(|command| command.find_subcommand(word));
            if let Some(below) = below.filter(|_| typed.rest.is_empty()) {
                commands.push(below);
                typed.path.push(below.get_name());
                typed.typed_path.push(word);
                typed.path_positions.push(at);
            } else {
                typed.rest.push(word);
                typed.rest_positions.push(at);
            }
        }
        typed
    }

    /// All words as the user typed them.
    pub fn words(&self) -> Vec<&'a str> {
        [&self.typed_path[..], &self.rest].concat()
    }
}

/// Whether the word after a flag is the value of the flag.
fn has_value_after(flag: &str, commands: &[&Command]) -> bool {
    let known = |is_it: &dyn Fn(&Arg) -> bool| {
        let found = commands.iter().flat_map(|command| command.get_arguments()).find(|argument| is_it(argument));
        found.is_some_and(|argument| {
            argument.get_action().takes_values() && argument.get_num_args().is_none_or(|count| count.min_values() > 0)
        })
    };
    match flag.strip_prefix("--") {
        Some(long) => !long.contains('=') && known(&|argument| argument.get_long() == Some(long)),
        None => flag.chars().next_back().is_some_and(|short| known(&|argument| argument.get_short() == Some(short))),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;
    use crate::cli::Cli;

    #[test]
    fn command_words_exclude_flags_and_their_values() {
        let whole = Cli::command();
        for (line, path, rest) in [
            ("armctl yerc job select WELD", "yerc job select", "WELD"),
            ("armctl -r status yerc job -h", "yerc job", ""),
            ("armctl --robot=status yerc --json job", "yerc job", ""),
            ("armctl -qo json yerc job", "yerc job", ""),
            ("armctl yerc job select --line 5 WELD status", "yerc job select", "WELD status"),
            ("armctl get file", "", "get file"),
            ("armctl yerc --watch status", "yerc status", ""),
            ("armctl toyo error show", "toyo alarm list", ""),
        ] {
            let args: Vec<OsString> = line.split(' ').map(Into::into).collect();
            let typed = TypedLine::new(&args, &whole);
            assert_eq!((typed.path.join(" ").as_str(), typed.rest.join(" ").as_str()), (path, rest), "{line}");
        }
    }
}
