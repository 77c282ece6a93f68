//! `armctl io get|list|watch` for robots of any family.

use clap::Subcommand;

use super::line::SharedLine;
use armctl_frame::prelude::*;
use armctl_frame::robot::io::{Filter, IoValue, Signals};
use armctl_frame::watch::Changes;
use armctl_frame::{AnyCommand, SchemaEntry};

/// Signals of all robots.
#[derive(Debug, Subcommand)]
pub enum Io {
    /// Read signals by name or address
    Get(Get),
    /// List the signals that are on or have a name
    List(List),
    /// Print each change of signals
    Watch(Watch),
}

/// Signals to read, by the names that each robot has for them.
#[derive(Debug, Args)]
pub struct Get {
    /// Names of signals, or addresses in the form that `armctl FAMILY io get` accepts
    #[arg(required = true, value_name = "SIGNAL", value_delimiter = ',')]
    signals: Vec<String>,
}

/// All signals of robots.
#[derive(Debug, Args)]
pub struct List {
    #[command(flatten)]
    filter: Filter,
}

/// Prints the values of signals, and then each change, until Ctrl-C. With --for, it ends after this time. With --count,
/// it ends after this number of reports.
#[derive(Debug, Args)]
pub struct Watch {
    /// Names of signals, or addresses in the form that `armctl FAMILY io watch` accepts
    #[arg(required = true, value_name = "SIGNAL", value_delimiter = ',')]
    signals: Vec<String>,
    /// Time after which the watch ends
    #[arg(long = "for", value_name = "TIME", value_parser = duration::parse_some)]
    within: Option<Duration>,
}

impl Io {
    /// Command for robots of any family.
    pub fn command(&self) -> Result<Box<dyn AnyCommand>> {
        let (id, verb, words) = match self {
            Self::Get(Get { signals }) => ("io.get", "get", signals.clone()),
            Self::Watch(Watch { signals, .. }) => ("io.watch", "watch", signals.clone()),
            Self::List(List { filter }) => ("io.list", "list", filter.words()),
        };
        let line = ["io", verb].map(ToOwned::to_owned).into_iter().chain(words);
        Ok(Box::new(SharedLine::new(id, line.collect())?))
    }
}

/// Schemas of the reports.
pub fn schemas() -> [SchemaEntry; 3] {
    [
        SchemaEntry::of::<Signals>("io.get"),
        SchemaEntry::of::<Signals>("io.list"),
        SchemaEntry::of::<Changes<IoValue>>("io.watch"),
    ]
}
