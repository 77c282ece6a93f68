//! Errors of EtherNet/IP connections.

use std::io;
use std::time::Duration;

use thiserror::Error;

use super::status;
use super::wire::{Status, WireError};
use crate::image::view::BusError;
use crate::local_error::LocalError;
use crate::plain;

/// An error of a request or connection.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum EipError {
    /// The host name has no address.
    #[error("cannot find host '{0}'")]
    NotFound(String),
    /// The host has no IPv4 address.
    #[error("'{0}' has no IPv4 address, but EtherNet/IP needs one")]
    NotIpv4(String),
    /// The TCP connection was refused or timed out.
    #[error("no TCP connection: {text}")]
    Unreachable {
        /// Kind of the system error.
        kind: io::ErrorKind,
        /// Text of the system error.
        text: String,
    },
    /// The TCP connection was closed before the answer.
    #[error("the TCP connection ended before the answer to {0}")]
    Hangup(&'static str),
    /// The device did not answer in time.
    #[error("no answer to {what} within {} ms", after.as_millis())]
    NoAnswer {
        /// Name of the request.
        what: &'static str,
        /// Time for which the client waited.
        after: Duration,
    },
    /// The device answered with an encapsulation error.
    #[error("{what} was refused: {} ({status:#04x})", status::encapsulation(*status).map_or("an unknown status", |code| code.name))]
    Encapsulation {
        /// Name of the request.
        what: &'static str,
        /// Encapsulation status.
        status: u32,
    },
    /// The device answered with a CIP error.
    #[error("{what} was refused: {}", status::describe(status))]
    Refused {
        /// Name of the request.
        what: &'static str,
        /// CIP status.
        status: Status,
    },
    /// The answer cannot be decoded.
    #[error("cannot decode the answer to {what}: {error}")]
    Malformed {
        /// Name of the request.
        what: &'static str,
        /// The wrong field, and what is wrong with it.
        error: WireError,
    },
    /// The answer can be decoded, but is not valid.
    #[error("invalid answer to {what}: {why}")]
    Senseless {
        /// Name of the request.
        what: &'static str,
        /// What is wrong with the answer.
        why: &'static str,
    },
    /// The device stopped sending its image, and the connection timed out.
    #[error("no image received for {} ms", .0.as_millis())]
    Silent(Duration),
    /// The connection was lost, and the caller has not noticed the loss yet: the image that it wants to send belongs to
    /// an older generation.
    #[error("the connection was lost")]
    Outdated,
    /// An assembly does not have the expected size.
    #[error("the input assembly has {found} bytes, not {expected}")]
    WrongSize {
        /// Size of the assembly in bytes.
        found: usize,
        /// Expected size in bytes.
        expected: u16,
    },
    /// The connection was closed by this program.
    #[error("the connection is closed")]
    Ended,
    /// A local socket failed.
    #[error(transparent)]
    Local(#[from] LocalError),
    /// The settings or the request are invalid; nothing was sent.
    #[error("{0}")]
    Impossible(String),
}

impl BusError for EipError {
    const OUTDATED: Self = Self::Outdated;
    const ENDED: Self = Self::Ended;
}

impl EipError {
    pub(super) fn unreachable(error: &io::Error) -> Self {
        Self::Unreachable { kind: error.kind(), text: plain(error).to_lowercase() }
    }

    /// Meaning and remedy of the status code in the error, if there is a code.
    pub fn code(&self) -> Option<&'static status::Code> {
        match self {
            Self::Encapsulation { status, .. } => status::encapsulation(*status),
            Self::Refused { status, .. } => status::meaning(status),
            _ => None,
        }
    }
}
