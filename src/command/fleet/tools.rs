//! `armctl decode FAMILY`, `explain FAMILY` and `sim FAMILY`.

use std::marker::PhantomData;

use clap::{ArgMatches, Command, FromArgMatches, Subcommand};

use crate::command::families::{self, FAMILIES};
use crate::command::fleet::cell::CellArguments;
use armctl_frame::SchemaEntry;
use armctl_frame::face::tool::{Tool, ToolKind, ToolTask};
use armctl_frame::prelude::*;

/// Arguments of `armctl decode FAMILY`.
pub type Decode = FamilyTool<Decoding>;
/// Arguments of `armctl explain FAMILY`.
pub type Explain = FamilyTool<Explaining>;

/// Which simulator to serve.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
pub struct Sim {
    #[command(flatten)]
    cell: CellArguments,
    #[command(subcommand)]
    family: Option<FamilyTool<Simulating>>,
}

impl Sim {
    /// Runs the command. Without arguments, lists the simulators.
    pub async fn run(self, run: &Run) -> Result<(), RunError> {
        match self.family {
            Some(simulator) => simulator.run(run).await,
            None if self.cell.is_named() => self.cell.run(run).await,
            None => run.local("sim", &Simulators::all()),
        }
    }

    /// Whether the command only lists the simulators.
    pub fn is_list(&self) -> bool {
        self.family.is_none() && !self.cell.is_named()
    }
}

/// The available simulators.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Simulators {
    simulators: Vec<Simulator>,
}

/// A simulator.
#[derive(Debug, Serialize, JsonSchema)]
struct Simulator {
    family: &'static str,
    /// Controllers that the simulator simulates.
    controller: &'static str,
    /// Command that starts the simulator.
    start: String,
    /// Target URL of the simulator.
    target: &'static str,
}

impl Simulators {
    fn all() -> Self {
        let simulators = FAMILIES.map(|face| {
            let family = face.family.name();
            let start = format!("armctl sim {family}");
            Simulator { family, controller: face.title, start, target: face.simulator }
        });
        Self { simulators: simulators.into() }
    }
}

impl Report for Simulators {
    fn view(&self) -> View {
        let mut table = Table::new(&["simulator of", "start command", "target"], "");
        for Simulator { controller, start, target, .. } in &self.simulators {
            table.row([(*controller).into(), start.as_str().into(), Cell::from(*target).whole()]);
        }
        View::table(table)
    }
}

/// Schemas of the reports.
pub fn schemas() -> Vec<SchemaEntry> {
    let tools = ToolKind::ALL.into_iter().flat_map(|kind| FAMILIES.map(|face| (face.tool)(kind)));
    tools.flat_map(|tool| (tool.schemas)()).collect()
}

/// A command word followed by a family.
pub trait Word {
    /// Tool of the families.
    const KIND: ToolKind;
}

/// `decode`.
#[derive(Debug)]
pub enum Decoding {}
/// `explain`.
#[derive(Debug)]
pub enum Explaining {}
/// `sim`.
#[derive(Debug)]
pub enum Simulating {}

impl Word for Decoding {
    const KIND: ToolKind = ToolKind::Decode;
}

impl Word for Explaining {
    const KIND: ToolKind = ToolKind::Explain;
}

impl Word for Simulating {
    const KIND: ToolKind = ToolKind::Simulate;
}

/// Family and arguments that follow the command word.
pub struct FamilyTool<W> {
    family: Family,
    task: ToolTask,
    word: PhantomData<W>,
}

impl<W: Word> FamilyTool<W> {
    fn tool(family: Family) -> Tool {
        (families::of(family).tool)(W::KIND)
    }

    /// Runs the command.
    pub async fn run(self, run: &Run) -> Result<(), RunError> {
        (self.task)(run).await
    }
}

impl<W> fmt::Debug for FamilyTool<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.family.name())
    }
}

impl<W: Word> Subcommand for FamilyTool<W> {
    fn augment_subcommands(command: Command) -> Command {
        let words = FAMILIES.map(|face| ((face.tool)(W::KIND).augment)(Command::new(face.family.name())));
        command.subcommands(words)
    }

    fn augment_subcommands_for_update(command: Command) -> Command {
        Self::augment_subcommands(command)
    }

    fn has_subcommand(name: &str) -> bool {
        name.parse::<Family>().is_ok()
    }
}

impl<W: Word> FromArgMatches for FamilyTool<W> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Self::from_arg_matches_mut(&mut matches.clone())
    }

    fn from_arg_matches_mut(matches: &mut ArgMatches) -> Result<Self, clap::Error> {
        let (family, mut matches) = families::by_name(matches)?;
        Ok(Self { family, task: (Self::tool(family).read)(&mut matches)?, word: PhantomData })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
