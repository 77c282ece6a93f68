//! Values of a request, and the reply.

use super::io::Port;
use super::memory::index;
use crate::toyo::field::Value;
use crate::toyo::layout::Record;

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Reply {
    /// The answer is `@OK`.
    Done,
    /// Values of the answer, and the index of their answer form.
    Data(usize, Vec<Value>),
}

/// Values of a request, all in range.
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
