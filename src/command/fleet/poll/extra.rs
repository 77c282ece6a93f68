//! Command lines that only read, asked along with the looks at the robots of their family: `yerc var get B0..B9`.

use std::any::TypeId;
use std::fmt;
use std::path::PathBuf;
use std::slice;
use std::sync::Arc;

use clap::parser::ValueSource;
use clap::{Arg, ArgMatches};

use crate::command::AnyCommand;
use crate::command::face::words::{Typed, Wish};
use crate::command::families;
use crate::command::frame::names;
use crate::controller::Risk;
use crate::failure::Failure;
use crate::settings::Robot;
use crate::settings::target::Family;

/// Such a line. Two with the same text are the same.
pub struct Extra {
    text: Arc<str>,
    family: Family,
    /// With any addresses in place of names, where there are some in it.
    command: Box<dyn AnyCommand>,
    /// Whether names stand for addresses in it: each robot has its own.
    is_named: bool,
}

/// The command that a line is, or why it is none.
pub type Read = Result<Box<dyn AnyCommand>, Failure>;

/// What gives an idea of a line that is none.
const EXAMPLE: &str = "such as 'yerc var get B0..B9' or 'toyo counter get'";

impl Extra {
    /// Reads a line; its first word is the family.
    ///
    /// # Errors
    /// It is no command, or one that does more than read, or none that has an end.
    pub fn parse(text: &str) -> Result<Self, Failure> {
        let wrong = |why: &str, hint: &str| Err(wrong(text, why, hint));
        let Some(words) = shlex::split(text) else { return wrong("has a quote without an end", EXAMPLE) };
        if words.iter().any(|word| word.contains(';')) {
            return wrong("is more than one command", "give one command without ';'; --also may be repeated");
        }
        let Some(family) = words.first().and_then(|word| word.parse::<Family>().ok()) else {
            return wrong("does not begin with a family", EXAMPLE);
        };
        let (command, is_named) = names::asking(|| read(text, family, &words));
        let command = command?;
        if command.intent(None).risk > Risk::Read {
            return wrong("does more than read", "whoever watches robots changes nothing; choose a command that reads");
        }
        if command.driver().is_none() {
            return wrong("asks no robot", EXAMPLE);
        }
        if command.uses_files() {
            return Err(takes_files(text));
        }
        if command.is_endless() {
            return wrong("does not end by itself", "use the command that reads once: it is asked again and again");
        }
        Ok(Self { text: text.into(), family, command, is_named })
    }

    /// What it is for one robot, where names in it stand for addresses; nothing where it is the same for all.
    pub fn of(&self, robot: &Robot) -> Option<Read> {
        let words = shlex::split(&self.text).filter(|_| self.is_named)?;
        Some(names::known(self.family, slice::from_ref(robot), || read(&self.text, self.family, &words)))
    }

    /// As it was typed.
    pub fn text(&self) -> &Arc<str> {
        &self.text
    }

    /// The family whose robots are asked.
    pub fn family(&self) -> Family {
        self.family
    }

    /// What it is, without its type.
    pub fn command(&self) -> &dyn AnyCommand {
        &*self.command
    }
}

fn wrong(text: &str, why: &str, hint: &str) -> Failure {
    Failure::usage(format!("'{text}' {why}")).hint(hint)
}

fn takes_files(text: &str) -> Failure {
    wrong(text, "is about a file or folder of this machine", "choose a command that reads the robot alone")
}

/// The command that words are, the first of them its family.
fn read(text: &str, family: Family, words: &[String]) -> Read {
    let face = families::of(family);
    let parser = face.augment(clap::Command::new(family.name())).no_binary_name(false).disable_help_flag(true);
    let parsed = parser.clone().try_get_matches_from(words);
    if parsed.as_ref().is_ok_and(|matches| takes_file(&parser, matches)) {
        return Err(takes_files(text));
    }
    match parsed.and_then(|mut matches| face.read(&mut matches)) {
        Ok(Typed { wish: Wish::Command(command), .. }) => Ok(command),
        Ok(_) => Err(wrong(text, "is no command", EXAMPLE)),
        Err(error) => {
            let told = error.render().to_string();
            let told = told.lines().next().unwrap_or_default().trim_start_matches("error: ");
            Err(wrong(text, &format!("is not understood: {told}"), &format!("see `armctl {family} --help`")))
        }
    }
}

impl PartialEq for Extra {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl fmt::Debug for Extra {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Extra").field(&self.text).finish()
    }
}

/// Whether a path was given to the command, or to one below it, or one is meant where none is given: a file would be read or
/// written again and again.
fn takes_file(command: &clap::Command, matches: &ArgMatches) -> bool {
    let is_path = |arg: &Arg| arg.get_value_parser().type_id() == TypeId::of::<PathBuf>();
    let is_given = |arg: &Arg| {
        let source = matches.value_source(arg.get_id().as_str());
        matches!(source, Some(ValueSource::CommandLine | ValueSource::DefaultValue))
    };
    if command.get_arguments().any(|arg| is_path(arg) && is_given(arg)) {
        return true;
    }
    let below = matches.subcommand().and_then(|(name, matches)| Some((command.find_subcommand(name)?, matches)));
    below.is_some_and(|(command, matches)| takes_file(command, matches))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_reads_and_ends_is_taken() {
        for text in ["yerc var get B0..B9", "yrcx io get", "toyo counter get 1", "yerc say hello"] {
            let risky = text.contains("say");
            assert_eq!(Extra::parse(text).is_err(), risky, "{text}");
        }
        for (text, why) in [
            ("", "does not begin with a family"),
            ("status", "does not begin with a family"),
            ("yerc", "is no command"),
            ("yerc 'var", "has a quote without an end"),
            ("yerc frobnicate", "is not understood"),
            ("yerc var set B0=1", "does more than read"),
            ("yerc job start", "does more than read"),
            ("yerc io watch 10010", "does not end by itself"),
            ("toyo ports", "asks no robot"),
            ("yerc var get B0; yerc hold on", "is more than one command"),
            ("yerc status ; yerc hold on", "is more than one command"),
            ("yerc var dump x.json", "is about a file or folder"),
            ("yerc file get A.JBI --dir x", "is about a file or folder"),
            ("yerc file diff A.JBI", "is about a file or folder"),
            ("yerc diff", "is about a file or folder"),
            ("yrcx diff", "is about a file or folder"),
            ("yerc file get A.JBI", "is about a file or folder"),
            ("yrcx backup x", "is about a file or folder"),
            ("toyo point list --csv x.csv", "is about a file or folder"),
        ] {
            let failure = Extra::parse(text).unwrap_err();
            assert!(failure.message.contains(why) && failure.hint.is_some(), "{text}: {failure:?}");
        }
    }
}
