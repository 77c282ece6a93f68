//! What can go wrong between a client and a controller, and a controller's "no".

use std::convert::Infallible;
use std::fmt;
use std::io;
use std::sync::Arc;
use std::time::Duration;

use armctl_controller::yerc::Model;
use armctl_controller::yerc::payload::PayloadError;
use armctl_controller::yerc::request::Request;
use armctl_controller::yerc::session::{Counters, DownloadEnd};
use armctl_controller::yerc::status;
use armctl_controller::yerc::wire::{Division, Status};
use armctl_transport::session::client::SessionBusy;
use thiserror::Error;

use crate::NotAuthorized;

/// Why there is no answer, or none to go on with.
#[derive(Debug, Clone, Error)]
#[non_exhaustive]
pub enum Error {
    /// The controller said no.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// Nobody answered a request that may be sent again without harm.
    #[error("no answer within {waited:?}")]
    NoAnswer {
        /// How long was waited.
        waited: Duration,
        /// What was seen meanwhile.
        counters: Counters,
    },
    /// Something answered, but not in this protocol.
    #[error("no answer of the protocol within {waited:?}, but {counters}")]
    Garbage {
        /// How long was waited.
        waited: Duration,
        /// What came instead.
        counters: Counters,
    },
    /// An answer that does not hold what was asked for.
    #[error("unexpected answer: {0}")]
    Unexpected(#[from] PayloadError),
    /// Nobody confirmed a request that changes something: it may or may not have been carried out. It was sent once.
    #[error("sent once, no answer within {waited:?}: it may or may not have been done")]
    OutcomeUnknown {
        /// What was sent.
        request: Request,
        /// How long was waited.
        waited: Duration,
        /// What was seen meanwhile.
        counters: Counters,
    },
    /// Nobody confirmed the stop, however often it was sent.
    #[error("the stop was sent again and again, no answer within {waited:?}: nothing tells that the robot is held")]
    Unconfirmed {
        /// How long was waited.
        waited: Duration,
    },
    /// The line went away after a request that changes something was sent, and before it was answered.
    #[error("{cause}; it was sent, and may or may not have been done")]
    CutShort {
        /// What was sent.
        request: Request,
        /// What happened then.
        cause: Box<Self>,
    },
    /// A file or list that did not come, or not whole.
    #[error("the transfer failed: {0:?}")]
    Incomplete(DownloadEnd),
    /// More than the client was granted.
    #[error(transparent)]
    NotAuthorized(#[from] NotAuthorized),
    /// The session that holds the line has ended, or somebody else has the line.
    #[error("{0}")]
    Session(SessionBusy),
    /// A name that is that of no host.
    #[error("cannot find host '{host}'")]
    HostNotFound {
        /// The name.
        host: String,
    },
    /// The socket has bad news.
    #[error("{error}")]
    Io {
        /// The controller's port; `None` where a session has the socket.
        port: Option<u16>,
        /// The news.
        #[source]
        error: Arc<io::Error>,
    },
    /// The controller does not tell what it is, and what was to be asked depends on it. Nothing else was sent.
    #[error("the controller did not tell its model: it refused {}: {}", .0.to, status::explain(.0.status).name)]
    ModelRefused(Refusal),
    /// Its software is that of no known model, and what was to be asked depends on it. Nothing else was sent.
    #[error("the system software '{version}' is of no model that armctl knows")]
    UnknownSoftware {
        /// Its version, with what is no letter escaped.
        version: String,
    },
    /// It refused what the model takes that it was another time, and is another one now.
    #[error("it was a {remembered}, and is a {found} now, which refused this")]
    AnotherModel {
        /// What it was taken for.
        remembered: Model,
        /// What it says that it is.
        found: Model,
    },
    /// A dry run sends nothing, and so has no answer.
    #[error("a dry run has no answer")]
    NotKnown,
}

impl Error {
    /// Whether something answered that made no sense.
    pub fn is_malformed(&self) -> bool {
        matches!(self, Self::Garbage { .. } | Self::Unexpected(_))
    }

    /// Whether there is no contact with the controller, or none any more.
    pub fn is_silence(&self) -> bool {
        match self {
            Self::NoAnswer { .. } | Self::HostNotFound { .. } | Self::Io { .. } => true,
            Self::Session(busy) => matches!(busy, SessionBusy::Ended(_) | SessionBusy::Busy(_)),
            _ => false,
        }
    }
}

/// A controller's "no".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("the controller refused {to}: {}", status::explain(*.status).name)]
pub struct Refusal {
    /// Why.
    pub status: Status,
    /// To what.
    pub to: Asked,
}

impl Refusal {
    /// Of a request to the file server.
    pub const fn of_file(service: u8, status: Status) -> Self {
        Self { status, to: Asked::File(service) }
    }
}

/// What a controller said no to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Asked {
    /// A request to the robot server.
    Robot {
        /// Its command number.
        command: u16,
        /// Which of the things the command addresses.
        instance: u16,
    },
    /// A request to the file server, by its service.
    File(u8),
}

impl From<&Request> for Asked {
    fn from(request: &Request) -> Self {
        match request.division() {
            Division::Robot => Self::Robot { command: request.command, instance: request.instance },
            Division::File => Self::File(request.service),
        }
    }
}

impl fmt::Display for Asked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Robot { command, instance } => write!(f, "0x{command:02X} (instance {instance})"),
            Self::File(service) => write!(f, "file service 0x{service:02X}"),
        }
    }
}

/// How a transfer broke off.
#[derive(Debug, Clone)]
pub struct TransferError<E> {
    /// What had left or come by then. Of a file that is sent the controller may hold a part, or all.
    pub bytes: u64,
    /// Why.
    pub cause: Cause<E>,
}

/// Who ended a transfer.
#[derive(Debug, Clone)]
pub enum Cause<E> {
    /// The line, or the controller.
    Client(Error),
    /// Whoever reads or writes the file here.
    Caller(E),
}

impl<E> From<Error> for TransferError<E> {
    fn from(error: Error) -> Self {
        Self { bytes: 0, cause: Cause::Client(error) }
    }
}

impl<E> From<NotAuthorized> for TransferError<E> {
    fn from(error: NotAuthorized) -> Self {
        Error::from(error).into()
    }
}

impl<E> From<Error> for Cause<E> {
    fn from(error: Error) -> Self {
        Self::Client(error)
    }
}

/// Where nothing is read or written here, only the line can fail.
impl From<Cause<Infallible>> for Error {
    fn from(cause: Cause<Infallible>) -> Self {
        match cause {
            Cause::Client(error) => error,
            Cause::Caller(never) => match never {},
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_a_sentence() {
        let request = Request { command: 0x7A, instance: 300, attribute: 1, service: 0x0E, data: Vec::new() };
        let refused = Error::from(Refusal { status: Status::refused(0xA001), to: Asked::from(&request) });
        assert!(refused.to_string().starts_with("the controller refused 0x7A (instance 300): "), "{refused}");
        let waited = Duration::from_secs(3);
        let unknown = Error::OutcomeUnknown { request: request.clone(), waited, counters: Counters::default() };
        assert_eq!(unknown.to_string(), "sent once, no answer within 3s: it may or may not have been done");
        let ended = Error::Session(SessionBusy::Ended("the session is gone".to_owned()));
        assert!(ended.is_silence() && !ended.is_malformed());
        let cut = Error::CutShort { request, cause: Box::new(ended) };
        assert_eq!(cut.to_string(), "the session is gone; it was sent, and may or may not have been done");
    }
}
