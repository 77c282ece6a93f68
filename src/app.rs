//! The command line program: from the arguments of the process to an exit code.

mod assignments;
mod batch;
mod complete;
mod flags;
#[cfg(test)]
mod gate_tests;
mod line_words;
mod name_lookup;
mod parser;
mod picker;
mod prepare;
mod rehearse;
mod repl;
mod spellings;
mod suggestions;
mod teach;
mod typed_line;

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use anyhow::Context as _;
use clap::ValueEnum as _;
use clap::builder::StyledStr;

use self::parser::{Parser, Refusal};
use self::prepare::{Invocation, PreparedCommand};
use crate::cli::{Cli, Words};
use crate::command::families;
use armctl_files as files;
#[cfg(unix)]
use armctl_frame::background::{DETACHED, close_inherited_files};
use armctl_frame::backup::twin;
use armctl_frame::failure::{Failure, Kind, omit_program_name};
use armctl_frame::guardian;
use armctl_frame::interrupt::catch_interrupts;
use armctl_frame::output::envelope::Envelope;
use armctl_frame::output::{ColorChoice, Format, Screen, jq};
use armctl_frame::run::RunError;
use armctl_frame::settings::target::Family;

/// Runs a command line that includes the program name. Returns the exit code.
pub fn main(args: impl IntoIterator<Item = OsString>) -> ExitCode {
    let args: Vec<OsString> = args.into_iter().collect();
    if let Some(served) = guardian::serve(&args) {
        return exit(served);
    }
    if jq::worker::is_worker(&args) {
        return exit(jq::worker::serve());
    }
    if let Some(answer) = complete::answer(&args) {
        // An error is ignored: the shell may have closed the pipe.
        let _ = Screen::new(Format::Table, ColorChoice::Never, true, 0).data(&answer);
        return ExitCode::SUCCESS;
    }
    #[cfg(unix)]
    if args.iter().any(|word| word == DETACHED) {
        close_inherited_files();
    }
    let mut args = with_family(args);
    if let Some(version) = parser::version(&args) {
        let screen = Screen::new(Format::Table, ColorChoice::Never, false, 0);
        return exit(screen.data(&version).map_err(|failure| report_failure(&screen, failure.into())));
    }
    let mut parser = Parser::default();
    let parsed = loop {
        let refusal = match name_lookup::parse(&mut parser, &args, None, false) {
            Err(refusal) => refusal,
            parsed => break parsed,
        };
        match picker::complete_line(&args, &refusal) {
            Some(Ok(line)) => args = line,
            Some(Err(stopped)) => {
                let screen = Screen::new(Format::Table, ColorChoice::Never, false, 0);
                return exit(Err(report_failure(&screen, stopped)));
            }
            None => break Err(refusal),
        }
    };
    parser.abandon();
    let mut cli = match parsed {
        Ok(cli) => cli,
        Err(refusal) => {
            let pager = args.iter().all(|word| word != "--no-pager");
            return exit(refuse(&args, &refusal, false, pager));
        }
    };
    let format = prepare::format_of_environment(&cli);
    if let Ok(format) = &format {
        cli.globals.format = cli.globals.format.or(*format);
    }
    let screen = cli.globals.screen();
    screen.use_for_exit();
    files::set_draft_hook(catch_interrupts);
    twin::register(|family, folder| (families::of(family).twin)(folder));
    if let Err(failure) = format {
        return exit(Err(report_failure(&screen, failure.into())));
    }
    exit(on_this_thread(run(cli)).map_err(|stopped| report_failure(&screen, stopped)))
}

fn exit(done: Result<(), Kind>) -> ExitCode {
    done.map_or_else(|kind| ExitCode::from(kind.exit()), |()| ExitCode::SUCCESS)
}

/// Inserts the subcommand of a family, if the binary was started through a link with the name of this family.
fn with_family(mut args: Vec<OsString>) -> Vec<OsString> {
    if files::was_started_by_itself() {
        return args;
    }
    let name = args.first().and_then(|name| Path::new(name).file_stem()).and_then(|name| name.to_str());
    if let Some(family) = name.and_then(|name| name.parse::<Family>().ok()) {
        omit_program_name();
        // Usage lines show this name, followed by the family.
        args[0] = "armctl".into();
        let asks_version = args.get(1).is_some_and(|word| word == "--version" || word == "-V");
        if !asks_version {
            args.insert(1, family.name().into());
        }
    }
    args
}

async fn run(cli: Cli) -> Result<(), RunError> {
    let Words { globals, command } = cli;
    match Invocation::from(command) {
        Invocation::Task(task) => Box::pin(PreparedCommand::new(globals, None, task, None)?.run()).await,
        Invocation::Batch(batch) => Box::pin(batch::run(globals, batch)).await,
        Invocation::Prompt(prefix) => Box::pin(repl::run(globals, prefix)).await,
        Invocation::Rehearse(rehearse) => Box::pin(rehearse::run(globals, rehearse)).await,
        Invocation::Teach(teach) => Box::pin(teach::run(globals, teach)).await,
        Invocation::Bare(prefix) if repl::can_type() => Box::pin(repl::run(globals, prefix)).await,
        Invocation::Bare(prefix) => Err(repl::usage(&globals.screen(), &prefix)),
    }
}

/// Runs a command on this thread.
fn on_this_thread(done: impl Future<Output = Result<(), RunError>>) -> Result<(), RunError> {
    check_descriptors()?;
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().context("start")?;
    let done = runtime.block_on(done);
    // A thread that still waits for stdin or a name server must not delay the exit.
    runtime.shutdown_background();
    done
}

/// Number of file descriptors that the simplest command needs.
#[cfg(unix)]
const NEEDED_DESCRIPTORS: usize = 20;

/// Checks that enough file descriptors are available. Without them, the runtime and the signal handler would panic.
#[cfg(unix)]
fn check_descriptors() -> Result<(), Failure> {
    let pairs: Result<Vec<_>, _> =
        (0..NEEDED_DESCRIPTORS / 2).map(|_| std::os::unix::net::UnixStream::pair()).collect();
    pairs.map(|_| ()).map_err(|error| {
        Failure::io("start", &error)
            .hint(format!("raise the limit of open files (`ulimit -n`): armctl needs {NEEDED_DESCRIPTORS} more"))
    })
}

#[cfg(not(unix))]
fn check_descriptors() -> Result<(), Failure> {
    Ok(())
}

/// Prints a failure in the requested format, unless it was already reported. Returns its kind.
fn report_failure(screen: &Screen, RunError { failure, envelope, is_reported: told }: RunError) -> Kind {
    let kind = failure.kind;
    if !told && kind != Kind::PipeClosed {
        if screen.is_json() && !matches!(kind, Kind::Halted(_)) {
            screen.failure_json(&envelope.unwrap_or_else(|| Box::new(Envelope::failed(None, failure))));
        } else {
            screen.failure(&failure);
        }
    }
    kind
}

/// Prints the result of the parser. Help, version and lists of verbs are printed to stdout, and errors to stderr. If
/// the line requests JSON, an error is JSON.
fn refuse(args: &[OsString], refusal: &Refusal, is_json: bool, pager: bool) -> Result<(), Kind> {
    let is_json = is_json || wants_json(args).unwrap_or_else(prepare::wants_json);
    let format = if is_json { Format::Json } else { Format::Table };
    let screen = Screen::new(format, color(args), false, 0).with_pager(pager);
    match refusal {
        // If the verb after a noun is missing, the list of verbs is printed. With JSON, this is an error.
        Refusal::Verb(text, _) if !is_json => print_text(&screen, text),
        Refusal::Text(text) => print_text(&screen, text),
        Refusal::Mistake(error) if !is_json => {
            screen.usage(&error.render());
            Err(Kind::Usage)
        }
        _ => Err(report_failure(&screen, refusal.failure().into())),
    }
}

/// Prints a text to stdout. A long text is shown with the pager.
fn print_text(screen: &Screen, text: &StyledStr) -> Result<(), Kind> {
    let text = if screen.stdout_color() { text.ansi().to_string() } else { text.to_string() };
    screen.read(&text).map_err(|failure| report_failure(screen, failure.into()))
}

/// Returns the color option of a line that could not be parsed.
fn color(args: &[OsString]) -> ColorChoice {
    let mut words = args.iter().skip(1).map(|arg| arg.to_str().unwrap_or_default()).take_while(|arg| *arg != "--");
    let value = words.by_ref().find_map(|word| match word {
        "--no-color" => Some(Some("never")),
        "--color" => Some(None),
        _ => word.strip_prefix("--color=").map(Some),
    });
    let value = value.and_then(|value| value.or_else(|| words.next()));
    value.and_then(|value| ColorChoice::from_str(value, false).ok()).unwrap_or(ColorChoice::Auto)
}

/// Whether a line that could not be parsed requests JSON. `None` if the line has no format option.
fn wants_json(args: &[OsString]) -> Option<bool> {
    let is_json = |format: &str| matches!(format.trim_start_matches('='), "json" | "jsonl");
    let mut words = args.iter().skip(1).map(|arg| arg.to_str().unwrap_or_default()).take_while(|arg| *arg != "--");
    while let Some(word) = words.next() {
        let format = match word {
            "--json" => return Some(true),
            "--output" | "--format" => words.next(),
            _ if word.starts_with("--") => {
                ["--output=", "--format="].into_iter().find_map(|flag| word.strip_prefix(flag))
            }
            // Short flags can be combined. The value of the last flag may be the next word.
            _ => match word
                .strip_prefix('-')
                .and_then(|flags| flags.trim_start_matches(['q', 'v', 'y']).strip_prefix('o'))
            {
                Some("") => words.next(),
                value => value,
            },
        };
        if let Some(format) = format {
            return Some(is_json(format));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colour_is_recognised_in_a_line_that_does_not_parse() {
        let color = |line: &str| color(&line.split(' ').map(OsString::from).collect::<Vec<_>>());
        assert_eq!(color("armctl --color always -h"), ColorChoice::Always);
        assert_eq!(color("armctl x --color=never"), ColorChoice::Never);
        assert_eq!(color("armctl --no-color -h"), ColorChoice::Never);
        for line in ["armctl -h", "armctl --color", "armctl --color blue", "armctl say -- --color always"] {
            assert_eq!(color(line), ColorChoice::Auto, "{line}");
        }
    }

    #[test]
    fn json_is_recognised_in_a_line_that_does_not_parse() {
        let wants = |line: &str| wants_json(&line.split(' ').map(OsString::from).collect::<Vec<_>>());
        for line in [
            "armctl --json x",
            "armctl x -o json",
            "armctl x -ojsonl",
            "armctl x -o=json",
            "armctl x -qojson",
            "armctl x -vyo json",
            "armctl --output jsonl x",
            "armctl --format jsonl x",
            "armctl --output=json x",
        ] {
            assert_eq!(wants(line), Some(true), "{line}");
        }
        for line in ["armctl x -o csv", "armctl x --output=table"] {
            assert_eq!(wants(line), Some(false), "{line}");
        }
        for line in ["armctl x", "armctl x --jq .a", "armctl x --jq=.a", "armctl say -- --json", "armctl x json"] {
            assert_eq!(wants(line), None, "{line}");
        }
    }
}
