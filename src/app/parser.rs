//! Parser for command lines.

use std::ffi::OsString;

use clap::builder::StyledStr;
use clap::error::ErrorKind;
use clap::{ArgMatches, Command, CommandFactory as _, FromArgMatches, Subcommand};

use super::typed_line::TypedLine;
use super::{assignments, spellings, suggestions};
use crate::cli::{Cli, FamilyWord, LONG_VERSION, Top, VERSION, Words};
use crate::command::about::help;
use crate::command::about::page::page;
use crate::command::common::Common;
use crate::command::{families, missing_verbs};
use armctl_frame::failure::Failure;
use armctl_frame::settings::target::Family;

/// Returns the version text if the line requests only the version. The commands are not built for this.
pub fn version(args: &[OsString]) -> Option<String> {
    let [_, flag] = args else { return None };
    let version = match flag.to_str()? {
        "-V" => VERSION,
        "--version" => LONG_VERSION,
        _ => return None,
    };
    Some(format!("armctl {version}\n"))
}

/// Parser for command lines. Building all commands takes longer than a short command runs. The parser therefore first
/// builds only the commands that the line names. The complete tree is kept for the next line.
#[derive(Debug, Default)]
pub struct Parser {
    all: Option<Command>,
    /// Commands that were built only for the last line.
    last: Option<Command>,
}

/// Reason why a line cannot be run as a command.
pub enum Refusal {
    /// The line requests a text: help or version.
    Text(StyledStr),
    /// The verb is missing. The values are the help with the list of verbs, and the list alone.
    Verb(StyledStr, String),
    /// The line requests help for an unknown topic.
    Unknown(Failure),
    /// A syntax error.
    Mistake(clap::Error),
    /// A name in the line could not be looked up.
    Failed(Failure),
}

impl Refusal {
    fn new(error: clap::Error, args: &[OsString], whole: &Command) -> Self {
        let TypedLine { mut path, rest, .. } = TypedLine::new(args, whole);
        let is_long = args.iter().any(|word| word == "--help");
        if matches!(error.kind(), ErrorKind::InvalidSubcommand | ErrorKind::UnknownArgument)
            && let Some(failure) = missing_verbs::missing(&path, &rest)
        {
            return Self::Failed(failure);
        }
        match error.kind() {
            ErrorKind::DisplayVersion => Self::Text(error.render()),
            ErrorKind::DisplayHelp => Self::Text(page(whole, &path, is_long)),
            ErrorKind::InvalidSubcommand if rest.first() == Some(&"help") => {
                path.extend(&rest[1..]);
                let mut whole = whole.clone();
                whole.build();
                if path.iter().try_fold(&whole, |command, word| command.find_subcommand(word)).is_some() {
                    return Self::Text(page(&whole, &path, is_long));
                }
                // The word is not a command of the family, but a help topic or a common command.
                let words: Vec<String> = rest[1..].iter().map(|word| (*word).to_owned()).collect();
                help::text(&words, true, Cli::command).map_or_else(Self::Unknown, |text| Self::Text(text.into()))
            }
            ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand | ErrorKind::MissingSubcommand => {
                let command = path.iter().try_fold(whole, |command, word| command.find_subcommand(word));
                let verbs = command.into_iter().flat_map(Command::get_subcommands).map(Command::get_name);
                Self::Verb(page(whole, &path, false), verbs.collect::<Vec<_>>().join(", "))
            }
            _ => Self::Mistake(suggestions::add_suggestion(error, args, whole)),
        }
    }

    /// Converts the refusal to a failure.
    pub fn failure(&self) -> Failure {
        match self {
            Self::Text(_) => Failure::usage("this command prints text, not data").hint("run it in a terminal"),
            Self::Verb(_, verbs) => Failure::usage("a command is missing").hint(format!("add one of {verbs}")),
            Self::Unknown(failure) | Self::Failed(failure) => failure.clone(),
            Self::Mistake(error) => {
                let text = error.render().to_string();
                let message: Vec<&str> = text.lines().take_while(|line| !line.is_empty()).map(str::trim).collect();
                let message = message.join(" ");
                let tip = text.lines().find_map(|line| line.trim().strip_prefix("tip: ")).unwrap_or("see --help");
                Failure::usage(message.trim_start_matches("error: ")).hint(tip)
            }
        }
    }
}

/// The commands to which a word belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Owner {
    /// The word is a command of a family.
    Family,
    /// The word is a common command of all families, or the name of a family.
    All,
    /// The word is not a command.
    None,
}

impl Parser {
    /// Parses a line that includes the program name. If parsing with the reduced tree fails, the complete tree produces
    /// the error, because its error text is better.
    pub fn parse(&mut self, args: &[OsString]) -> Result<Cli, Refusal> {
        let reduced = match parse_first_word(args) {
            Some(FirstWord::Family(family)) => {
                parse_named_commands(&mut self.last, family, args).map(|words| words.into_top(Top::Family))
            }
            Some(FirstWord::Common) => {
                read(&mut Words::<Common>::command(), args).ok().map(|words| words.into_top(Top::Common))
            }
            None => None,
        };
        if let Some(cli) = reduced {
            return Ok(cli);
        }
        let all = build_commands::<Top>(&mut self.all);
        read(all, args).map_err(|error| Refusal::new(error, args, all))
    }

    /// Returns the owner of a word. The commands of `family` are checked first.
    pub fn owner(&mut self, word: &str, family: Option<Family>) -> Owner {
        let all = build_commands::<Top>(&mut self.all);
        let of_family = family.and_then(|family| all.find_subcommand(family.name())?.find_subcommand(word));
        if of_family.is_some() {
            Owner::Family
        } else if all.find_subcommand(word).is_some() {
            Owner::All
        } else {
            Owner::None
        }
    }

    /// Leaks the command trees. Freeing their thousands of parts would take a quarter of the time of a short command,
    /// and the process is about to exit.
    pub fn abandon(self) {
        std::mem::forget(self);
    }
}

fn build_commands<C: Subcommand>(command: &mut Option<Command>) -> &mut Command {
    command.get_or_insert_with(Words::<C>::command)
}

fn read<C: Subcommand>(command: &mut Command, args: &[OsString]) -> Result<Words<C>, clap::Error> {
    let respelled = spellings::rewrite_spelling(args, command);
    let args = respelled.as_deref().unwrap_or(args);
    let own = assignments::split_assignments(args, command);
    let parsed = command.try_get_matches_from_mut(own.as_deref().unwrap_or(args));
    let words = parsed.and_then(|mut matches| Words::from_arg_matches_mut(&mut matches));
    words.map_err(|error| error.format(command))
}

/// Owner of the first word that is a family or a common command. The parser does not know yet which words are values of
/// flags.
enum FirstWord {
    Family(Family),
    Common,
}

fn parse_first_word(args: &[OsString]) -> Option<FirstWord> {
    args.iter().skip(1).filter_map(|word| word.to_str()).find_map(|word| match word.parse() {
        Ok(family) => Some(FirstWord::Family(family)),
        Err(_) => Common::has_subcommand(word).then_some(FirstWord::Common),
    })
}

/// Parses with only the commands that the line names. Returns `None` if this fails.
fn parse_named_commands(last: &mut Option<Command>, family: Family, args: &[OsString]) -> Option<Words<FamilyWord>> {
    let is_named = |name: &str| args.iter().any(|word| word == name);
    let word = (families::of(family).lay_out)(Command::new(family.name()), &is_named);
    let command = last.insert(Words::<NoSubcommand>::command().subcommand(word));
    read(command, args).ok()
}

/// A command without subcommands.
enum NoSubcommand {}

impl Subcommand for NoSubcommand {
    fn augment_subcommands(command: Command) -> Command {
        command
    }

    fn augment_subcommands_for_update(command: Command) -> Command {
        command
    }

    fn has_subcommand(_: &str) -> bool {
        false
    }
}

impl FromArgMatches for NoSubcommand {
    fn from_arg_matches(_: &ArgMatches) -> Result<Self, clap::Error> {
        Err(clap::Error::new(ErrorKind::InvalidSubcommand))
    }

    fn update_from_arg_matches(&mut self, _: &ArgMatches) -> Result<(), clap::Error> {
        match *self {}
    }
}

impl<C: Subcommand> Words<C> {
    fn into_top(self, top: impl FnOnce(C) -> Top) -> Cli {
        Words { globals: self.globals, command: top(self.command) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the names and arguments of a command and of all its verbs.
    fn shape(command: &Command) -> Vec<String> {
        let own = command.get_arguments().map(|argument| argument.get_id().to_string());
        let verbs = command.get_subcommands().filter(|verb| verb.get_name() != "repl");
        let verbs = verbs.flat_map(|verb| shape(verb).into_iter().map(|word| format!("{} {word}", verb.get_name())));
        std::iter::once(String::new()).chain(own).chain(verbs).collect()
    }

    #[test]
    fn builds_named_commands_as_the_complete_tree() {
        let whole = Cli::command();
        let lay_out = |family: Family, is_named: &dyn Fn(&str) -> bool| {
            (families::of(family).lay_out)(Command::new(family.name()), is_named)
        };
        for family in Family::ALL {
            let expected = whole.find_subcommand(family.name()).unwrap();
            assert_eq!(shape(&lay_out(family, &|_| true)), shape(expected));
        }
        let narrow = lay_out(Family::Yerc, &|name| ["job", "select"].contains(&name));
        assert_eq!(narrow.get_subcommands().count(), 1);
    }

    #[test]
    fn prints_the_version_of_the_complete_parser() {
        for flag in ["-V", "--version"] {
            let args = ["armctl", flag].map(OsString::from);
            let version_request = Cli::command().try_get_matches_from(&args).unwrap_err();
            assert_eq!(
                (version_request.kind(), version(&args)),
                (ErrorKind::DisplayVersion, Some(version_request.to_string()))
            );
        }
        assert_eq!(version(&["armctl", "--version", "-q"].map(OsString::from)), None);
    }

    #[test]
    fn parses_a_line_with_its_named_commands() {
        let args = |line: &str| line.split(' ').map(OsString::from).collect::<Vec<_>>();
        assert!(
            parse_named_commands(&mut None, Family::Yerc, &args("armctl yerc --sim job select --line 3 WELD -q"))
                .is_some()
        );
        assert!(
            parse_named_commands(&mut None, Family::Yrcx, &args("armctl --sim yrcx --unit 2 point get 5")).is_some()
        );
        for left_to_the_whole in ["armctl yerc", "armctl yerc stat", "armctl yerc status -h", "armctl yerc repl"] {
            let is_read = parse_named_commands(&mut None, Family::Yerc, &args(left_to_the_whole)).is_some();
            assert_eq!(is_read, left_to_the_whole == "armctl yerc", "{left_to_the_whole}");
        }
    }
}
