//! `yrcx status-reset` (4.1).

use clap::Args;

use super::link;
use super::single::Single;
use crate::command::frame::orders::Done;
use crate::controller::yrcx::table::Command;
use crate::failure::Failure;

/// Resets the status of remote commands to ready.
#[derive(Debug, Args)]
#[command(
    after_help = "Every command resets the status before and after itself, so that this is rarely needed: only when \
    somebody else's command left an end status behind, and the next one is to find the controller ready. It ends \
    neither a motion nor a command that runs, and resets no alarm (`yrcx alarm reset`)."
)]
pub struct StatusReset {}

impl Single for StatusReset {
    type Report = Done;
    const ID: &'static str = "yrcx.status-reset";

    fn command(&self) -> Command {
        Command::StatusReset
    }

    fn report(&self, _done: &link::Done) -> Result<Done, Failure> {
        Ok(Done::new("the controller is ready for a remote command"))
    }
}

#[cfg(test)]
mod tests {
    use crate::command::yrcx::testing::{Scripted, run_on, words};

    #[test]
    fn all_words_are_zero() {
        assert_eq!(words(&["status-reset"]).unwrap(), [vec!["0x0000"; 16]]);
    }

    #[test]
    fn an_end_status_of_somebody_else_goes_away() {
        let mut scripted = Scripted::new([]);
        scripted.image.0[0] = 0x4000;
        let (outcome, peer) = run_on(scripted, &["status-reset"]);
        assert_eq!(outcome.unwrap()["done"], "the controller is ready for a remote command");
        assert_eq!((peer.image.0[0], peer.taken.len()), (0, 0));
    }
}
