//! Extra read commands of consumers, which run with each poll of a robot: `yerc var get B0..B9`.

use std::any::TypeId;
use std::slice;

use clap::parser::ValueSource;
use clap::{Arg, ArgMatches};

use crate::command::families;
use armctl_frame::AnyCommand;
use armctl_frame::face::family_command::{FamilyLine, ParsedCommand};
use armctl_frame::prelude::*;

/// An extra command. Two extra commands with the same text are equal.
pub struct Extra {
    text: Arc<str>,
    family: Family,
    /// Parsed command. If the text contains names, they have placeholder addresses here.
    command: Box<dyn AnyCommand>,
    /// Whether the text contains names. Names stand for different addresses on each robot.
    is_named: bool,
}

/// A parsed command, or the error.
pub type Read = Result<Box<dyn AnyCommand>>;

const EXAMPLE: &str = "type a command such as 'yerc var get B0..B9' or 'toyo counter get'";

impl Extra {
    /// Parses a command; its first word is the family.
    ///
    /// # Errors
    /// If the text is not a command, does more than read, or does not end by itself.
    pub fn parse(text: &str) -> Result<Self> {
        let wrong = |why: &str, hint: &str| Err(invalid(text, why, hint));
        let Some(words) = shlex::split(text) else { return wrong("has an unclosed quote", EXAMPLE) };
        if words.iter().any(|word| word.contains(';')) {
            return wrong("is more than one command", "write one command without ';', and repeat --also");
        }
        let Some(family) = words.first().and_then(|word| word.parse::<Family>().ok()) else {
            return wrong("does not begin with a family", EXAMPLE);
        };
        let (command, is_named) = names::detect_names(|| read(text, family, &words));
        let command = command?;
        if command.intent(None).risk > Risk::Read {
            return wrong("does more than read", "use a command that only reads, because monitoring only reads");
        }
        if command.driver().is_none() {
            return wrong("does not read from a robot", EXAMPLE);
        }
        if command.uses_files() {
            return Err(check_files(text));
        }
        if command.is_endless() {
            return wrong(
                "does not end by itself",
                "use the command that reads once, because armctl repeats the command at each poll",
            );
        }
        Ok(Self { text: text.into(), family, command, is_named })
    }

    /// The command for one robot, if the text contains names; `None` if the command is the same for all robots.
    pub fn of(&self, robot: &Robot) -> Option<Read> {
        let words = shlex::split(&self.text).filter(|_| self.is_named)?;
        Some(names::with_names(self.family, slice::from_ref(robot), || read(&self.text, self.family, &words)))
    }

    /// The text, as typed.
    pub fn text(&self) -> &Arc<str> {
        &self.text
    }

    /// Family of the robots.
    pub fn family(&self) -> Family {
        self.family
    }

    /// The command.
    pub fn command(&self) -> &dyn AnyCommand {
        &*self.command
    }
}

fn invalid(text: &str, why: &str, hint: &str) -> Failure {
    Failure::usage(format!("'{text}' {why}")).hint(hint)
}

fn check_files(text: &str) -> Failure {
    invalid(text, "uses a file or folder of this computer", "use a command that only reads from the robot")
}

/// Parses words into a command; the first word is the family.
fn read(text: &str, family: Family, words: &[String]) -> Read {
    let face = families::of(family);
    let parser = (face.augment)(clap::Command::new(family.name())).no_binary_name(false).disable_help_flag(true);
    let parsed = parser.clone().try_get_matches_from(words);
    if parsed.as_ref().is_ok_and(|matches| accepts_file(&parser, matches)) {
        return Err(check_files(text));
    }
    match parsed.and_then(|mut matches| (face.read)(&mut matches)) {
        Ok(FamilyLine { command: ParsedCommand::Command(command), .. }) => Ok(command),
        Ok(_) => Err(invalid(text, "is not a command", EXAMPLE)),
        Err(error) => {
            let message = error.render().to_string();
            let told = message.lines().next().unwrap_or_default().trim_start_matches("error: ");
            Err(invalid(text, &format!("is not valid: {told}"), &format!("see `armctl {family} --help`")))
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

/// Whether the command or one of its subcommands uses a path, typed or by default. Each poll would read or write the
/// file again.
fn accepts_file(command: &clap::Command, matches: &ArgMatches) -> bool {
    let is_path = |arg: &Arg| arg.get_value_parser().type_id() == TypeId::of::<PathBuf>();
    let is_given = |arg: &Arg| {
        let source = matches.value_source(arg.get_id().as_str());
        matches!(source, Some(ValueSource::CommandLine | ValueSource::DefaultValue))
    };
    if command.get_arguments().any(|arg| is_path(arg) && is_given(arg)) {
        return true;
    }
    let below = matches.subcommand().and_then(|(name, matches)| Some((command.find_subcommand(name)?, matches)));
    below.is_some_and(|(command, matches)| accepts_file(command, matches))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accepts_only_reads_that_end() {
        for text in ["yerc var get B0..B9", "yrcx io get", "toyo counter get 1", "yerc say hello"] {
            let risky = text.contains("say");
            assert_eq!(Extra::parse(text).is_err(), risky, "{text}");
        }
        for (text, why) in [
            ("", "does not begin with a family"),
            ("status", "does not begin with a family"),
            ("yerc", "is not a command"),
            ("yerc 'var", "has an unclosed quote"),
            ("yerc frobnicate", "is not valid"),
            ("yerc var set B0=1", "does more than read"),
            ("yerc job start", "does more than read"),
            ("yerc io watch 10010", "does not end by itself"),
            ("toyo ports", "does not read from a robot"),
            ("yerc var get B0; yerc hold on", "is more than one command"),
            ("yerc status ; yerc hold on", "is more than one command"),
            ("yerc var dump x.csv", "uses a file or folder"),
            ("yerc file get A.JBI --dir x", "uses a file or folder"),
            ("yerc file diff A.JBI", "uses a file or folder"),
            ("yerc diff", "uses a file or folder"),
            ("yrcx diff", "uses a file or folder"),
            ("yerc file get A.JBI", "uses a file or folder"),
            ("yrcx backup x", "uses a file or folder"),
            ("toyo point dump x.csv", "uses a file or folder"),
        ] {
            let failure = Extra::parse(text).unwrap_err();
            assert!(failure.message.contains(why) && failure.hint.is_some(), "{text}: {failure:?}");
        }
    }
}
