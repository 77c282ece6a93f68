//! `armctl session`: a link that outlives commands.

mod close;
mod list;
mod open;

use clap::Subcommand;

pub use close::Closed;
pub use list::Sessions;
pub use open::Opened;

use crate::command::run::{Run, Stopped};
use crate::failure::{Failure, Kind};
use crate::transport::session::place::PlaceError;

/// What can be done with sessions.
#[derive(Debug, Subcommand)]
pub enum Session {
    /// Hold the link to a robot, for all commands that follow
    Open(open::Open),
    /// Which links are held, and who uses them
    List(list::List),
    /// Let the link to a robot go
    Close(close::Close),
}

impl Session {
    /// Whether it makes a link, and so must know all about a robot.
    pub fn opens(&self) -> bool {
        matches!(self, Self::Open(_))
    }

    pub(super) async fn run(self, run: &Run) -> Result<(), Stopped> {
        match self {
            Self::Open(open) => open.run(run).await,
            Self::List(list) => list.run(run).await,
            Self::Close(close) => close.run(run).await,
        }
    }
}

/// There is no place for sessions.
fn no_place(error: &PlaceError) -> Failure {
    let failure = Failure::new(Kind::Local, format!("sessions: {error}"));
    match error {
        PlaceError::Unsafe { path, .. } => {
            failure.hint(format!("remove {}, or set XDG_RUNTIME_DIR to a folder of your own", path.display()))
        }
        PlaceError::Io { .. } => failure.hint("XDG_RUNTIME_DIR names the folder that they are kept in"),
    }
}
