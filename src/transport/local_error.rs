//! Errors of local resources. They occur before anything reaches a network.

use std::io;

use thiserror::Error;

use crate::plain;

/// Failure of a local resource, such as a socket or thread.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{what}: {text}")]
pub struct LocalError {
    /// The action that failed.
    pub what: &'static str,
    /// Kind of the system error.
    pub kind: io::ErrorKind,
    /// Text of the system error.
    pub text: String,
}

impl LocalError {
    pub(crate) fn new(what: &'static str, error: &io::Error) -> Self {
        Self { what, kind: error.kind(), text: plain(error).to_lowercase() }
    }
}
