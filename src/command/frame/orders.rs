//! What orders of every family report and take.

use clap::ValueEnum;
use schemars::JsonSchema;
use serde::Serialize;

use super::report::Report;
use crate::output::view::View;

/// What the controller accepted.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Done {
    /// In words.
    done: String,
}

impl Done {
    /// In words.
    pub fn new(done: impl Into<String>) -> Self {
        Self { done: done.into() }
    }
}

impl Report for Done {
    fn view(&self) -> View {
        View::text(self.done.clone())
    }
}

/// On or off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Switch {
    /// Switch it on
    On,
    /// Switch it off
    Off,
}
