//! What orders of every family report and take.

use clap::ValueEnum;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};

use super::report::Report;
use crate::output::view::View;

/// One thing that the controller accepted: `{"set":"B0","old":1,"new":5}`. Programs get values, people a sentence.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Done {
    /// What was set, by the name that reads give it: `servo_on`.
    set: String,
    /// Which one of several it is, and what else was given: numbers and names.
    #[serde(flatten)]
    with: Map<String, Value>,
    /// Its value before; null where the controller was not asked.
    old: Value,
    /// Its value now.
    new: Value,
    #[serde(skip)]
    words: String,
}

impl Done {
    /// What was set to which value; the same in words.
    pub fn new(set: impl Into<String>, new: impl Into<Value>, words: impl Into<String>) -> Self {
        Self { set: set.into(), with: Map::new(), old: Value::Null, new: new.into(), words: words.into() }
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

    /// With its value before.
    #[must_use]
    pub fn replaces(mut self, old: impl Into<Value>) -> Self {
        self.old = old.into();
        self
    }

    /// What was set, for people.
    pub fn words(&self) -> &str {
        &self.words
    }
}

impl Report for Done {
    fn view(&self) -> View {
        View::text(self.words.clone())
    }
}

/// Several things that one command set.
#[derive(Debug, Serialize, JsonSchema)]
pub struct AllDone {
    items: Vec<Done>,
    #[serde(skip)]
    words: String,
}

impl AllDone {
    /// What was set; all of it in words.
    pub fn new(items: Vec<Done>, words: impl Into<String>) -> Self {
        Self { items, words: words.into() }
    }
}

impl Report for AllDone {
    fn view(&self) -> View {
        View::text(self.words.clone())
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
