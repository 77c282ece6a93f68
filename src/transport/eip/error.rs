//! What can go wrong between an originator and a device.

use std::io;
use std::time::Duration;

use thiserror::Error;

use super::status;
use super::wire::{Status, WireError};
use crate::image::view::BusError;
use crate::local::LocalError;
use crate::plain;

/// Why something did not come about.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum EipError {
    /// No address belongs to the name.
    #[error("cannot find host '{host}'")]
    NotFound {
        /// The name.
        host: String,
    },
    /// The addresses are not IPv4.
    #[error("'{host}' has no IPv4 address, as EtherNet/IP needs")]
    NotIpv4 {
        /// The name.
        host: String,
    },
    /// Nobody listens there, or nobody is there.
    #[error("no TCP connection: {text}")]
    Unreachable {
        /// The system's reason.
        kind: io::ErrorKind,
        /// In its words.
        text: String,
    },
    /// The TCP connection ended before the answer.
    #[error("the TCP connection ended before {what} was answered")]
    Hangup {
        /// What had been asked.
        what: &'static str,
    },
    /// No answer in time.
    #[error("{what} was not answered within {} ms", after.as_millis())]
    NoAnswer {
        /// What had been asked.
        what: &'static str,
        /// How long was waited.
        after: Duration,
    },
    /// The encapsulation refused.
    #[error("{what} was refused: {} ({status:#04x})", status::encapsulation(*status).map_or("an unknown status", |code| code.name))]
    Encapsulation {
        /// What had been asked.
        what: &'static str,
        /// The status.
        status: u32,
    },
    /// The device refused.
    #[error("{what} was refused: {}", status::describe(status))]
    Refused {
        /// What had been asked.
        what: &'static str,
        /// The status.
        status: Status,
    },
    /// An answer that cannot be read.
    #[error("the answer to {what} cannot be read: {error}")]
    Malformed {
        /// What had been asked.
        what: &'static str,
        /// The field that is wrong.
        error: WireError,
    },
    /// An answer that can be read, and makes no sense.
    #[error("the answer to {what} makes no sense: {why}")]
    Senseless {
        /// What had been asked.
        what: &'static str,
        /// What is wrong with it.
        why: &'static str,
    },
    /// The device no longer sends its image.
    #[error("no image came for {} ms", after.as_millis())]
    Silent {
        /// How long was waited.
        after: Duration,
    },
    /// The image or the wish is for a connection that has ended meanwhile.
    #[error("the connection was lost meanwhile")]
    Outdated,
    /// An assembly that was read has another size than was expected.
    #[error("the input assembly has {found} bytes, not {expected}")]
    WrongSize {
        /// Its bytes.
        found: usize,
        /// What was expected.
        expected: u16,
    },
    /// The connection was closed here.
    #[error("the connection is closed")]
    Ended,
    /// A local socket did not work.
    #[error(transparent)]
    Local(#[from] LocalError),
    /// Something that cannot be, such as settings that no connection can have; nothing was sent.
    #[error("{0}")]
    Impossible(
        /// Why it cannot be.
        String,
    ),
}

impl BusError for EipError {
    const OUTDATED: Self = Self::Outdated;
    const ENDED: Self = Self::Ended;
}

impl EipError {
    pub(super) fn unreachable(error: &io::Error) -> Self {
        Self::Unreachable { kind: error.kind(), text: plain(error).to_lowercase() }
    }

    /// What the code in it means, and what to do about it.
    pub fn code(&self) -> Option<&'static status::Code> {
        match self {
            Self::Encapsulation { status, .. } => status::encapsulation(*status),
            Self::Refused { status, .. } => status::meaning(status),
            _ => None,
        }
    }
}
