//! What goes wrong on this machine, before anything reaches a network.

use std::io;

use thiserror::Error;

use crate::plain;

/// Something of this machine, such as a socket or a thread, that did not work.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{what}: {text}")]
pub struct LocalError {
    /// What was tried.
    pub what: &'static str,
    /// The system's reason.
    pub kind: io::ErrorKind,
    /// In its words.
    pub text: String,
}

impl LocalError {
    pub(crate) fn new(what: &'static str, error: &io::Error) -> Self {
        Self { what, kind: error.kind(), text: plain(error).to_lowercase() }
    }
}
