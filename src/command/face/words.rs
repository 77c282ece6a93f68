//! What can stand behind the word of a family: its commands, or `repl`.

use clap::builder::CommandExt;
use clap::{ArgMatches, Command, FromArgMatches as _, Subcommand};

use crate::command::frame::repl::Repl;
use crate::command::{AnyCommand, CommandSet, Own};

/// What was typed behind the word of a family.
pub struct Typed {
    /// What stands between both.
    pub own: Own,
    /// What is wanted.
    pub wish: Wish,
}

/// What is wanted of a family.
pub enum Wish {
    /// A command.
    Command(Box<dyn AnyCommand>),
    /// A prompt.
    Prompt,
    /// Nobody says.
    Nothing,
}

/// What follows the name of a family. Nothing at all is the prompt, too, where somebody can type.
#[derive(Debug, Subcommand)]
enum Verb<C: Subcommand> {
    /// A command of the family
    #[command(flatten)]
    Command(C),
    /// Interactive prompt on one open connection
    Repl(Repl),
}

/// The word of a family with all its commands, and what the help says of it.
pub fn augment<C: CommandSet + Subcommand>(command: Command, about: &'static str) -> Command {
    let command = Verb::<C>::augment_subcommands(command).mut_subcommands(with_verbs);
    command.about(about).long_about(None).add(Headings(C::headings))
}

/// Most characters of what a noun is and of its verbs: the help has a line of 80 for it.
const ABOUT: usize = 55;

/// A noun is told with its verbs: `Jobs: show, list, select`.
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

/// Headings of the help over the words of a command, see [`CommandSet::headings`].
#[derive(Debug, Clone, Copy)]
pub struct Headings(pub fn() -> Vec<(Option<&'static str>, String)>);

impl CommandExt for Headings {}

/// What is wanted of a family.
pub fn read<C: CommandSet + Subcommand>(matches: &mut ArgMatches) -> Result<Wish, clap::Error> {
    if matches.subcommand_name().is_none() {
        return Ok(Wish::Nothing);
    }
    Ok(match Verb::<C>::from_arg_matches_mut(matches)? {
        Verb::Command(command) => Wish::Command(command.command()),
        Verb::Repl(Repl {}) => Wish::Prompt,
    })
}

impl From<Wish> for Typed {
    fn from(wish: Wish) -> Self {
        Self { own: Own::default(), wish }
    }
}
