//! `yrcx shift-data` (4.3.4).

use schemars::JsonSchema;
use serde::Serialize;

use super::{Four, four};
use crate::command::commands;
use crate::command::frame::store::{Copy, Dump, Get, Ids, List, Restore, TableWords, ids};
use crate::command::yrcx::backup::{Records, SHIFTS};
use crate::command::yrcx::numbers::single;
use crate::command::yrcx::overwrite::Stored;
use crate::command::yrcx::single::one_row;
use crate::command::yrcx::stores::{Kind, Numbered, all_zero, mm as mm_of};
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::{Key, Values};

commands! {
    /// Commands for shifts.
    pub enum ShiftData {
        /// Read shifts: 5, 0..39
        Get(Get<Numbered<Shifts>>),
        /// List the defined shifts
        List(List<Numbered<Shifts>>),
        /// Define a shift: 5 --mm 10,-20,5,-18
        Set(Set),
        /// Copy a shift to other shifts
        Copy(Copy<Numbered<Shifts>>),
        /// Save to a CSV file
        Dump(Dump<Numbered<Shifts>>),
        /// Write from a CSV file
        Restore(Restore<Numbered<Shifts>>),
    }
}

/// The shifts of the controller.
#[derive(Debug)]
pub struct Shifts;

impl Kind for Shifts {
    type Value = Shift;
    const WORDS: TableWords = TableWords {
        nouns: ["shift", "shifts"],
        placeholder: "SHIFT",
        range: "Shifts, 0 to 39: 5, 0..39 or 1,5",
        reading: None,
        writing: None,
    };
    const IDS: Ids = ids!("yrcx.shift-data");
    const RECORDS: &'static Records = &SHIFTS;
    const HEADINGS: &'static [&'static str] = &["axis 1 (mm)", "axis 2 (mm)", "axis 3 (mm)", "axis 4 (mm)"];

    fn value(values: &Values) -> Option<Shift> {
        Some(Shift { shift_mm: Key::AXES.map(|key| mm_of(values, key)) })
    }

    fn is_blank(values: &Values) -> bool {
        all_zero(values, &Key::AXES)
    }
}

/// A shift.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Shift {
    /// Shift of axes 1 to 4 in mm, or degrees for rotary axes.
    shift_mm: [f64; 4],
}

one_row! {
    /// Defines a shift.
    Set(self) "yrcx.shift-data.set" -> Stored {
        /// Shift, 0 to 39
        #[arg(value_name = "SHIFT", value_parser = |text: &str| single(table::Command::ShiftSet, Key::Shift, text))]
        shift: i32,
        /// Shift of axes 1 to 4 in mm, or degrees for rotary axes
        #[arg(long, value_name = "MM,…", required = true, allow_hyphen_values = true, value_parser = four)]
        mm: Four,
    }
    gives table::Command::ShiftSet,
    with draft => self.mm.put(draft.with(Key::Shift, self.shift)),
    done format!("defined shift {}: {} mm", self.shift, self.mm.describe());
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{example, objection, read_example, written};

    #[test]
    fn the_examples_of_the_manual() {
        let set = ["shift-data", "set", "5", "--mm", "10,-20,5,-18"];
        assert_eq!(written(&set).unwrap(), [example("4.3.4-define")]);
        assert_eq!(
            read_example("4.3.4-define", &set)["items"][0]["new"],
            json!({"shift_mm": [10.0, -20.0, 5.0, -18.0]})
        );
        let read = read_example("4.3.4-reference", &["shift-data", "get", "5"]);
        assert_eq!(read["items"][0]["value"], json!({"shift_mm": [10.0, -20.0, 5.0, -18.0]}));
    }

    #[test]
    fn mistakes_are_named() {
        assert!(objection(&["shift-data", "set", "40", "--mm", "1,2,3,4"]).contains("allowed: 0 to 39"));
        assert!(objection(&["shift-data", "set", "4"]).contains("--mm"));
    }
}
