//! Views as tables for people and as CSV for spreadsheets.

use std::borrow::Cow;

use comfy_table::presets::NOTHING;
use comfy_table::{Attribute, CellAlignment, Color, ColumnConstraint, ContentArrangement, Width};
use dialoguer::console::measure_text_width;

use super::view::{Cell, Section, Table, Tone, View};
use super::{busy, escape};

/// The view as text of at most `width` columns.
pub fn text(view: &View, width: u16, color: bool) -> String {
    let _busy = busy::busy();
    let parts: Vec<String> = view.sections.iter().map(|section| section_text(section, width, color)).collect();
    parts.join("\n")
}

/// The view as CSV (RFC 4180): its table, or its fields as one row, after a column that names the robot where there are
/// several. Lines end in `\n`. Characters that a terminal would obey are escaped, and texts that a spreadsheet would take
/// for a formula are marked.
pub fn csv(view: &View, robot: Option<&str>) -> String {
    let _busy = busy::busy();
    let mut out = String::new();
    let header = |names: &mut dyn Iterator<Item = &str>| {
        robot.map(|_| "robot".to_owned()).into_iter().chain(names.map(column_id)).collect::<Vec<_>>()
    };
    let line = |cells: &mut dyn Iterator<Item = &Cell>| {
        robot.map(harmless).into_iter().chain(cells.map(csv_cell)).collect::<Vec<_>>()
    };
    for section in &view.sections {
        match section {
            Section::Fields(fields) => {
                csv_line(&mut out, &header(&mut fields.iter().map(|(name, _)| *name)));
                csv_line(&mut out, &line(&mut fields.iter().map(|(_, cell)| cell)));
            }
            Section::Table(table) => {
                csv_line(&mut out, &header(&mut table.columns.iter().copied()));
                for row in &table.rows {
                    csv_line(&mut out, &line(&mut row.iter()));
                }
            }
            Section::Text(text) => out.push_str(&escape::lines(text)),
            Section::Lines(lines) => {
                for line in lines {
                    out.push_str(&escape::line(&line.text));
                    out.push('\n');
                }
            }
        }
    }
    out
}

fn section_text(section: &Section, width: u16, color: bool) -> String {
    let mut grid = grid(width, color);
    match section {
        Section::Text(text) => {
            let mut text = escape::lines(text).into_owned();
            if !text.is_empty() && !text.ends_with('\n') {
                text.push('\n');
            }
            return text;
        }
        Section::Lines(lines) => return lines.iter().map(|line| painted(line, color) + "\n").collect(),
        Section::Fields(fields) => {
            let names = fields.iter().map(|(name, _)| measure_text_width(name)).max().unwrap_or_default();
            let room = room(width, 2, names);
            for (name, cell) in fields {
                // Values of fields stand on the left: they are of different kinds.
                let value = styled(&Cell { is_number: false, ..cell.clone() }, room);
                grid.add_row([comfy_table::Cell::new(*name).add_attribute(Attribute::Dim), value]);
            }
        }
        Section::Table(Table { rows, empty, .. }) if rows.is_empty() => return format!("{empty}\n"),
        Section::Table(table) if least_width(table) > usize::from(width) => return records(table, width, color),
        Section::Table(table) if table.rows.len() > LONG => return piecewise(table, width, color),
        Section::Table(table) => {
            let header = table.columns.iter().enumerate().map(|(index, name)| {
                let is_number = table.rows.iter().all(|row| row[index].is_number || row[index].text == "-");
                let cell = comfy_table::Cell::new(name.to_uppercase()).add_attribute(Attribute::Bold);
                if is_number { cell.set_alignment(CellAlignment::Right) } else { cell }
            });
            grid.set_header(header.collect::<Vec<_>>());
            let room = room(width, table.columns.len(), 0);
            for row in &table.rows {
                grid.add_row(row.iter().map(|cell| styled(cell, room)).collect::<Vec<_>>());
            }
        }
    }
    for (index, column) in grid.column_iter_mut().enumerate() {
        column.set_padding((0, PADDING));
        let is_whole = match section {
            Section::Table(table) => table.rows.iter().any(|row| row[index].is_whole),
            _ => index == 0,
        };
        if is_whole {
            column.set_constraint(ColumnConstraint::ContentWidth);
        } else if let Section::Table(table) = section
            && table.rows.iter().any(|row| row[index].text.contains("://"))
        {
            let least = u16::try_from(least_column(table, index)).unwrap_or(u16::MAX).saturating_add(PADDING);
            column.set_constraint(ColumnConstraint::LowerBoundary(Width::Fixed(least)));
        }
    }
    grid.lines().fold(String::new(), |text, line| text + line.trim_end() + "\n")
}

/// Blanks behind a column.
const PADDING: u16 = 2;

/// Rows from which on a table is laid out piece by piece, because the layout takes much memory for each.
const LONG: usize = 1000;

/// A long table, all of whose columns are as wide from its first row to its last.
fn piecewise(table: &Table, width: u16, color: bool) -> String {
    let mut layout = Layout::new(&table.columns);
    table.rows.iter().for_each(|row| layout.measure(row));
    let mut layout = layout.fit(width);
    table.rows.chunks(LONG).map(|rows| layout.piece(rows, color)).collect()
}

/// How a table is laid out whose rows come one after the other: after all of them were measured, and fitted to a width,
/// each piece looks like a part of the whole.
#[derive(Debug)]
pub struct Layout {
    names: Vec<&'static str>,
    columns: Vec<Column>,
    width: u16,
    has_header: bool,
}

#[derive(Debug)]
struct Column {
    /// Of its widest cell; fitted, what it gets.
    width: usize,
    is_number: bool,
    is_whole: bool,
}

impl Layout {
    /// For columns of these names.
    pub fn new(names: &[&'static str]) -> Self {
        let column = |name: &&str| Column { width: measure_text_width(name), is_number: true, is_whole: false };
        Self { names: names.to_vec(), columns: names.iter().map(column).collect(), width: 0, has_header: false }
    }

    /// Takes note of a row.
    pub fn measure(&mut self, row: &[Cell]) {
        for (column, cell) in self.columns.iter_mut().zip(row) {
            column.width = column.width.max(measure_text_width(&escape::line(&cell.text)));
            column.is_number = column.is_number && (cell.is_number || cell.text == "-");
            column.is_whole = column.is_whole || cell.is_whole;
        }
    }

    /// Gives columns that need less than their share what they need; the others share the rest.
    #[must_use]
    pub fn fit(mut self, width: u16) -> Self {
        self.width = width;
        let mut left = usize::from(width).saturating_sub(usize::from(PADDING) * self.columns.len());
        let (whole, mut undecided): (Vec<_>, Vec<_>) = self.columns.iter_mut().partition(|column| column.is_whole);
        for column in whole {
            left = left.saturating_sub(column.width);
        }
        loop {
            let share = left / undecided.len().max(1);
            let Some(next) = undecided.iter().position(|column| column.width <= share) else {
                for column in undecided {
                    column.width = share.max(1);
                }
                return self;
            };
            left -= undecided.remove(next).width;
        }
    }

    /// The next rows; those of the first piece come below a header.
    pub fn piece(&mut self, rows: &[Vec<Cell>], color: bool) -> String {
        let header = |(name, column): (&&str, &Column)| {
            let cell = comfy_table::Cell::new(name.to_uppercase()).add_attribute(Attribute::Bold);
            if column.is_number { cell.set_alignment(CellAlignment::Right) } else { cell }
        };
        let mut grid = grid(self.width, color);
        if !std::mem::replace(&mut self.has_header, true) {
            grid.set_header(self.names.iter().zip(&self.columns).map(header).collect::<Vec<_>>());
        }
        for row in rows {
            let cells = row.iter().zip(&self.columns);
            grid.add_row(cells.map(|(cell, column)| styled(cell, column.width)).collect::<Vec<_>>());
        }
        for (column, Column { width, .. }) in grid.column_iter_mut().zip(&self.columns) {
            let width = u16::try_from(*width).unwrap_or(u16::MAX).saturating_add(PADDING);
            column.set_padding((0, PADDING)).set_constraint(ColumnConstraint::Absolute(Width::Fixed(width)));
        }
        grid.lines().flat_map(|line| [line.trim_end(), "\n"].map(ToOwned::to_owned)).collect()
    }
}

fn grid(width: u16, color: bool) -> comfy_table::Table {
    let mut grid = comfy_table::Table::new();
    grid.load_style(NOTHING).set_content_arrangement(ContentArrangement::Dynamic).set_width(width);
    if color {
        grid.enforce_styling();
    } else {
        grid.force_no_tty();
    }
    grid
}

/// Longest run of characters that keeps together; what is longer, such as a frame in hex, is broken like nothing else.
const WORD: usize = 16;

/// Longest address that stays whole.
const LONGEST: usize = 60;

/// The width of a column below which it would break words.
fn least_column(table: &Table, index: usize) -> usize {
    let of_word = |word: &str| {
        let wide = measure_text_width(word);
        if word.contains("://") && wide <= LONGEST { wide } else { wide.min(WORD) }
    };
    let of_text = |text: &str| escape::line(text).split(' ').map(of_word).max().unwrap_or_default();
    let of_cell = |cell: &Cell| if cell.is_whole { measure_text_width(&cell.text) } else { of_text(&cell.text) };
    let cells = table.rows.iter().map(|row| of_cell(&row[index]));
    cells.chain([of_text(table.columns[index])]).max().unwrap_or_default()
}

/// The width below which a table would break words.
fn least_width(table: &Table) -> usize {
    let columns: usize = (0..table.columns.len()).map(|index| least_column(table, index)).sum();
    columns + usize::from(PADDING) * table.columns.len()
}

/// The rows one below the other, each as a list of fields: for a terminal that is too narrow for columns.
fn records(table: &Table, width: u16, color: bool) -> String {
    let rows = table.rows.iter().map(|row| {
        let fields = table.columns.iter().copied().zip(row.iter().cloned()).collect();
        section_text(&Section::Fields(fields), width, color)
    });
    rows.collect::<Vec<_>>().join("\n")
}

/// A word from which on it is broken here, because the layout takes a time for one that grows with its square.
const GIANT: usize = 4096;

/// Columns that a giant word may fill beside so many columns of a table, of which one is known to have this width.
fn room(width: u16, columns: usize, known: usize) -> usize {
    let others = if known > 0 { known } else { columns.saturating_sub(1) * WORD };
    usize::from(width).saturating_sub(others + usize::from(PADDING) * columns).max(WORD)
}

/// The text with its giant words in lines of `room` columns.
fn without_giants(text: Cow<'_, str>, room: usize) -> Cow<'_, str> {
    if text.len() < GIANT || text.split(' ').all(|word| word.len() < GIANT) {
        return text;
    }
    let mut broken = String::with_capacity(text.len() + text.len() / room + 1);
    for (index, word) in text.split(' ').enumerate() {
        if word.len() < GIANT {
            if index > 0 && !broken.ends_with('\n') {
                broken.push(' ');
            }
            broken.push_str(word);
            continue;
        }
        let mut column = room;
        for character in word.chars() {
            let wide = if character.is_ascii() { 1 } else { measure_text_width(character.encode_utf8(&mut [0; 4])) };
            if column + wide > room {
                if !broken.is_empty() {
                    broken.push('\n');
                }
                column = 0;
            }
            column += wide;
            broken.push(character);
        }
        broken.push('\n');
    }
    broken.truncate(broken.trim_end_matches('\n').len());
    broken.into()
}

fn styled(cell: &Cell, room: usize) -> comfy_table::Cell {
    let shown = comfy_table::Cell::new(without_giants(escape::line(&cell.text), room));
    let shown = match cell.tone {
        Tone::Plain => shown,
        Tone::Good => shown.fg(Color::Green),
        Tone::Warning => shown.fg(Color::Yellow),
        Tone::Bad => shown.fg(Color::Red),
    };
    if cell.is_number { shown.set_alignment(CellAlignment::Right) } else { shown }
}

/// A line as wide as it is.
pub fn painted(line: &Cell, color: bool) -> String {
    let text = escape::line(&line.text);
    let code = match line.tone {
        Tone::Plain => return text.into_owned(),
        _ if !color => return text.into_owned(),
        Tone::Good => 32,
        Tone::Warning => 33,
        Tone::Bad => 31,
    };
    format!("\x1b[{code}m{text}\x1b[0m")
}

/// `x (mm)` becomes `x_mm`, and `#` `number`.
fn column_id(name: &str) -> String {
    if name == "#" {
        return "number".to_owned();
    }
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let id = words.map(str::to_lowercase).collect::<Vec<_>>().join("_");
    if id.is_empty() { "number".to_owned() } else { id }
}

/// The text of a cell; numbers are as they are.
fn csv_cell(cell: &Cell) -> String {
    if cell.is_number { escape::lines(&cell.text).into_owned() } else { harmless(&cell.text) }
}

/// A text that does nothing on a terminal, and nothing in a spreadsheet: OWASP's apostrophe before what would be a
/// formula. Signed numbers are none, nor is the dash that stands for nothing.
pub(super) fn harmless(text: &str) -> String {
    let shown = escape::lines(text);
    let is_plain = shown == "-" || shown.parse::<f64>().is_ok();
    if shown.starts_with(['=', '+', '-', '@']) && !is_plain { format!("'{shown}") } else { shown.into_owned() }
}

pub(super) fn csv_line(out: &mut String, fields: &[String]) {
    for (index, field) in fields.iter().enumerate() {
        if index > 0 {
            out.push(',');
        }
        if field.contains([',', '"', '\n', '\r']) {
            out.push('"');
            out.push_str(&field.replace('"', "\"\""));
            out.push('"');
        } else {
            out.push_str(field);
        }
    }
    out.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> View {
        let mut table = Table::new(&["name", "x (mm)"], "nothing here");
        table.row(["てすと".into(), Cell::number("1.000")]);
        table.row(["a,\"b\"\u{1b}[31m".into(), Cell::number("-20.500")]);
        View::table(table)
    }

    #[test]
    fn numbers_stand_right_and_wide_characters_count_double() {
        assert_eq!(
            text(&sample(), 80, false),
            "NAME            X (MM)\nてすと           1.000\na,\"b\"\\x1b[31m  -20.500\n"
        );
    }

    #[test]
    fn csv_quotes_what_needs_it() {
        assert_eq!(csv(&sample(), None), "name,x_mm\nてすと,1.000\n\"a,\"\"b\"\"\\x1b[31m\",-20.500\n");
    }

    #[test]
    fn csv_does_nothing_on_a_terminal_or_in_a_spreadsheet() {
        let csv = |text: &str| {
            let mut table = Table::new(&["text"], "");
            table.row([text.into()]);
            csv(&View::table(table), None).trim_start_matches("text\n").trim_end_matches('\n').to_owned()
        };
        for (text, expected) in [
            ("=1+2", "'=1+2"),
            ("+SUM(A1)", "'+SUM(A1)"),
            ("-2+3", "'-2+3"),
            ("@HSON", "'@HSON"),
            ("=HYPERLINK(\"x\",\"y\")", "\"'=HYPERLINK(\"\"x\"\",\"\"y\"\")\""),
            ("-12.5", "-12.5"),
            ("+3", "+3"),
            ("-", "-"),
            ("a=b", "a=b"),
            ("\t=1", "\\t=1"),
            ("\u{1b}]0;title\u{7}", "\\x1b]0;title\\x07"),
            ("two\nlines", "\"two\nlines\""),
        ] {
            assert_eq!(csv(text), expected, "{text:?}");
        }
        let text = View::text("a\u{1b}[2Jb\n");
        assert_eq!(super::csv(&text, Some("=r")), "a\\x1b[2Jb\n");
        assert!(super::csv(&sample(), Some("=r")).contains("'=r,"));
    }

    #[test]
    fn a_long_table_looks_like_a_short_one() {
        let table = |rows: usize| {
            let mut table = Table::new(&["number", "time", "message"], "");
            for number in 0..rows {
                let words = format!("word {}", "of several ".repeat(number % 9));
                table.row([(number + 100_000).into(), Cell::from("08:00 h").whole(), words.into()]);
            }
            text(&View::table(table), 60, false)
        };
        let (short, long) = (table(LONG), table(2 * LONG + 10));
        assert!(long.starts_with(&short), "{}\n{}", &short[..600], &long[..600]);
        assert!(long.lines().all(|line| line.len() <= 60) && long.lines().count() > short.lines().count());
    }

    /// With a time that grows with the square of the length this would take hours.
    #[test]
    fn a_word_of_megabytes_is_laid_out_in_lines() {
        let giant = "A".repeat(8 << 20);
        let mut table = Table::new(&["number", "raw"], "");
        table.row([Cell::number("1"), format!("before {giant} after").into()]);
        table.row([Cell::number("2"), "字".repeat(100_000).into()]);
        for view in [View::table(table), View::fields([("raw", giant.clone().into())])] {
            let text = text(&view, 80, false);
            assert!(text.lines().all(|line| measure_text_width(line) <= 80));
            assert_eq!(text.matches('A').count() - text.matches("RAW").count(), giant.len());
        }
    }

    #[test]
    fn lines_are_coloured_one_by_one() {
        let lines = || vec![Cell::from("-a\u{1b}[0m").tone(Tone::Bad), Cell::from(" b")];
        let view = View::default().and(Section::Lines(lines()));
        assert_eq!(text(&view, 80, false), "-a\\x1b[0m\n b\n");
        assert_eq!(text(&view, 80, true), "\x1b[31m-a\\x1b[0m\x1b[0m\n b\n");
    }

    #[test]
    fn what_is_whole_stays_on_a_line() {
        let mut table = Table::new(&["name", "time"], "");
        table.row(["word ".repeat(20).into(), Cell::from("2026/03/14 08:00").whole()]);
        let text = text(&View::table(table), 40, false);
        assert!(text.contains("2026/03/14 08:00\n"), "{text}");
        assert!(text.lines().all(|line| line.len() <= 40), "{text}");
    }

    #[test]
    fn an_address_stays_on_a_line() {
        let mut table = Table::new(&["robot", "target", "what it says"], "");
        let url = "profinet://cell-3@enp4s0?ip=192.168.1.5";
        table.row(["cell3".into(), url.into(), "word ".repeat(20).into()]);
        for width in [60, 70, 80] {
            assert!(text(&View::table(table.clone()), width, false).contains(url), "{width}");
        }
    }

    #[test]
    fn a_table_that_would_break_words_becomes_a_list() {
        let mut table = Table::new(&["robot", "mode", "state"], "");
        table.row(["weld1".into(), "play".into(), "stopped".into()]);
        table.row(["weld2".into(), "auto".into(), "running".into()]);
        let text = |width| text(&View::table(table.clone()), width, false);
        assert_eq!(text(22), "ROBOT  MODE  STATE\nweld1  play  stopped\nweld2  auto  running\n");
        let list = "robot  weld1\nmode   play\nstate  stopped\n\nrobot  weld2\nmode   auto\nstate  running\n";
        assert_eq!(text(21), list);
    }

    #[test]
    fn tables_fit_the_width() {
        let view = View::fields([("text", Cell::from("word ".repeat(40)))]);
        assert!(text(&view, 80, false).lines().all(|line| line.chars().count() <= 80));
    }
}
