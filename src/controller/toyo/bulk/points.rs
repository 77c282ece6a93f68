//! Coordinate table in CSV: `name,x_mm,y_mm,z_mm,r_mm`, one point per line.
//!
//! Columns can be in any order, and cells can be quoted. Complete points may lack a column only for an axis that the
//! controller does not have; its coordinate is 0. Millimetres have at most two decimals.

use std::collections::HashMap;

use super::{Placed, Setting, plain};
use crate::findings::{Finding, Findings};
use crate::sheet::{self, Column, Dialect, Row, Sheet};
use crate::toyo::field::{Field, Value};
use crate::toyo::table::Parameter;

/// The columns, in the field order of the table.
const COLUMNS: [&str; 5] = ["name", "x_mm", "y_mm", "z_mm", "r_mm"];

/// The coordinate table.
///
/// # Panics
/// If it is missing in the parameter table; a test checks that.
pub fn table() -> &'static Parameter {
    Parameter::named("T1").expect("the parameter table has the coordinate table")
}

/// Columns with axis numbers instead of letters: they have the same meaning on every machine.
const NUMBERED_COLUMNS: [&str; 5] = ["name", "ax1_mm", "ax2_mm", "ax3_mm", "ax4_mm"];

/// The columns for 1 to 4 axes.
pub fn columns(axes: usize) -> Vec<Column> {
    COLUMNS[..=axes.clamp(1, 4)].iter().map(|name| Column::number(*name)).collect()
}

/// Points as cells under all columns.
fn rows(points: &[Setting]) -> Vec<Vec<String>> {
    let cells = |point: &Setting| {
        table().layout.fields.iter().zip(&point.values).map(|(field, value)| plain(field, value)).collect()
    };
    points.iter().map(cells).collect()
}

/// Formats points as CSV, with axis numbers as columns.
pub fn write_numbered(points: &[Setting]) -> String {
    let columns = NUMBERED_COLUMNS.map(Column::number);
    sheet::write(Dialect::COMMAS, &columns, &rows(points))
}

/// Formats points as CSV, with the columns of 1 to 4 axes.
pub fn write(points: &[Setting], axes: usize) -> String {
    sheet::write(Dialect::COMMAS, &columns(axes), &rows(points))
}

/// A point of a file; `None` for a coordinate without a column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Partial {
    /// Number, then x, y, z and r.
    pub values: Vec<Option<Value>>,
    /// Line, from 1.
    pub line: usize,
}

impl Partial {
    /// Number of the point.
    pub fn row(&self) -> i32 {
        match self.values.first() {
            Some(Some(Value::Number(row))) => *row,
            _ => 0,
        }
    }
}

/// Parses points from CSV for a controller with 1 to 4 axes. Each must be unique and have all coordinates in range.
pub fn read(bytes: &[u8], axes: usize) -> Result<Vec<Placed>, Vec<Finding>> {
    let points = read_columns(bytes, COLUMNS, axes, &COLUMNS[..=axes.clamp(1, 4)])?;
    let whole = |Partial { values, line }: Partial| {
        let values = values.into_iter().map(|value| value.unwrap_or(Value::Number(0))).collect();
        (Setting { parameter: table(), values }, line)
    };
    Ok(points.into_iter().map(whole).collect())
}

/// The points that a file has, in its order; coordinates may be missing.
pub fn numbers(bytes: &[u8]) -> Result<Vec<i32>, Vec<Finding>> {
    let mut findings = Findings::default();
    let mut points = Vec::new();
    let expected = format!("the first line must begin with {}", COLUMNS[0]);
    if let Some(sheet) = Sheet::read(bytes, &expected, &mut findings) {
        match sheet.column(COLUMNS[0]) {
            Some(at) => {
                for row in sheet.rows() {
                    match coordinate(&table().layout.fields[0], COLUMNS[0], &sheet, row, at) {
                        Ok(Value::Number(point)) => points.push(point),
                        Ok(_) => {}
                        Err((message, hint)) => findings.error(row.place(at), message, hint),
                    }
                }
            }
            None => findings.error(sheet.end_of_head(), format!("column {} is missing", COLUMNS[0]), Some(expected)),
        }
    }
    if findings.errors() == 0 { Ok(points) } else { Err(findings.into_errors()) }
}

/// Whether the columns of a file have axis numbers.
fn has_numbers(bytes: &[u8]) -> bool {
    let head = bytes.split(|byte| *byte == b'\n').find(|line| !line.trim_ascii().is_empty()).unwrap_or_default();
    String::from_utf8_lossy(head).to_ascii_lowercase().contains(NUMBERED_COLUMNS[1].trim_end_matches("1_mm"))
}

fn read_columns(bytes: &[u8], names: [&str; 5], axes: usize, required: &[&str]) -> Result<Vec<Partial>, Vec<Finding>> {
    let mut findings = Findings::default();
    let names = if has_numbers(bytes) { NUMBERED_COLUMNS } else { names };
    let expected = format!("the first line must be {}", names[..=axes.clamp(1, 4)].join(","));
    let mut points = Vec::new();
    if let Some(sheet) = Sheet::read(bytes, &expected, &mut findings) {
        // An error in one row does not hide errors in others.
        let before = findings.errors();
        let places = sheet.columns(&names, &expected, &mut findings);
        for (name, _) in names.iter().zip(&places).filter(|(name, place)| place.is_none() && required.contains(name)) {
            findings.error(sheet.end_of_head(), format!("column {name} is missing"), Some(expected.clone()));
        }
        if findings.errors() == before && places[1..].iter().all(Option::is_none) {
            findings.error(sheet.end_of_head(), "no column with coordinates", Some(expected));
        }
        if findings.errors() == before {
            points = read_rows(&sheet, names, &places, &mut findings);
        }
    }
    if findings.errors() == 0 { Ok(points) } else { Err(findings.into_errors()) }
}

fn read_rows(sheet: &Sheet, names: [&str; 5], places: &[Option<usize>], findings: &mut Findings) -> Vec<Partial> {
    let mut points: Vec<Partial> = Vec::new();
    let mut line_of_row = HashMap::new();
    for row in sheet.rows() {
        if findings.is_full() {
            break;
        }
        let before = findings.errors();
        let mut values = Vec::with_capacity(COLUMNS.len());
        for (index, place) in places.iter().enumerate() {
            let read = place.map(|at| (at, coordinate(&table().layout.fields[index], names[index], sheet, row, at)));
            values.push(match read {
                None => None,
                Some((_, Ok(value))) => Some(value),
                Some((at, Err((message, hint)))) => {
                    findings.error(row.place(at), message, hint);
                    None
                }
            });
        }
        if findings.errors() > before {
            continue;
        }
        let point = Partial { values, line: row.line };
        if let Some(other) = line_of_row.insert(point.row(), row.line) {
            let message = format!("point {} already exists in line {other}", point.row());
            findings.error(row.place(usize::MAX), message, None);
        }
        points.push(point);
    }
    points
}

fn coordinate(
    field: &Field,
    column: &str,
    sheet: &Sheet,
    row: &Row,
    at: usize,
) -> Result<Value, (String, Option<String>)> {
    if row.text(at).is_empty() {
        let hint = (column != COLUMNS[0]).then(|| "to keep a coordinate unchanged, remove its column".to_owned());
        return Err((format!("{column} is empty"), hint));
    }
    match sheet.number(row, at) {
        Ok(text) => field.read(&text).map_err(|error| (error.to_string(), None)),
        Err(why) => Err((format!("{column}: '{}' is ambiguous", row.text(at)), Some(why.to_owned()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str, axes: usize) -> Vec<(i32, Vec<i32>, usize)> {
        let points = read(text.as_bytes(), axes).unwrap_or_else(|errors| panic!("{text}: {errors:?}"));
        let number = |value: &Value| if let Value::Number(number) = value { *number } else { panic!("{value:?}") };
        points
            .iter()
            .map(|(point, line)| (point.row().unwrap(), point.values[1..].iter().map(number).collect(), *line))
            .collect()
    }

    fn errors(text: &str) -> Vec<String> {
        read(text.as_bytes(), 4).unwrap_err().iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_written_file_reads_back_unchanged() {
        let text = "name,x_mm,y_mm,z_mm,r_mm\n1,100.00,20.00,0.00,-0.05\n999,-8000.00,8000.00,0.00,0.00\n";
        assert_eq!(rows(text, 4), [(1, vec![10_000, 2000, 0, -5], 2), (999, vec![-800_000, 800_000, 0, 0], 3)]);
        let points: Vec<Setting> = read(text.as_bytes(), 4).unwrap().into_iter().map(|(point, _)| point).collect();
        assert_eq!(write(&points, 4), text);
        assert_eq!(write(&points, 2).lines().nth(1), Some("1,100.00,20.00"));
        assert_eq!(points[0].write().unwrap().text(), "@WPAR T1 PT=001 X=+0100.00 Y=+0020.00 Z=+0000.00 R=-0000.05");
        assert_eq!(points[0].read().unwrap().text(), "@RPAR T1 PT=001");
    }

    #[test]
    fn column_order_and_quotes_do_not_matter() {
        let text = "\u{FEFF}\r\nY_mm , \"x_mm\", name\r\n\r\n1.5,\"2\", 7\r\n,,\r\n";
        assert_eq!(rows(text, 2), [(7, vec![200, 150, 0, 0], 4)]);
    }

    #[test]
    fn columns_are_named_by_axis_letters_or_numbers() {
        let points = read(b"name,ax1_mm,ax2_mm,ax3_mm,ax4_mm\n1,1.00,2.00,3.00,4.00\n", 4).unwrap();
        let points: Vec<Setting> = points.into_iter().map(|(point, _)| point).collect();
        assert_eq!(write_numbered(&points), "name,ax1_mm,ax2_mm,ax3_mm,ax4_mm\n1,1.00,2.00,3.00,4.00\n");
    }

    #[test]
    fn each_existing_axis_needs_a_column() {
        assert_eq!(
            errors("name,x_mm,y_mm,z_mm\n1,0,0,0"),
            ["line 1, column 20: error: column r_mm is missing (the first line must be name,x_mm,y_mm,z_mm,r_mm)"]
        );
        assert_eq!(rows("name,x_mm\n1,0.01", 1), [(1, vec![1, 0, 0, 0], 2)]);
    }

    #[test]
    fn errors_have_line_and_column() {
        for (text, expected) in [
            ("", "line 1, column 1: error: the file is empty (the first line must be name,x_mm,y_mm,z_mm,r_mm)"),
            ("name,x_mm,y_mm,z_mm,r_mm,x_mn\n", "line 1, column 26: error: unknown column 'x_mn' (did you mean x_mm?)"),
            ("name,x_mm,y_mm,z_mm,r_mm,X_MM\n", "line 1, column 26: error: column X_MM appears twice"),
        ] {
            assert_eq!(errors(text), [expected]);
        }
        let header = "name,x_mm,y_mm,z_mm,r_mm\n";
        for (row, expected) in [
            ("1,0,0,0", "line 2, column 1: error: 4 cells for 5 columns"),
            ("1,0,0,0,", "line 2, column 9: error: r_mm is empty (to keep a coordinate unchanged, remove its column)"),
            (
                "1,0,8000.01,0,0",
                "line 2, column 5: error: y: 8000.01 is out of range (a number, -8000.00 to 8000.00 mm)",
            ),
            (
                "1,0,0.001,0,0",
                "line 2, column 5: error: y: 0.001 has too many decimals: at most 2 decimals (a number, -8000.00 to 8000.00 mm)",
            ),
            ("1000,0,0,0,0", "line 2, column 1: error: row: 1000 is out of range (a number, 1 to 999)"),
            ("1,0,\"0,5\",0,0", "line 2, column 5: error: y_mm: '0,5' is ambiguous (use a decimal point, not a comma)"),
            ("1,0,\"0,0,0", "line 2, column 5: error: wrong quotes"),
            ("1,0,0\"5\",0,0", "line 2, column 6: error: wrong quotes"),
            ("1,0,0,0,0\n01,1,1,1,1", "line 3, column 1: error: point 1 already exists in line 2"),
        ] {
            assert_eq!(errors(&format!("{header}{row}\n")), [expected]);
        }
        assert_eq!(errors(&format!("{header}x,0,0,0,0\n1,y,0,0,z\n")).len(), 3);
        assert_eq!(read(b"point\xFF", 4).unwrap_err()[0].message, "byte FF is not UTF-8");
    }
}
