//! Common arguments and reports of commands that set a value.

use serde_json::Map;

use crate::face::shared_commands::CommonReport;
use crate::prelude::basics::*;
use crate::robot::item::{Item, Written, WrittenItems};

/// Purpose of a read before a write, as a dry run shows it.
pub const OLD_VALUE: &str = "old value";
/// Condition for a write, as a dry run shows it.
pub const IF_DIFFERENT: &str = "whether the old value differs from the new value";

/// Adds to a failure that nothing was written.
pub fn nothing_written(failure: Failure) -> Failure {
    let message = format!("{}; nothing was written", failure.message.trim_end_matches('.'));
    Failure { message, ..failure }
}

/// Old value of a write: null if the value was not read, or if the controller refused to report it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct Old(Value);

impl Old {
    /// The value was not read: there is no request that reads it, the action has no value, or the command must not wait
    /// for an answer.
    pub const UNREAD: Self = Self(Value::Null);

    /// Old value; `None` if the controller refused to report it.
    pub fn read(value: Option<impl Into<Value>>) -> Self {
        Self(value.map_or(Value::Null, Into::into))
    }

    /// The value; `None` if it is unknown.
    pub fn value(&self) -> Option<Value> {
        Some(self.0.clone()).filter(|value| !value.is_null())
    }

    /// Value as text; `None` if it is unknown.
    pub fn describe(&self) -> Option<String> {
        (!self.0.is_null()).then(|| shown(&self.0))
    }
}

/// A value that was set. It becomes a report only together with its old value, so that no command omits the old value.
#[derive(Debug)]
pub struct NewValue {
    name: String,
    arguments: Map<String, Value>,
    new: Value,
    text: String,
}

impl NewValue {
    /// Creates a new value from its name, its JSON value, and its text.
    pub fn of(set: impl Into<String>, new: impl Into<Value>, words: impl Into<String>) -> Self {
        Self { name: set.into(), arguments: Map::new(), new: new.into(), text: words.into() }
    }

    /// Adds a number or a name to the report. A null value is not added.
    #[must_use]
    pub fn with(mut self, name: &str, value: impl Into<Value>) -> Self {
        let value = value.into();
        if !value.is_null() {
            self.arguments.insert(name.to_owned(), value);
        }
        self
    }

    /// Question about the change: the intent, and the old and new value if the old value was read.
    pub fn question(&self, intent: String, old: &Old) -> Change {
        let change = Change::new(intent);
        let what = self.name.trim_end_matches("_on").replace('_', " ");
        match old.describe() {
            Some(old) => change.replaces(&what, &old, &shown(&self.new)),
            None => change,
        }
    }

    /// Adds the old value, for an item that can be read and written by its name.
    pub fn into_item(self, kind: &'static str, old: &Old) -> WrittenItems<Value> {
        let item = Item::new(kind, self.name, Ok(Some(self.new)));
        WrittenItems::describe(self.text, vec![Written::new(item, old.value(), true)])
    }

    /// Adds the old value and returns the report.
    pub fn replaces(self, old: Old) -> SetReport {
        let Self { name: set, arguments: with, new, text: words } = self;
        SetReport { set, with, old, new, words }
    }
}

/// Result of a set command: `{"set":"B0","old":1,"new":5}`. JSON contains the values, the view is a sentence.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SetReport {
    /// Name of the value, as read commands report it, for example `servo_on`.
    set: String,
    /// Index and other arguments of the command: numbers and names.
    #[serde(flatten)]
    with: Map<String, Value>,
    old: Old,
    /// New value.
    new: Value,
    #[serde(skip)]
    words: String,
}

impl SetReport {
    /// Text of the result.
    pub fn words(&self) -> &str {
        &self.words
    }
}

impl CommonReport for SetReport {
    type Core = Self;

    fn core(&self) -> Self {
        self.clone()
    }
}

impl Report for SetReport {
    fn view(&self) -> View {
        View::text(self.words.clone())
    }
}

/// Value as text.
fn shown(value: &Value) -> String {
    match value {
        Value::Bool(on) => if *on { "on" } else { "off" }.to_owned(),
        Value::String(text) => text.clone(),
        value => value.to_string(),
    }
}

/// Converts a typed number to JSON; null if the text is not a number.
pub fn number(text: &str) -> Value {
    let whole = text.parse::<i64>().map(Value::from);
    whole.unwrap_or_else(|_| text.parse::<f64>().map_or(Value::Null, Value::from))
}

/// On or off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Switch {
    /// Switch on
    On,
    /// Switch off
    Off,
}
