//! Values of a command and what it is answered.

use super::io::Port;
use super::memory::index;
use crate::toyo::field::Value;
use crate::toyo::layout::Record;

/// What a command is answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Reply {
    /// `@OK`.
    Done,
    /// Values in a form of the answer.
    Data(usize, Vec<Value>),
}

/// The values of a request, which are all in range.
pub(super) struct Fields<'a>(pub(super) &'a Record);

impl Fields<'_> {
    pub(super) fn number(&self, name: &str) -> i32 {
        self.0.number(name).unwrap_or_default()
    }

    pub(super) fn index(&self, name: &str) -> usize {
        index(self.number(name))
    }

    pub(super) fn word(&self, name: &str) -> &'static str {
        self.0.word(name).unwrap_or_default()
    }

    pub(super) fn port(&self) -> Port {
        Port { station: self.index("station"), port: self.index("port") }
    }
}
