//! Palletizing program in TOML, one record per line.
//!
//! ```toml
//! # 1: start program and mode; M-1 from a matrix to one place, …
//! start = { tag = 5, mode = "M-M" }
//! # 2: source matrix: corner P0, mm
//! source-p0 = { x = 100.00, y = 20.00, z = 0.00 }
//! ```
//!
//! Numbers are accepted instead of names. Records may be missing, but each record needs all its values, because a
//! write sends them all.

use std::collections::HashMap;
use std::fmt::Write as _;

use super::reading::{self, Reading};
use crate::findings::Finding;
use crate::toyo::field::Value;
use crate::toyo::layout::Record;
use crate::toyo::table::Pallet;
use crate::toyo::table::palletizing::RECORDS;

/// A record with all its values.
pub type Filled = (&'static Pallet, Vec<Value>);

/// Formats records as TOML; a comment gives number, purpose and units.
pub fn write(records: &[(&'static Pallet, Record)]) -> String {
    let mut text = String::new();
    for (pallet, record) in records {
        let fields = pallet.layout.fields;
        let (number, name, about, units) = (pallet.number, pallet.name, pallet.about, reading::comment(fields));
        let _ = writeln!(text, "# {number}: {about}{units}\n{name} = {}", reading::toml(fields, record.values()));
    }
    text
}

/// Parses records from TOML, in their order. Each must be known, unique, complete and in range.
pub fn read(bytes: &[u8]) -> Result<Vec<Filled>, Vec<Finding>> {
    reading::read(bytes, records)
}

fn records(reading: &mut Reading<'_>, document: &toml_edit::Table) -> Vec<Filled> {
    let mut records: Vec<Filled> = Vec::new();
    let mut line_of_record: HashMap<u8, usize> = HashMap::new();
    for (name, item) in document {
        let at = reading.key(document, name);
        let Some(pallet) = Pallet::named(name) else {
            reading.unknown(at, "record", name, RECORDS.iter().map(|pallet| pallet.name));
            continue;
        };
        if let Some(other) = line_of_record.insert(pallet.number, at.line) {
            reading.findings.error(at, format!("{} already exists in line {other}", pallet.name), None);
        }
        records.push((pallet, reading.values(pallet.name, pallet.layout.fields, item, at)));
    }
    records.sort_by_key(|(pallet, _)| pallet.number);
    records
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_written_file_reads_back_unchanged() {
        let text = "\
# 1: start program and mode; M-1 from a matrix to one place, 1-M from one place to a matrix, M-M matrix to matrix
start = { tag = 5, mode = \"M-M\" }
# 3: source matrix: corner P1, mm
source-p1 = { x = 100.00, y = -0.05, z = 0.00 }
# 16: end program
end = 7
";
        let records = read(text.as_bytes()).unwrap();
        let records: Vec<_> =
            records.into_iter().map(|(pallet, values)| (pallet, pallet.layout.record(values).unwrap())).collect();
        assert_eq!(write(&records), text);
        assert_eq!(records[1].1.emit().unwrap(), "X=+0100.00 Y=-0000.05 Z=+0000.00");
    }

    #[test]
    fn errors_have_line_and_column() {
        let errors = |text: &str| -> Vec<String> {
            read(text.as_bytes()).unwrap_err().iter().map(ToString::to_string).collect()
        };
        assert_eq!(errors("stat = 1"), ["line 1, column 1: error: unknown record 'stat' (did you mean start?)"]);
        assert_eq!(errors("end = 7\n16 = 8"), ["line 2, column 1: error: end already exists in line 1"]);
        assert_eq!(
            errors("source-p0 = { x = 9000.0, y = 0.0 }"),
            [
                "line 1, column 1: error: z is missing: a number, -8000.00 to 8000.00 mm",
                "line 1, column 19: error: x: 9000.00 is out of range (a number, -8000.00 to 8000.00 mm)"
            ]
        );
    }
}
