//! What orders of every family report and take.

use clap::ValueEnum;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};

use super::report::Report;
use crate::command::face::shared::Alike;
use crate::failure::Failure;
use crate::gate::Change;
use crate::output::view::View;

/// What a read before a write is for, in a dry run.
pub const BEFORE: &str = "the value before";

/// What failed before anything was written.
pub fn unwritten(failure: Failure) -> Failure {
    let message = format!("{}; nothing was written", failure.message.trim_end_matches('.'));
    Failure { message, ..failure }
}

/// A value before a write: null where nobody asked, or where the controller refused to tell.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct Old(Value);

impl Old {
    /// Nobody asked: no request reads it, it is an event and no value, or the order must not wait for an answer.
    pub const UNREAD: Self = Self(Value::Null);

    /// As it was read; nothing where it was not told.
    pub fn read(value: Option<impl Into<Value>>) -> Self {
        Self(value.map_or(Value::Null, Into::into))
    }

    /// The value, where it is known.
    pub fn value(&self) -> Option<Value> {
        Some(self.0.clone()).filter(|value| !value.is_null())
    }

    /// As a person reads it; nothing where it is not known.
    pub fn in_words(&self) -> Option<String> {
        (!self.0.is_null()).then(|| shown(&self.0))
    }
}

/// What was set, and to what. Only with what it was before, it is a report: no command forgets to say that.
#[derive(Debug)]
pub struct New {
    set: String,
    with: Map<String, Value>,
    new: Value,
    words: String,
}

impl New {
    /// What was set to which value; the same in words.
    pub fn of(set: impl Into<String>, new: impl Into<Value>, words: impl Into<String>) -> Self {
        Self { set: set.into(), with: Map::new(), new: new.into(), words: words.into() }
    }

    /// With a number or a name that belongs to it; nothing where there is none.
    #[must_use]
    pub fn with(mut self, name: &str, value: impl Into<Value>) -> Self {
        let value = value.into();
        if !value.is_null() {
            self.with.insert(name.to_owned(), value);
        }
        self
    }

    /// What is asked before it is set: what that will do, and old and new where old was read.
    pub fn question(&self, intent: String, old: &Old) -> Change {
        let change = Change::new(intent);
        let what = self.set.trim_end_matches("_on").replace('_', " ");
        match old.in_words() {
            Some(old) => change.replaces(&what, &old, &shown(&self.new)),
            None => change,
        }
    }

    /// With its value before.
    pub fn replaces(self, old: Old) -> Done {
        let Self { set, with, new, words } = self;
        Done { set, with, old, new, words }
    }
}

/// One thing that the controller accepted: `{"set":"B0","old":1,"new":5}`. Programs get values, people a sentence.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Done {
    /// What was set, by the name that reads give it: `servo_on`.
    set: String,
    /// Which one of several it is, and what else was given: numbers and names.
    #[serde(flatten)]
    with: Map<String, Value>,
    old: Old,
    /// Its value now.
    new: Value,
    #[serde(skip)]
    words: String,
}

impl Done {
    /// What was set, for people.
    pub fn words(&self) -> &str {
        &self.words
    }
}

impl Alike for Done {
    type Core = Self;

    fn core(&self) -> Self {
        self.clone()
    }
}

impl Report for Done {
    fn view(&self) -> View {
        View::text(self.words.clone())
    }
}

/// One of several things that a command wrote, as reads tell it, with what it held and what it holds.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Written<T> {
    /// Which one.
    #[serde(flatten)]
    pub item: T,
    old: Old,
    /// Its value now.
    new: Value,
    /// True: it was written.
    written: bool,
}

impl<T> Written<T> {
    /// With its value before and now.
    pub fn new(item: T, old: Old, new: impl Into<Value>) -> Self {
        Self { item, old, new: new.into(), written: true }
    }
}

/// A value as a person reads it.
fn shown(value: &Value) -> String {
    match value {
        Value::Bool(on) => if *on { "on" } else { "off" }.to_owned(),
        Value::String(text) => text.clone(),
        value => value.to_string(),
    }
}

/// A number as it was typed and accepted; null where it is none.
pub fn number(text: &str) -> Value {
    let whole = text.parse::<i64>().map(Value::from);
    whole.unwrap_or_else(|_| text.parse::<f64>().map_or(Value::Null, Value::from))
}

/// On or off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Switch {
    /// Switch it on
    On,
    /// Switch it off
    Off,
}
