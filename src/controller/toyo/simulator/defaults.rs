//! Content of a new controller. The manual has samples but no initial values. These values are plausible.

use super::memory::TABLES;
use crate::toyo::field::Value;
use crate::toyo::layout::Record;
use crate::toyo::table::Parameter;
use crate::toyo::table::parameters::PARAMETERS;

/// Values in the protocol format, with the ids of the parameters and tables that have them. If a parameter has more
/// fields than values, the values repeat.
#[rustfmt::skip] // A line per id would hide the groups.
const VALUES: [(&str, &[&str]); 41] = [
    ("0 01 0", &["M01", "M02", "M03", "M04", "M05", "M06", "M07", "M08", "M12", "M13", "M14", "M15", "M19",
        "M21", "M22", "M24", "M25", "M26"]),
    ("E", &["M09"]),
    ("I", &["M10", "M11", "M20", "E23"]),
    ("01", &["M16"]),
    ("01 156K 0000", &["M17"]),
    ("01 125K 0000", &["M18"]),
    ("0", &["M23", "E24", "E25", "E26"]),
    ("+1000.00", &["P01"]),
    ("-1000.00", &["P02"]),
    ("07", &["P03", "P04"]),
    ("0000", &["P05", "T4.S2"]),
    ("+0000.00", &["P06", "E13", "T4.S5"]),
    ("2 2 1 3", &["P07"]),
    ("010.0 050.0", &["P08", "P09", "P10", "P11"]),
    ("00.01", &["P12"]),
    (">= +0000.00 0 01 0", &["P13", "P14", "P15", "P16"]),
    ("+000.00", &["P17"]),
    ("20.00", &["P18"]),
    ("X Y Z R", &["E01"]),
    ("00.05", &["E02"]),
    ("20000", &["E03"]),
    ("02000", &["E04"]),
    ("1", &["E05", "E11", "E12", "E20"]),
    ("1000", &["E06"]),
    ("002.0 020.0 100.0", &["E07", "E08", "E09", "E10"]),
    ("20.000", &["E14"]),
    ("2000", &["E15"]),
    ("4", &["E16"]),
    ("i", &["E17"]),
    ("090", &["E18"]),
    ("5000", &["E19"]),
    ("999", &["E21"]),
    ("2000 0000 0000 0000", &["E22"]),
    ("00", &["E27"]),
    ("005", &["U03"]),
    ("000.0", &["U21"]),
    ("000.00", &["U22"]),
    ("3.00", &["T5"]),
    ("001 000 000 000", &["T4.S1"]),
    ("01 02 03", &["T4.S3"]),
    ("a +0000.00 +0000.00", &["T4.S4"]),
];

/// Speeds of the first rows in 0.1 mm/s. All later rows have the last of these speeds.
const SPEEDS: [i32; 10] = [100, 200, 500, 1000, 2000, 3000, 4000, 5000, 8000, 10_000];

/// Values of a parameter, or of a row of a table.
///
/// # Panics
/// Never: a test checks that every parameter has values in its format.
pub(super) fn values(parameter: &Parameter, row: i32) -> Vec<Value> {
    match parameter.id {
        "T1" => return vec![Value::Number(0); 4],
        "T2" => {
            let speed = SPEEDS.get(super::memory::index(row) - 1).or(SPEEDS.last());
            return speed.map(|speed| Value::Number(*speed)).into_iter().collect();
        }
        // Row 1 is 0.1 s, and each further row adds 0.1 s.
        "T3" => return vec![Value::Number(10 * row)],
        _ => {}
    }
    let (text, _) = VALUES.iter().find(|(_, ids)| ids.contains(&parameter.id)).expect("every parameter has defaults");
    let fields = parameter.fields().iter().zip(text.split(' ').cycle());
    fields.map(|(field, text)| field.read(text).expect("the defaults are in form")).collect()
}

/// All parameters without rows, by id.
///
/// # Panics
/// Never: the number of values equals the number of fields.
pub(super) fn singles() -> impl Iterator<Item = (&'static str, Record)> {
    let singles = PARAMETERS.iter().filter(|parameter| parameter.row().is_none());
    singles.map(|parameter| {
        (parameter.id, parameter.layout.record(values(parameter, 0)).expect("a value for every field"))
    })
}

/// All rows of the tables except T1, by table id and row.
pub(super) fn rows() -> impl Iterator<Item = ((&'static str, i32), Vec<Value>)> {
    let tables = PARAMETERS.iter().filter(|parameter| TABLES.contains(&parameter.id));
    tables.flat_map(|parameter| {
        let last = parameter.row().map_or(0, super::memory::last_row);
        (1..=last).map(|row| ((parameter.id, row), values(parameter, row)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_default_can_be_sent() {
        for parameter in &PARAMETERS {
            let values = values(parameter, 1);
            let row = parameter.row().map(|_| Value::Number(1));
            let all: Vec<_> = row.into_iter().chain(values).collect();
            parameter.layout.emit(&all).unwrap_or_else(|error| panic!("{}: {error}", parameter.id));
        }
    }
}
