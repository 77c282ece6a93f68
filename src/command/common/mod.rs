//! Commands that are about no single controller.

pub mod backup;
pub mod batch;
pub mod completions;
mod decode;
mod explain;
pub mod help;
pub mod man;
pub mod repl;
pub mod robots;
pub mod schema;
pub mod session;
mod sim;
mod top;

use clap::Subcommand;

use super::overview::Overview;
use super::run::{Run, Stopped};

/// Commands that every family shares.
#[derive(Debug, Subcommand)]
pub enum Common {
    /// One line a robot: reachable, mode, servo, state, alarm, position
    Status(Overview),
    /// All robots, or one, live on the whole screen
    Top(top::Top),
    /// The inventory: list, show, add, remove; check and discover
    #[command(subcommand)]
    Robots(robots::Robots),
    /// Hold a link for all commands that follow: open, list, close
    #[command(subcommand)]
    Session(session::Session),
    /// Save what controllers store in a folder of files
    Backup(backup::Backup),
    /// Write back what a backup holds
    Restore(backup::Restore),
    /// Compare a backup with another one, or with a controller
    Diff(backup::Diff),
    /// Serve the simulators on real sockets
    Sim(sim::Sim),
    /// Explain bytes of the line
    #[command(subcommand)]
    Decode(decode::Decode),
    /// What an error or alarm code means and what to do
    #[command(subcommand)]
    Explain(explain::Explain),
    /// Print the completion script of a shell
    Completions(completions::Completions),
    /// Write the man pages
    Man(man::Man),
    /// Print the JSON Schema of a report
    Schema(schema::SchemaOf),
    /// Explain a topic, or a command
    Help(help::Help),
}

impl Common {
    /// Whether it asks or lists robots, and so needs the inventory.
    pub fn is_about_robots(&self) -> bool {
        match self {
            Self::Status(_) | Self::Top(_) | Self::Robots(_) | Self::Session(_) | Self::Restore(_) => true,
            Self::Backup(backup) => !backup.is_local(),
            Self::Diff(diff) => !diff.is_local(),
            _ => false,
        }
    }

    /// Why it is nothing for a line of a file: it would never end, or writes something else than results.
    pub fn why_not_in_batch(&self) -> Option<&'static str> {
        match self {
            Self::Session(session) if session.stays() => Some("it holds a link until it is ended; add --background"),
            Self::Sim(_) => Some("it serves until it is ended"),
            Self::Top(_) => Some("it is a view for a terminal"),
            Self::Completions(_) | Self::Man(_) | Self::Schema(_) | Self::Help(_) => Some("it prints a text to read"),
            Self::Status(_)
            | Self::Robots(_)
            | Self::Session(_)
            | Self::Decode(_)
            | Self::Explain(_)
            | Self::Backup(_)
            | Self::Restore(_)
            | Self::Diff(_) => None,
        }
    }

    /// Does it.
    pub async fn run(self, run: &Run) -> Result<(), Stopped> {
        match self {
            Self::Status(overview) => run.robots(&overview).await,
            Self::Backup(backup) => backup.run(run).await,
            Self::Restore(restore) => run.robots(&restore).await,
            Self::Diff(diff) => diff.run(run).await,
            Self::Top(top) => Box::pin(top.run(run)).await,
            Self::Sim(sim) => sim.run(run).await,
            Self::Session(session) => Box::pin(session.run(run)).await,
            Self::Robots(robots) => robots.run(run).await,
            Self::Decode(decode) => decode.run(run),
            Self::Explain(explain) => explain.run(run),
            Self::Completions(completions) => Ok(completions.run(run)?),
            Self::Man(man) => Ok(man.run(run)?),
            Self::Schema(schema) => Ok(schema.run(run)?),
            Self::Help(help) => Ok(help.run(run)?),
        }
    }
}
