//! Preparation of a command line, before anything is sent.

use clap::{CommandFactory as _, ValueEnum as _};

use super::flags;
use crate::cli::{Cli, FamilyWord, Top};
use crate::command::common::{Common, Properties};
use crate::command::fleet::common;
use crate::command::fleet::robots::Robots;
use crate::command::fleet::robots::check::Check;
use crate::command::fleet::teach::Teach;
use armctl_frame::batch::{Batch, Rehearse};
use armctl_frame::condition::Condition;
use armctl_frame::face::family_command::{FamilyLine, ParsedCommand};
use armctl_frame::flags::Globals;
use armctl_frame::gate::Gate;
use armctl_frame::output::Format;
use armctl_frame::output::jq::Filter;
use armctl_frame::output::redraw::Redraw;
use armctl_frame::prelude::*;
use armctl_frame::run::Repeat;
use armctl_frame::script_line::Line;
use armctl_frame::settings::inventory::{Inventory, Location, Options};
use armctl_frame::settings::target::TargetArgument;
use armctl_frame::settings::{Selection, Sessions, Sources};
use armctl_frame::{AnyCommand, FamilyArguments};

/// Meaning of a command line.
pub enum Invocation {
    /// A command.
    Task(Task),
    /// A file of commands.
    Batch(Batch),
    /// Commands that run on simulators.
    Rehearse(Rehearse),
    /// The teach panel.
    Teach(Teach),
    /// A prompt. These words precede each line that the user types.
    Prompt(Vec<String>),
    /// Only the name of a family. If there is a terminal, this means a prompt.
    Bare(Vec<String>),
}

/// A command to run.
#[allow(clippy::large_enum_variant, reason = "a process has only a few")]
pub enum Task {
    /// A command of a family, with the options of the family.
    Family(FamilyArguments, Box<dyn AnyCommand>),
    /// A command that all families have in common.
    Common(Common),
}

impl From<Top> for Invocation {
    fn from(command: Top) -> Self {
        match command {
            Top::Family(FamilyWord { family, typed: FamilyLine { arguments: own, command: wish } }) => {
                let prefix = std::iter::once(family.name().to_owned()).chain(own.words()).collect();
                match wish {
                    ParsedCommand::Command(command) => Self::Task(Task::Family(own, command)),
                    ParsedCommand::Prompt => Self::Prompt(prefix),
                    ParsedCommand::Nothing => Self::Bare(prefix),
                }
            }
            Top::Common(common) => Self::Task(Task::Common(common)),
            Top::Batch(batch) => Self::Batch(batch),
            Top::Rehearse(rehearse) => Self::Rehearse(rehearse),
            Top::Teach(teach) => Self::Teach(teach),
            Top::Repl(_) => Self::Prompt(Vec::new()),
        }
    }
}

/// A command that is ready to run.
pub struct PreparedCommand {
    /// Settings of the run.
    pub run: Run,
    /// The command.
    pub task: Task,
}

impl PreparedCommand {
    /// Reads flags, environment and inventory once. `all` contains the global flags for all lines, if there are several
    /// lines.
    pub fn new(globals: Globals, all: Option<&Globals>, task: Task, line: Option<Line>) -> Result<Self> {
        flags::check(&globals, &task)?;
        let globals = match all {
            // At the prompt of a robot, this command still lists the whole inventory.
            Some(all) if matches!(task, Task::Common(Common::Robots(Robots::List))) => {
                globals.within(&all.clone().without_robot())
            }
            Some(all) => globals.within(all),
            None => globals,
        };
        let need = match task.need() {
            Need::Names if matches!(task, Task::Common(Common::Explain(_))) && globals.names_robot() => Need::Inventory,
            need => need,
        };
        let mut run = prepare(globals, need, line)?;
        match &task {
            Task::Family(own, _) => run.own = own.clone(),
            Task::Common(common) if common.properties().is_for_all => {
                run.sources.default_to_all();
                run.sources.selection.every_simulator = true;
            }
            Task::Common(Common::Wait(wait)) => run.repeat = wait.repeat(&run.repeat)?,
            Task::Common(Common::Robots(Robots::Check(Check { name: Some(name) }))) => run.sources.choose(name)?,
            Task::Common(Common::Report(pack)) => match &pack.robots[..] {
                [] => {}
                [robot] => run.sources.choose(robot)?,
                robots => run.sources.choose_all(robots)?,
            },
            Task::Common(Common::Restore(restore)) => run.sources.selection.simulated = restore.of_family(),
            Task::Common(Common::Diff(diff)) => match diff.robots(&run.sources.inventory) {
                Some(robots) => run.sources.choose_all(&robots)?,
                None => run.sources.selection.simulated = diff.of_family(),
            },
            Task::Common(_) => {}
        }
        Ok(Self { run, task })
    }

    /// Runs the command.
    pub async fn run(self) -> Result<(), RunError> {
        self.task.go(&self.run).await
    }

    /// Refuses the command, before a connection is opened, if a robot is missing or if the gate rejects the command.
    pub fn check_gate(&self) -> Result<()> {
        match &self.task {
            Task::Family(_, command) => self.run.check_gate(&**command),
            Task::Common(Common::Status(overview)) => self.run.check_gate(overview),
            Task::Common(Common::Wait(wait)) => self.run.check_gate(&*wait.command()?),
            Task::Common(Common::Alarm(alarm)) => self.run.check_gate(&*alarm.command()?),
            Task::Common(Common::Io(io)) => self.run.check_gate(&*io.command()?),
            Task::Common(Common::Position) => self.run.check_gate(&common::position()),
            Task::Common(Common::Stop) => self.run.check_gate(&common::stop()),
            Task::Common(_) => Ok(()),
        }
    }
}

impl Task {
    /// Runs the command.
    pub async fn go(self, run: &Run) -> Result<(), RunError> {
        match self {
            Self::Family(_, command) => run.robots(&*command).await,
            Self::Common(common) => common.run(run, Cli::command).await,
        }
    }

    /// Properties of the command with its arguments.
    pub fn properties(&self) -> Properties {
        match self {
            Self::Family(_, command) if command.driver().is_none() => {
                Properties { can_rehearse: true, ..Properties::ALONE }
            }
            Self::Family(..) => Properties::ROBOTS,
            Self::Common(common) => common.properties(),
        }
    }

    fn need(&self) -> Need {
        match self {
            Self::Common(Common::Robots(Robots::Discover(_))) => Need::Nothing,
            Self::Common(Common::Robots(robots)) if robots.is_about_file() => Need::Names,
            Self::Common(Common::Robots(robots)) if robots.makes_inventory() => Need::InventoryOrNone,
            Self::Common(Common::Setup(_)) => Need::InventoryOrNone,
            Self::Common(Common::Session(session)) if !session.opens() => Need::Names,
            // `explain` reads `alarms.toml`, which is in the folder of the inventory.
            Self::Common(Common::Explain(_)) => Need::Names,
            task if task.properties().is_about_robots => Need::Inventory,
            _ => Need::Nothing,
        }
    }
}

/// Parts of inventory and environment that a command needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// The command needs no inventory and no environment variables. Mistakes in them are ignored: `help` must also work
    /// while a user corrects a mistake.
    Nothing,
    /// The command needs names of robots, without their inventory entries.
    Names,
    /// The command needs the inventory. If the user names the file, it must exist.
    Inventory,
    /// The command needs the inventory, or creates it if it does not exist.
    InventoryOrNone,
}

/// Reads flags, environment and inventory.
pub fn prepare(globals: Globals, need: Need, line: Option<Line>) -> Result<Run> {
    let screen = globals.screen().with_pager(!globals.no_pager && line.is_none());
    let filter = globals.jq.as_deref().map(Filter::new).transpose()?;
    let until = globals.until.as_deref().map(Condition::new).transpose()?;
    let check = globals.check.as_deref().map(Condition::new).transpose()?;
    let gate = Gate { yes: globals.yes, dry_run: globals.dry_run, on_interrupt: globals.on_interrupt };
    let repeat = Repeat {
        every: globals.watch,
        count: globals.count,
        until,
        check,
        within: globals.within,
        ..Repeat::default()
    };
    let trace = globals.trace.clone();
    let sources = if need == Need::Nothing { Sources::default() } else { sources(globals, need, line.is_some())? };
    let rehearsal = line.as_ref().and_then(|line| line.rehearsal.clone());
    let sources = Sources { rehearsal, ..sources };
    Ok(Run {
        screen,
        sources,
        gate,
        repeat,
        filter,
        trace,
        line,
        redraw: Redraw::default(),
        own: FamilyArguments::default(),
    })
}

/// Returns the selected robots and their settings. `among` is `true` if this process also runs other lines; its
/// simulators then stay alive between lines.
pub fn sources(globals: Globals, need: Need, among: bool) -> Result<Sources> {
    let mut selection = Selection {
        sim: globals.sim,
        target: globals.target,
        robots: globals.robot,
        from_environment: false,
        tags: globals.tag,
        all: globals.all,
        environment: variable("ARMCTL_TARGET", |url| url.parse::<TargetArgument>().map_err(|failure| failure.message))?,
        sessions: match (globals.no_session, among) {
            (true, _) => Sessions::None,
            (false, true) => Sessions::OwnSimulators,
            (false, false) => Sessions::Shared,
        },
        simulated: None,
        every_simulator: false,
    };
    let names = variable("ARMCTL_ROBOT", names)?;
    if let (Some(names), false) = (names, selection.has_flags()) {
        (selection.robots, selection.from_environment) = (names, true);
    }
    // The inventory is also read if a robot is selected by address, because the entry of the robot may be read-only.
    let mut location = location(globals.config)?;
    if let (Location::Named(path), Need::InventoryOrNone) = (&location, need) {
        location = Location::Default(path.clone());
    }
    let inventory = if selection.sim || need == Need::Names {
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
            number.parse().map_err(|_| format!("'{number}' is not a valid number of retries"))
        })?,
        encoding: variable("ARMCTL_ENCODING", |name| name.parse().map_err(|error| format!("{error}")))?,
        ..Options::default()
    };
    Ok(Sources { selection, flags, environment, inventory, rehearsal: None })
}

/// Parses robot names or patterns that are separated by commas.
fn names(text: &str) -> Result<Vec<String>, String> {
    let names: Vec<String> = text.split(',').map(str::trim).filter(|name| !name.is_empty()).map(Into::into).collect();
    if names.is_empty() { Err(format!("no robot name in '{text}'")) } else { Ok(names) }
}

/// Returns the format from `ARMCTL_OUTPUT`, if the line has no format option. Help and interactive commands ignore the
/// variable.
pub fn format_of_environment(cli: &Cli) -> Result<Option<Format>> {
    let asks = !cli.globals.says_format() && !matches!(cli.command, Top::Common(Common::Help(_) | Common::Top(_)));
    if asks { variable(OUTPUT, format) } else { Ok(None) }
}

/// Whether `ARMCTL_OUTPUT` is a JSON format.
pub fn wants_json() -> bool {
    matches!(variable(OUTPUT, format), Ok(Some(Format::Json | Format::Jsonl)))
}

/// Environment variable with the output format.
const OUTPUT: &str = "ARMCTL_OUTPUT";

fn format(name: &str) -> Result<Format, String> {
    Format::from_str(name, true)
        .map_err(|_| format!("unknown output format '{name}'; use table, json, jsonl, csv or value"))
}

/// Location of the inventory.
fn location(config: Option<PathBuf>) -> Result<Location> {
    Ok(Location::find(match config {
        Some(path) => Some(path),
        None => variable("ARMCTL_CONFIG", |path| Ok(path.into()))?,
    }))
}

/// Returns the value of an environment variable. An empty variable counts as not set. An error contains the name of the
/// variable.
fn variable<T>(name: &str, parse: impl FnOnce(&str) -> Result<T, String>) -> Result<Option<T>> {
    let Some(value) = std::env::var_os(name).filter(|value| !value.is_empty()) else { return Ok(None) };
    let wrong =
        |why: String| Failure::usage(format!("{name}: {why}")).hint(format!("correct the value, or unset {name}"));
    let text = value.to_str().ok_or_else(|| wrong("the value is not UTF-8".to_owned()))?;
    parse(text).map(Some).map_err(wrong)
}
