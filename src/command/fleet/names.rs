//! `armctl names`: names of signals, variables and registers, from robots.toml and from the controller.

use clap::Subcommand;

use super::robots::entry::{self, check_known};
use armctl_frame::SchemaEntry;
use armctl_frame::names::{Listing, list};
use armctl_frame::prelude::*;

/// What can be done with the names of a robot.
#[derive(Debug, Subcommand)]
pub enum Names {
    /// List the names of a robot's signals, variables and registers
    List(List),
    /// Name a signal, variable or register in robots.toml
    Set(Set),
}

/// Lists the names of a robot.
#[derive(Debug, Args)]
#[command(
    after_help = "Names are in robots.toml, below [robot.names] of the robot's entry. `armctl yerc names get` reads \
                  the names that a yerc controller stores."
)]
pub struct List {
    /// Show only names with this text in the name, kind, address or origin
    filter: Option<String>,
}

/// Writes a name into the entry of the robot in robots.toml.
#[derive(Debug, Args)]
#[command(after_help = "Later commands accept the name instead of the address: `armctl yerc io get clamp`.")]
pub struct Set {
    /// The name, such as clamp
    #[arg(value_name = "NAME")]
    name: String,
    /// The address, for example 27010 or B5 (yerc), SO(20) or DO12 (yrcx), IN2.1 or CN05 (toyo)
    #[arg(value_name = "ADDRESS")]
    address: String,
}

impl Names {
    /// Runs the command.
    pub fn run(self, run: &Run) -> Result<(), RunError> {
        let robot = one(run)?;
        match self {
            Self::List(List { filter }) => run.local("names.list", &list(&robot, filter.as_deref())?),
            Self::Set(Set { name, address }) => {
                check_known(&run.sources.inventory, &robot.name)?;
                if name.is_empty() || name.contains('=') {
                    let failure = Failure::usage(format!("'{name}' is not a valid name"));
                    return Err(failure.hint("use letters, digits and _, such as clamp").into());
                }
                entry::set(run, "names.set", robot.name, &[format!("names.{name}={address}")])
            }
        }
    }
}

/// The one selected robot.
fn one(run: &Run) -> Result<Robot> {
    let mut robots = run.sources.robots(None)?;
    match (robots.pop(), robots.len()) {
        (Some(robot), 0) => Ok(robot),
        (_, others) => {
            let message = format!("each robot has its own names, but {} robots are selected", others + 1);
            Err(Failure::usage(message).hint("select one robot with -r"))
        }
    }
}

/// Schemas of the reports.
pub fn schemas() -> [SchemaEntry; 2] {
    [SchemaEntry::of::<Listing>("names.list"), SchemaEntry::of::<entry::WasSet>("names.set")]
}
