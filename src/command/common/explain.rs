//! `armctl explain FAMILY CODE`.

use clap::Subcommand;

use crate::command::run::{Run, Stopped};
use crate::command::{Desk, SchemaEntry, toyo, yerc, yrcx};

/// Families whose codes are known.
#[derive(Debug, Subcommand)]
pub enum Explain {
    Yerc(yerc::explain::Explain),
    Yrcx(yrcx::explain::Explain),
    Toyo(toyo::explain::Explain),
}

impl Explain {
    pub(super) fn run(self, run: &Run) -> Result<(), Stopped> {
        match self {
            Self::Yerc(arguments) => explain(&arguments, run),
            Self::Yrcx(arguments) => explain(&arguments, run),
            Self::Toyo(arguments) => explain(&arguments, run),
        }
    }

    /// The schemas of all reports.
    pub fn schemas() -> [SchemaEntry; 3] {
        [schema::<toyo::explain::Explain>(), schema::<yerc::explain::Explain>(), schema::<yrcx::explain::Explain>()]
    }
}

fn explain<C: Desk>(arguments: &C, run: &Run) -> Result<(), Stopped> {
    run.local(C::ID, &arguments.run(&run.screen)?)
}

fn schema<C: Desk>() -> SchemaEntry {
    SchemaEntry::of::<C::Report>(C::ID)
}
