//! `armctl sim FAMILY`: a simulator as a network or serial server.

use clap::{Args, Subcommand};

use crate::command::run::{Run, Stopped};
use crate::command::{SchemaEntry, serve, toyo, yerc, yrcx};

/// Which simulator to serve.
#[derive(Debug, Args)]
pub struct Sim {
    #[command(subcommand)]
    family: Option<SimFamily>,
}

/// Families with a simulator.
#[derive(Debug, Subcommand)]
enum SimFamily {
    Yerc(yerc::serve::Serve),
    Yrcx(yrcx::serve::ServeArgs),
    Toyo(toyo::serve::Serve),
}

impl Sim {
    pub(super) async fn run(self, run: &Run) -> Result<(), Stopped> {
        match self.family {
            Some(SimFamily::Yerc(arguments)) => serve::run(arguments, run).await,
            Some(SimFamily::Yrcx(arguments)) => serve::run(arguments, run).await,
            Some(SimFamily::Toyo(arguments)) => serve::run(arguments, run).await,
            None => serve::run(yerc::serve::Serve::default(), run).await,
        }
    }

    /// The schemas of all reports.
    pub fn schemas() -> [SchemaEntry; 3] {
        [
            serve::schema::<toyo::serve::Serve>(),
            serve::schema::<yerc::serve::Serve>(),
            serve::schema::<yrcx::serve::ServeArgs>(),
        ]
    }
}
