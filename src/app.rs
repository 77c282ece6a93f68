//! From the words of a command line to an exit code.

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory as _, FromArgMatches as _, Subcommand};

use crate::cli::{Cli, Globals, OfToyo, OfYerc, OfYrcx, Top, Words};
use crate::command::common::Common;
use crate::command::common::robots::Robots;
use crate::command::common::robots::check::Check;
use crate::command::run::{Repeat, Run, Stopped};
use crate::command::{self, AnyCommand, Noun as _};
use crate::failure::{Failure, Kind};
use crate::gate::Gate;
use crate::output::envelope::Envelope;
use crate::output::jq::Filter;
use crate::output::{ColorChoice, Format, Screen};
use crate::settings::duration;
use crate::settings::inventory::{Inventory, Location, Options};
use crate::settings::target::{Family, Target};
use crate::settings::{Selection, Sources};

/// Runs a command line, the program's name included, and says how the process ends.
pub fn main(args: impl IntoIterator<Item = OsString>) -> ExitCode {
    let args = with_family(args.into_iter().collect());
    let cli = match parse(&args) {
        Ok(cli) => cli,
        Err(error) => return refuse(&args, &error),
    };
    let screen = screen(&cli.globals);
    match run(cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(stopped) => tell(&screen, stopped),
    }
}

/// To lay out all commands takes longer than all the rest of a short one. So a line that names a family is tried on that
/// family alone; what does not parse there is left to the whole.
fn parse(args: &[OsString]) -> Result<Cli, clap::Error> {
    let family = args.iter().skip(1).find_map(|word| word.to_str()?.parse::<Family>().ok());
    let tried = match family {
        Some(Family::Yerc) => {
            words(args).map(|Words { globals, command }| Words { globals, command: Top::Yerc(command) })
        }
        Some(Family::Yrcx) => {
            words(args).map(|Words { globals, command }| Words { globals, command: Top::Yrcx(command) })
        }
        Some(Family::Toyo) => {
            words(args).map(|Words { globals, command }| Words { globals, command: Top::Toyo(command) })
        }
        None => return words(args),
    };
    tried.or_else(|_| words(args))
}

fn words<C: Subcommand>(args: &[OsString]) -> Result<Words<C>, clap::Error> {
    let mut command = Words::<C>::command();
    let parsed = command.try_get_matches_from_mut(args);
    let words = parsed.and_then(|mut matches| Words::from_arg_matches_mut(&mut matches));
    let words = words.map_err(|error| error.format(&mut command));
    // It holds some thousand parts. The process is short, and their memory goes with it: taking them apart one by one
    // would be a quarter of all the work that a short command is.
    std::mem::forget(command);
    words
}

/// Started under the name of a family (a link to the binary), the program is that subcommand.
fn with_family(mut args: Vec<OsString>) -> Vec<OsString> {
    let name = args.first().and_then(|name| Path::new(name).file_stem()).and_then(|name| name.to_str());
    if let Some(family) = name.and_then(|name| name.parse::<Family>().ok()) {
        args.insert(1, family.name().into());
    }
    args
}

fn run(cli: Cli) -> Result<(), Stopped> {
    match cli.command {
        Top::Yerc(OfYerc::Yerc(noun)) => for_robots(cli.globals, &*noun.command()),
        Top::Yrcx(OfYrcx::Yrcx(noun)) => for_robots(cli.globals, &*noun.command()),
        Top::Toyo(OfToyo::Toyo(noun)) => for_robots(cli.globals, &*noun.command()),
        Top::Common(common) => for_all_families(cli.globals, common),
    }
}

fn for_robots<F: command::Family>(globals: Globals, command: &dyn AnyCommand<F>) -> Result<(), Stopped> {
    let need = if command.takes_robot() { Need::Inventory } else { Need::Nothing };
    let run = prepare(globals, need)?;
    to_the_end(run.robots(command))
}

fn for_all_families(globals: Globals, common: Common) -> Result<(), Stopped> {
    let need = match &common {
        Common::Robots(Robots::Discover(_)) => Need::Nothing,
        Common::Robots(robots) if robots.makes_inventory() => Need::InventoryOrNone,
        Common::Session(session) if !session.opens() => Need::Names,
        common if !common.is_about_robots() => Need::Nothing,
        _ => Need::Inventory,
    };
    let mut run = prepare(globals, need)?;
    match &common {
        Common::Status(_) => run.sources.widen(),
        Common::Robots(Robots::Check(Check { name: Some(name) })) => run.sources.choose(name)?,
        _ => {}
    }
    to_the_end(common.run(&run))
}

/// Runs it on this thread.
fn to_the_end(done: impl Future<Output = Result<(), Stopped>>) -> Result<(), Stopped> {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .map_err(|error| Failure::io("start", &error))?;
    let done = runtime.block_on(done);
    // A thread that waits for stdin or a name server must not hold up the end.
    runtime.shutdown_background();
    done
}

/// What a command wants of inventory and environment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Need {
    /// Nothing: what is wrong in them is no matter, and `help` must tell how to set it right.
    Nothing,
    /// Which robots are named, whatever the inventory says of them.
    Names,
    /// The inventory; one that is named must be there.
    Inventory,
    /// The inventory, which is made if it is not there.
    InventoryOrNone,
}

/// Flags, environment and inventory, read once.
fn prepare(globals: Globals, need: Need) -> Result<Run, Failure> {
    let screen = screen(&globals);
    let filter = globals.jq.as_deref().map(Filter::new).transpose()?;
    let until = globals.until.as_deref().map(Filter::new).transpose()?;
    let gate = Gate { yes: globals.yes, dry_run: globals.dry_run, on_interrupt: globals.on_interrupt };
    let repeat = Repeat { every: globals.watch, count: globals.count, until, within: globals.within };
    let trace = globals.trace.clone();
    let sources = if need == Need::Nothing { Sources::default() } else { sources(globals, need)? };
    Ok(Run { screen, sources, gate, repeat, filter, trace })
}

/// Which robots, and their settings.
fn sources(globals: Globals, need: Need) -> Result<Sources, Failure> {
    let selection = Selection {
        sim: globals.sim,
        target: globals.target,
        robots: globals.robot,
        tags: globals.tag,
        all: globals.all,
        environment: variable("ARMCTL_TARGET", |url| url.parse::<Target>().map_err(|failure| failure.message))?,
        by_session: !globals.no_session,
    };
    // A robot that is told by flag needs no file; a broken file is an error for everybody else.
    let mut location = Location::find(match globals.config {
        Some(path) => Some(path),
        None => variable("ARMCTL_CONFIG", |path| Ok(path.into()))?,
    });
    if let (Location::Named(path), Need::InventoryOrNone) = (&location, need) {
        location = Location::Usual(path.clone());
    }
    let inventory = if selection.sim || selection.target.is_some() || need == Need::Names {
        Inventory { path: location.path().map(Path::to_owned), ..Inventory::default() }
    } else {
        Inventory::load(&location)?
    };
    let flags = Options {
        timeout: globals.timeout,
        retries: globals.retries,
        encoding: globals.encoding,
        ..Options::default()
    };
    let environment = Options {
        timeout: variable("ARMCTL_TIMEOUT", duration::parse_some)?,
        retries: variable("ARMCTL_RETRIES", |number| {
            number.parse().map_err(|_| format!("'{number}' is no number of repetitions"))
        })?,
        encoding: variable("ARMCTL_ENCODING", |name| name.parse().map_err(|error| format!("{error}")))?,
        ..Options::default()
    };
    Ok(Sources { selection, flags, environment, inventory })
}

/// A variable of the environment; an empty one counts as not set, a wrong one is an error that names it.
fn variable<T>(name: &str, parse: impl FnOnce(&str) -> Result<T, String>) -> Result<Option<T>, Failure> {
    let Some(value) = std::env::var_os(name).filter(|value| !value.is_empty()) else { return Ok(None) };
    let wrong = |why: String| Failure::usage(format!("{name}: {why}")).hint(format!("correct it, or unset {name}"));
    let text = value.to_str().ok_or_else(|| wrong("it is not UTF-8".to_owned()))?;
    parse(text).map(Some).map_err(wrong)
}

fn screen(globals: &Globals) -> Screen {
    let format = match globals.format {
        Some(format) => format,
        None if globals.json || globals.jq.is_some() => Format::Json,
        None => Format::Table,
    };
    Screen::new(format, globals.color, globals.quiet, globals.verbose)
}

/// Writes a failure once, in the form that was asked for.
fn tell(screen: &Screen, Stopped { failure, envelope, told }: Stopped) -> ExitCode {
    let exit = failure.kind.exit();
    if !told && failure.kind != Kind::PipeClosed {
        if screen.is_json() {
            screen.failure_json(&envelope.unwrap_or_else(|| Box::new(Envelope::failed(None, failure))));
        } else {
            screen.failure(&failure);
        }
    }
    ExitCode::from(exit)
}

/// What the parser has to say: help and version on stdout, mistakes on stderr with exit code 2.
fn refuse(args: &[OsString], error: &clap::Error) -> ExitCode {
    let is_json = wants_json(args);
    let format = if is_json { Format::Json } else { Format::Table };
    let screen = Screen::new(format, ColorChoice::Auto, false, 0);
    let rendered = error.render();
    if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        let text = if screen.stdout_color() { rendered.ansi().to_string() } else { rendered.to_string() };
        return match screen.data(&text) {
            Ok(()) => ExitCode::SUCCESS,
            Err(failure) => tell(&screen, failure.into()),
        };
    }
    if is_json {
        let text = rendered.to_string();
        let message = text.lines().next().unwrap_or_default().trim_start_matches("error: ");
        let tip = text.lines().find_map(|line| line.trim().strip_prefix("tip: ")).unwrap_or("see --help");
        return tell(&screen, Failure::usage(message).hint(tip).into());
    }
    screen.usage(&rendered);
    ExitCode::from(Kind::Usage.exit())
}

/// Whether a command line that could not be parsed asks for JSON, in any of the forms that flags have.
fn wants_json(args: &[OsString]) -> bool {
    let is_json = |format: &str| matches!(format.trim_start_matches('='), "json" | "jsonl");
    let mut words = args.iter().skip(1).map(|arg| arg.to_str().unwrap_or_default()).take_while(|arg| *arg != "--");
    while let Some(word) = words.next() {
        let format = match word {
            "--json" | "--jq" => return true,
            "--format" => words.next(),
            _ if word.starts_with("--jq=") => return true,
            _ if word.starts_with("--") => word.strip_prefix("--format"),
            // Short flags without a value may stand before the last one, whose value may be the next word.
            _ => match word
                .strip_prefix('-')
                .and_then(|flags| flags.trim_start_matches(['q', 'v', 'y']).strip_prefix('o'))
            {
                Some("") => words.next(),
                value => value,
            },
        };
        if format.is_some_and(is_json) {
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_is_recognised_in_a_line_that_does_not_parse() {
        let wants = |line: &str| wants_json(&line.split(' ').map(OsString::from).collect::<Vec<_>>());
        for line in [
            "armctl --json x",
            "armctl x --jq .a",
            "armctl x --jq=.a",
            "armctl x -o json",
            "armctl x -ojsonl",
            "armctl x -o=json",
            "armctl x -qojson",
            "armctl x -vyo json",
            "armctl --format jsonl x",
            "armctl --format=json x",
        ] {
            assert!(wants(line), "{line}");
        }
        for line in ["armctl x", "armctl x -o csv", "armctl x --format=table", "armctl say -- --json", "armctl x json"]
        {
            assert!(!wants(line), "{line}");
        }
    }
}
