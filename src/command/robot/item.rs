//! Items: whatever is read or written by a name, such as variables, counters, ports, signals, points and parameters.
//!
//! Reads report `items[]` with `name`, `label`, `kind`, `ok`, `value` and, of one that failed, `error`; writes also `old`,
//! `new` and `written`. Each item answers for itself.

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::Report;
use crate::command::frame::items::{ItemError, verdict};
use crate::failure::Failure;
use crate::output::csv::RowsOf;
use crate::output::view::{Cell, Table, View};

/// Nothing beside what every item has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, JsonSchema)]
pub struct Plain {}

/// One thing that was read: what it is and what it holds.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Item<V, M = Plain> {
    /// As it can be typed: `B5`, `CN05`, `19`.
    pub name: String,
    /// What people call it; null where it has no name.
    pub label: Option<String>,
    /// What it is: `variable`, `counter`, `point`, `signal`.
    pub kind: &'static str,
    /// What the family adds.
    #[serde(flatten)]
    pub more: M,
    /// Whether the controller answered.
    pub ok: bool,
    /// What it holds; null where that is not defined, or was not read.
    pub value: Option<V>,
    /// Why it was not read.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ItemError")]
    pub error: Option<ItemError>,
    /// What a table shows of it.
    #[serde(skip)]
    pub cells: Vec<Cell>,
}

impl<V> Item<V> {
    /// An item and what it holds, or why that was not read.
    pub fn new(kind: &'static str, name: impl Into<String>, outcome: Result<Option<V>, Failure>) -> Self {
        Self::with(kind, name, Plain {}, outcome)
    }
}

impl<V, M> Item<V, M> {
    /// The same with what the family adds.
    pub fn with(kind: &'static str, name: impl Into<String>, more: M, outcome: Result<Option<V>, Failure>) -> Self {
        let name = name.into();
        let (ok, value, error) = match outcome {
            Ok(value) => (true, value, None),
            Err(failure) => (false, None, Some(ItemError::new(asked(kind, &name), failure))),
        };
        Self { name, label: None, kind, more, ok, value, error, cells: Vec::new() }
    }

    /// With what a table shows of its value.
    #[must_use]
    pub fn shown(mut self, cells: impl Fn(&V) -> Vec<Cell>) -> Self {
        self.cells.extend(self.value.iter().flat_map(cells));
        self
    }

    /// With the name that people gave it.
    #[must_use]
    pub fn labelled(self, label: Option<String>) -> Self {
        Self { label, ..self }
    }
}

/// An item in messages: `point 19`, and `B5` where the name says what it is.
pub fn asked(kind: &str, name: &str) -> String {
    if name.starts_with(|c: char| c.is_ascii_digit()) { format!("{kind} {name}") } else { name.to_owned() }
}

/// How items look in a table.
#[derive(Debug, Clone, Default)]
pub struct Columns {
    /// Heading of the names: `counter`.
    pub name: &'static str,
    /// Headings of the cells.
    pub values: Vec<&'static str>,
    /// Shown where there are none.
    pub empty: &'static str,
}

/// Items in the order in which they were asked for.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Items<V, M = Plain> {
    /// Each answers for itself.
    pub items: Vec<Item<V, M>>,
    /// How many of them were asked for: the table ends with these.
    #[serde(skip)]
    asked: usize,
    #[serde(skip)]
    columns: Columns,
}

impl<V, M> Items<V, M> {
    /// Items with the headings of their table.
    pub fn new(columns: Columns, items: Vec<Item<V, M>>) -> Self {
        Self { asked: items.len(), items, columns }
    }

    /// The same where the controller was asked only for the first ones, as the others would fail alike.
    #[must_use]
    pub fn asked(self, asked: usize) -> Self {
        Self { asked, ..self }
    }

    /// Fails where there is a single item and it was not read: there is no report then.
    pub fn or_only_failure(self) -> Result<Self, Failure> {
        match &self.items[..] {
            [Item { error: Some(error), .. }] => Err(error.failure()),
            _ => Ok(self),
        }
    }

    /// Why items were not read.
    pub fn errors(&self) -> impl Iterator<Item = &ItemError> {
        self.items.iter().filter_map(|item| item.error.as_ref())
    }
}

/// A table of items: name, label, cells, and an error where one failed.
fn table<'i, V: 'i, M: 'i>(
    Columns { name, values, empty }: &Columns,
    items: impl Iterator<Item = &'i Item<V, M>> + Clone,
) -> Table {
    let has_errors = items.clone().any(|item| item.error.is_some());
    let columns = [*name, "label"].into_iter().chain(values.iter().copied());
    let columns: Vec<_> = columns.chain(has_errors.then_some("error")).collect();
    let row = |item: &Item<V, M>| {
        let mut row = vec![numeric(&item.name), Cell::maybe(item.label.as_deref())];
        row.extend(item.cells.iter().cloned());
        row.resize_with(2 + values.len(), || "-".into());
        row.extend(has_errors.then(|| item.error.as_ref().map_or_else(|| "-".into(), ItemError::cell)));
        row
    };
    Table { rows: items.map(row).collect(), columns, empty }.without_blank("label")
}

/// A name, to the right where it is a number.
fn numeric(name: &str) -> Cell {
    if name.bytes().all(|byte| byte.is_ascii_digit()) { Cell::number(name) } else { name.into() }
}

impl<V: Serialize + JsonSchema, M: Serialize + JsonSchema> Report for Items<V, M> {
    fn view(&self) -> View {
        View::table(table(&self.columns, self.items.iter().take(self.asked)))
    }

    fn failure(&self) -> Option<Failure> {
        let failure = verdict(self.items.len(), self.errors())?;
        Some(match self.items.len() - self.asked.min(self.items.len()) {
            0 => failure,
            rest => Failure { message: format!("{}; {rest} were not asked for", failure.message), ..failure },
        })
    }

    fn rows(&self) -> RowsOf {
        RowsOf::List("items")
    }
}

/// One thing that a command wrote.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Written<V, M = Plain> {
    /// The item with what it holds now.
    #[serde(flatten)]
    pub item: Item<V, M>,
    /// What it held; null where that is not known, or was not defined.
    pub old: Option<V>,
    /// What it holds now; null where that is not known.
    pub new: Option<V>,
    /// Whether it was written; false where it held that already, or the write failed.
    pub written: bool,
}

/// Things that a command wrote.
#[derive(Debug, Serialize, JsonSchema)]
pub struct WrittenItems<V, M = Plain> {
    /// Each answers for itself.
    pub items: Vec<Written<V, M>>,
    #[serde(skip)]
    words: Option<String>,
    #[serde(skip)]
    columns: Columns,
}

impl<V, M> WrittenItems<V, M> {
    /// What was written, with the headings of a table.
    pub fn new(columns: Columns, items: Vec<Written<V, M>>) -> Self {
        Self { items, words: None, columns }
    }

    /// What was written, said in a sentence.
    pub fn said(words: impl Into<String>, items: Vec<Written<V, M>>) -> Self {
        Self { items, words: Some(words.into()), columns: Columns::default() }
    }
}

impl<V, M> WrittenItems<V, M> {
    /// Fails where there is a single item and it was not written: there is no report then.
    pub fn or_only_failure(self) -> Result<Self, Failure> {
        match &self.items[..] {
            [Written { item: Item { error: Some(error), .. }, .. }] => Err(error.failure()),
            _ => Ok(self),
        }
    }
}

impl<V: Clone, M> Written<V, M> {
    /// An item that now holds `new`.
    pub fn new(item: Item<V, M>, old: Option<V>, written: bool) -> Self {
        let new = item.value.clone();
        Self { item, old, new, written }
    }
}

impl<V: Serialize + JsonSchema, M: Serialize + JsonSchema> Report for WrittenItems<V, M> {
    fn view(&self) -> View {
        match &self.words {
            Some(words) => View::text(words.clone()),
            None => View::table(table(&self.columns, self.items.iter().map(|written| &written.item))),
        }
    }

    fn failure(&self) -> Option<Failure> {
        verdict(self.items.len(), self.items.iter().filter_map(|written| written.item.error.as_ref()))
    }

    fn rows(&self) -> RowsOf {
        RowsOf::List("items")
    }
}
