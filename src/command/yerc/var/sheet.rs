//! Variables as a spreadsheet table: one row per variable, with the axes of positions in columns.
//!
//! Fields of a position without a cell stay unchanged on the controller.

use std::collections::HashMap;

use serde_json::{Map, Value as Json, json};

use super::entry::{Entry, Reading};
use super::in_form;
use super::position::{self, PositionData};
use crate::controller::findings::{Finding, Findings};
use crate::controller::sheet::{Column, Row, Sheet};
use crate::controller::text::hex;
use crate::controller::yerc::payload::{Axes, ExtendedForm, Form, MAX_AXES, Position, PositionKind};
use crate::controller::yerc::variables::{Reference, Value, VariableKind};

/// Content of a file for a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Kept {
    /// Complete value.
    Whole(Value),
    /// Fields of a position, as in JSON.
    Fields(Map<String, Json>),
}

/// Column before the axes, and column after them.
const NAME: &str = "name";
const VALUE: &str = "value";
const TEXT: &str = "text";
const TEXT_HEX: &str = "value_hex";
const TYPE: &str = "type";
/// Text for an empty string, because an empty cell means no value. A string of these two characters also has its
/// bytes in the row.
const EMPTY: &str = "\"\"";
const ARM: [&str; 4] = ["tool", "user", "form_code", "extended_form_code"];
const EXPECTED: &str = "the columns are name, value (numbers), text (strings), and for positions type, x_mm and so on, \
                        as in a file from `var dump FILE.csv`";

/// Table of variables, with only the columns that have a value.
pub fn rows(entries: &[Entry]) -> (Vec<Column>, Vec<Vec<String>>) {
    let cells: Vec<Vec<(String, String)>> = entries.iter().map(cells).collect();
    let used = |name: &str| cells.iter().flatten().any(|(column, _)| column == name);
    let mut columns = vec![Column::text(NAME)];
    columns.extend(Some(Column::number(VALUE)).filter(|_| used(VALUE)));
    columns.extend([TEXT, TEXT_HEX, TYPE].into_iter().filter(|name| used(name)).map(Column::text));
    for (name, _) in cells.iter().flatten().filter(|(name, _)| position::is_axis(name)) {
        if !columns.iter().any(|column| column.name == *name) {
            columns.push(Column::number(name));
        }
    }
    columns.extend(ARM.into_iter().filter(|name| used(name)).map(Column::number));
    let row = |cells: &Vec<(String, String)>| {
        let cell = |column: &Column| cells.iter().find(|(name, _)| *name == column.name).map(|(_, text)| text.clone());
        columns.iter().map(|column| cell(column).unwrap_or_default()).collect()
    };
    let rows = cells.iter().map(row).collect();
    (columns, rows)
}

/// Cells of a variable by column.
fn cells(entry: &Entry) -> Vec<(String, String)> {
    let mut cells = vec![(NAME.to_owned(), entry.name().to_owned())];
    let json = serde_json::to_value(entry).unwrap_or_default();
    match json.get("value") {
        Some(Json::Object(position)) => {
            let fields = position.iter().filter(|(name, _)| is_field(name));
            cells.extend(fields.map(|(name, value)| (name.clone(), plain(value))));
        }
        Some(Json::String(text)) if text.is_empty() => cells.push((TEXT.to_owned(), EMPTY.to_owned())),
        Some(Json::String(text)) => cells.push((TEXT.to_owned(), text.clone())),
        Some(Json::Null) | None => {}
        Some(number) => cells.push((VALUE.to_owned(), number.to_string())),
    }
    if let Some(digits) = json.get("value_hex") {
        cells.push((TEXT_HEX.to_owned(), plain(digits)));
    } else if json.get("value") == Some(&json!(EMPTY)) {
        cells.push((TEXT_HEX.to_owned(), hex(EMPTY.as_bytes())));
    }
    cells
}

fn is_field(name: &str) -> bool {
    name == TYPE || ARM.contains(&name) || position::is_axis(name)
}

fn plain(json: &Json) -> String {
    json.as_str().map_or_else(|| json.to_string(), ToOwned::to_owned)
}

/// Canonical spelling of a name.
pub fn canonical(name: &str) -> String {
    name.parse::<Reference>().map_or_else(|_| name.to_owned(), |reference| reference.to_string())
}

/// Variables of a file without duplicates; a variable without cells has no value.
pub fn read(bytes: &[u8], reading: Reading) -> Result<Vec<(Reference, Option<Kept>)>, Vec<Finding>> {
    let mut findings = Findings::default();
    let mut variables = Vec::new();
    if let Some(sheet) = Sheet::read(bytes, EXPECTED, &mut findings) {
        let mut known: Vec<&str> = [NAME, VALUE, TEXT, TEXT_HEX, TYPE].into_iter().chain(ARM).collect();
        known.extend(sheet.names().filter(|name| position::is_axis(name)));
        let places = sheet.columns(&known, EXPECTED, &mut findings);
        if places[0].is_none() && findings.errors() == 0 {
            findings.error(sheet.end_of_head(), "column name is missing", Some(EXPECTED.to_owned()));
        }
        let mut seen = HashMap::new();
        for row in sheet.rows().iter().filter(|_| places[0].is_some()) {
            if findings.is_full() {
                break;
            }
            let given = known.iter().zip(&places).filter_map(|(name, at)| Some((*name, (*at)?)));
            match variable(&sheet, row, given, reading) {
                Ok((reference, kept)) => {
                    if let Some(other) = seen.insert(reference, row.line) {
                        let message = format!("{reference} is already in line {other}");
                        findings.error(row.place(usize::MAX), message, None);
                    }
                    variables.push((reference, kept));
                }
                Err((at, message)) => findings.error(row.place(at), message, None),
            }
        }
    }
    if findings.errors() == 0 { Ok(variables) } else { Err(findings.into_errors()) }
}

/// Parses a row. An error includes the column of the cell.
fn variable<'k>(
    sheet: &Sheet,
    row: &Row,
    given: impl Iterator<Item = (&'k str, usize)>,
    reading: Reading,
) -> Result<(Reference, Option<Kept>), (usize, String)> {
    let (mut name, mut whole, mut fields, mut first) = ((0, ""), Map::new(), Map::new(), 0);
    for (column, at) in given.filter(|(column, at)| *column == NAME || !row.string(*at).is_empty()) {
        let text = row.text(at);
        let number = || -> Result<Json, (usize, String)> {
            let digits =
                sheet.number(row, at).map_err(|why| (at, format!("{column}: '{text}' is not clear: {why}")))?;
            serde_json::from_str(&digits).map_err(|_| (at, format!("{column}: '{text}' is not a number")))
        };
        match column {
            NAME => name = (at, text),
            VALUE => drop(whole.insert("value".to_owned(), number()?)),
            TEXT if row.string(at) == EMPTY => drop(whole.insert("value".to_owned(), json!(""))),
            TEXT => drop(whole.insert("value".to_owned(), json!(row.string(at)))),
            TEXT_HEX => drop(whole.insert("value_hex".to_owned(), json!(text))),
            TYPE => drop(fields.insert(column.to_owned(), json!(text))),
            _ => drop(fields.insert(column.to_owned(), number()?)),
        }
        first = if column == NAME { first } else { at };
    }
    if whole.contains_key("value_hex") && whole.get("value") == Some(&json!("")) {
        // With its bytes in the row, it is not an empty string.
        whole.insert("value".to_owned(), json!(EMPTY));
    }
    let reference: Reference = name.1.parse().map_err(|error| (name.0, format!("{error}")))?;
    let reference = in_form(reference, reading.model, false);
    let is_position = reference.kind.is_position();
    let (own, other) = if is_position { (&fields, &whole) } else { (&whole, &fields) };
    if !other.is_empty() {
        let what = if is_position { "a position, which has axes in columns" } else { "not a position" };
        return Err((first, format!("{reference} is {what}")));
    }
    if own.is_empty() {
        return Ok((reference, None));
    }
    if is_position {
        return Ok((reference, Some(Kept::Fields(fields))));
    }
    whole.insert("name".to_owned(), json!(name.1));
    let (_, value) = reading.entry(&Json::Object(whole)).map_err(|error| (first, format!("{reference}{error}")))?;
    Ok((reference, value.map(Kept::Whole)))
}

impl Kept {
    /// Complete value, with missing fields from the current one.
    pub fn over(self, kind: VariableKind, old: Option<&Value>) -> Result<Value, String> {
        let fields = match self {
            Self::Whole(value) => return Ok(value),
            Self::Fields(fields) => fields,
        };
        let old = old.and_then(PositionData::of).and_then(|data| serde_json::to_value(data).ok());
        let mut merged: Map<String, Json> = match old {
            Some(Json::Object(old)) => old.into_iter().filter(|(name, _)| is_field(name)).collect(),
            _ => Map::new(),
        };
        let is_other_type = fields.get(TYPE).is_some_and(|given| merged.get(TYPE) != Some(given));
        let is_alone = merged.is_empty() || is_other_type;
        if is_alone && !fields.contains_key(TYPE) {
            return Err("the position is undefined on the controller; give type and all axes".to_owned());
        }
        if is_alone {
            merged.clear();
        }
        merged.extend(fields.clone());
        let value =
            position::read(kind, &merged).map_err(|error| error.trim_start_matches([':', '.', ' ']).to_owned())?;
        let missing = |data: &PositionData| {
            let all = serde_json::to_value(data).ok()?;
            let axes = all.as_object()?.keys().filter(|name| position::is_axis(name));
            Some(axes.filter(|name| !fields.contains_key(*name)).cloned().collect::<Vec<_>>())
        };
        match PositionData::of(&value).as_ref().and_then(missing).filter(|_| is_alone) {
            Some(missing) if !missing.is_empty() => {
                Err(format!("the position on the controller has another type; {} is missing", missing.join(", ")))
            }
            _ => Ok(value),
        }
    }

    /// Two positions that differ in all unknown fields, for a dry run.
    pub fn sketch(&self, kind: VariableKind) -> Option<[Value; 2]> {
        let Self::Fields(fields) = self else { return None };
        let is_pulses =
            fields.keys().any(|name| name.ends_with("_pulses")) || fields.get(TYPE) == Some(&json!("pulse"));
        let kinds = if is_pulses { [PositionKind::Pulse; 2] } else { [PositionKind::Base, PositionKind::Robot] };
        let of = |(at, word, axis): (usize, u32, i32)| Position {
            kind: fields.get(TYPE).and_then(|name| named(name.as_str()?)).unwrap_or(kinds[at]),
            form: Form(word),
            tool: word.min(LAST_TOOL),
            user: word.min(LAST_TOOL),
            extended: ExtendedForm(word),
            axes: Axes::full([axis; MAX_AXES]),
        };
        let whole = |old: Position| self.clone().over(kind, Some(&Value::Position(old))).ok();
        Some([whole(of((0, 0, 0)))?, whole(of((1, u32::MAX, -1)))?])
    }

    /// Text of the unknown fields for a dry run.
    pub fn describe(&self) -> Option<String> {
        let Self::Fields(fields) = self else { return None };
        Some(fields.iter().map(|(name, value)| format!("{name}={}", plain(value))).collect::<Vec<_>>().join(", "))
    }
}

/// Tools and user coordinates are 0 to 63 (3.3.16).
const LAST_TOOL: u32 = 63;

fn named(name: &str) -> Option<PositionKind> {
    PositionKind::ALL.iter().find(|row| row.2 == name).map(|row| row.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::text::Encoding;
    use crate::controller::yerc::Model;

    const READING: Reading = Reading { model: Model::Dx200, encoding: Encoding::ShiftJis };

    fn value(name: &str, text: &str) -> (Reference, Value) {
        let reference = in_form(name.parse().unwrap(), Model::Dx200, false);
        (reference, Value::from_text(reference.kind, text.as_bytes()).unwrap())
    }

    #[test]
    fn what_is_written_reads_back() {
        let values = [
            value("B7", "255"),
            value("R3", "-1.5"),
            value("S2", "1.5;x"),
            value("S3", ""),
            value("S4", "\"\""),
            value("P2", "base:x=1000,y=0.5,z=1200,rx=180,ry=0,rz=-0.0001,tool=2,user=1,form=lower"),
            value("P3", "pulse:s=1,l=-2,u=3,r=4,b=5,t=6"),
            value("EX1", "pulse:1=77"),
        ];
        let entries: Vec<Entry> = values
            .iter()
            .map(|(reference, value)| Entry::new(*reference, &Ok(value.clone()), READING.encoding).bare())
            .collect();
        let (columns, rows) = rows(&entries);
        for dialect in [crate::controller::sheet::Dialect::COMMAS, crate::controller::sheet::Dialect::DECIMAL_COMMA] {
            let text = crate::controller::sheet::write(dialect, &columns, &rows);
            let read = read(text.as_bytes(), READING).unwrap();
            for ((reference, value), (back, kept)) in values.iter().zip(read) {
                let old = reference.kind.is_position().then_some(value);
                assert_eq!(
                    (back, kept.unwrap().over(back.kind, old).unwrap().emit()),
                    (*reference, value.emit()),
                    "{text}"
                );
            }
        }
    }

    #[test]
    fn a_position_keeps_what_has_no_cell() {
        let old = value("P2", "base:x=1000,y=0.5,z=1200,rx=180,ry=0,rz=0,tool=2,form=lower").1;
        let read = |text: &str| read(text.as_bytes(), READING).unwrap()[0].1.clone().unwrap();
        let new = read("name;x_mm;comment\nP2;7,25;above\n").over(VariableKind::P, Some(&old)).unwrap();
        assert_eq!(new, value("P2", "base:x=7.25,y=0.5,z=1200,rx=180,ry=0,rz=0,tool=2,form=lower").1);
        let alone = read("name,type,x_mm\nP2,base,1\n");
        assert!(alone.clone().over(VariableKind::P, Some(&old)).is_ok());
        assert!(alone.over(VariableKind::P, None).is_err());
        assert!(read("name,x_mm\nP2,1\n").over(VariableKind::P, None).unwrap_err().contains("give type and all axes"));
        let pulses = value("P2", "pulse:s=1,l=2,u=3,r=4,b=5,t=6").1;
        assert!(read("name,x_mm\nP2,1\n").over(VariableKind::P, Some(&pulses)).is_err());
    }

    #[test]
    fn mistakes_are_told_with_their_place() {
        let error = |text: &str| read(text.as_bytes(), READING).unwrap_err()[0].to_string();
        assert!(error("value\n1\n").contains("column name is missing"));
        assert!(error("name,value\nB0,256\n").contains("not a number from 0 to 255"));
        assert!(error("name,value\nB0,1\nB000,2\n").contains("B0 is already in line 2"));
        assert!(error("name,value\nP0,1\n").contains("P0 is a position"));
        assert!(error("name,x_mm\nB0,1\n").contains("B0 is not a position"));
        assert!(error("name,value\nQ0,1\n").starts_with("line 2, column 1"));
    }
}
