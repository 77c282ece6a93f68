//! Signals: common keys of `io get|set|list|watch` in every family, and of `armctl io`.

use crate::items::{ItemError, all_failed, verdict};
use crate::prelude::basics::*;
use crate::watch::Watched;

/// Location of the watched items for `io watch` of every family.
pub const WATCHED: Watched =
    Watched { list: "items", name: "name", prefix: "", label: "meaning", value: Some("value"), empty: "no signals" };

/// Selection of signals for `io list`.
#[derive(Debug, Clone, Copy, Args)]
pub struct Filter {
    /// Only inputs
    #[arg(long, conflicts_with = "out")]
    r#in: bool,
    /// Only outputs
    #[arg(long)]
    out: bool,
    /// Also signals that are off and have no name
    #[arg(long)]
    off: bool,
}

impl Filter {
    /// Whether signals of this kind are selected.
    pub fn has(self, kind: IoKind) -> bool {
        match (self.r#in, self.out) {
            (true, _) => kind == IoKind::Input,
            (_, true) => kind == IoKind::Output,
            _ => true,
        }
    }

    /// Equivalent command-line words.
    pub fn words(self) -> Vec<String> {
        let flags = [(self.r#in, "--in"), (self.out, "--out"), (self.off, "--off")];
        flags.into_iter().filter(|(is_given, _)| *is_given).map(|(_, flag)| flag.to_owned()).collect()
    }

    /// Whether a signal is listed: it is on, has a name, could not be read, or all are listed.
    pub fn lists(self, row: &IoRow) -> bool {
        let is_off = matches!(row.value, Some(IoValue::State(false)));
        self.has(row.item.kind) && (self.off || !is_off || row.item.label.is_some())
    }
}

/// Side that sets a signal, or type of a group.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum IoKind {
    /// An input of the controller.
    Input,
    /// An output of the controller.
    Output,
    /// A signal inside the controller.
    Internal,
    /// A group of eight signals (yerc).
    Group,
    /// A word (yrcx).
    Word,
}

/// A signal, or several signals as a number.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct IoItem {
    /// Name that can be typed: `#20010`, `servo-on`, `IN1.3`.
    pub name: String,
    /// Name in `robots.toml` or on the controller; null if there is none.
    pub label: Option<String>,
    /// Side that sets the signal.
    pub kind: IoKind,
    /// Notation of the controller's manuals: `#20010`, `SO(02)`, `PN01.3`.
    pub address: String,
    /// Meaning: `external input` (yerc), `servo on` (yrcx); null if it is not fixed.
    pub meaning: Option<String>,
}

/// Value of one or several signals.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum IoValue {
    /// On or off.
    State(bool),
    /// Unsigned number.
    Number(u32),
}

impl IoValue {
    fn cell(self) -> Cell {
        match self {
            Self::State(on) => Cell::switch(on),
            Self::Number(number) => Cell::from(format!("{number} ({number:#04x})")),
        }
    }
}

/// Value of a signal, or the reason why it was not read.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct IoRow {
    /// Signal.
    #[serde(flatten)]
    pub item: IoItem,
    /// Whether the signal was read.
    ok: bool,
    /// Value; null if the signal was not read.
    value: Option<IoValue>,
    /// Reason why the signal was not read.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ItemError")]
    error: Option<ItemError>,
}

impl IoRow {
    /// Result of a read.
    pub fn new(item: IoItem, outcome: Result<IoValue>) -> Self {
        match outcome {
            Ok(value) => Self { item, ok: true, value: Some(value), error: None },
            Err(failure) => {
                let error = Some(ItemError::new(item.name.as_str(), failure));
                Self { item, ok: false, value: None, error }
            }
        }
    }

    /// Result of a read of a single signal.
    pub fn state(item: IoItem, outcome: Result<bool>) -> Self {
        Self::new(item, outcome.map(IoValue::State))
    }

    fn cells(&self) -> [Cell; 4] {
        let value = match (&self.value, &self.error) {
            (Some(value), None) => value.cell(),
            (_, Some(error)) => error.cell(),
            (None, None) => "-".into(),
        };
        let IoItem { name, label, meaning, .. } = &self.item;
        [name.as_str().into(), Cell::optional(label.as_deref()), value, Cell::optional(meaning.as_deref())]
    }
}

/// Report of `io get` and `io list`.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Signals {
    items: Vec<IoRow>,
}

impl Signals {
    /// Report of these rows.
    ///
    /// # Errors
    /// If no signal was read, for the same reason.
    pub fn new(items: Vec<IoRow>) -> Result<Self> {
        all_failed(items.len(), items.iter().filter_map(|row| row.error.as_ref()))?;
        Ok(Self { items })
    }
}

impl Report for Signals {
    fn view(&self) -> View {
        let mut table = Table::new(&["signal", "label", "value", "meaning"], "no signals");
        self.items.iter().for_each(|row| table.row(row.cells()));
        View::table(table.without_blank("label").without_blank("meaning"))
    }

    fn failure(&self) -> Option<Failure> {
        verdict(self.items.len(), self.items.iter().filter_map(|row| row.error.as_ref()))
    }
}

/// A signal that was written.
#[derive(Debug, Serialize, JsonSchema)]
pub struct WrittenSignal {
    /// Value read back, or the written value if it cannot be read.
    #[serde(flatten)]
    row: IoRow,
    /// Old value; null if it was not read.
    old: Option<IoValue>,
    /// New value.
    new: IoValue,
    /// Whether the signal was written.
    written: bool,
}

impl WrittenSignal {
    /// Result of an accepted write.
    pub fn new(item: IoItem, old: Option<IoValue>, new: IoValue) -> Self {
        Self::with_outcome(item, old, new, Ok(true))
    }

    /// Result of a write that succeeded, or failed for this reason.
    pub fn with_outcome(item: IoItem, old: Option<IoValue>, new: IoValue, outcome: Result<bool>) -> Self {
        let written = outcome == Ok(true);
        Self { row: IoRow::new(item, outcome.map(|_| new)), old, new, written }
    }

    /// Result of a write with a different value read back.
    #[must_use]
    pub fn with_error(mut self, value: IoValue, failure: Failure) -> Self {
        (self.row.ok, self.row.value) = (false, Some(value));
        self.row.error = Some(ItemError::new(self.row.item.name.as_str(), failure));
        self
    }
}

/// Report of `io set`.
#[derive(Debug, Serialize, JsonSchema)]
pub struct WrittenSignals {
    items: Vec<WrittenSignal>,
}

impl WrittenSignals {
    /// Report in the order typed.
    pub fn new(items: Vec<WrittenSignal>) -> Self {
        Self { items }
    }

    /// The report, unless all signals failed for the same reason.
    pub fn unless_all_failed(self) -> Result<Self> {
        all_failed(self.items.len(), self.errors())?;
        Ok(self)
    }

    fn errors(&self) -> impl Iterator<Item = &ItemError> {
        self.items.iter().filter_map(|written| written.row.error.as_ref())
    }
}

impl Report for WrittenSignals {
    fn view(&self) -> View {
        let mut table = Table::new(&["signal", "label", "old", "new", "meaning"], "no signals");
        for WrittenSignal { row, old, new, .. } in &self.items {
            let [name, label, read, meaning] = row.cells();
            let new = if row.ok { new.cell() } else { read.tone(Tone::Bad) };
            table.row([name, label, Cell::optional(old.map(IoValue::cell)), new, meaning]);
        }
        View::table(table.without_blank("label").without_blank("old").without_blank("meaning"))
    }

    fn failure(&self) -> Option<Failure> {
        verdict(self.items.len(), self.errors())
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    fn item(label: Option<&str>) -> IoItem {
        let (name, address) = ("IN1.3".to_owned(), "PN01.3".to_owned());
        IoItem { name, label: label.map(ToOwned::to_owned), kind: IoKind::Input, address, meaning: None }
    }

    #[test]
    fn every_row_has_every_key() {
        let read = serde_json::to_value(IoRow::state(item(None), Ok(true))).unwrap();
        let expected = json!({"name": "IN1.3", "label": null, "kind": "input", "address": "PN01.3", "meaning": null, "ok": true, "value": true});
        assert_eq!(read, expected);
        let refused = IoRow::state(item(None), Err(Failure::new(Kind::Refused, "no")));
        let refused = serde_json::to_value(refused).unwrap();
        assert_eq!(
            (&refused["ok"], &refused["value"], &refused["error"]["asked"]),
            (&json!(false), &json!(null), &json!("IN1.3"))
        );
        let set = WrittenSignal::new(item(None), Some(IoValue::State(false)), IoValue::State(true));
        let set = serde_json::to_value(set).unwrap();
        assert_eq!(
            (&set["value"], &set["old"], &set["new"], &set["written"]),
            (&json!(true), &json!(false), &json!(true), &json!(true))
        );
    }

    #[test]
    fn lists_active_or_named_signals() {
        let usual = Filter { r#in: false, out: false, off: false };
        let lists = |filter: Filter, label, on| filter.lists(&IoRow::state(item(label), Ok(on)));
        assert!(lists(usual, None, true) && lists(usual, Some("clamp"), false) && !lists(usual, None, false));
        assert!(lists(Filter { off: true, ..usual }, None, false) && !lists(Filter { out: true, ..usual }, None, true));
    }
}
