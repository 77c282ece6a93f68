//! `yrcx pallet` (4.2.5): move to a pallet position.

use super::{Motion, MotionReport};
use crate::arguments::{Arch, Ramps, SpeedArguments};
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;

/// Moves to a pallet position.
#[derive(Debug, Args)]
pub struct Pallet {
    /// Pallet, 0 to 39
    #[arg(long, value_name = "N")]
    pallet: String,
    /// Position on the pallet, starting with 1
    #[arg(long, value_name = "N")]
    position: String,
    #[command(flatten)]
    arch: Arch,
    #[command(flatten)]
    pace: SpeedArguments,
    #[command(flatten)]
    ramps: Ramps,
}

impl Motion for Pallet {
    type Report = MotionReport;
    const ID: &'static str = "yrcx.pallet";

    fn command(&self) -> Command {
        if self.arch.is_wanted() { Command::PalletArch } else { Command::PalletPtp }
    }

    fn fill(&self, draft: Draft) -> Result<Draft> {
        let draft = draft.with(Key::Pallet, self.pallet.as_str()).with(Key::WorkPosition, self.position.as_str());
        self.pace.apply_to(self.arch.apply_to(self.ramps.apply_to(draft, self.command())?))
    }

    fn target(&self) -> String {
        format!("to position {} of pallet {}{}", self.position, self.pallet, self.arch.describe())
    }

    fn axes_and_speed(&self) -> String {
        format!("all axes, {}", self.pace.describe())
    }
}
