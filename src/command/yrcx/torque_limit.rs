//! `yrcx torque-limit` (4.2.22).

use clap::Args;

use super::link;
use super::single::Single;
use crate::command::frame::orders::Done;
use crate::controller::yrcx::order::Draft;
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::Key;
use crate::failure::Failure;

/// Limits the torque of an axis from the next motion on; the parameter stays as it is.
#[derive(Debug, Args)]
pub struct TorqueLimit {
    /// The axis, 1 to 4
    #[arg(long, value_name = "AXIS")]
    axis: String,
    /// Percent of the maximum, 1 to 100
    percent: String,
}

impl Single for TorqueLimit {
    type Report = Done;
    const ID: &'static str = "yrcx.torque-limit";

    fn command(&self) -> Command {
        Command::TorqueLimit
    }

    fn fill(&self, draft: Draft) -> Draft {
        draft.with(Key::Axes, self.axis.as_str()).with(Key::Torque, self.percent.trim_end_matches('%'))
    }

    fn report(&self, _done: &link::Done) -> Result<Done, Failure> {
        let percent = self.percent.trim_end_matches('%');
        Ok(Done::new(format!("limited the torque of axis {} to {percent} % from the next motion on", self.axis)))
    }
}

#[cfg(test)]
mod tests {
    use crate::command::yrcx::testing::words;

    #[test]
    fn one_axis_and_a_share() {
        let sent = words(&["torque-limit", "--axis", "4", "100%", "--unit", "2"]).unwrap();
        assert_eq!(sent[0][..4], ["0x2048", "0x0000", "0x0008", "0x0064"]);
        assert!(words(&["torque-limit", "--axis", "1,2", "50"]).unwrap_err().message.contains("name exactly 1"));
        assert!(words(&["torque-limit", "--axis", "1", "0"]).unwrap_err().message.contains("allowed: 1 to 100 %"));
    }
}
