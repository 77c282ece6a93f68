//! Test support for all families.

use clap::{Args as _, FromArgMatches as _};

use super::command::{AnyCommand, AnyContext, Context};
use super::confirmation::Confirmer;
use super::connection::{self, Access, ConnectMode, Family, Linked};
use super::dry_run::{DryRun, is_end};
use super::report::{AnyReport as _, Outcome};
use super::settings_report::OLD_VALUE;
use crate::face::Face;
use crate::face::family_command::{FamilyLine, ParsedCommand};
use crate::flags::Globals;
use crate::gate::{Gate, Grant};
use crate::prelude::basics::*;
use crate::settings::inventory::Options;
use crate::settings::{Selection, Sources};

/// Screen without output.
pub static QUIET: Screen = Screen::silent();

/// Access without restrictions.
pub fn unlimited_access() -> Access {
    Access { grant: Grant::up_to(Risk::Motion), ..Access::reading(ConnectMode::Control) }
}

/// Context for a command in which all questions are confirmed, as with `--yes`.
pub fn context<'a, F: Family>(robot: &'a Robot, link: &'a mut F::Link) -> Context<'a, F> {
    let gate = Gate { yes: true, ..Gate::default() };
    let confirmer = Confirmer::new(gate, &QUIET, robot, Risk::Motion, Grant::up_to(Risk::Motion));
    Context { robot, link, screen: &QUIET, several: false, confirmer }
}

/// Runs a command on a link that the test continues to own.
pub async fn run<F: Family>(command: &dyn AnyCommand, context: Context<'_, F>) -> Outcome {
    let Context { robot, link, screen, several, confirmer } = context;
    let mut borrowed = Linked::<F>::Borrowed(link);
    command.run(AnyContext { robot, connection: &mut borrowed, screen, several, confirmer }).await
}

/// Report of a dry run.
pub fn planned<F: Family>(
    robot: &Robot,
    command: &dyn AnyCommand,
    prepare: impl FnOnce(&mut F::Link),
) -> Result<Value> {
    let intent = command.intent(Some(robot));
    let grant = Grant::up_to(intent.initial_risk());
    let access = Access { grant: grant.clone(), dry_run: true, ..Access::reading(command.connect_mode(robot)) };
    let connected = command.connect(robot, access, &QUIET).now_or_never().expect("a dry run opens nothing");
    let mut connection = connected?;
    prepare(connection::link::<F>(&mut *connection)?);
    let gate = Gate { dry_run: true, ..Gate::default() };
    let confirmer = Confirmer::new(gate, &QUIET, robot, intent.risk, grant);
    let context = AnyContext { robot, connection: &mut *connection, screen: &QUIET, several: false, confirmer };
    match command.run(context).now_or_never().expect("a dry run waits for nothing") {
        Err(failure) if !is_end(&failure) => Err(failure),
        _ => DryRun::from(connection.planned()).data(),
    }
}

/// Frames of [`planned`], without the reads of old values.
pub fn frames(planned: &Value) -> Vec<Value> {
    complete_frames(planned).into_iter().filter(|frame| frame["about"] != OLD_VALUE).collect()
}

/// All frames of a [`planned`] report.
pub fn complete_frames(planned: &Value) -> Vec<Value> {
    planned["frames"].as_array().expect("frames").clone()
}

/// Number of frames in [`planned`] that only read old values.
pub fn count_before(planned: &Value) -> usize {
    complete_frames(planned).len() - frames(planned).len()
}

/// The words after `armctl`, as clap reads them in the program with all families.
fn program(face: &Face) -> clap::Command {
    Globals::augment_args(clap::Command::new("armctl")).subcommand(family(face))
}

/// The command of a family, with all subcommands.
pub fn family(face: &Face) -> clap::Command {
    (face.augment)(clap::Command::new(face.family.name()))
}

/// Parses `armctl -t TARGET FAMILY WORDS…`.
pub fn parse(face: &Face, target: &str, words: &[&str]) -> Result<(Globals, FamilyLine), clap::Error> {
    let line = [&["armctl", "-t", target, face.family.name()], words].concat();
    let mut matches = program(face).try_get_matches_from(line)?;
    let globals = Globals::from_arg_matches_mut(&mut matches)?;
    let (_, mut typed) = matches.remove_subcommand().expect("the line names the family");
    Ok((globals, (face.read)(&mut typed)?))
}

/// Robot and command of a line.
pub fn resolve(face: &Face, target: &str, words: &[&str]) -> Result<(Robot, Box<dyn AnyCommand>)> {
    let (globals, typed) = parse(face, target, words).map_err(|error| Failure::usage(error.to_string()))?;
    let selection = Selection { target: globals.target, ..Selection::default() };
    let flags = Options { encoding: globals.encoding, ..Options::default() };
    let robot = Sources { selection, flags, ..Sources::default() }.robots(Some(face.family))?.remove(0);
    match typed.command {
        ParsedCommand::Command(command) => Ok((robot, command)),
        _ => panic!("{words:?} is not a command"),
    }
}

/// Words of a command line as typed in a shell.
pub fn words_of(line: &str) -> Vec<String> {
    shlex::split(line).expect("a line whose quotes are closed")
}

/// Calls `check` with the words of each line, and with what the table expects of this line.
#[track_caller]
pub fn for_lines<T>(cases: impl IntoIterator<Item = (&'static str, T)>, check: impl Fn(&str, &[&str], T)) {
    for (line, expected) in cases {
        let words = words_of(line);
        check(line, &words.iter().map(String::as_str).collect::<Vec<_>>(), expected);
    }
}

/// Each line is a usage error, of the parser or of the dry run, with this part in its message.
#[track_caller]
pub fn rejects(plan: impl Fn(&[&str]) -> Result<Value>, cases: impl IntoIterator<Item = (&'static str, &'static str)>) {
    for_lines(cases, |line, words, part| {
        let failure = plan(words).expect_err(line);
        assert_eq!(failure.kind, Kind::Usage, "{line}: {failure}");
        assert!(failure.message.contains(part), "{line}: {failure}");
    });
}

/// Whether `data` has everything of `expected`: each key of an object, each element of a list in its place.
pub fn has_all(data: &Value, expected: &Value) -> bool {
    match (data, expected) {
        (Value::Object(data), Value::Object(expected)) => {
            expected.iter().all(|(key, expected)| data.get(key).is_some_and(|data| has_all(data, expected)))
        }
        (Value::Array(data), Value::Array(expected)) => {
            data.len() == expected.len() && data.iter().zip(expected).all(|(data, expected)| has_all(data, expected))
        }
        (data, expected) => data == expected,
    }
}
