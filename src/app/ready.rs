//! A command line with all that it needs, before anything is sent.

use std::path::Path;

use super::{flags, screen};
use crate::cli::{Globals, OfToyo, OfYerc, OfYrcx, Top, Verb};
use crate::command::commands::Common;
use crate::command::fleet::robots::Robots;
use crate::command::fleet::robots::check::Check;
use crate::command::fleet::status::Fleet;
use crate::command::frame::batch::Batch;
use crate::command::frame::run::{Repeat, Run, Stopped};
use crate::command::frame::script_line::Line;
use crate::command::{self, AnyCommand, Noun as _, toyo, yerc, yrcx};
use crate::failure::Failure;
use crate::gate::Gate;
use crate::output::jq::Filter;
use crate::output::redraw::Redraw;
use crate::settings::duration;
use crate::settings::inventory::{Inventory, Location, Options};
use crate::settings::target::{Family, Target};
use crate::settings::{Selection, Sessions, Sources};

/// What a command line wants.
pub enum Wanted {
    /// Something done.
    Work(Work),
    /// The commands of a file.
    Batch(Batch),
    /// A prompt; these words stand before each line.
    Prompt(Vec<String>),
    /// Nothing but the name of a family was typed: a prompt, where somebody can type.
    Bare(Vec<String>),
}

/// What is to be done, and for whom.
pub enum Work {
    /// For robots of a family.
    Yerc(Box<dyn AnyCommand<yerc::Family>>),
    /// For robots of a family, and which robot of the controller.
    Yrcx(u8, Box<dyn AnyCommand<yrcx::Family>>),
    /// For robots of a family.
    Toyo(Box<dyn AnyCommand<toyo::Family>>),
    /// Whatever all families share.
    Common(Common),
}

impl From<Top> for Wanted {
    fn from(command: Top) -> Self {
        let after = |family: Family, more: Vec<String>, is_asked: bool| {
            let prefix = std::iter::once(family.name().to_owned()).chain(more).collect();
            if is_asked { Self::Prompt(prefix) } else { Self::Bare(prefix) }
        };
        match command {
            Top::Yerc(OfYerc::Yerc { verb: Some(Verb::Command(verb)) }) => Self::Work(Work::Yerc(verb.command())),
            Top::Yerc(OfYerc::Yerc { verb }) => after(Family::Yerc, Vec::new(), verb.is_some()),
            Top::Yrcx(OfYrcx::Yrcx { unit, verb: Some(Verb::Command(verb)) }) => {
                Self::Work(Work::Yrcx(unit.number(), verb.command()))
            }
            Top::Yrcx(OfYrcx::Yrcx { unit, verb }) => after(Family::Yrcx, unit.words(), verb.is_some()),
            Top::Toyo(OfToyo::Toyo { verb: Some(Verb::Command(verb)) }) => Self::Work(Work::Toyo(verb.command())),
            Top::Toyo(OfToyo::Toyo { verb }) => after(Family::Toyo, Vec::new(), verb.is_some()),
            Top::Common(common) => Self::Work(Work::Common(common)),
            Top::Batch(batch) => Self::Batch(batch),
            Top::Repl(_) => Self::Prompt(Vec::new()),
        }
    }
}

/// A command line, ready to run.
pub struct Ready {
    /// How.
    pub run: Run,
    /// What.
    pub work: Work,
}

impl Ready {
    /// Reads flags, environment and inventory, once. `all` are the flags that were given to all lines, where it is one of
    /// several.
    pub fn new(globals: Globals, all: Option<&Globals>, work: Work, line: Option<Line>) -> Result<Self, Failure> {
        flags::check(&globals, &work)?;
        let globals = match all {
            Some(all) => globals.within(all),
            None => globals,
        };
        let need = work.need();
        let mut run = prepare(globals, need, line)?;
        match &work {
            Work::Yrcx(unit, _) => run.unit = *unit,
            Work::Common(Common::Status(_) | Common::Top(_)) => run.sources.widen(),
            Work::Common(Common::Robots(Robots::Check(Check { name: Some(name) }))) => run.sources.choose(name)?,
            Work::Common(Common::Restore(restore)) => run.sources.selection.simulated = restore.family(),
            Work::Common(Common::Diff(diff)) => run.sources.selection.simulated = diff.family(),
            _ => {}
        }
        Ok(Self { run, work })
    }

    /// Does it.
    pub async fn go(self) -> Result<(), Stopped> {
        self.work.go(&self.run).await
    }

    /// Finds what would be refused without asking anybody: robots that are not there, a gate that is closed.
    pub fn check_gate(&self) -> Result<(), Failure> {
        match &self.work {
            Work::Yerc(command) => self.run.check_gate(&**command),
            Work::Yrcx(_, command) => self.run.check_gate(&**command),
            Work::Toyo(command) => self.run.check_gate(&**command),
            Work::Common(Common::Status(overview)) => self.run.check_gate::<Fleet>(overview),
            Work::Common(_) => Ok(()),
        }
    }

    /// Why this is nothing for a line of a file: it would never end, or writes something else than results.
    pub fn why_not_in_batch(&self) -> Option<&'static str> {
        match &self.work {
            Work::Common(common) => common.why_not_in_batch(),
            _ => None,
        }
    }
}

impl Work {
    /// Does it.
    pub async fn go(self, run: &Run) -> Result<(), Stopped> {
        match self {
            Self::Yerc(command) => run.robots(&*command).await,
            Self::Yrcx(_, command) => run.robots(&*command).await,
            Self::Toyo(command) => run.robots(&*command).await,
            Self::Common(common) => common.run(run).await,
        }
    }

    fn need(&self) -> Need {
        fn of<F: command::Family>(command: &dyn AnyCommand<F>) -> Need {
            if command.takes_robot() { Need::Inventory } else { Need::Nothing }
        }
        match self {
            Self::Yerc(command) => of(&**command),
            Self::Yrcx(_, command) => of(&**command),
            Self::Toyo(command) => of(&**command),
            Self::Common(Common::Robots(Robots::Discover(_))) => Need::Nothing,
            Self::Common(Common::Robots(robots)) if robots.makes_inventory() => Need::InventoryOrNone,
            Self::Common(Common::Session(session)) if !session.opens() => Need::Names,
            Self::Common(common) if !common.is_about_robots() => Need::Nothing,
            Self::Common(_) => Need::Inventory,
        }
    }
}

/// What a command wants of inventory and environment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Need {
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
fn prepare(globals: Globals, need: Need, line: Option<Line>) -> Result<Run, Failure> {
    let screen = screen(&globals);
    let filter = globals.jq.as_deref().map(Filter::new).transpose()?;
    let until = globals.until.as_deref().map(Filter::new).transpose()?;
    let gate = Gate { yes: globals.yes, dry_run: globals.dry_run, on_interrupt: globals.on_interrupt };
    let repeat = Repeat { every: globals.watch, count: globals.count, until, within: globals.within };
    let trace = globals.trace.clone();
    let sources = if need == Need::Nothing { Sources::default() } else { sources(globals, need, line.is_some())? };
    Ok(Run { screen, sources, gate, repeat, filter, trace, line, redraw: Redraw::default(), unit: 0 })
}

/// Which robots, and their settings; `among` other lines of this process, simulators live on.
pub fn sources(globals: Globals, need: Need, among: bool) -> Result<Sources, Failure> {
    let selection = Selection {
        sim: globals.sim,
        target: globals.target,
        robots: globals.robot,
        tags: globals.tag,
        all: globals.all,
        environment: variable("ARMCTL_TARGET", |url| url.parse::<Target>().map_err(|failure| failure.message))?,
        sessions: match (globals.no_session, among) {
            (true, _) => Sessions::None,
            (false, true) => Sessions::OwnSimulators,
            (false, false) => Sessions::Shared,
        },
        simulated: None,
    };
    // Also for a robot that is told by its address: the file says whether that may be changed.
    let mut location = Location::find(match globals.config {
        Some(path) => Some(path),
        None => variable("ARMCTL_CONFIG", |path| Ok(path.into()))?,
    });
    if let (Location::Named(path), Need::InventoryOrNone) = (&location, need) {
        location = Location::Usual(path.clone());
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
