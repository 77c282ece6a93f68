//! `yrcx shift-data` (4.3.4).

use schemars::JsonSchema;
use serde::Serialize;

use super::{Four, four, mm};
use crate::command::commands;
use crate::command::yrcx::numbers::single;
use crate::command::yrcx::overwrite::Stored;
use crate::command::yrcx::position::mm as mm_of;
use crate::command::yrcx::several::by_number;
use crate::command::yrcx::single::one_row;
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::Key;

commands! {
    /// What can be done with shifts.
    pub enum ShiftData {
        /// Read shifts: 5, 0..39
        Get(Get),
        /// Define a shift: 5 --mm 10,-20,5,-18
        Set(Set),
    }
}

by_number! {
    /// Reads shifts, one after the other.
    Get "yrcx.shift-data.get" {
        /// Shifts, 0 to 39: 5, 0..39 or 1,5
        shifts "SHIFT"
    }
    gives ShiftGet Shift ["shift", "shifts"],
    /// Shifts.
    Shifts,
    /// Which shift.
    shift of ShiftReport: |values| ShiftReport { shift_mm: mm_of(values).unwrap_or_default() },
    columns ["axis 1 (mm)", "axis 2 (mm)", "axis 3 (mm)", "axis 4 (mm)"],
    cells |way| way.shift_mm.map(mm);
}

/// A shift.
#[derive(Debug, Serialize, JsonSchema)]
struct ShiftReport {
    /// Of axes 1 to 4; degrees of what turns.
    shift_mm: [f64; 4],
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
        assert_eq!(read_example("4.3.4-define", &set)["new"], json!({"position_mm": [10.0, -20.0, 5.0, -18.0]}));
        let read = read_example("4.3.4-reference", &["shift-data", "get", "5"]);
        assert_eq!(read["shifts"], json!([{"shift": 5, "ok": true, "shift_mm": [10.0, -20.0, 5.0, -18.0]}]));
    }

    #[test]
    fn mistakes_are_named() {
        assert!(objection(&["shift-data", "set", "40", "--mm", "1,2,3,4"]).contains("allowed: 0 to 39"));
        assert!(objection(&["shift-data", "set", "4"]).contains("--mm"));
    }
}
