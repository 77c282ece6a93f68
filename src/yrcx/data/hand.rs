//! `yrcx hand-data` (4.3.5).

use crate::numbered_tables::{Kind, Numbered, int, mm};
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;

table_commands! {
    /// Commands for hands.
    HandData of Numbered<Hands> {}
}

/// Note for the help about data 1, the only value whose unit is not clear.
const DATA_1: &str = "Data 1 is the raw value of the protocol, because the manual is ambiguous about its unit. In the \
                      example of the manual for a Cartesian robot, 10000 means 10.000 mm. The text of the manual has \
                      no such factor of 1000.";

/// The hands of the controller.
#[derive(Debug)]
pub struct Hands;

impl Kind for Hands {
    type Value = Data;
    const WORDS: TableWords = TableWords {
        nouns: ["hand", "hands"],
        placeholder: "HAND",
        range: "Hands (0 to 31), such as 1, 0..31 or 1,5",
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
