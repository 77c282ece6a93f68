//! Rows of the coordinate table as CSV: `point,x_mm,y_mm,z_mm,r_mm`, a point a line.
//!
//! Columns come in any order, and cells may be quoted. A column may only be missing for an axis that the controller does
//! not have; such a coordinate is 0. Millimetres have a point, and at most two decimals.

use std::borrow::Cow;
use std::collections::HashMap;
use std::fmt::Write as _;

use super::{Placed, Setting, plain};
use crate::nearest::nearest;
use crate::toyo::field::{Field, Value};
use crate::toyo::findings::{Finding, Findings, SourceLocation};
use crate::toyo::source;
use crate::toyo::table::Parameter;

/// The columns, in the order of the fields of the table.
const COLUMNS: [&str; 5] = ["point", "x_mm", "y_mm", "z_mm", "r_mm"];

/// The coordinate table.
///
/// # Panics
/// If the table of parameters lacks it, which a test shows.
pub fn table() -> &'static Parameter {
    Parameter::named("T1").expect("the coordinate table is in the table of parameters")
}

/// Points as CSV, with the columns of so many axes (1 to 4).
pub fn write(points: &[Setting], axes: usize) -> String {
    let columns = &COLUMNS[..=axes.clamp(1, 4)];
    let mut text = columns.join(",");
    text.push('\n');
    for point in points {
        for (index, (field, value)) in table().layout.fields.iter().zip(&point.values).take(columns.len()).enumerate() {
            let comma = if index > 0 { "," } else { "" };
            let _ = write!(text, "{comma}{}", plain(field, value));
        }
        text.push('\n');
    }
    text
}

/// Points in a CSV file, for a controller of so many axes (1 to 4): each once, all coordinates in range.
pub fn read(bytes: &[u8], axes: usize) -> Result<Vec<Placed>, Vec<Finding>> {
    let mut findings = Findings::default();
    let lines = source::lines(bytes, &mut findings);
    if findings.errors() > 0 {
        return Err(findings.into_errors());
    }
    let mut lines = lines.iter().map(AsRef::as_ref).enumerate().map(|(index, line)| (index + 1, line));
    let mut points = Vec::new();
    if let Some((number, line)) = lines.find(|(_, line): &(usize, &str)| !line.trim().is_empty()) {
        if let Some(header) = header(line, number, axes, &mut findings) {
            points = rows(lines, &header, &mut findings);
        }
    } else {
        findings.error(SourceLocation { line: 1, column: 1 }, "the file is empty", Some(expected(axes)));
    }
    if findings.errors() == 0 { Ok(points) } else { Err(findings.into_errors()) }
}

fn expected(axes: usize) -> String {
    format!("the first line is {}", COLUMNS[..=axes.clamp(1, 4)].join(","))
}

/// Which field each column is.
fn header(line: &str, number: usize, axes: usize, findings: &mut Findings) -> Option<Vec<usize>> {
    let before = findings.errors();
    let place = |at| place(line, number, at);
    if !line.contains(',') && line.contains([';', '\t']) {
        let hint = "save the file with commas between the columns, and points in the numbers";
        findings.error(place(0), "the columns are not separated by commas", Some(hint.to_owned()));
        return None;
    }
    let mut columns = Vec::new();
    for (at, name) in told(cells(line), line, number, findings)? {
        match COLUMNS.iter().position(|column| column.eq_ignore_ascii_case(&name)) {
            Some(index) if columns.contains(&index) => {
                findings.error(place(at), format!("column {name} is there twice"), None);
            }
            Some(index) => columns.push(index),
            None => {
                let near = nearest(&name, COLUMNS).map(|near| format!("did you mean {near}?"));
                let message = format!("there is no column '{}'", name.escape_debug());
                findings.error(place(at), message, near.or_else(|| Some(expected(axes))));
            }
        }
    }
    for (index, name) in COLUMNS.iter().enumerate().filter(|(index, _)| *index <= axes.clamp(1, 4)) {
        if !columns.contains(&index) {
            findings.error(place(line.len()), format!("column {name} is missing"), Some(expected(axes)));
        }
    }
    (findings.errors() == before).then_some(columns)
}

fn rows<'l>(lines: impl Iterator<Item = (usize, &'l str)>, header: &[usize], findings: &mut Findings) -> Vec<Placed> {
    let mut points: Vec<Placed> = Vec::new();
    let mut seen = HashMap::new();
    for (number, line) in lines {
        if findings.is_full() {
            break;
        }
        let Some(cells) = told(cells(line), line, number, findings) else { continue };
        // Spreadsheets leave lines of nothing but commas.
        if cells.iter().all(|(_, cell)| cell.is_empty()) {
            continue;
        }
        if cells.len() != header.len() {
            let message = format!("{} cells under {} columns", cells.len(), header.len());
            findings.error(place(line, number, 0), message, None);
            continue;
        }
        let mut values = vec![Value::Number(0); COLUMNS.len()];
        let before = findings.errors();
        for (index, (at, cell)) in header.iter().zip(&cells) {
            match coordinate(&table().layout.fields[*index], COLUMNS[*index], cell) {
                Ok(value) => values[*index] = value,
                Err((message, hint)) => findings.error(place(line, number, *at), message, hint),
            }
        }
        if findings.errors() > before {
            continue;
        }
        let point = Setting { parameter: table(), values };
        if let Some(other) = seen.insert(point.row(), number) {
            let row = point.row().unwrap_or_default();
            let message = format!("point {row} is there already, in line {other}");
            findings.error(place(line, number, 0), message, None);
        }
        points.push((point, number));
    }
    points
}

fn coordinate(field: &Field, column: &str, cell: &str) -> Result<Value, (String, Option<String>)> {
    if cell.is_empty() {
        return Err((format!("{column} is empty"), None));
    }
    field.read(cell).map_err(|error| {
        let hint = cell.contains(',').then(|| "numbers have a point, not a comma".to_owned());
        (error.to_string(), hint)
    })
}

/// A cell: where it begins, in bytes, and what is in it.
type Cell<'l> = (usize, Cow<'l, str>);

/// The cells of a line; where a quote is not closed, or not at the edge of a cell, its place.
fn cells(line: &str) -> Result<Vec<Cell<'_>>, usize> {
    let mut cells = Vec::new();
    let mut at = 0;
    loop {
        let rest = &line[at..];
        let start = at + rest.len() - rest.trim_start().len();
        let (cell, end) = if line[start..].starts_with('"') {
            let (cell, end) = quoted(line, start)?;
            (Cow::Owned(cell), end)
        } else {
            let end = line[start..].find(',').map_or(line.len(), |len| start + len);
            let cell = line[start..end].trim_end();
            match cell.find('"') {
                Some(quote) => return Err(start + quote),
                None => (Cow::Borrowed(cell), end),
            }
        };
        cells.push((start, cell));
        let rest = line[end..].trim_start();
        match rest.strip_prefix(',') {
            Some(more) => at = line.len() - more.len(),
            None if rest.is_empty() => return Ok(cells),
            None => return Err(line.len() - rest.len()),
        }
    }
}

/// The text of a quoted cell, and where it ends.
fn quoted(line: &str, start: usize) -> Result<(String, usize), usize> {
    let mut text = String::new();
    let mut at = start + 1;
    loop {
        let len = line[at..].find('"').ok_or(start)?;
        text.push_str(&line[at..at + len]);
        at += len + 1;
        if !line[at..].starts_with('"') {
            return Ok((text.trim().to_owned(), at));
        }
        text.push('"');
        at += 1;
    }
}

fn told<'l>(
    cells: Result<Vec<Cell<'l>>, usize>,
    line: &str,
    number: usize,
    findings: &mut Findings,
) -> Option<Vec<Cell<'l>>> {
    cells.map_err(|at| findings.error(place(line, number, at), "the quotes are wrong here", None)).ok()
}

fn place(line: &str, number: usize, at: usize) -> SourceLocation {
    SourceLocation { line: number, column: line[..at].chars().count() + 1 }
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
    fn what_is_written_reads_back() {
        let text = "point,x_mm,y_mm,z_mm,r_mm\n1,100.00,20.00,0.00,-0.05\n999,-8000.00,8000.00,0.00,0.00\n";
        assert_eq!(rows(text, 4), [(1, vec![10_000, 2000, 0, -5], 2), (999, vec![-800_000, 800_000, 0, 0], 3)]);
        let points: Vec<Setting> = read(text.as_bytes(), 4).unwrap().into_iter().map(|(point, _)| point).collect();
        assert_eq!(write(&points, 4), text);
        assert_eq!(write(&points, 2).lines().nth(1), Some("1,100.00,20.00"));
        assert_eq!(points[0].write().unwrap().text(), "@WPAR T1 PT=001 X=+0100.00 Y=+0020.00 Z=+0000.00 R=-0000.05");
        assert_eq!(points[0].read().unwrap().text(), "@RPAR T1 PT=001");
    }

    #[test]
    fn columns_and_quotes_are_free() {
        let text = "\u{FEFF}\r\nY_mm , \"x_mm\", point\r\n\r\n1.5,\"2\", 7\r\n,,\r\n";
        assert_eq!(rows(text, 2), [(7, vec![200, 150, 0, 0], 4)]);
    }

    #[test]
    fn an_axis_that_is_there_needs_its_column() {
        assert_eq!(
            errors("point,x_mm,y_mm,z_mm\n1,0,0,0"),
            ["line 1, column 21: error: column r_mm is missing \
                 (the first line is point,x_mm,y_mm,z_mm,r_mm)"]
        );
        assert_eq!(rows("point,x_mm\n1,0.01", 1), [(1, vec![1, 0, 0, 0], 2)]);
    }

    #[test]
    fn mistakes_are_told_with_their_place() {
        for (text, expected) in [
            ("", "line 1, column 1: error: the file is empty (the first line is point,x_mm,y_mm,z_mm,r_mm)"),
            (
                "point;x_mm;y_mm;z_mm;r_mm\n1;0;0;0;0",
                "line 1, column 1: error: the columns are not separated by commas \
                 (save the file with commas between the columns, and points in the numbers)",
            ),
            (
                "point,x_mm,y_mm,z_mm,r_mm,x_mn\n",
                "line 1, column 27: error: there is no column 'x_mn' (did you mean x_mm?)",
            ),
            ("point,x_mm,y_mm,z_mm,r_mm,X_MM\n", "line 1, column 27: error: column X_MM is there twice"),
        ] {
            assert_eq!(errors(text), [expected]);
        }
        let header = "point,x_mm,y_mm,z_mm,r_mm\n";
        for (row, expected) in [
            ("1,0,0,0", "line 2, column 1: error: 4 cells under 5 columns"),
            ("1,0,0,0,", "line 2, column 9: error: r_mm is empty"),
            (
                "1,0,8000.01,0,0",
                "line 2, column 5: error: y: 8000.01 is out of range (a number, -8000.00 to 8000.00 mm)",
            ),
            (
                "1,0,0.001,0,0",
                "line 2, column 5: error: y: 0.001 has too many decimals: at most 2 decimals (a number, -8000.00 to 8000.00 mm)",
            ),
            ("1000,0,0,0,0", "line 2, column 1: error: row: 1000 is out of range (a number, 1 to 999)"),
            (
                "1,0,\"0,5\",0,0",
                "line 2, column 5: error: y: '0,5' is not a number, -8000.00 to 8000.00 mm \
                 (numbers have a point, not a comma)",
            ),
            ("1,0,\"0,0,0", "line 2, column 5: error: the quotes are wrong here"),
            ("1,0,0\"5\",0,0", "line 2, column 6: error: the quotes are wrong here"),
            ("1,0,0,0,0\n01,1,1,1,1", "line 3, column 1: error: point 1 is there already, in line 2"),
        ] {
            assert_eq!(errors(&format!("{header}{row}\n")), [expected]);
        }
        assert_eq!(errors(&format!("{header}x,0,0,0,0\n1,y,0,0,z\n")).len(), 3);
        assert_eq!(read(b"point\xFF", 4).unwrap_err()[0].message, "byte FF is not UTF-8");
    }
}
