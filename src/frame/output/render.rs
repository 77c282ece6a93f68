//! Rendering of views as text tables.

use std::borrow::Cow;

use comfy_table::presets::NOTHING;
use comfy_table::{Attribute, CellAlignment, Color, ColumnConstraint, ContentArrangement, Width};
use dialoguer::console::measure_text_width;

use super::view::{Cell, Section, Table, Tone, View};
use super::{busy_work, escape};

/// Returns the view as text of at most `width` columns.
pub fn text(view: &View, width: u16, color: bool) -> String {
    let _busy = busy_work::register();
    let parts: Vec<String> = view.sections.iter().map(|section| section_text(section, width, color)).collect();
    parts.join("\n")
}

/// Returns the tables and fields of a view as CSV, for tests.
#[cfg(any(test, feature = "testing"))]
pub fn csv(view: &View) -> String {
    let mut out = String::new();
    let header = |names: &mut dyn Iterator<Item = &str>| names.map(column_id).collect::<Vec<_>>();
    let line = |cells: &mut dyn Iterator<Item = &Cell>| cells.map(csv_cell).collect::<Vec<_>>();
    let csv_line = |out: &mut String, cells: &[String]| super::csv::line(out, cells.iter().map(String::as_str));
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
            Section::Picture(_) => {}
        }
    }
    out
}

fn section_text(section: &Section, width: u16, color: bool) -> String {
    match section {
        Section::Text(text) => {
            let mut text = escape::lines(text).into_owned();
            if !text.is_empty() && !text.ends_with('\n') {
                text.push('\n');
            }
            text
        }
        Section::Lines(lines) => lines.iter().map(|line| with_color(line, color) + "\n").collect(),
        Section::Picture(lines) => {
            let line = |parts: &Vec<Cell>| parts.iter().map(|part| with_color(part, color)).collect::<String>();
            lines.iter().map(|parts| line(parts).trim_end().to_owned() + "\n").collect()
        }
        Section::Fields(fields) => fields_text(fields, width, color),
        Section::Table(Table { rows, empty, .. }) if rows.is_empty() => format!("{empty}\n"),
        Section::Table(table) => {
            let mut layout = Layout::new(&table.columns);
            table.rows.iter().for_each(|row| layout.measure(row));
            if layout.least() > usize::from(width) {
                return records(table, width, color);
            }
            let mut layout = layout.fit_width(width);
            table.rows.chunks(LONG_VALUE).map(|rows| layout.piece(rows, color)).collect()
        }
    }
}

/// Formats fields, each on one or more lines. If a word is too long for the space after the names, the value starts on
/// its own line.
fn fields_text(fields: &[(&'static str, Cell)], width: u16, color: bool) -> String {
    const INDENT: usize = 2;
    let names = fields.iter().map(|(name, _)| width_of(name)).max().unwrap_or_default();
    let padding = usize::from(PADDING);
    let width = usize::from(width);
    let room = width.saturating_sub(names + 2 * padding).max(MIN_WORD);
    let mut out = String::new();
    for (name, cell) in fields {
        let text = escape::line(&cell.text);
        let is_beside = least(&text) <= room;
        let (indent, room) = if is_beside { (names + padding, room) } else { (INDENT, width.saturating_sub(INDENT)) };
        let name = if color {
            format!("\x1b[2m{name}\x1b[0m{:1$}", "", names - width_of(name))
        } else {
            format!("{name:names$}")
        };
        let mut line =
            if is_beside { format!("{name}{:padding$}", "") } else { format!("{}\n{:INDENT$}", name.trim_end(), "") };
        for (at, part) in fold(&text, room).lines().enumerate() {
            if at > 0 {
                line = format!("{:indent$}", "");
            }
            line.push_str(&with_sgr(part, cell.tone, color));
            out.push_str(line.trim_end());
            out.push('\n');
        }
        if text.is_empty() {
            out.push_str(line.trim_end());
            out.push('\n');
        }
    }
    out
}

/// Number of blanks between columns.
const PADDING: u16 = 2;

/// Number of rows that are rendered at a time, to limit memory.
const LONG_VALUE: usize = 1000;

/// Layout of a table whose rows are rendered in pieces. First all rows are measured, then the columns are fitted to a
/// width. All pieces therefore have the same columns.
#[derive(Debug)]
pub struct Layout {
    names: Vec<&'static str>,
    columns: Vec<Column>,
    width: u16,
    has_header: bool,
}

#[derive(Debug)]
struct Column {
    /// Width of the widest cell. After fitting, the assigned width.
    width: usize,
    /// Minimum width at which no word is broken.
    min_width: usize,
    is_number: bool,
    is_whole: bool,
}

impl Column {
    fn measure(&mut self, cell: &Cell) {
        let text = escape::line(&cell.text);
        let width = width_of(&text);
        self.width = self.width.max(width);
        // A word has at least as many bytes as columns. Most rows have no longer word than the rows before.
        if cell.is_whole || text.split(' ').any(|word| word.len() > self.min_width) {
            self.min_width = self.min_width.max(if cell.is_whole { width } else { least(&text) });
        }
        self.is_number = self.is_number && (cell.is_number || cell.text == "-");
        self.is_whole = self.is_whole || cell.is_whole;
    }
}

impl Layout {
    /// Creates a layout for columns with these names.
    pub fn new(names: &[&'static str]) -> Self {
        let column = |name: &&str| {
            let (width, least) = (width_of(name), least(name));
            Column { width, min_width: least, is_number: true, is_whole: false }
        };
        Self { names: names.to_vec(), columns: names.iter().map(column).collect(), width: 0, has_header: false }
    }

    /// Measures a row.
    pub fn measure(&mut self, row: &[Cell]) {
        for (column, cell) in self.columns.iter_mut().zip(row) {
            column.measure(cell);
        }
    }

    /// Total number of spaces between columns.
    fn gaps(&self) -> usize {
        usize::from(PADDING) * self.columns.len().saturating_sub(1)
    }

    /// Minimum total width that breaks no word.
    fn least(&self) -> usize {
        let words = self.columns.iter().map(|column| if column.is_whole { column.width } else { column.min_width });
        words.sum::<usize>() + self.gaps()
    }

    /// Assigns the width. Narrow columns get the width that they need, and the other columns share the remaining width.
    /// No column is narrower than its longest word.
    #[must_use]
    pub fn fit_width(mut self, width: u16) -> Self {
        self.width = width;
        // If there is room, a space also follows the last column.
        let room =
            usize::from(width).saturating_sub(self.gaps() + usize::from(PADDING)).max(self.least() - self.gaps());
        let at = |column: &Column, share: usize| {
            if column.is_whole { column.width } else { column.width.min(share.max(column.min_width)) }
        };
        let total = |columns: &[Column], share| columns.iter().map(|column| at(column, share)).sum::<usize>();
        let share = (1..=room).rev().find(|share| total(&self.columns, *share) <= room).unwrap_or(1);
        let mut left = room.saturating_sub(total(&self.columns, share));
        for column in &mut self.columns {
            let more = usize::from(left > 0 && at(column, share + 1) > at(column, share));
            left -= more;
            column.width = at(column, share + more);
        }
        self
    }

    /// Renders the next rows. The first piece includes the header.
    pub fn piece(&mut self, rows: &[Vec<Cell>], color: bool) -> String {
        let mut text = String::new();
        if !std::mem::replace(&mut self.has_header, true) {
            self.push_grid(&mut text, &[], true, color);
        }
        let mut others = 0;
        for (at, row) in rows.iter().enumerate() {
            let Some(cells) = self.simple_cells(row, color) else {
                others += 1;
                continue;
            };
            self.push_grid(&mut text, &rows[at - others..at], false, color);
            others = 0;
            self.push_simple(&mut text, row, &cells);
        }
        self.push_grid(&mut text, &rows[rows.len() - others..], false, color);
        text
    }

    /// Returns the texts of a row in the lines of their columns, if all are printable ASCII without a color.
    fn simple_cells<'c>(&self, row: &'c [Cell], color: bool) -> Option<Vec<Cow<'c, str>>> {
        let cell = |(cell, column): (&'c Cell, &Column)| {
            let is_plain = !color || cell.tone == Tone::Plain;
            let is_simple = is_plain && escape::is_printable_ascii(&cell.text);
            let shown = is_simple.then(|| folded(Cow::Borrowed(&cell.text), column.width))?;
            shown.split('\n').all(|line| line.len() <= column.width).then_some(shown)
        };
        if row.len() == self.columns.len() { row.iter().zip(&self.columns).map(cell).collect() } else { None }
    }

    /// Appends a row of simple cells. Most rows of a long table are simple, and this takes a small part of the time of
    /// a grid.
    fn push_simple(&self, text: &mut String, row: &[Cell], cells: &[Cow<'_, str>]) {
        let mut lines: Vec<_> = cells.iter().map(|cell| cell.split('\n')).collect();
        loop {
            let (mut is_over, mut blanks) = (true, 0);
            let start = text.len();
            for ((lines, cell), column) in lines.iter_mut().zip(row).zip(&self.columns) {
                let next = lines.next();
                is_over &= next.is_none();
                let whole = next.unwrap_or_default();
                let shown = whole.trim_end();
                let missing = column.width - whole.len();
                let before = if cell.is_number { missing } else { 0 };
                if !shown.is_empty() {
                    text.extend(std::iter::repeat_n(' ', blanks + before));
                    text.push_str(shown);
                    blanks = 0;
                }
                let used = if shown.is_empty() { 0 } else { before + shown.len() };
                blanks += column.width - used + usize::from(PADDING);
            }
            if is_over {
                return text.truncate(start);
            }
            text.push('\n');
        }
    }

    /// Appends the header, and any rows.
    fn push_grid(&self, text: &mut String, rows: &[Vec<Cell>], has_header: bool, color: bool) {
        if rows.is_empty() && !has_header {
            return;
        }
        let header = |(name, column): (&&str, &Column)| {
            let cell = comfy_table::Cell::new(name.to_uppercase()).add_attribute(Attribute::Bold);
            if column.is_number { cell.set_alignment(CellAlignment::Right) } else { cell }
        };
        let mut grid = grid(self.width, color);
        if has_header {
            grid.set_header(self.names.iter().zip(&self.columns).map(header).collect::<Vec<_>>());
        }
        for row in rows {
            let cells = row.iter().zip(&self.columns);
            grid.add_row(cells.map(|(cell, column)| apply_tone(cell, column.width)).collect::<Vec<_>>());
        }
        for (column, Column { width, .. }) in grid.column_iter_mut().zip(&self.columns) {
            let width = u16::try_from(*width).unwrap_or(u16::MAX).saturating_add(PADDING);
            column.set_padding((0, PADDING)).set_constraint(ColumnConstraint::Absolute(Width::Fixed(width)));
        }
        for line in grid.lines() {
            text.push_str(line.trim_end());
            text.push('\n');
        }
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

/// Number of columns of a text.
fn width_of(text: &str) -> usize {
    if escape::is_printable_ascii(text) { text.len() } else { measure_text_width(text) }
}

/// Maximum length of a part that is kept together in a breakable word.
const MIN_WORD: usize = 16;

/// Whether a word may be broken anywhere. This applies to very long words, to bytes and bits, and to languages without
/// blanks.
fn may_break(word: &str) -> bool {
    let is_digit = |byte: u8| byte.is_ascii_hexdigit() || b"?_[]".contains(&byte);
    word.len() >= GIANT_WORD || !word.is_ascii() || word.bytes().all(is_digit)
}

/// Returns the parts of a word that stay together. Lists are split after commas; addresses are not split.
fn pieces(word: &str) -> impl Iterator<Item = &str> {
    let is_address = word.contains("://");
    word.split_inclusive(move |c: char| c == ',' && !is_address)
}

/// Minimum width of a text that breaks no word.
fn least(text: &str) -> usize {
    let of_piece = |piece: &str| {
        let wide = width_of(piece);
        if may_break(piece) { wide.min(MIN_WORD) } else { wide }
    };
    text.split(' ').flat_map(pieces).map(of_piece).max().unwrap_or_default()
}

/// Renders rows as lists of fields. Used if a terminal is too narrow for the columns.
fn records(table: &Table, width: u16, color: bool) -> String {
    let rows = table.rows.iter().map(|row| {
        let fields = table.columns.iter().copied().zip(row.iter().cloned()).collect();
        section_text(&Section::Fields(fields), width, color)
    });
    rows.collect::<Vec<_>>().join("\n")
}

/// Length from which a word counts as giant. The normal line breaking would need quadratic time for it.
const GIANT_WORD: usize = 4096;

/// A text in lines of `room` columns.
fn folded(text: Cow<'_, str>, room: usize) -> Cow<'_, str> {
    if text.len() < GIANT_WORD && width_of(&text) <= room { text } else { fold(&text, room).into() }
}

/// Breaks a text between words, into lines of `room` columns.
fn fold(text: &str, room: usize) -> String {
    let mut out = String::with_capacity(text.len() + text.len() / room.max(1) + 1);
    let mut column = 0;
    for (at, word) in text.split(' ').enumerate() {
        let is_short = word.len() < GIANT_WORD && width_of(word) <= room;
        let whole = is_short.then_some(word);
        let parts = (!is_short).then(|| pieces(word)).into_iter().flatten();
        for (part_at, part) in whole.into_iter().chain(parts).enumerate() {
            let gap = usize::from(at > 0 && part_at == 0);
            let wide = if part.len() < GIANT_WORD { width_of(part) } else { usize::MAX / 2 };
            if column > 0 && column + gap + wide > room {
                out.push('\n');
                column = 0;
            } else if gap > 0 && (column > 0 || out.is_empty()) {
                out.push(' ');
                column += 1;
            }
            if wide <= room || !may_break(part) {
                out.push_str(part);
                column += wide;
                continue;
            }
            for character in part.chars() {
                let wide = width_of(character.encode_utf8(&mut [0; 4]));
                if column + wide > room {
                    out.push('\n');
                    column = 0;
                }
                out.push(character);
                column += wide;
            }
        }
    }
    out
}

fn apply_tone(cell: &Cell, room: usize) -> comfy_table::Cell {
    let shown = comfy_table::Cell::new(folded(escape::line(&cell.text), room));
    let shown = match cell.tone {
        Tone::Plain => shown,
        Tone::Good => shown.fg(Color::Green),
        Tone::Warning => shown.fg(Color::Yellow),
        Tone::Bad => shown.fg(Color::Red),
    };
    if cell.is_number { shown.set_alignment(CellAlignment::Right) } else { shown }
}

/// Formats a line in its color, without line breaks.
pub fn with_color(line: &Cell, color: bool) -> String {
    with_sgr(&escape::line(&line.text), line.tone, color).into_owned()
}

/// Adds the color of a tone to a text.
fn with_sgr(text: &str, tone: Tone, color: bool) -> Cow<'_, str> {
    let code = match tone {
        Tone::Good if color => 32,
        Tone::Warning if color => 33,
        Tone::Bad if color => 31,
        _ => return text.into(),
    };
    format!("\x1b[{code}m{text}\x1b[0m").into()
}

/// Converts `x (mm)` to `x_mm`, and `#` to `number`.
#[cfg(any(test, feature = "testing"))]
fn column_id(name: &str) -> String {
    if name == "#" {
        return "number".to_owned();
    }
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let id = words.map(str::to_lowercase).collect::<Vec<_>>().join("_");
    if id.is_empty() { "number".to_owned() } else { id }
}

/// Text of a cell. Numbers are not changed.
#[cfg(any(test, feature = "testing"))]
fn csv_cell(cell: &Cell) -> String {
    if cell.is_number {
        escape::lines(&cell.text).into_owned()
    } else {
        super::csv::neutralize_formula(&cell.text).into_owned()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn sample() -> View {
        let mut table = Table::new(&["name", "x (mm)"], "nothing here");
        table.row(["てすと".into(), Cell::number("1.000")]);
        table.row(["a,\"b\"\u{1b}[31m".into(), Cell::number("-20.500")]);
        View::table(table)
    }

    #[test]
    fn aligns_numbers_and_counts_wide_characters_twice() {
        assert_eq!(
            text(&sample(), 80, false),
            "NAME            X (MM)\nてすと           1.000\na,\"b\"\\x1b[31m  -20.500\n"
        );
    }

    #[test]
    fn long_table_has_the_layout_of_a_short_one() {
        let table = |rows: usize| {
            let mut table = Table::new(&["number", "time", "message"], "");
            for number in 0..rows {
                let words = format!("word {}", "of several ".repeat(number % 9));
                table.row([(number + 100_000).into(), Cell::from("08:00 h").whole(), words.into()]);
            }
            text(&View::table(table), 60, false)
        };
        let (short, long) = (table(LONG_VALUE), table(2 * LONG_VALUE + 10));
        assert!(long.starts_with(&short), "{}\n{}", &short[..600], &long[..600]);
        assert!(long.lines().all(|line| line.len() <= 60) && long.lines().count() > short.lines().count());
    }

    proptest! {
        #[test]
        fn a_simple_row_looks_like_a_row_of_the_grid(
            rows in prop::collection::vec(prop::collection::vec(("[ -~]{0,12}|[a-z ]{20,40}|é", any::<bool>(), any::<bool>()), 3), 1..9),
            width in 20u16..90,
            color in any::<bool>(),
        ) {
            let cell = |(text, is_number, is_bad): (String, bool, bool)| {
                let cell = if is_number { Cell::number(text) } else { text.into() };
                cell.tone(if is_bad { Tone::Bad } else { Tone::Plain })
            };
            let rows: Vec<Vec<Cell>> = rows.into_iter().map(|row| row.into_iter().map(cell).collect()).collect();
            let mut layout = Layout::new(&["a", "b", "c"]);
            for row in &rows {
                layout.measure(row);
            }
            let mut layout = layout.fit_width(width);
            let mut of_grid = String::new();
            layout.push_grid(&mut of_grid, &rows, true, color);
            prop_assert_eq!(layout.piece(&rows, color), of_grid);
        }
    }

    /// An algorithm with quadratic time would need hours for this word.
    #[test]
    fn wraps_a_giant_word() {
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
    fn colors_each_line() {
        let lines = || vec![Cell::from("-a\u{1b}[0m").tone(Tone::Bad), Cell::from(" b")];
        let view = View::default().append(Section::Lines(lines()));
        assert_eq!(text(&view, 80, false), "-a\\x1b[0m\n b\n");
        assert_eq!(text(&view, 80, true), "\x1b[31m-a\\x1b[0m\x1b[0m\n b\n");
    }

    #[test]
    fn keeps_whole_cells_on_one_line() {
        let mut table = Table::new(&["name", "time"], "");
        table.row(["word ".repeat(20).into(), Cell::from("2026/03/14 08:00").whole()]);
        let text = text(&View::table(table), 40, false);
        assert!(text.contains("2026/03/14 08:00\n"), "{text}");
        assert!(text.lines().all(|line| line.len() <= 40), "{text}");
    }

    #[test]
    fn never_breaks_words() {
        let url = "profinet://cell-3@enp4s0?ip=192.168.1.5&cycle=16ms&watchdog=320ms&words=le&startup=advanced";
        let list = "base:x=1000.000,y=0.000,z=1200.000,rx=180.0000,ry=0.0000,rz=0.0000,tool=0,user=0,form=front";
        let rows = [
            ["TESTJOB-OF-THE-THIRD-CELL.JBI", "which synchronizes", "02:00:00:00:00:01 is up"],
            ["short", "SYNCHRONIZING", url],
            ["P2", list, "-"],
        ];
        let mut table = Table::new(&["name", "text", "where"], "");
        for row in &rows {
            table.row(row.map(Cell::from));
        }
        let fields = || rows.iter().flatten().map(|text| ("field", Cell::from(*text)));
        for width in 40..200 {
            for view in [View::table(table.clone()), View { sections: vec![Section::Fields(fields().collect())] }] {
                let shown = text(&view, width, false);
                for piece in rows.iter().flatten().flat_map(|cell| cell.split(' ')).flat_map(pieces) {
                    assert!(shown.contains(piece), "{width}: {piece}\n{shown}");
                }
                let is_long = |line: &&str| line.len() > usize::from(width).max(url.len() + 2);
                assert_eq!(shown.lines().find(is_long), None, "{width}:\n{shown}");
            }
        }
    }

    #[test]
    fn keeps_an_address_on_one_line() {
        let mut table = Table::new(&["robot", "target", "what it says"], "");
        let url = "profinet://cell-3@enp4s0?ip=192.168.1.5";
        table.row(["cell3".into(), url.into(), "word ".repeat(20).into()]);
        for width in [60, 70, 80] {
            assert!(text(&View::table(table.clone()), width, false).contains(url), "{width}");
        }
    }

    #[test]
    fn shows_a_narrow_table_as_a_list() {
        let mut table = Table::new(&["robot", "mode", "state"], "");
        table.row(["weld1".into(), "play".into(), "stopped".into()]);
        table.row(["weld2".into(), "auto".into(), "running".into()]);
        let text = |width| text(&View::table(table.clone()), width, false);
        assert_eq!(text(20), "ROBOT  MODE  STATE\nweld1  play  stopped\nweld2  auto  running\n");
        let list = "robot  weld1\nmode   play\nstate  stopped\n\nrobot  weld2\nmode   auto\nstate  running\n";
        assert_eq!(text(19), list);
    }

    #[test]
    fn fits_tables_to_the_width() {
        let view = View::fields([("text", Cell::from("word ".repeat(40)))]);
        assert!(text(&view, 80, false).lines().all(|line| line.chars().count() <= 80));
    }
}
