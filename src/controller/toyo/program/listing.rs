//! Listing of a controller's program as text. [`check`](super::check) can parse this text.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use super::instruction::is_tag;
use crate::names::Names;
use crate::toyo::layout::Record;
use crate::toyo::names;
use crate::toyo::table::{Op, Parameter};

/// Table rows by table id and number, for comments.
pub type Rows = BTreeMap<(&'static str, i32), Record>;

/// Text of a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Listing {
    /// One step per line, with line ends.
    pub text: String,
    /// Number of omitted NOPs at the end.
    pub left_out: usize,
}

/// Format of a listing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Style {
    /// Number of the first step.
    pub first: usize,
    /// Whether the listing contains the whole program. NOPs at its end are then omitted, because no step follows them.
    pub is_whole: bool,
    /// Whether lines begin with step numbers.
    pub is_numbered: bool,
}

/// Comment after a step that is not in the manual. The step is kept as received.
pub const NOT_IN_MANUAL: &str = "not in the manual";

/// Instruction fields that refer to a table row, with the table id.
const TABLES: [(&str, &str); 5] =
    [("point", "T1"), ("speed", "T2"), ("ramp", "T3"), ("group", "T4.S1"), ("table", "T5")];

/// The table rows to which steps refer. [`listing`] shows them in comments.
pub fn uses(steps: &[Record]) -> BTreeSet<(&'static str, i32)> {
    steps.iter().flat_map(rows_of).map(|(_, key)| key).collect()
}

/// Placeholder of a step that was not read. It is not an instruction, so the text is not a valid program.
pub const NOT_READ: &str = "?";

/// Why steps were not read, by the index of the step. The record of each of these steps is [`not_read`].
pub type Unread = BTreeMap<usize, String>;

/// Record of a step that was not read.
pub fn not_read() -> Record {
    Record::unlisted(NOT_READ)
}

/// Formats steps that were all read.
pub fn listing(steps: &[Record], style: Style, rows: &Rows) -> Listing {
    listing_with(steps, &Unread::new(), style, rows)
}

/// Formats a program of which some steps were not read. The header and a comment at each of these steps report this.
pub fn listing_with(steps: &[Record], unread: &Unread, style: Style, rows: &Rows) -> Listing {
    listing_named(steps, unread, style, rows, &Names::default())
}

/// Formats steps, with the names of points, counters and timers in comments.
pub fn listing_named(steps: &[Record], unread: &Unread, style: Style, rows: &Rows, known: &Names) -> Listing {
    let Style { first, is_whole, is_numbered } = style;
    let used = used(steps).max(steps.len().min(1));
    let end = if is_whole { used } else { steps.len() };
    let (listed, left_out) = (&steps[..end], steps.len() - end);
    let texts: Vec<String> = listed.iter().map(Record::written).collect();
    let width = texts.iter().map(String::len).max().unwrap_or_default();
    let tags = tags(listed, first);
    let mut text = String::new();
    if !unread.is_empty() {
        let _ = writeln!(text, "# INCOMPLETE: {} of {} steps were not read", unread.len(), steps.len());
    }
    for (index, (record, own)) in listed.iter().zip(&texts).enumerate() {
        if let Some(why) = unread.get(&index) {
            // Consecutive steps that were not read for the same reason have one comment.
            if index.checked_sub(1).and_then(|before| unread.get(&before)) != Some(why) {
                let last = (index..end).take_while(|index| unread.get(index) == Some(why)).last().unwrap_or(index);
                let _ = match (index + first, last + first) {
                    (one, last) if one == last => writeln!(text, "{NOT_READ}  # step {one} was not read: {why}"),
                    (one, last) => writeln!(text, "{NOT_READ}  # steps {one} to {last} were not read: {why}"),
                };
            }
            continue;
        }
        if is_numbered {
            let _ = write!(text, "{:04}  ", index + first);
        }
        text.push_str(own);
        let comments = comments(record, &tags, rows, known);
        if !comments.is_empty() {
            let _ = write!(text, "{:pad$}  # {}", "", comments.join("; "), pad = width - own.len());
        }
        text.push('\n');
    }
    if left_out > 0 {
        let _ = writeln!(text, "# {left_out} NOP at the end of the program are omitted");
    }
    Listing { text, left_out }
}

/// Comments about the objects that an instruction uses.
fn comments(record: &Record, tags: &BTreeMap<i32, usize>, rows: &Rows, known: &Names) -> Vec<String> {
    if !record.is_listed() {
        return vec![NOT_IN_MANUAL.to_owned()];
    }
    let jumps = record.layout() != Op::Tag.row().layout;
    let named = record.pairs().filter(|(field, _)| jumps && is_tag(field));
    let steps = named.filter_map(|(field, _)| {
        let tag = record.number(field.name)?;
        Some(format!("{} {tag:03} is step {}", field.name, tags.get(&tag)?))
    });
    let rows = rows_of(record).filter_map(|(name, key)| {
        let row = rows.get(&key)?;
        Some(format!("{name} {}: {}", key.1, values_of(key.0, row)))
    });
    steps.chain(labels(record, known)).chain(rows).collect()
}

/// Names of the points, counters and timers of an instruction, for example `point 1 is pick`.
fn labels(record: &Record, known: &Names) -> impl Iterator<Item = String> {
    record.pairs().filter_map(|(field, _)| {
        let (kind, _) = names::of_field(field.name)?;
        let number = record.number(field.name)?;
        let label = known.label(kind, &names::address_of(kind, number)?)?;
        Some(format!("{} {number} is {label}", field.name))
    })
}

/// The table rows that an instruction uses. Row 0 is not a row of a table.
fn rows_of(record: &Record) -> impl Iterator<Item = (&'static str, (&'static str, i32))> {
    TABLES.iter().filter_map(|(name, id)| {
        let row = record.number(name).filter(|row| *row > 0)?;
        Some((*name, (*id, row)))
    })
}

/// The values of a row, without its number.
fn values_of(id: &str, row: &Record) -> String {
    let own = Parameter::named(id).map_or(0, |parameter| parameter.key.fields.len());
    let values = row.pairs().skip(own).map(|(field, value)| {
        let meaning = field.meaning(value);
        if row.pairs().count() == own + 1 { meaning.into_owned() } else { format!("{} {meaning}", field.name) }
    });
    values.collect::<Vec<_>>().join(", ")
}

/// Number of steps up to the last that is not a NOP.
pub fn used(steps: &[Record]) -> usize {
    let is_nop = |record: &Record| record.layout() == Op::Nop.row().layout;
    steps.iter().rposition(|record| !is_nop(record)).map_or(0, |last| last + 1)
}

/// Step number of each tag, counted from `first`. If a tag is defined twice, the first definition counts.
pub fn tags(steps: &[Record], first: usize) -> BTreeMap<i32, usize> {
    let mut tags = BTreeMap::new();
    for (index, record) in steps.iter().enumerate().filter(|(_, record)| record.layout() == Op::Tag.row().layout) {
        if let Some(tag) = record.number("tag") {
            tags.entry(tag).or_insert(index + first);
        }
    }
    tags
}
