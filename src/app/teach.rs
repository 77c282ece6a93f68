//! `armctl teach`: runs the command lines of the teach panel over a link that stays open.

use std::cell::RefCell;
use std::ffi::OsString;
use std::rc::Rc;

use super::batch::refuse_repetition;
use super::parser::Parser;
use super::prepare::{Invocation, Need, PreparedCommand, sources};
use crate::cli::Words;
use crate::command::families;
use crate::command::fleet::session::host;
use crate::command::fleet::teach::{CommandRunner, Teach, show};
use armctl_frame::ConnectionEffect;
use armctl_frame::confirmation;
use armctl_frame::flags::Globals;
use armctl_frame::gate::{Gate, Intent};
use armctl_frame::interrupt::catch_interrupts;
use armctl_frame::output::Format;
use armctl_frame::prelude::*;
use armctl_frame::run::begin_trace;
use armctl_frame::script_line::Line;
use armctl_frame::session_manager::SessionManager;

/// Shows the teach panel until the user leaves it.
pub async fn run(globals: Globals, teach: Teach) -> Result<(), RunError> {
    refuse_repetition(&globals)?;
    let screen = globals.screen();
    let robot = select_robot(&globals, &teach)?;
    check_globals(&globals, &screen)?;
    catch_interrupts();
    begin_trace(globals.trace.as_deref())?;
    let gate = Gate { yes: globals.yes, dry_run: false, on_interrupt: globals.on_interrupt };
    confirmation::confirm_intent(gate, &screen, &robot, &intent(&teach, &robot)).await?;
    // Messages about the link would damage the screen, so they are dropped. The commands report link errors.
    let (manager, thread) = host::start(|_| {})?;
    let lines = Lines { globals: line_globals(&globals), manager, robot: robot.clone(), parser: RefCell::default() };
    let panel = families::of(robot.family).panel;
    let outcome = match lines.line("teach").hold(&robot, globals.trace.as_deref(), &screen).await {
        Ok(()) => show(&screen, &robot, panel, &teach, &lines).await,
        Err(failure) => Err(failure),
    };
    thread.end().await;
    Ok(outcome?)
}

/// Selects the robot of the panel. There must be exactly one.
fn select_robot(globals: &Globals, teach: &Teach) -> Result<Robot> {
    let sources = sources(globals.clone(), Need::Inventory, true)?;
    if sources.selection.sim && teach.family.is_none() {
        return Err(
            Failure::usage("the family of the simulator is missing").hint("add the family: `armctl --sim teach yerc`")
        );
    }
    match &sources.robots(teach.family)?[..] {
        [robot] => Ok(robot.clone()),
        robots => Err(Failure::usage(format!("teach moves one robot, but {} are selected", robots.len()))
            .hint("select one robot with -r")),
    }
}

fn check_globals(globals: &Globals, screen: &Screen) -> Result<()> {
    let wrong = |what: &str, hint: &str| Err(Failure::usage(format!("teach {what}")).hint(hint));
    if globals.dry_run {
        return wrong(
            "has no dry run: keys move the robot",
            "use --dry-run with a single command, for example `yerc move relative`",
        );
    }
    if screen.format != Format::Table || globals.jq.is_some() {
        return wrong("is interactive and prints no data", "in programs, use `position` and `move`");
    }
    if !screen.can_fill() || !screen.can_ask() {
        return wrong("needs a terminal for its display and keys", "run it in a terminal");
    }
    Ok(())
}

/// Returns the intent for one confirmation. It covers all keys, and the effects of the link itself.
fn intent(teach: &Teach, robot: &Robot) -> Intent {
    let intent = teach.intent();
    match (families::driver(robot).connection_effect)(robot, ConnectMode::Control) {
        ConnectionEffect::Stops(entry) => Intent { text: format!("{}, and {entry}", intent.text), ..intent },
        ConnectionEffect::Harmless | ConnectionEffect::ThroughSession => intent,
    }
}

/// Returns the flags of each line: confirmed, JSON output, quiet.
fn line_globals(globals: &Globals) -> Globals {
    Globals { yes: true, json: true, format: None, quiet: true, verbose: 0, ..globals.clone() }
}

/// Runs command lines for the robot's family.
struct Lines {
    globals: Globals,
    manager: SessionManager,
    robot: Robot,
    parser: RefCell<Parser>,
}

impl Lines {
    fn line(&self, typed: &str) -> Line {
        Line {
            typed: Arc::from(typed),
            manager: self.manager.clone(),
            origin: None,
            results: Some(Rc::default()),
            rehearsal: None,
        }
    }
}

impl CommandRunner for Lines {
    async fn run(&self, words: &[String]) -> Result<Value> {
        let line = self.line(&words.join(" "));
        let results = line.results.clone().unwrap_or_default();
        let family = self.robot.family.name().to_owned();
        let args: Vec<OsString> =
            ["armctl".to_owned(), family].into_iter().chain(words.iter().cloned()).map(OsString::from).collect();
        let parsed = self.parser.borrow_mut().parse(&args);
        let Words { globals, command } = parsed.map_err(|refusal| refusal.failure())?;
        let Invocation::Task(task) = command.into() else {
            return Err(Failure::local(format!("internal error: '{}' is not a command", words.join(" "))));
        };
        let prepared = PreparedCommand::new(globals, Some(&self.globals), task, Some(line))?;
        Box::pin(prepared.run()).await.map_err(|stopped| stopped.failure)?;
        let envelope = results.borrow_mut().pop().unwrap_or_default();
        Ok(envelope.get("data").cloned().unwrap_or_default())
    }
}
