//! CSV files of a backup: one record per line under named columns.

use std::fmt::Write as _;

/// Cells of a line.
pub type Row = Vec<String>;

/// Columns and rows as CSV.
pub fn write(columns: &[&str], rows: &[Row]) -> String {
    let mut text = columns.join(",") + "\n";
    for row in rows {
        for (index, cell) in row.iter().enumerate() {
            let comma = if index > 0 { "," } else { "" };
            let quoted = cell.contains([',', '"']) || cell.starts_with(' ') || cell.ends_with(' ');
            let _ = if quoted {
                write!(text, "{comma}\"{}\"", cell.replace('"', "\"\""))
            } else {
                write!(text, "{comma}{cell}")
            };
        }
        text.push('\n');
    }
    text
}

/// Rows of a CSV file with these columns, each with its line number.
pub fn read(columns: &[&str], text: &str) -> Result<Vec<(usize, Row)>, String> {
    let mut lines = (1..).zip(text.lines());
    match lines.next() {
        Some((_, head)) if head == columns.join(",") => {}
        _ => return Err(format!("line 1: the columns are {}", columns.join(","))),
    }
    let mut rows = Vec::new();
    for (number, line) in lines {
        match cells(line) {
            Some(row) if row.len() == columns.len() => rows.push((number, row)),
            Some(row) => {
                return Err(format!("line {number}: {} cells for {} columns", row.len(), columns.len()));
            }
            None => return Err(format!("line {number}: a closing quotation mark is missing")),
        }
    }
    Ok(rows)
}

/// Cells of a line; `None` if a quotation is not closed.
pub fn cells(line: &str) -> Option<Row> {
    let mut cells = vec![String::new()];
    let (mut is_quoted, mut chars) = (false, line.chars().peekable());
    while let Some(c) = chars.next() {
        let cell = cells.last_mut()?;
        match c {
            '"' if is_quoted && chars.peek() == Some(&'"') => {
                chars.next();
                cell.push('"');
            }
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => cells.push(String::new()),
            c => cell.push(c),
        }
    }
    (!is_quoted).then_some(cells)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        let columns = ["point", "comment"];
        let rows: Vec<Row> = ["PLAIN", "A, B", "SAY \"X\"", " x", "\"", ""].map(|c| vec!["1".into(), c.into()]).into();
        let text = write(&columns, &rows);
        assert!(text.starts_with("point,comment\n1,PLAIN\n1,\"A, B\"\n1,\"SAY \"\"X\"\"\"\n"));
        let read = read(&columns, &text).unwrap();
        assert_eq!(read.into_iter().map(|(_, row)| row).collect::<Vec<_>>(), rows);
    }

    #[test]
    fn what_does_not_fit_is_named_by_its_line() {
        for (text, why) in [
            ("", "line 1: the columns are a,b"),
            ("a\n", "line 1: the columns are a,b"),
            ("a,b\n1,2\n3\n", "line 3: 1 cells for 2 columns"),
            ("a,b\n1,\"2\n", "line 2: a closing quotation mark is missing"),
        ] {
            assert_eq!(read(&["a", "b"], text).unwrap_err(), why);
        }
    }
}
