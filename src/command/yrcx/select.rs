//! `yrcx shift select` (4.2.17), `yrcx hand select` (4.2.18) and `yrcx arm select` (4.2.19).

use clap::Args;

use super::arguments::Hand as HandSystem;
use super::link;
use super::single::Single;
use crate::command::commands;
use crate::command::frame::orders::Done;
use crate::controller::yrcx::order::Draft;
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::Key;
use crate::failure::Failure;

commands! {
    /// What can be done about the shift.
    pub enum Shift {
        /// Select a coordinate shift
        Select(ShiftSelect),
    }
}

commands! {
    /// What can be done about the hand.
    pub enum Hand {
        /// Select the hand
        Select(HandSelect),
    }
}

commands! {
    /// What can be done about the arm.
    pub enum Arm {
        /// Select the hand system for coordinates
        Select(ArmSelect),
    }
}

/// Selects a shift.
#[derive(Debug, Args)]
pub struct ShiftSelect {
    /// Shift, 0 to 39
    shift: String,
}

impl Single for ShiftSelect {
    type Report = Done;
    const ID: &'static str = "yrcx.shift.select";

    fn command(&self) -> Command {
        Command::ShiftSelect
    }

    fn fill(&self, draft: Draft) -> Draft {
        draft.with(Key::Shift, self.shift.as_str())
    }

    fn report(&self, _done: &link::Done) -> Result<Done, Failure> {
        Ok(Done::new(format!("selected shift {}", self.shift)))
    }
}

/// Selects a hand.
#[derive(Debug, Args)]
pub struct HandSelect {
    /// Hand, 0 to 31
    hand: String,
}

impl Single for HandSelect {
    type Report = Done;
    const ID: &'static str = "yrcx.hand.select";

    fn command(&self) -> Command {
        Command::HandSelect
    }

    fn fill(&self, draft: Draft) -> Draft {
        draft.with(Key::Hand, self.hand.as_str())
    }

    fn report(&self, _done: &link::Done) -> Result<Done, Failure> {
        Ok(Done::new(format!("selected hand {}", self.hand)))
    }
}

/// Selects a hand system.
#[derive(Debug, Args)]
#[command(after_help = "`yrcx info arm` reads it.")]
pub struct ArmSelect {
    /// Which one
    side: HandSystem,
}

impl Single for ArmSelect {
    type Report = Done;
    const ID: &'static str = "yrcx.arm.select";

    fn command(&self) -> Command {
        Command::ArmSelect
    }

    fn fill(&self, draft: Draft) -> Draft {
        draft.with(Key::Arm, i32::from(self.side == HandSystem::Left))
    }

    fn report(&self, _done: &link::Done) -> Result<Done, Failure> {
        let side = if self.side == HandSystem::Left { "left" } else { "right" };
        Ok(Done::new(format!("selected the {side}-handed system")))
    }
}

#[cfg(test)]
mod tests {
    use crate::command::yrcx::testing::{objection, words};

    #[test]
    fn numbers_have_their_ranges_and_arms_two_sides() {
        assert_eq!(words(&["shift", "select", "39", "--unit", "2"]).unwrap()[0][..3], ["0x203B", "0x0000", "0x0027"]);
        assert_eq!(words(&["hand", "select", "31"]).unwrap()[0][..3], ["0x003C", "0x0000", "0x001F"]);
        assert_eq!(words(&["arm", "select", "left", "--unit", "4"]).unwrap()[0][..3], ["0x403D", "0x0000", "0x0001"]);
        assert!(words(&["shift", "select", "40"]).unwrap_err().message.contains("allowed: 0 to 39"));
        assert!(words(&["hand", "select", "32"]).unwrap_err().message.contains("allowed: 0 to 31"));
        assert!(objection(&["arm", "select", "both"]).contains("right, left"));
    }
}
