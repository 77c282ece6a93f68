//! `toyo mvm`: groups of the MVM table, which is five sheets: corners, pieces, counters, approach, destination.

mod get;
mod set;

use schemars::JsonSchema;
use serde::Serialize;

use super::link;
use super::rows::Listed;
use crate::command::commands;
use crate::command::robot::item::{Columns, Item};
use crate::controller::toyo::field::{Field, Value};
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::Parameter;
use crate::failure::Failure;
use crate::output::view::Cell;

commands! {
    /// What can be done with groups of the MVM table.
    pub enum Mvm {
        /// Read groups: 1-3; without any, all 32
        Get(get::Get),
        /// Change values of a group: 1 origin=5 pieces1=10
        Set(set::Set),
    }
}

/// The sheets.
const SHEETS: [&str; 5] = ["T4.S1", "T4.S2", "T4.S3", "T4.S4", "T4.S5"];

/// Every value of a group: its name as typed, its sheet, and its place in it behind the number of the group.
const VALUES: [(&str, usize, usize); 14] = [
    ("origin", 0, 0),
    ("p1", 0, 1),
    ("p2", 0, 2),
    ("p3", 0, 3),
    ("pieces1", 1, 0),
    ("pieces2", 1, 1),
    ("pieces3", 1, 2),
    ("counter1", 2, 0),
    ("counter2", 2, 1),
    ("counter3", 2, 2),
    ("approach", 3, 0),
    ("approach-z", 3, 1),
    ("approach-r", 3, 2),
    ("destination-r", 4, 0),
];

fn sheet(index: usize) -> &'static Parameter {
    Parameter::named(SHEETS[index]).expect("every sheet is in the table of parameters")
}

/// The number of a group, 1 to 32.
fn field() -> Field {
    sheet(0).key.fields[0].named("group")
}

/// What reads the sheets of a group.
fn reads(group: i32) -> Result<Vec<Request>, Failure> {
    let read = |index| Request::read_parameter(sheet(index), Some(group));
    (0..SHEETS.len()).map(read).collect::<Result<_, _>>().map_err(|error| link::wrong(&error))
}

/// A group of the MVM table.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Group {
    /// Row of the coordinate table of corner P0.
    origin_point: i32,
    /// Row of the coordinate table of corner P1; 0 for none.
    p1_point: i32,
    /// Row of the coordinate table of corner P2; 0 for none.
    p2_point: i32,
    /// Row of the coordinate table of corner P3; 0 for none.
    p3_point: i32,
    /// Pieces towards P1, P2 and P3.
    pieces: [i32; 3],
    /// Counters that count them.
    counters: [i32; 3],
    /// `absolute` or `incremental`.
    approach: String,
    /// `a` or `i`.
    approach_raw: &'static str,
    approach_z_mm: f64,
    approach_r_mm: f64,
    destination_r_mm: f64,
}

impl Group {
    /// From its sheets, in their order.
    fn of(sheets: &[Record]) -> Self {
        let record = |index: usize| sheets.get(index);
        let number = |index, name| record(index).and_then(|sheet: &Record| sheet.number(name)).unwrap_or_default();
        let mm = |index, name| f64::from(number(index, name)) / 100.0;
        let three = |index| ["p1", "p2", "p3"].map(|name| number(index, name));
        let aim = record(3).and_then(|sheet| sheet.pairs().find(|(field, _)| field.name == "aim"));
        let raw = |value: &Value| if let Value::Word(word) = value { *word } else { "" };
        Self {
            origin_point: number(0, "origin"),
            p1_point: number(0, "p1"),
            p2_point: number(0, "p2"),
            p3_point: number(0, "p3"),
            pieces: three(1),
            counters: three(2),
            approach: aim.map_or_else(String::new, |(field, value)| field.meaning(value).into_owned()),
            approach_raw: aim.map_or("", |(_, value)| raw(value)),
            approach_z_mm: mm(3, "z"),
            approach_r_mm: mm(3, "r"),
            destination_r_mm: mm(4, "r"),
        }
    }

    fn cells(&self) -> Vec<Cell> {
        vec![
            self.corners().into(),
            joined(self.pieces).into(),
            joined(self.counters).into(),
            self.approach.as_str().into(),
            mm(self.approach_z_mm),
            mm(self.approach_r_mm),
            mm(self.destination_r_mm),
        ]
    }

    fn corners(&self) -> String {
        joined([self.origin_point, self.p1_point, self.p2_point, self.p3_point])
    }
}

/// Headings of a table of groups.
fn columns() -> Columns {
    let values = vec!["P0 P1 P2 P3", "pieces", "counters", "approach", "z (mm)", "r (mm)", "dest r (mm)"];
    Columns { name: "group", values, empty: "no groups" }
}

/// A group by its sheets; the first that was refused, or holds what the manual does not list, tells of the whole.
fn item(group: i32, sheets: &[Result<Record, Failure>]) -> Item<Group, Listed> {
    let all: Vec<Record> = sheets.iter().flatten().cloned().collect();
    let unlisted = all.iter().find(|sheet| !sheet.is_listed());
    let failed = sheets.iter().find_map(|sheet| sheet.as_ref().err());
    let outcome =
        failed.map_or_else(|| Ok(unlisted.is_none().then(|| Group::of(&all))), |failure| Err(failure.clone()));
    let listed = Listed::of(unlisted.or(all.first()).filter(|_| failed.is_none()));
    Item::with("group", group.to_string(), listed, outcome).shown(Group::cells)
}

fn joined<const N: usize>(numbers: [i32; N]) -> String {
    numbers.map(|number| number.to_string()).join(" ")
}

fn mm(value: f64) -> Cell {
    Cell::number(format!("{value:.2}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::toyo::testing::{Bench, blocks, objection};

    #[test]
    fn every_value_of_the_sheets_has_a_name() {
        let mut places: Vec<(usize, usize)> = VALUES.iter().map(|(_, sheet, place)| (*sheet, *place)).collect();
        places.sort_unstable();
        let all = (0..SHEETS.len()).flat_map(|index| (0..sheet(index).fields().len()).map(move |place| (index, place)));
        assert_eq!(places, all.collect::<Vec<_>>());
    }

    #[test]
    fn a_group_is_five_sheets() {
        assert_eq!(
            blocks(&["mvm", "get", "3"]).unwrap(),
            [
                "@RPAR T4 S1 GRP=03",
                "@RPAR T4 S2 GRP=03",
                "@RPAR T4 S3 GRP=03",
                "@RPAR T4 S4 GRP=03",
                "@RPAR T4 S5 GRP=03"
            ]
        );
        assert_eq!(blocks(&["mvm", "get"]).unwrap().len(), 160);
        assert!(objection(&["mvm", "get", "33"]).contains("33 is out of range"));
    }

    #[test]
    fn only_sheets_with_changes_are_written() {
        let written = |words: &[&str]| {
            let blocks = blocks(&[&["mvm", "set", "1"], words].concat()).unwrap();
            assert_eq!(blocks[..5], reads(1).unwrap().iter().map(Request::text).collect::<Vec<_>>());
            blocks[5..].to_vec()
        };
        assert_eq!(
            written(&["pieces1=10", "destination-r=-5.5"]),
            [
                "@WPAR T4 S2 GRP=01 P1=0010 P2=? P3=?",
                "@RPAR T4 S2 GRP=01",
                "@WPAR T4 S5 GRP=01 R=-0005.50",
                "@RPAR T4 S5 GRP=01"
            ]
        );
        assert_eq!(
            written(&["counter1=1", "counter2=2", "counter3=3"]),
            ["@WPAR T4 S3 GRP=01 P1=01 P2=02 P3=03", "@RPAR T4 S3 GRP=01"]
        );
        let error = |words: &[&str]| blocks(words).unwrap_err().message;
        assert_eq!(error(&["mvm", "set", "1", "origin=0"]), "origin: 0 is out of range (a number, 1 to 999)");
        assert_eq!(error(&["mvm", "set", "1", "orgin=1"]), "there is no value 'orgin'; did you mean origin?");
        assert_eq!(error(&["mvm", "set", "1", "p1=1", "p1=2"]), "p1 is given twice");
    }

    #[test]
    fn what_is_set_is_read_back() {
        let mut bench = Bench::new("sim:");
        let words = ["origin=5", "p1=6", "pieces1=10", "counter3=7", "approach=incremental", "approach-z=2.5"];
        let stored = bench.data(&[&["mvm", "set", "2"], &words[..]].concat());
        assert_eq!(stored["items"][0]["written"], true, "{stored}");
        let read = bench.data(&["mvm", "get", "2"]);
        let group = &read["items"][0]["value"];
        assert_eq!(
            (&group["origin_point"], &group["p1_point"], &group["pieces"][0]),
            (&5.into(), &6.into(), &10.into())
        );
        assert_eq!((&group["approach"], &group["approach_z_mm"]), (&"incremental".into(), &2.5.into()));
        let again = bench.data(&[&["mvm", "set", "2"], &words[..]].concat());
        assert_eq!((&again["items"][0]["written"], &again["items"][0]["old"]), (&false.into(), group));
    }
}
