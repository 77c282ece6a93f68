//! Content of a new controller. The manual has samples but no initial values. These values are plausible.

use super::memory::TABLES;
use crate::toyo::field::Value;
use crate::toyo::layout::Record;
use crate::toyo::table::Parameter;
use crate::toyo::table::parameters::PARAMETERS;

/// Values of parameters in the protocol format. If there are fewer values than fields, the values repeat.
const VALUES: [(&str, &str); 76] = [
    ("M01", "0 01 0"),
    ("M02", "0 01 0"),
    ("M03", "0 01 0"),
    ("M04", "0 01 0"),
    ("M05", "0 01 0"),
    ("M06", "0 01 0"),
    ("M07", "0 01 0"),
    ("M08", "0 01 0"),
    ("M09", "E"),
    ("M10", "I"),
    ("M11", "I"),
    ("M12", "0 01 0"),
    ("M13", "0 01 0"),
    ("M14", "0 01 0"),
    ("M15", "0 01 0"),
    ("M16", "01"),
    ("M17", "01 156K 0000"),
    ("M18", "01 125K 0000"),
    ("M19", "0 01 0"),
    ("M20", "I"),
    ("M21", "0 01 0"),
    ("M22", "0 01 0"),
    ("M23", "0"),
    ("M24", "0 01 0"),
    ("M25", "0 01 0"),
    ("M26", "0 01 0"),
    ("P01", "+1000.00"),
    ("P02", "-1000.00"),
    ("P03", "07"),
    ("P04", "07"),
    ("P05", "0000"),
    ("P06", "+0000.00"),
    ("P07", "2 2 1 3"),
    ("P08", "010.0 050.0"),
    ("P09", "010.0 050.0"),
    ("P10", "010.0 050.0"),
    ("P11", "010.0 050.0"),
    ("P12", "00.01"),
    ("P13", ">= +0000.00 0 01 0"),
    ("P14", ">= +0000.00 0 01 0"),
    ("P15", ">= +0000.00 0 01 0"),
    ("P16", ">= +0000.00 0 01 0"),
    ("P17", "+000.00"),
    ("P18", "20.00"),
    ("E01", "X Y Z R"),
    ("E02", "00.05"),
    ("E03", "20000"),
    ("E04", "02000"),
    ("E05", "1"),
    ("E06", "1000"),
    ("E07", "002.0 020.0 100.0"),
    ("E08", "002.0 020.0 100.0"),
    ("E09", "002.0 020.0 100.0"),
    ("E10", "002.0 020.0 100.0"),
    ("E11", "1"),
    ("E12", "1"),
    ("E13", "+0000.00"),
    ("E14", "20.000"),
    ("E15", "2000"),
    ("E16", "4"),
    ("E17", "i"),
    ("E18", "090"),
    ("E19", "5000"),
    ("E20", "1"),
    ("E21", "999"),
    ("E22", "2000 0000 0000 0000"),
    ("E23", "I"),
    ("E24", "0"),
    ("E25", "0"),
    ("E26", "0"),
    ("E27", "00"),
    ("U03", "005"),
    ("U21", "000.0"),
    ("U22", "000.00"),
    // From here on: tables with equal rows.
    ("T5", "3.00"),
    ("T4.S1", "001 000 000 000"),
];

/// Speeds of the first rows in 0.1 mm/s. All later rows have the last of these speeds.
const SPEEDS: [i32; 10] = [100, 200, 500, 1000, 2000, 3000, 4000, 5000, 8000, 10_000];

/// Values of a parameter, or of a row of a table.
///
/// # Panics
/// Never: a test checks the format of every value.
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
    let text = VALUES.iter().find(|(id, _)| *id == parameter.id).map_or_else(|| table(parameter.id), |(_, text)| text);
    let fields = parameter.fields().iter().zip(text.split(' ').cycle());
    fields.map(|(field, text)| field.read(text).expect("the defaults are in form")).collect()
}

fn table(id: &str) -> &'static str {
    match id {
        "T4.S2" => "0000",
        "T4.S3" => "01 02 03",
        "T4.S4" => "a +0000.00 +0000.00",
        _ => "+0000.00",
    }
}

/// All parameters without rows, in order.
///
/// # Panics
/// Never: the number of values equals the number of fields.
pub(super) fn singles() -> Vec<Record> {
    let singles = PARAMETERS.iter().filter(|parameter| parameter.row().is_none());
    singles.map(|parameter| parameter.layout.record(values(parameter, 0)).expect("a value for every field")).collect()
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
