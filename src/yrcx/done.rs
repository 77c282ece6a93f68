//! Result of a remote command.

use std::time::Duration;

use serde_json::Value as Json;

use armctl_client::yrcx;
use armctl_controller::yrcx::value::Values;
use armctl_frame::settings_report::Old;

/// Result of a command.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Done {
    /// Values of the answer.
    pub values: Values,
    /// Time from the first transmission of the command to its end.
    pub elapsed: Duration,
    /// Overwritten data, if any.
    pub replaced: Option<Replaced>,
    /// Old value, for a command that sets one.
    pub old: Old,
}

impl From<yrcx::Done> for Done {
    fn from(yrcx::Done { values, elapsed }: yrcx::Done) -> Self {
        Self { values, elapsed, replaced: None, old: Old::UNREAD }
    }
}

/// Overwritten row and its replacement.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Replaced {
    pub kind: &'static str,
    pub name: String,
    /// Old and new value; none if not defined, or not known in advance.
    pub values: [Option<Json>; 2],
    /// Whether old and new are equal, so that no write is necessary.
    pub is_there: bool,
}
