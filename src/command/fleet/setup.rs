//! `armctl setup`: interactive setup of a robot: address, check, name, access.

use super::robots::discover::Discover;
use super::robots::entry::{NewRobot, check_new};
use super::robots::file;
use crate::command::families::{self, FAMILIES};
use armctl_frame::face::layers;
use armctl_frame::interrupt::{catch_interrupts, interruptible};
use armctl_frame::output::render;
use armctl_frame::prelude::*;
use armctl_frame::prompt::ask;
use armctl_frame::settings::target::{Target, TargetArgument};

/// Asks for address, name and access rights, checks the connection, and writes robots.toml.
#[derive(Debug, Args)]
#[command(
    after_help = "The check only reads, and changes nothing on the controller. `armctl robots add` does the same \
                  without questions."
)]
pub struct Setup {}

/// Limit of the numbers in a proposed name.
const MAX_NAME_NUMBER: u32 = 999;

/// Target and family of the new robot.
struct FoundTarget {
    family: Family,
    target: Target,
}

impl Setup {
    /// Runs the command.
    pub async fn run(self, run: &Run) -> Result<(), RunError> {
        if !run.screen.can_ask() {
            return Err(Failure::usage("setup needs a terminal for its questions")
                .hint("use `armctl robots add NAME URL --read-only`, which does the same without questions")
                .into());
        }
        let path = file::path(run)?.display().to_string();
        // From here on, Ctrl-C ends with a message and an exit code.
        catch_interrupts();
        run.screen.ask_note(
            "Set up a robot. Enter selects the value in brackets. armctl writes nothing before the last answer.",
        );
        let FoundTarget { family, target } = ask_target(run).await.map_err(no_terminal)?;
        let robot = describe(run, family, target).await.map_err(no_terminal)?;
        run.screen.ask_note(&format!("\n[[robot]]\n{}", robot.table()));
        if !yes(run, format!("Write this to {path}?"), true).await.map_err(no_terminal)? {
            return Err(Failure::new(Kind::Rejected, "not confirmed; nothing was written").into());
        }
        robot.add(run, "setup", &[])?;
        run.screen.note("use `armctl status` to see the state of the robot, and `armctl -h` to list the commands");
        Ok(())
    }
}

/// Failure for a missing answer to a question.
fn no_terminal(failure: Failure) -> Failure {
    match failure.kind {
        Kind::Rejected => Failure::new(Kind::Rejected, "no answer; nothing was written")
            .hint("use `armctl robots add NAME URL --read-only`, which does the same without questions"),
        Kind::Interrupted => Failure { message: format!("{}; nothing was written", failure.message), ..failure },
        _ => failure,
    }
}

async fn line(run: &Run, question: impl Into<String>, usual: Option<&str>) -> Result<String> {
    let (screen, question, usual) = (run.screen, question.into(), usual.map(ToOwned::to_owned));
    ask(screen, move || screen.ask_line(&question, usual.as_deref())).await
}

async fn choice(run: &Run, question: &'static str, options: Vec<String>) -> Result<usize> {
    let screen = run.screen;
    ask(screen, move || screen.ask_choice(question, &options)).await
}

async fn yes(run: &Run, question: impl Into<String>, usual: bool) -> Result<bool> {
    let (screen, question) = (run.screen, question.into());
    ask(screen, move || screen.ask_yes(&question, usual)).await
}

/// Asks for an address until its check succeeds or the user accepts it.
async fn ask_target(run: &Run) -> Result<FoundTarget> {
    loop {
        let found = address(run).await?;
        loop {
            if check(run, &found).await? {
                return Ok(found);
            }
            let choices = ["check again", "another address", "continue anyway"];
            match choice(run, "The check failed. What now?", choices.map(String::from).into()).await? {
                0 => {}
                1 => break,
                _ => return Ok(found),
            }
        }
    }
}

async fn address(run: &Run) -> Result<FoundTarget> {
    let ways = [
        "type an address or serial port",
        "search: controllers in this network, serial ports",
        "no robot yet: use a simulator",
    ];
    loop {
        let found = match choice(run, "Where is the robot?", ways.map(String::from).into()).await? {
            0 => ask_address(run).await,
            1 => match search(run).await? {
                Some((given, family)) => ask_missing_parts(run, &given, family).await,
                None => continue,
            },
            _ => simulator(run).await,
        };
        match found {
            Err(failure) if failure.kind == Kind::Usage => run.screen.failure(&failure),
            found => return found,
        }
    }
}

async fn ask_address(run: &Run) -> Result<FoundTarget> {
    let input = line(run, "Address, such as 192.168.1.31, COM3, /dev/ttyUSB0 or a URL", None).await?;
    ask_missing_parts(run, &input.parse()?, None).await
}

/// Searches for controllers, and lets the user select one of them; `None` if the user selects none because the right
/// controller is not in the list.
async fn search(run: &Run) -> Result<Option<(TargetArgument, Option<Family>)>> {
    let found = interruptible(Discover::default_arguments()?.find(run)).await??;
    let mut targets = found.places();
    let shown = targets.iter().map(|(target, _, device)| format!("{target}  {device}"));
    let options: Vec<String> = shown.chain(["none of these".to_owned()]).collect();
    let at = choice(run, "Found:", options).await?;
    if at >= targets.len() {
        return Ok(None);
    }
    let (target, family, _) = targets.swap_remove(at);
    Ok(Some((target.parse()?, family.and_then(|family| family.parse().ok()))))
}

async fn simulator(run: &Run) -> Result<FoundTarget> {
    let family = family(run).await?;
    let question = format!(
        "Address of a simulator that runs (`armctl sim {family}`), or `sim:` for the built-in \
                            simulator"
    );
    let input = line(run, question, Some(families::of(family).simulator)).await?;
    ask_missing_parts(run, &input.parse()?, Some(family)).await
}

/// Asks for the parts that the address does not contain.
async fn ask_missing_parts(run: &Run, given: &TargetArgument, known: Option<Family>) -> Result<FoundTarget> {
    let hint = match given {
        TargetArgument::Url(target) => target.family(),
        TargetArgument::Bare(_) => None,
    };
    let family = match known.or(hint) {
        Some(family) => family,
        None => family(run).await?,
    };
    let target = given.resolve(Some(family))?;
    target.check(family).map_err(Failure::usage)?;
    Ok(FoundTarget { family, target })
}

async fn family(run: &Run) -> Result<Family> {
    let titles = FAMILIES.map(|face| format!("{} ({})", face.title, face.family));
    let at = choice(run, "Which controller is it?", titles.into()).await?;
    FAMILIES.get(at).map(|face| face.family).ok_or_else(|| Failure::local("internal error: no such family"))
}

/// Checks each layer and shows it. Returns whether all layers succeeded.
async fn check(run: &Run, found: &FoundTarget) -> Result<bool> {
    let robot = run.sources.at(&found.target, found.family)?;
    let access = Access { trace: run.trace.clone(), ..Access::reading(ConnectMode::Explicit) };
    run.begin_trace()?;
    let layers = interruptible((families::of(found.family).check)(&robot, access, &run.screen)).await??;
    let table = render::text(&View::table(layers::table(&layers)), run.screen.width(), false);
    run.screen.ask_note(&format!("\n{}", table.trim_end()));
    Ok(layers::first_failed(&layers).is_none())
}

/// Asks for name and access.
async fn describe(run: &Run, family: Family, target: Target) -> Result<NewRobot> {
    let (screen, inventory) = (&run.screen, &run.sources.inventory);
    let unused_name =
        (1..=MAX_NAME_NUMBER).map(|number| format!("cell{number}")).find(|name| check_new(inventory, name).is_ok());
    screen.ask_note("");
    let name = loop {
        let name = line(run, "Name", unused_name.as_deref()).await?;
        match check_new(inventory, &name) {
            Ok(()) => break name,
            Err(failure) => screen.failure(&failure),
        }
    };
    let read_only = yes(run, "Read-only: reject commands that change something?", true).await?;
    let hold = family == Family::Yrcx
        && !read_only
        && yes(run, "Hold: open a session automatically if a command needs a session?", false).await?;
    let is_default = match &inventory.default {
        // The first robot becomes the default without a question.
        None if inventory.robots.is_empty() => true,
        None => yes(run, "Default: use this robot if no robot is selected?", true).await?,
        Some(other) => {
            yes(run, format!("Default: use this robot if no robot is selected, instead of {other}?"), false).await?
        }
    };
    Ok(NewRobot { name, target, family, read_only, hold, tags: Vec::new(), is_default })
}
