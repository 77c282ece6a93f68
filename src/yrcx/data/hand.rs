//! `yrcx hand-data` (4.3.5).

use schemars::JsonSchema;
use serde::Serialize;

use crate::stores::{Kind, Numbered, int, mm};
use armctl_controller::yrcx::table::Command;
use armctl_controller::yrcx::value::{Key, Values};
use armctl_frame::store::{Ids, TableWords, ids, table_commands};

table_commands! {
    /// Commands for hands.
    HandData of Numbered<Hands> {}
}

/// Note for the help about data 1, the only value whose unit is not clear.
const DATA_1: &str = "Data 1 is the raw value of the protocol, because the manual is ambiguous about the unit. The \
                      example of the manual for a Cartesian robot uses 10000 for 10.000 mm. The text of the manual \
                      uses a whole number.";

/// The hands of the controller.
#[derive(Debug)]
pub struct Hands;

impl Kind for Hands {
    type Value = Data;
    const WORDS: TableWords = TableWords {
        nouns: ["hand", "hands"],
        placeholder: "HAND",
        range: "Hands, 0 to 31: 1, 0..31 or 1,5",
        reading: Some(DATA_1),
        writing: Some(DATA_1),
    };
    const IDS: Ids = ids!("yrcx.hand-data");
    const READ: (Command, Key) = (Command::HandGet, Key::Hand);
    const WRITE: Command = Command::HandSet;
    const NUMBERS: &'static [&'static str] = &["0..31"];
    const FIELDS: &'static [(&'static str, Key, &'static str)] = &[
        ("robot", Key::Owner, "robot"),
        ("data_1", Key::Data1, "data 1"),
        ("data_2_mm", Key::Data2, "data 2 (mm)"),
        ("data_3_mm", Key::Data3, "data 3 (mm)"),
        ("data_4", Key::Data4, "data 4"),
    ];

    fn value(values: &Values) -> Option<Data> {
        Some(Data {
            robot: int(values, Key::Owner),
            data_1: int(values, Key::Data1),
            data_2_mm: mm(values, Key::Data2),
            data_3_mm: mm(values, Key::Data3),
            data_4: int(values, Key::Data4),
        })
    }

    fn is_blank(values: &Values) -> bool {
        int(values, Key::Owner) == 0
    }
}

/// Data of a hand.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Data {
    /// Robot that the hand belongs to.
    robot: i32,
    /// Data 1 as the raw value of the protocol, because the manual does not clearly define its unit.
    data_1: i32,
    data_2_mm: f64,
    data_3_mm: f64,
    /// Data 4: 1 for a hand on the R axis, otherwise 0.
    data_4: i32,
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::testing::{example, read_example, words, written};
    use armctl_frame::failure::Kind;

    const SET: [&str; 8] = ["hand-data", "set", "1", "0", "10000", "-2", "5", "0"];

    #[test]
    fn the_examples_of_the_manual() {
        assert_eq!(written(&SET).unwrap(), [example("4.3.5-define")]);
        assert_eq!(read_example("4.3.5-define", &SET)["items"][0]["new"]["data_2_mm"], -2.0);
        let read = read_example("4.3.5-reference", &["hand-data", "get", "1"]);
        let hand = json!({"robot": 1, "data_1": 10000, "data_2_mm": -2.0, "data_3_mm": 5.0, "data_4": 0});
        assert_eq!(read["items"][0]["value"], hand);
    }

    #[test]
    fn a_hand_belongs_to_a_robot_and_is_read_without() {
        let sent = written(&["hand-data", "set", "1", "3", "10000", "-2", "5", "1"]).unwrap();
        assert_eq!((sent[0][0].as_str(), sent[0][10].as_str()), ("0x3110", "0x0001"));
        assert_eq!(words(&["hand-data", "get", "1", "--unit", "3"]).unwrap_err().kind, Kind::Usage);
        let first = |data| words(&["hand-data", "set", "1", "1", data, "0", "0", "0"]);
        assert!(first("10.5").unwrap_err().message.contains("data_1"));
        assert!(first("10.000").is_err(), "ambiguous: 10 or 10000");
    }
}
