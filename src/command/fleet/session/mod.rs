//! `armctl session`: a link that outlives commands.

mod close;
pub mod host;
mod list;
mod open;
mod watched_entry;

use clap::Subcommand;

pub use close::Closed;
pub use list::Sessions;

use armctl_frame::run::{Run, RunError};

/// Commands for sessions.
#[derive(Debug, Subcommand)]
pub enum Session {
    /// Open a connection and keep it for later commands
    Open(open::Open),
    /// List open sessions and their clients
    List(list::List),
    /// Close a session
    Close(close::Close),
}

impl Session {
    /// Whether the command opens a link, and therefore needs all settings of a robot.
    pub fn opens(&self) -> bool {
        matches!(self, Self::Open(_))
    }

    /// Whether the command runs until the session is closed.
    pub fn stays(&self) -> bool {
        matches!(self, Self::Open(open) if open.stays())
    }

    /// Runs the command.
    pub async fn run(self, run: &Run) -> Result<(), RunError> {
        match self {
            Self::Open(open) => open.run(run).await,
            Self::List(list) => list.run(run).await,
            Self::Close(close) => close.run(run).await,
        }
    }
}
