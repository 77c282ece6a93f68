//! `yrcx shift-data` (4.3.4).

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Four, four, mm};
use crate::command::yrcx::link::Yrcx;
use crate::command::yrcx::numbers::{Numbers, single};
use crate::command::yrcx::overwrite::Stored;
use crate::command::yrcx::position::{Position, Unit};
use crate::command::yrcx::several::{Rows, read_numbers};
use crate::command::yrcx::single::one_row;
use crate::command::{Command, Context, Report, commands};
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::Key;
use crate::failure::Failure;
use crate::output::view::View;

commands! {
    /// What can be done with shifts.
    pub enum ShiftData {
        /// Read shifts: 5, 0..39
        Get(Get),
        /// Define a shift: 5 --mm 10,-20,5,-18
        Set(Set),
    }
}

/// Reads shifts, one after the other.
#[derive(Debug, Args)]
pub struct Get {
    /// Shifts, 0 to 39: 5, 0..39 or 1,5
    #[arg(required = true, value_name = "SHIFT", value_delimiter = ',',
        value_parser = |text: &str| Numbers::parse(table::Command::ShiftGet, Key::Shift, text))]
    shifts: Vec<Numbers>,
}

impl Command for Get {
    type Family = Yrcx;
    type Report = Shifts;
    const ID: &'static str = "yrcx.shift-data.get";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Shifts, Failure> {
        let nouns = ["shift", "shifts"];
        let field = (table::Command::ShiftGet, Key::Shift);
        let of = |values: &_| Way { shift_mm: Position::of(values, Some(Unit::Mm)).position_mm.unwrap_or_default() };
        let (numbers, shifts) = read_numbers(context, nouns, field, &self.shifts, of).await?;
        Ok(Shifts { shifts: shifts.rows(numbers.into_iter().map(|shift| Which { shift })) })
    }
}

/// Shifts.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Shifts {
    shifts: Rows<Which, Way>,
}

/// Which shift.
#[derive(Debug, Serialize, JsonSchema)]
struct Which {
    shift: i32,
}

/// A shift.
#[derive(Debug, Serialize, JsonSchema)]
struct Way {
    /// Of axes 1 to 4; degrees of what turns.
    shift_mm: [f64; 4],
}

impl Report for Shifts {
    fn view(&self) -> View {
        let columns = ["axis 1 (mm)", "axis 2 (mm)", "axis 3 (mm)", "axis 4 (mm)"];
        let name = |which: &Which| [which.shift.into()];
        View::table(self.shifts.table(["shift"], columns, "no shifts", name, |way| way.shift_mm.map(mm)))
    }

    fn failure(&self) -> Option<Failure> {
        self.shifts.failure()
    }
}

one_row! {
    /// Defines a shift.
    Set(self) "yrcx.shift-data.set" -> Stored {
        /// Shift, 0 to 39
        #[arg(value_name = "SHIFT", value_parser = |text: &str| single(table::Command::ShiftSet, Key::Shift, text))]
        shift: i32,
        /// Shift of axes 1 to 4 in mm, degrees of what turns
        #[arg(long, value_name = "MM,…", required = true, allow_hyphen_values = true, value_parser = four)]
        mm: Four,
    }
    gives table::Command::ShiftSet,
    with draft => self.mm.put(draft.with(Key::Shift, self.shift)),
    done format!("defined shift {}: {} mm", self.shift, self.mm.told());
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{example, objection, read_example, written};

    #[test]
    fn the_examples_of_the_manual() {
        let set = ["shift-data", "set", "5", "--mm", "10,-20,5,-18"];
        assert_eq!(written(&set).unwrap(), [example("4.3.4-define")]);
        assert_eq!(read_example("4.3.4-define", &set)["done"], "defined shift 5: 10, -20, 5, -18 mm");
        let read = read_example("4.3.4-reference", &["shift-data", "get", "5"]);
        assert_eq!(read["shifts"], json!([{"shift": 5, "ok": true, "shift_mm": [10.0, -20.0, 5.0, -18.0]}]));
    }

    #[test]
    fn mistakes_are_named() {
        assert!(objection(&["shift-data", "set", "40", "--mm", "1,2,3,4"]).contains("allowed: 0 to 39"));
        assert!(objection(&["shift-data", "set", "4"]).contains("--mm"));
    }
}
