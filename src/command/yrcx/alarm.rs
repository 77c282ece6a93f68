//! `yrcx alarm reset` (4.8.3).

use clap::Args;

use super::Family;
use super::link;
use super::single::Single;
use crate::command::commands;
use crate::command::orders::Done;
use crate::controller::yrcx::table::Command;
use crate::failure::Failure;

commands! {
    /// What can be done about alarms.
    pub enum Alarm of Family {
        /// Reset the alarm
        Reset(Reset),
    }
}

/// Resets the alarm.
#[derive(Debug, Args)]
#[command(
    after_help = "`yrcx io pulse alarm-reset` does the same by a signal, also where remote commands are not taken."
)]
pub struct Reset {}

impl Single for Reset {
    type Report = Done;
    const ID: &'static str = "yrcx.alarm.reset";

    fn command(&self) -> Command {
        Command::AlarmReset
    }

    fn report(&self, _done: &link::Done) -> Result<Done, Failure> {
        Ok(Done::new("the alarm was reset"))
    }
}

#[cfg(test)]
mod tests {
    use crate::command::yrcx::testing::{example, words};

    #[test]
    fn the_example_of_the_manual() {
        assert_eq!(words(&["alarm", "reset"]).unwrap(), [example("4.8.3-reset")]);
    }
}
