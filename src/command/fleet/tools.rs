//! `armctl decode FAMILY`, `explain FAMILY` and `sim FAMILY`.

use std::fmt;
use std::marker::PhantomData;

use clap::{ArgMatches, Args, Command, FromArgMatches, Subcommand};

use crate::command::SchemaEntry;
use crate::command::face::tool::{Tool, ToolKind, ToolTask};
use crate::command::families::{self, FAMILIES};
use crate::command::frame::run::{Run, RunError};
use crate::failure::Failure;
use crate::settings::target::Family;

/// `armctl decode FAMILY`.
pub type Decode = OfFamily<Decoding>;
/// `armctl explain FAMILY`.
pub type Explain = OfFamily<Explaining>;

/// Which simulator to serve.
#[derive(Debug, Args)]
pub struct Sim {
    #[command(subcommand)]
    family: Option<OfFamily<Simulating>>,
}

impl Sim {
    /// Does it; without a family, that of the first one.
    pub async fn run(self, run: &Run) -> Result<(), RunError> {
        let simulator = match self.family {
            Some(simulator) => simulator,
            None => OfFamily::first()
                .map_err(|error| Failure::usage(error.to_string()).hint("name a family: `armctl sim -h` lists them"))?,
        };
        simulator.run(run).await
    }
}

/// The schemas of all that they report.
pub fn schemas() -> Vec<SchemaEntry> {
    let tools = ToolKind::ALL.into_iter().flat_map(|kind| FAMILIES.map(|face| face.tool(kind)));
    tools.flat_map(|tool| (tool.schemas)()).collect()
}

/// A word behind which families stand.
pub trait Word {
    /// What they do there.
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

/// What was typed behind such a word: a family, and what it takes.
pub struct OfFamily<W> {
    family: Family,
    task: Box<dyn ToolTask>,
    word: PhantomData<W>,
}

impl<W: Word> OfFamily<W> {
    fn tool(family: Family) -> Tool {
        families::of(family).tool(W::KIND)
    }

    /// The first family, without arguments.
    fn first() -> Result<Self, clap::Error> {
        let family = FAMILIES[0].family();
        let tool = Self::tool(family);
        let mut matches = (tool.augment)(Command::new(family.name())).try_get_matches_from([family.name()])?;
        Ok(Self { family, task: (tool.read)(&mut matches)?, word: PhantomData })
    }

    /// Does it.
    pub async fn run(self, run: &Run) -> Result<(), RunError> {
        self.task.run(run).await
    }
}

impl<W> fmt::Debug for OfFamily<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.family.name())
    }
}

impl<W: Word> Subcommand for OfFamily<W> {
    fn augment_subcommands(command: Command) -> Command {
        let words = FAMILIES.map(|face| (face.tool(W::KIND).augment)(Command::new(face.family().name())));
        command.subcommands(words)
    }

    fn augment_subcommands_for_update(command: Command) -> Command {
        Self::augment_subcommands(command)
    }

    fn has_subcommand(name: &str) -> bool {
        name.parse::<Family>().is_ok()
    }
}

impl<W: Word> FromArgMatches for OfFamily<W> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Self::from_arg_matches_mut(&mut matches.clone())
    }

    fn from_arg_matches_mut(matches: &mut ArgMatches) -> Result<Self, clap::Error> {
        let (family, mut matches) = families::named(matches)?;
        Ok(Self { family, task: (Self::tool(family).read)(&mut matches)?, word: PhantomData })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
