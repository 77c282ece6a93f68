//! Result of a remote command.

use serde_json::Value as Json;

use crate::prelude::basics::*;
use armctl_client::yrcx;

/// Result of a command.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CommandResult {
    /// Values of the answer.
    pub values: Values,
    /// Time from the first transmission of the command to the end of the command.
    pub elapsed: Duration,
    /// Overwritten data, if any.
    pub replaced: Option<ReplacedRow>,
    /// Old value, if the command sets a value.
    pub old: Old,
}

impl From<yrcx::CompletedCommand> for CommandResult {
    fn from(yrcx::CompletedCommand { values, elapsed }: yrcx::CompletedCommand) -> Self {
        Self { values, elapsed, replaced: None, old: Old::UNREAD }
    }
}

/// A row that a command overwrites, with its old and new value.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ReplacedRow {
    pub kind: &'static str,
    pub name: String,
    /// Old value and new value; `None` if the row was not defined, or if the new value is not known in advance.
    pub values: [Option<Json>; 2],
    /// Whether the old and the new value are equal, so that no write is necessary.
    pub is_unchanged: bool,
}
