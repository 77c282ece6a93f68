//! Words after the family name: its commands, or `repl`.

use clap::builder::CommandExt;
use clap::{ArgMatches, Command, FromArgMatches as _, Subcommand};

use crate::repl::Repl;
use crate::{AnyCommand, CommandSet, FamilyArguments};

/// Parsed words after the family name.
pub struct FamilyLine {
    /// Arguments before the command.
    pub arguments: FamilyArguments,
    /// Requested action.
    pub command: ParsedCommand,
}

/// Requested action of a family.
pub enum ParsedCommand {
    /// A command.
    Command(Box<dyn AnyCommand>),
    /// Interactive prompt.
    Prompt,
    /// No action.
    Nothing,
}

/// Word after the family name. Without such a word, an interactive terminal gets the prompt.
#[derive(Debug, Subcommand)]
enum Verb<C: Subcommand> {
    /// A command of the family
    #[command(flatten)]
    Command(C),
    /// Interactive prompt on one open connection
    Repl(Repl),
}

/// Family command with all subcommands and its help.
pub fn augment<C: CommandSet + Subcommand>(command: Command, about: &'static str) -> Command {
    let command = Verb::<C>::augment_subcommands(command).mut_subcommands(with_verbs);
    command.about(about).long_about(None).add(Headings(C::headings))
}

/// Maximum length of a group summary with its subcommands, for one help line of 80 columns.
const ABOUT: usize = 55;

/// Adds the subcommands to the summary of a group: `Jobs: show, list, select`.
fn with_verbs(noun: Command) -> Command {
    let Some(about) = noun.get_about().map(ToString::to_string) else { return noun };
    let mut verbs = String::new();
    for verb in noun.get_subcommands().map(Command::get_name) {
        if about.len() + verbs.len() + verb.len() > ABOUT {
            verbs.push_str(", …");
            break;
        }
        verbs.push_str(if verbs.is_empty() { "" } else { ", " });
        verbs.push_str(verb);
    }
    if verbs.is_empty() {
        return noun;
    }
    noun.about(format!("{about}: {verbs}")).mut_subcommands(with_verbs)
}

/// Help headings of a command; see [`CommandSet::headings`].
#[derive(Debug, Clone, Copy)]
pub struct Headings(pub fn() -> Vec<(Option<&'static str>, String)>);

impl CommandExt for Headings {}

/// Reads the requested action of a family.
pub fn read<C: CommandSet + Subcommand>(matches: &mut ArgMatches) -> Result<ParsedCommand, clap::Error> {
    if matches.subcommand_name().is_none() {
        return Ok(ParsedCommand::Nothing);
    }
    Ok(match Verb::<C>::from_arg_matches_mut(matches)? {
        Verb::Command(command) => ParsedCommand::Command(command.command()),
        Verb::Repl(Repl {}) => ParsedCommand::Prompt,
    })
}

impl From<ParsedCommand> for FamilyLine {
    fn from(wish: ParsedCommand) -> Self {
        Self { arguments: FamilyArguments::default(), command: wish }
    }
}
