//! `yrcx pallet` (4.2.5): move to a pallet position.

use clap::Args;

use super::{Motion, MotionReport};
use crate::arguments::{Arch, Pace, Ramps};
use armctl_controller::yrcx::order::Draft;
use armctl_controller::yrcx::table::Command;
use armctl_controller::yrcx::value::Key;
use armctl_frame::failure::Failure;

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
    pace: Pace,
    #[command(flatten)]
    ramps: Ramps,
}

impl Motion for Pallet {
    type Report = MotionReport;
    const ID: &'static str = "yrcx.pallet";

    fn command(&self) -> Command {
        if self.arch.is_wanted() { Command::PalletArch } else { Command::PalletPtp }
    }

    fn fill(&self, draft: Draft) -> Result<Draft, Failure> {
        let draft = draft.with(Key::Pallet, self.pallet.as_str()).with(Key::WorkPosition, self.position.as_str());
        self.pace.put(self.arch.put(self.ramps.put(draft, self.command())?))
    }

    fn target(&self) -> String {
        format!("to position {} of pallet {}{}", self.position, self.pallet, self.arch.describe())
    }

    fn manner(&self) -> String {
        format!("all axes, {}", self.pace.describe())
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{intent, rejects, words};

    #[test]
    fn places_and_pallets_have_their_ranges() {
        let sent =
            words(&["pallet", "--pallet", "39", "--position", "32767", "--accel", "1", "--decel", "100"]).unwrap();
        assert_eq!(sent[0][..6], ["0x0018", "0x0060", "0x0000", "0x0000", "0x0027", "0x7FFF"]);
        assert_eq!(sent[0][10..12], ["0x0001", "0x0064"]);
        rejects([
            ("pallet --pallet 40 --position 1", "pallet: 40 is out of range; allowed: 0 to 39"),
            ("pallet --pallet 0 --position 0", "work_position: 0 is out of range; allowed: 1 to 32767"),
            ("pallet --pallet 0 --position 1 --arch 3:1 --accel 50", "pallet-arch has neither"),
        ]);
        assert_eq!(
            intent(&["pallet", "--pallet", "1", "--position", "21", "--arch", "3:-5", "--speed", "70"]),
            "move robot 1 to position 21 of pallet 1 in an arch over axis 3 at -5 mm (all axes, at 70 %)"
        );
    }
}
