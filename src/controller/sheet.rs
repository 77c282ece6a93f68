//! CSV tables for spreadsheets: a header line, then one line per row, with commas, semicolons or tabs between the
//! cells.
//!
//! Columns can be in any order, and cells can be quoted. Columns whose name begins with `comment` are ignored. If the
//! separator is not a comma, numbers may have a decimal comma. A table must not mix decimal points and decimal commas:
//! in such a table, a point could be a thousands separator.

use std::borrow::Cow;
use std::collections::HashMap;

use crate::findings::{Findings, SourceLocation};
use crate::similar_word::nearest;
use crate::source;

/// Prefix of ignored columns.
pub const COMMENT: &str = "comment";

/// Separator and decimal mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dialect {
    separator: char,
    decimal_comma: bool,
}

impl Dialect {
    /// Comma separator, decimal point.
    pub const COMMAS: Self = Self { separator: ',', decimal_comma: false };
    /// Semicolon separator, decimal comma.
    pub const DECIMAL_COMMA: Self = Self { separator: ';', decimal_comma: true };

    fn row<'c>(self, cells: impl IntoIterator<Item = Cow<'c, str>>) -> String {
        let mut text = String::new();
        for (index, cell) in cells.into_iter().enumerate() {
            if index > 0 {
                text.push(self.separator);
            }
            let is_quoted = cell.contains([self.separator, '"', '\n', '\r']) || cell.trim() != cell;
            if is_quoted {
                text.extend(["\"", &cell.replace('"', "\"\""), "\""]);
            } else {
                text.push_str(&cell);
            }
        }
        text
    }

    fn cell<'c>(self, column: &Column, text: &'c str) -> Cow<'c, str> {
        if column.is_number && self.decimal_comma {
            Cow::Owned(text.replace('.', ","))
        } else if !column.is_number && is_formula(text) {
            Cow::Owned(format!("'{text}"))
        } else {
            Cow::Borrowed(text)
        }
    }
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Name of the column.
    pub name: String,
    /// Whether the cells are numbers, with a decimal point.
    pub is_number: bool,
}

impl Column {
    /// A column of numbers.
    pub fn number(name: impl Into<String>) -> Self {
        Self { name: name.into(), is_number: true }
    }

    /// A column of text.
    pub fn text(name: impl Into<String>) -> Self {
        Self { name: name.into(), is_number: false }
    }
}

/// Formats a table.
pub fn write(dialect: Dialect, columns: &[Column], rows: &[Vec<String>]) -> String {
    let mut text = dialect.row(columns.iter().map(|column| Cow::Borrowed(&*column.name))) + "\n";
    for row in rows {
        text += &dialect.row(columns.iter().zip(row).map(|(column, cell)| dialect.cell(column, cell)));
        text.push('\n');
    }
    text
}

/// A parsed table.
#[derive(Debug)]
pub struct Sheet {
    dialect: Dialect,
    head: Row,
    rows: Vec<Row>,
}

/// A row of a table.
#[derive(Debug)]
pub struct Row {
    /// Line number, from 1.
    pub line: usize,
    cells: Vec<Cell>,
}

#[derive(Debug)]
struct Cell {
    text: String,
    /// Start, in characters from 1.
    column: usize,
}

impl Row {
    /// Position of a cell. For an index after the last cell, the position is the start of the row.
    pub fn place(&self, index: usize) -> SourceLocation {
        SourceLocation { line: self.line, column: self.cells.get(index).map_or(1, |cell| cell.column) }
    }

    /// Text of a cell without surrounding blanks.
    pub fn text(&self, index: usize) -> &str {
        self.whole(index).trim()
    }

    /// Text of a cell, including the blanks inside quotes. An apostrophe at the start is removed if it only keeps a
    /// spreadsheet from evaluating the text as a formula.
    pub fn string(&self, index: usize) -> &str {
        let text = self.whole(index);
        text.strip_prefix('\'').filter(|rest| is_formula(rest)).unwrap_or(text)
    }

    fn whole(&self, index: usize) -> &str {
        self.cells.get(index).map_or("", |cell| &cell.text)
    }
}

impl Sheet {
    /// Parses a table. Returns `None` after an error, and adds the error to the findings.
    pub fn read(bytes: &[u8], expected: &str, findings: &mut Findings) -> Option<Self> {
        let before = findings.errors();
        let lines = source::lines(bytes, findings);
        if findings.errors() > before {
            return None;
        }
        let mut lines = lines.iter().map(AsRef::as_ref).enumerate().map(|(index, line)| (index + 1, line));
        let Some((number, line)) = lines.find(|(_, line): &(usize, &str)| !line.trim().is_empty()) else {
            let hint = Some(expected.to_owned());
            findings.error(SourceLocation { line: 1, column: 1 }, "the file is empty", hint);
            return None;
        };
        let separator = separator(line);
        let head = row(line, number, separator, findings)?;
        let mut rows = Vec::new();
        for (number, line) in lines {
            if findings.is_full() {
                break;
            }
            let Some(row) = row(line, number, separator, findings) else { continue };
            // Spreadsheets write lines that contain only separators.
            if row.cells.iter().all(|cell| cell.text.trim().is_empty()) {
                continue;
            }
            if row.cells.len() == head.cells.len() {
                rows.push(row);
            } else {
                let count =
                    |number: usize, what: &str| format!("{number} {what}{}", if number == 1 { "" } else { "s" });
                let (cells, columns) = (count(row.cells.len(), "cell"), count(head.cells.len(), "column"));
                let message = format!("the row has {cells}, but the table has {columns}");
                findings.error(SourceLocation { line: number, column: 1 }, message, None);
            }
        }
        let mut sheet = Self { dialect: Dialect { separator, decimal_comma: false }, head, rows };
        // With semicolons, the cells have decimal commas unless a cell contains a decimal point. With tabs, they have
        // decimal commas only if a cell contains one.
        sheet.dialect.decimal_comma = separator == ';' && !sheet.own_cells().any(|text| is_decimal(text, '.'))
            || separator != ',' && sheet.own_cells().any(|text| is_decimal(text, ','));
        Some(sheet)
    }

    /// Text of the cells, without the cells of comment columns.
    fn own_cells(&self) -> impl Iterator<Item = &str> {
        let of = |row| {
            let cells = self.head.cells.iter().zip(row).filter(|(head, _)| !is_comment(&head.text));
            cells.map(|(_, cell): (_, &Cell)| cell.text.trim())
        };
        self.rows.iter().flat_map(move |row| of(&row.cells))
    }

    /// The rows.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Names of the columns.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.head.cells.iter().map(|cell| cell.text.trim())
    }

    /// Index of a column.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.head.cells.iter().position(|cell| cell.text.trim().eq_ignore_ascii_case(name))
    }

    /// Index of each of these columns; `None` for a column that the table does not have. Any other column in the table,
    /// except a comment column, is an error.
    pub fn columns<S: AsRef<str>>(&self, known: &[S], expected: &str, findings: &mut Findings) -> Vec<Option<usize>> {
        let mut places = vec![None; known.len()];
        for (at, Cell { text: name, .. }) in self.head.cells.iter().enumerate() {
            let place = self.head.place(at);
            match known.iter().position(|column| column.as_ref().eq_ignore_ascii_case(name.trim())) {
                Some(index) if places[index].is_some() => {
                    findings.error(place, format!("column `{name}` appears twice"), None);
                }
                Some(index) => places[index] = Some(at),
                None if is_comment(name) => {}
                None => {
                    let near = nearest(name, known.iter().map(AsRef::as_ref));
                    let near = near.map(|near| format!("did you mean {near}?"));
                    let message = format!("unknown column '{}'", name.escape_debug());
                    let usual = || format!("{expected}; the name of an extra column must begin with `{COMMENT}`");
                    findings.error(place, message, near.or_else(|| Some(usual())));
                }
            }
        }
        places
    }

    /// Position after the last column name.
    pub fn end_of_head(&self) -> SourceLocation {
        let behind = |cell: &Cell| cell.column + cell.text.chars().count();
        SourceLocation { line: self.head.line, column: self.head.cells.last().map_or(1, behind) }
    }

    /// Returns a cell as the text of a number with a decimal point.
    pub fn number<'r>(&self, row: &'r Row, index: usize) -> Result<Cow<'r, str>, &'static str> {
        let text = row.text(index);
        match (self.dialect, text.contains(',')) {
            (Dialect { separator: ',', .. }, true) => Err("use a decimal point, not a comma"),
            (Dialect { decimal_comma: true, .. }, _) if text.contains('.') => {
                Err("other numbers in the file have a decimal comma, so the point is ambiguous")
            }
            (_, true) => Ok(Cow::Owned(text.replacen(',', ".", 1))),
            (_, false) => Ok(Cow::Borrowed(text)),
        }
    }
}

/// Updates the rows of a table. Comments, the order, and rows without a new value stay unchanged, byte for byte. New
/// rows are appended. The first of `columns` identifies a row; `canonical` normalizes the text of this column.
pub fn update(
    bytes: &[u8],
    columns: &[Column],
    rows: &[Vec<String>],
    canonical: impl Fn(&str) -> String,
    findings: &mut Findings,
) -> Option<String> {
    let names: Vec<&str> = columns.iter().map(|column| &*column.name).collect();
    let expected = format!("the columns are {}", names.join(", "));
    let sheet = Sheet::read(bytes, &expected, findings)?;
    let places = sheet.columns(&names, &expected, findings);
    let (Some(key), 0) = (places.first().copied().flatten(), findings.errors()) else {
        if findings.errors() == 0 {
            let missing = names.first().copied().unwrap_or_default();
            findings.error(sheet.end_of_head(), format!("column `{missing}` is missing"), Some(expected));
        }
        return None;
    };
    let cells = |row: &Vec<String>, old: &dyn Fn(usize) -> String| {
        let new = |at: usize| {
            let index = places.iter().position(|place| *place == Some(at))?;
            let (column, cell) = (columns.get(index)?, row.get(index)?);
            // An empty comment does not replace a comment that the user wrote.
            let is_none = cell.is_empty() && is_comment(&column.name);
            (!is_none).then(|| sheet.dialect.cell(column, cell).into_owned())
        };
        let cells: Vec<String> = (0..sheet.head.cells.len()).map(|at| new(at).unwrap_or_else(|| old(at))).collect();
        sheet.dialect.row(cells.into_iter().map(Cow::Owned))
    };
    let mut left: HashMap<String, &Vec<String>> =
        rows.iter().filter_map(|row| Some((canonical(row.first()?), row))).collect();
    let text = String::from_utf8_lossy(bytes);
    let end_of = |line: &str| if line.trim_end_matches('\n').ends_with('\r') { "\r\n" } else { "\n" };
    let end = text.split_inclusive('\n').next().map_or("\n", end_of);
    let mut updated = String::with_capacity(text.len());
    let mut old_rows = sheet.rows.iter().peekable();
    for (index, line) in text.split_inclusive('\n').enumerate() {
        let old = old_rows.next_if(|row| row.line == index + 1);
        match old.and_then(|old| Some((old, left.remove(&canonical(old.text(key)))?))) {
            Some((old, row)) => updated.extend([&cells(row, &|at| old.whole(at).to_owned()), end_of(line)]),
            None => updated.push_str(line),
        }
    }
    if !updated.ends_with('\n') {
        updated.push_str(if updated.ends_with('\r') { "\n" } else { end });
    }
    for row in rows.iter().filter(|row| row.first().is_some_and(|key| left.contains_key(&canonical(key)))) {
        updated.extend([&cells(row, &|_| String::new()), end]);
    }
    Some(updated)
}

/// Whether a spreadsheet would evaluate the text as a formula, or remove its apostrophe.
fn is_formula(text: &str) -> bool {
    let rest = text.trim_start_matches('\'');
    rest.starts_with(['=', '+', '-', '@']) && (rest.len() < text.len() || text.parse::<f64>().is_err())
}

fn is_comment(name: &str) -> bool {
    name.trim().get(..COMMENT.len()).is_some_and(|start| start.eq_ignore_ascii_case(COMMENT))
}

/// The most frequent separator of the header line.
fn separator(line: &str) -> char {
    let count = |separator| line.matches(separator).count();
    [',', ';', '\t'].into_iter().rev().max_by_key(|separator| count(*separator)).unwrap_or(',')
}

/// Whether a text is a number with this decimal mark.
fn is_decimal(text: &str, mark: char) -> bool {
    let digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    let Some((whole, decimals)) = text.split_once(mark) else { return false };
    digits(whole.trim_start_matches(['+', '-'])) && !decimals.is_empty() && digits(decimals)
}

/// Returns the cells of a line. An unclosed or misplaced quote is added to the findings.
fn row(line: &str, number: usize, separator: char, findings: &mut Findings) -> Option<Row> {
    let column = |at: usize| line.get(..at).map_or(1, |before| before.chars().count() + 1);
    let told = cells(line, separator).map_err(|at| {
        findings.error(SourceLocation { line: number, column: column(at) }, "wrong quotes", None);
    });
    let cells = told.ok()?.into_iter().map(|(at, text)| Cell { column: column(at), text: text.into_owned() });
    Some(Row { line: number, cells: cells.collect() })
}

/// Returns the cells of a line with their byte offsets. An error is the byte offset of a quote at a wrong place.
fn cells(line: &str, separator: char) -> Result<Vec<(usize, Cow<'_, str>)>, usize> {
    let trimmed =
        |text: &str| text.len() - text.trim_start_matches(|c: char| c != separator && c.is_whitespace()).len();
    let mut cells = Vec::new();
    let mut at = 0;
    loop {
        let start = at + trimmed(&line[at..]);
        let (cell, end) = if line[start..].starts_with('"') {
            let (cell, end) = quoted(line, start)?;
            (Cow::Owned(cell), end)
        } else {
            let end = line[start..].find(separator).map_or(line.len(), |len| start + len);
            let cell = line[start..end].trim_end();
            match cell.find('"') {
                Some(quote) => return Err(start + quote),
                None => (Cow::Borrowed(cell), end),
            }
        };
        cells.push((start, cell));
        let end = end + trimmed(&line[end..]);
        match line[end..].strip_prefix(separator) {
            Some(more) => at = line.len() - more.len(),
            None if end == line.len() => return Ok(cells),
            None => return Err(end),
        }
    }
}

/// Returns the text of a quoted cell and the offset of its end.
fn quoted(line: &str, start: usize) -> Result<(String, usize), usize> {
    let mut text = String::new();
    let mut at = start + 1;
    loop {
        let len = line[at..].find('"').ok_or(start)?;
        text.push_str(&line[at..at + len]);
        at += len + 1;
        if !line[at..].starts_with('"') {
            return Ok((text, at));
        }
        text.push('"');
        at += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLUMNS: [&str; 3] = ["point", "x_mm", "y_mm"];

    fn read(text: &str) -> Result<Vec<Vec<String>>, Vec<String>> {
        let mut findings = Findings::default();
        let mut rows = Vec::new();
        if let Some(sheet) = Sheet::read(text.as_bytes(), "point first", &mut findings) {
            let places = sheet.columns(&COLUMNS, "point first", &mut findings);
            for row in sheet.rows() {
                let cells = places.iter().flatten().map(|at| sheet.number(row, *at).map(Cow::into_owned));
                match cells.collect::<Result<Vec<_>, _>>() {
                    Ok(cells) => rows.push(cells),
                    Err(why) => findings.error(row.place(0), why, None),
                }
            }
        }
        let errors = findings.into_errors();
        if errors.is_empty() { Ok(rows) } else { Err(errors.iter().map(ToString::to_string).collect()) }
    }

    #[test]
    fn semicolons_tabs_and_decimal_commas_are_read() {
        let expected = Ok(vec![vec!["1".to_owned(), "-1.5".to_owned(), "20".to_owned()]]);
        for text in [
            "point,x_mm,y_mm\n1,-1.5,20\n",
            "point;x_mm;y_mm\r\n1;-1,5;20\r\n",
            "point;x_mm;y_mm\n1;-1.5;20\n",
            "\u{FEFF}Point\tX_MM\tcomment\ty_mm\n1\t-1,5\ta;b, c\t20\n\t\t\t\n",
            "comment_2;y_mm;x_mm;point\n\"3,14; \"\"x\"\"\";20;-1,5;1\n",
        ] {
            let mut rows = read(text);
            // Cells are in the order of the requested columns.
            rows.iter_mut().flatten().for_each(|row| assert_eq!(row.len(), 3, "{text}"));
            assert_eq!(rows, expected, "{text}");
        }
    }

    #[test]
    fn rejects_ambiguous_sheets() {
        let errors = |text: &str| read(text).unwrap_err();
        assert!(errors("point,x_mm\n1,\"1,5\"\n")[0].contains("use a decimal point"));
        assert!(errors("point;x_mm;y_mm\n1;1,5;1.234\n")[0].contains("the point is ambiguous"));
        assert!(errors("point;x_mm;remark\n")[0].contains("unknown column 'remark'"));
        assert!(errors("point;x_mn\n")[0].contains("did you mean x_mm?"));
        assert!(errors("point,x_mm,X_mm\n")[0].contains("appears twice"));
        assert!(errors("point,x_mm\n1\n")[0].contains("the row has 1 cell, but the table has 2 columns"));
        assert!(errors("point,x_mm\n1,\"2\n")[0].contains("wrong quotes"));
        assert!(errors("")[0].contains("the file is empty"));
    }

    fn columns() -> Vec<Column> {
        COLUMNS.map(Column::number).into()
    }

    fn rows(rows: &[[&str; 3]]) -> Vec<Vec<String>> {
        rows.iter().map(|row| row.map(str::to_owned).into()).collect()
    }

    #[test]
    fn update_keeps_comments_and_formulas() {
        let canonical = |text: &str| text.trim_start_matches('0').to_owned();
        let updated = |old: &str, new: &[[&str; 3]]| {
            update(old.as_bytes(), &columns(), &rows(new), canonical, &mut Findings::default())
        };
        assert_eq!(
            updated(
                "comment;x_mm;point\r\n\"above; 1,5\";1,5;007\r\n;;\r\nlast;2;3",
                &[["7", "-9.25", "8"], ["9", "4.5", "5"]]
            )
            .unwrap(),
            "comment;x_mm;point\r\n\"above; 1,5\";-9,25;7\r\n;;\r\nlast;2;3\r\n;4,5;9\r\n"
        );
        let old = "point,y_mm,comment\n1,2.00,\"say \"\"x\"\"\"\n";
        assert_eq!(updated(old, &[["1", "5.0", "2.00"]]).unwrap(), old);
        assert_eq!(updated(old, &[]).unwrap(), old);
        assert_eq!(updated("x_mm\n1\n", &[]), None);
        // Each row keeps its line end. A new row gets that of the first line.
        let mixed = updated("point,y_mm\n1,2\r\n3,4\r", &[["1", "0", "5"], ["9", "0", "6"]]).unwrap();
        assert_eq!(mixed, "point,y_mm\n1,5\r\n3,4\r\n9,6\n");
    }

    #[test]
    fn texts_round_trip() {
        let texts = ["=1+1", "'=x", "''@", "-5", "-x", " a ", "a;b", "say \"x\"", "'", ""];
        let columns = [Column::number("point"), Column::text("comment")];
        let rows: Vec<Vec<String>> = texts.iter().map(|text| vec!["1".to_owned(), (*text).to_owned()]).collect();
        for dialect in [Dialect::COMMAS, Dialect::DECIMAL_COMMA] {
            let text = write(dialect, &columns, &rows);
            assert!(text.contains("'=1+1\n") && !text.contains("\n1,=") && !text.contains("\n1;="), "{text}");
            let sheet = Sheet::read(text.as_bytes(), "", &mut Findings::default()).unwrap();
            let back: Vec<&str> = sheet.rows().iter().map(|row| row.string(1)).collect();
            assert_eq!(back, texts, "{text}");
        }
    }

    #[test]
    fn both_dialects_are_written() {
        let rows = rows(&[["1", "1.5", "-2"]]);
        let columns = [columns(), vec![Column::text("comment")]].concat();
        let rows: Vec<Vec<String>> = rows.into_iter().map(|row| [row, vec!["1.5; a".to_owned()]].concat()).collect();
        assert_eq!(write(Dialect::COMMAS, &columns, &rows), "point,x_mm,y_mm,comment\n1,1.5,-2,1.5; a\n");
        assert_eq!(write(Dialect::DECIMAL_COMMA, &columns, &rows), "point;x_mm;y_mm;comment\n1;1,5;-2;\"1.5; a\"\n");
    }
}
