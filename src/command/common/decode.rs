//! `armctl decode FAMILY …`: protocol bytes or a capture file in words.

use clap::Subcommand;

use crate::command::run::{Run, Stopped};
use crate::command::{SchemaEntry, decode, toyo, yerc, yrcx};

/// Families whose traffic is known.
#[derive(Debug, Subcommand)]
pub enum Decode {
    Yerc(yerc::decode::Decode),
    Yrcx(yrcx::decode::Decode),
    Toyo(toyo::decode::Decode),
}

impl Decode {
    pub(super) fn run(self, run: &Run) -> Result<(), Stopped> {
        match self {
            Self::Yerc(arguments) => decode::run(&arguments, run),
            Self::Yrcx(arguments) => decode::run(&arguments, run),
            Self::Toyo(arguments) => decode::run(&arguments, run),
        }
    }

    /// The schemas of all reports.
    pub fn schemas() -> impl Iterator<Item = SchemaEntry> {
        let toyo = decode::schemas::<toyo::decode::Decode>();
        let yerc = decode::schemas::<yerc::decode::Decode>();
        toyo.into_iter().chain(yerc).chain(decode::schemas::<yrcx::decode::Decode>())
    }
}
