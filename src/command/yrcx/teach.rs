//! `yrcx teach` (4.2.9): where the robot is, as a point.

use clap::Args;

use super::link;
use super::overwrite::Stored;
use super::position::Unit;
use super::single::Single;
use crate::controller::yrcx::order::Draft;
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::Key;
use crate::failure::Failure;

/// Stores where the robot is in a point, in place of what the point was.
#[derive(Debug, Args)]
pub struct Teach {
    /// Point to store it in, 0 to 29999
    #[arg(long, value_name = "POINT")]
    point: String,
    /// Unit of the point
    #[arg(long = "in", value_name = "UNIT")]
    unit_of_point: Unit,
}

impl Single for Teach {
    type Report = Stored;
    const ID: &'static str = "yrcx.teach";

    fn command(&self) -> Command {
        Command::Teach
    }

    fn fill(&self, draft: Draft) -> Draft {
        draft.with(Key::Point, self.point.as_str()).with(Key::Unit, i32::from(self.unit_of_point == Unit::Mm))
    }

    fn report(&self, done: &link::Done) -> Result<Stored, Failure> {
        Ok(Stored::new(
            format!("stored where the robot is in point {}, in {}", self.point, self.unit_of_point.symbol()),
            done,
        ))
    }
}

#[cfg(test)]
mod tests {
    use crate::command::yrcx::testing::{objection, words, written};

    #[test]
    fn the_unit_is_always_told() {
        let sent = written(&["teach", "--point", "29999", "--in", "mm", "--unit", "2"]).unwrap();
        assert_eq!(sent[0][..4], ["0x2028", "0x0000", "0x752F", "0x0001"]);
        assert!(words(&["teach", "--point", "30000", "--in", "mm"]).unwrap_err().message.contains("0 to 29999"));
        assert!(objection(&["teach", "--point", "1"]).contains("--in"));
    }
}
