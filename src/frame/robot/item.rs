//! Items: data that is read or written by name, such as variables, counters, ports, signals, points and parameters.
//!
//! Reads report `items[]` with `name`, `label`, `kind`, `ok`, `value` and, after a failure, `error`. Writes also
//! report `old`, `new` and `written`. Each item has its own result.

use crate::items::{ItemError, verdict};
use crate::prelude::basics::*;

/// No family-specific fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, JsonSchema)]
pub struct Plain {}

/// An item that was read.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Item<V, M = Plain> {
    /// Name that can be typed: `B5`, `CN05`, `19`.
    pub name: String,
    /// User name; null if there is none.
    pub label: Option<String>,
    /// Kind: `variable`, `counter`, `point`, `signal`.
    pub kind: &'static str,
    /// Family-specific fields.
    #[serde(flatten)]
    pub more: M,
    /// Whether the controller answered.
    pub ok: bool,
    /// Value; null if it is undefined or was not read.
    pub value: Option<V>,
    /// Reason why it was not read.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ItemError")]
    pub error: Option<ItemError>,
    /// Table cells.
    #[serde(skip)]
    pub cells: Vec<Cell>,
}

impl<V> Item<V> {
    /// Item with its value, or the reason why it was not read.
    pub fn new(kind: &'static str, name: impl Into<String>, outcome: Result<Option<V>>) -> Self {
        Self::with(kind, name, Plain {}, outcome)
    }
}

impl<V, M> Item<V, M> {
    /// Item with family-specific fields.
    pub fn with(kind: &'static str, name: impl Into<String>, more: M, outcome: Result<Option<V>>) -> Self {
        let name = name.into();
        let (ok, value, error) = match outcome {
            Ok(value) => (true, value, None),
            Err(failure) => (false, None, Some(ItemError::new(as_requested(kind, &name), failure))),
        };
        Self { name, label: None, kind, more, ok, value, error, cells: Vec::new() }
    }

    /// Adds the table cells of its value.
    #[must_use]
    pub fn with_cells(mut self, cells: impl Fn(&V) -> Vec<Cell>) -> Self {
        self.cells.extend(self.value.iter().flat_map(cells));
        self
    }

    /// Adds the user name.
    #[must_use]
    pub fn labelled(self, label: Option<String>) -> Self {
        Self { label, ..self }
    }
}

/// Name of an item in messages: `point 19`, or `B5` if the name implies the kind.
pub fn as_requested(kind: &str, name: &str) -> String {
    if name.starts_with(|c: char| c.is_ascii_digit()) { format!("{kind} {name}") } else { name.to_owned() }
}

/// Table layout of items.
#[derive(Debug, Clone, Default)]
pub struct Columns {
    /// Heading of the names: `counter`.
    pub name: &'static str,
    /// Headings of the cells.
    pub values: Vec<&'static str>,
    /// Text for an empty table.
    pub empty: &'static str,
}

/// Items in the order requested.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Items<V, M = Plain> {
    /// Items, each with its own result.
    pub items: Vec<Item<V, M>>,
    /// Number of requested items; the table has only these.
    #[serde(skip)]
    asked: usize,
    /// Reasons why items that were read have no value; used only if no item has a value.
    #[serde(skip)]
    undefined: Vec<ItemError>,
    #[serde(skip)]
    columns: Columns,
}

impl<V, M> Items<V, M> {
    /// Items with the headings of their table.
    pub fn new(columns: Columns, items: Vec<Item<V, M>>) -> Self {
        Self { asked: items.len(), items, undefined: Vec::new(), columns }
    }

    /// Sets the number of requested items, if the other items were not read because they would fail in the same way.
    #[must_use]
    pub fn asked(self, asked: usize) -> Self {
        Self { asked, ..self }
    }

    /// Sets the reasons why items have no value. If no item has a value, the command fails with these reasons.
    #[must_use]
    pub fn undefined(self, undefined: Vec<ItemError>) -> Self {
        Self { undefined, ..self }
    }

    /// The failure, if there is only one item and it was not read.
    pub fn single_failure(self) -> Result<Self> {
        match &self.items[..] {
            [Item { error: Some(error), .. }] => Err(error.failure()),
            _ => Ok(self),
        }
    }

    /// Errors of items that were not read.
    pub fn errors(&self) -> impl Iterator<Item = &ItemError> {
        self.items.iter().filter_map(|item| item.error.as_ref())
    }
}

/// Table of items: name, label, cells, and errors.
fn table<'i, V: 'i, M: 'i>(columns: &Columns, items: impl Iterator<Item = &'i Item<V, M>> + Clone) -> Table {
    let has_errors = items.clone().any(|item| item.error.is_some());
    let last = |item: &Item<V, M>| item.error.as_ref().map_or_else(|| "-".into(), ItemError::cell);
    let rows = items.map(|item| (item, item.cells.clone(), has_errors.then(|| last(item))));
    rows_table(columns, has_errors.then_some("error"), rows)
}

/// Table of items. Each row has the cells of the item, and a cell of the last column if the table has one.
fn rows_table<'i, V: 'i, M: 'i>(
    Columns { name, values, empty }: &Columns,
    last: Option<&'static str>,
    rows: impl Iterator<Item = (&'i Item<V, M>, Vec<Cell>, Option<Cell>)>,
) -> Table {
    let columns = [*name, "label"].into_iter().chain(values.iter().copied()).chain(last);
    let row = |(item, cells, last): (&Item<V, M>, Vec<Cell>, Option<Cell>)| {
        let mut row = vec![numeric(&item.name), Cell::optional(item.label.as_deref())];
        row.extend(cells);
        row.resize_with(2 + values.len(), || "-".into());
        row.extend(last);
        row
    };
    Table { columns: columns.collect(), rows: rows.map(row).collect(), empty }.without_blank("label")
}

/// Name cell, right-aligned if it is a number.
fn numeric(name: &str) -> Cell {
    if name.bytes().all(|byte| byte.is_ascii_digit()) { Cell::number(name) } else { name.into() }
}

impl<V: Serialize + JsonSchema, M: Serialize + JsonSchema> Report for Items<V, M> {
    const ROWS: RowsOf = RowsOf::List("items");

    fn view(&self) -> View {
        View::table(table(&self.columns, self.items.iter().take(self.asked)))
    }

    fn failure(&self) -> Option<Failure> {
        let is_empty = self.items.iter().all(|item| item.value.is_none());
        let failure = verdict(self.items.len(), self.errors().chain(self.undefined.iter().filter(|_| is_empty)))?;
        Some(match self.items.len() - self.asked.min(self.items.len()) {
            0 => failure,
            rest => Failure { message: format!("{}; {rest} were not read", failure.message), ..failure },
        })
    }
}

/// An item that was written.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Written<V, M = Plain> {
    /// Item with its new value.
    #[serde(flatten)]
    pub item: Item<V, M>,
    /// Old value; null if it is unknown or was undefined.
    pub old: Option<V>,
    /// New value; null if it is unknown.
    pub new: Option<V>,
    /// Whether it was written; false if the value was equal, or after a failure.
    pub written: bool,
    /// Table cells of the old value.
    #[serde(skip)]
    pub old_cells: Vec<Cell>,
}

/// If more rows than this are unchanged, a table has only their number.
const MANY_UNCHANGED: usize = 8;

/// Items that were written.
#[derive(Debug, Serialize, JsonSchema)]
pub struct WrittenItems<V, M = Plain> {
    /// Items, each with its own result.
    pub items: Vec<Written<V, M>>,
    #[serde(skip)]
    words: Option<String>,
    #[serde(skip)]
    columns: Columns,
}

impl<V, M> WrittenItems<V, M> {
    /// Report with a table.
    pub fn new(columns: Columns, items: Vec<Written<V, M>>) -> Self {
        Self { items, words: None, columns }
    }

    /// Report with a sentence.
    pub fn describe(words: impl Into<String>, items: Vec<Written<V, M>>) -> Self {
        Self { items, words: Some(words.into()), columns: Columns::default() }
    }
}

impl<V, M> WrittenItems<V, M> {
    /// The failure, if there is only one item and it was not written.
    pub fn or_only_failure(self) -> Result<Self> {
        match &self.items[..] {
            [Written { item: Item { error: Some(error), .. }, .. }] => Err(error.failure()),
            _ => Ok(self),
        }
    }
}

impl<V: Clone, M> Written<V, M> {
    /// Item with the new value.
    pub fn new(item: Item<V, M>, old: Option<V>, written: bool) -> Self {
        let new = item.value.clone();
        Self { item, old, new, written, old_cells: Vec::new() }
    }
}

impl<V, M> Written<V, M> {
    /// Adds the table cells of the old value.
    #[must_use]
    pub fn with_old_cells(self, old_cells: Vec<Cell>) -> Self {
        Self { old_cells, ..self }
    }

    /// Table cells of the change. If a value was written, its cell contains the old and the new value.
    fn change_cells(&self) -> Vec<Cell> {
        let cell = |(at, new): (usize, &Cell)| match self.old_cells.get(at) {
            Some(old) if self.written && old.text != new.text => {
                let [old, text] = [old, new].map(|cell| if cell.text.is_empty() { "\"\"" } else { &cell.text });
                Cell { text: format!("{old} -> {text}"), ..new.clone() }
            }
            _ => new.clone(),
        };
        self.item.cells.iter().enumerate().map(cell).collect()
    }

    fn is_unchanged(&self) -> bool {
        self.item.error.is_none() && !self.written
    }

    fn result_cell(&self) -> Cell {
        match &self.item.error {
            Some(error) => error.cell(),
            None if self.written => "written".into(),
            None => "unchanged".into(),
        }
    }
}

impl<V: Serialize + JsonSchema, M: Serialize + JsonSchema> Report for WrittenItems<V, M> {
    const ROWS: RowsOf = RowsOf::List("items");

    fn view(&self) -> View {
        if let Some(words) = &self.words {
            return View::text(words.clone());
        }
        let unchanged = self.items.iter().filter(|row| row.is_unchanged()).count();
        let is_shown = |row: &&Written<V, M>| unchanged <= MANY_UNCHANGED || !row.is_unchanged();
        let rows = self.items.iter().filter(is_shown);
        let rows = rows.map(|row| (&row.item, row.change_cells(), Some(row.result_cell())));
        let table = rows_table(&self.columns, Some("result"), rows);
        if unchanged <= MANY_UNCHANGED {
            return View::table(table);
        }
        let words = format!("{unchanged} unchanged");
        if table.rows.is_empty() { View::text(words) } else { View::table(table).append(Section::Text(words)) }
    }

    fn failure(&self) -> Option<Failure> {
        verdict(self.items.len(), self.items.iter().filter_map(|written| written.item.error.as_ref()))
    }
}
