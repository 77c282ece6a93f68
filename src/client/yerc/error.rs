//! Errors of a client, and the refusal of a controller.

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
use armctl_controller::yerc::wire::{Division, MAX_DATA, Status};
use armctl_transport::session::client::SessionBusy;
use thiserror::Error;

use crate::NotAuthorized;

/// Why a request has no usable answer.
///
/// ```
/// use armctl_client::yerc::{Client, Endpoint, Error, FileName, Model, Options, Refusal, RefusedRequest};
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut robot = Client::connect(Endpoint::simulator(Model::Dx200), Options::auto()).await?;
/// match robot.read_file(&FileName::new("NOSUCH.JBI")?).await {
///     Ok(job) => println!("{} bytes", job.len()),
///     Err(Error::Refused(Refusal { status, to: RefusedRequest::File(_) })) => println!("refused: {status:?}"),
///     Err(Error::OutcomeUnknown { .. } | Error::CutShort { .. }) => unreachable!("a read changes nothing"),
///     Err(error) => return Err(error.into()),
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Error)]
#[non_exhaustive]
pub enum Error {
    /// The controller refused.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// No answer to a request. The request can be repeated without harm.
    #[error("no answer within {waited:?}")]
    NoAnswer {
        /// Total waiting time.
        waited: Duration,
        /// Counters of what was received instead of an answer.
        counters: Counters,
    },
    /// Data was received, but it contained no valid frame.
    #[error("no valid answer within {waited:?}, but {counters}")]
    Garbage {
        /// Total waiting time.
        waited: Duration,
        /// Counters of what was received instead of an answer.
        counters: Counters,
    },
    /// An answer without the requested content.
    #[error("unexpected answer: {0}")]
    Unexpected(#[from] PayloadError),
    /// No answer to a change: the controller may or may not have carried out the change. The change was sent once.
    #[error("no answer within {waited:?}: the command was sent once, and may or may not have been carried out")]
    OutcomeUnknown {
        /// The request.
        request: Request,
        /// Total waiting time.
        waited: Duration,
        /// Counters of what was received instead of an answer.
        counters: Counters,
    },
    /// No answer to the stop, although the client sent the stop repeatedly.
    #[error("no answer to the repeated stop within {waited:?}: armctl cannot confirm that the robot is held")]
    Unconfirmed {
        /// Total waiting time.
        waited: Duration,
    },
    /// The link was lost after a change was sent and before its answer arrived.
    #[error("{cause}; the command was sent, and may or may not have been carried out")]
    CutShort {
        /// The request.
        request: Request,
        /// The error of the link.
        cause: Box<Self>,
    },
    /// A file or list that was not received completely.
    #[error("the transfer failed: {0:?}")]
    Incomplete(DownloadEnd),
    /// The risk of the request is higher than the authorized risk. Nothing was sent.
    #[error(transparent)]
    NotAuthorized(#[from] NotAuthorized),
    /// The session on the link has ended, or another client uses the link.
    #[error("{0}")]
    Session(SessionBusy),
    /// A host name that cannot be resolved.
    #[error("cannot find host '{host}'")]
    HostNotFound {
        /// The host name.
        host: String,
    },
    /// An I/O error of the socket.
    #[error("{error}")]
    Io {
        /// Port of the controller; `None` if a session owns the socket.
        port: Option<u16>,
        /// The cause.
        #[source]
        error: Arc<io::Error>,
    },
    /// The controller refused to report its model. The request depends on the model and was not sent.
    #[error("the controller did not report its model: it refused {}: {}", .0.to, status::explain(.0.status).name)]
    ModelRefused(Refusal),
    /// The software version belongs to no known model. The request depends on the model and was not sent.
    #[error("armctl does not support the system software '{version}' of this controller")]
    UnknownSoftware {
        /// Software version, with unusual characters escaped.
        version: String,
    },
    /// The controller is not the model that the client remembers from an earlier connection. The controller refused a
    /// request that the remembered model accepts.
    #[error("the controller was a {remembered} and is now a {found}, which refused this request")]
    AnotherModel {
        /// The remembered model.
        remembered: Model,
        /// The model that the controller reports.
        found: Model,
    },
    /// A request with more data than a frame can have. Nothing was sent.
    #[error("the request has {bytes} bytes of data; a frame can have at most {MAX_DATA}")]
    TooLarge {
        /// Size of the data.
        bytes: usize,
    },
    /// A dry run sends nothing and has no answer.
    #[error("a dry run has no answer")]
    DryRun,
}

impl Error {
    /// Whether invalid data was received.
    pub fn is_malformed(&self) -> bool {
        matches!(self, Self::Garbage { .. } | Self::Unexpected(_))
    }

    /// Whether there is no connection to the controller, or the connection was lost.
    pub fn is_silence(&self) -> bool {
        match self {
            Self::NoAnswer { .. } | Self::HostNotFound { .. } | Self::Io { .. } => true,
            Self::Session(busy) => matches!(busy, SessionBusy::Ended(_) | SessionBusy::Busy(_)),
            _ => false,
        }
    }
}

/// A refusal of a controller.
///
/// Example: [`enum@Error`]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("the controller refused {to}: {}", status::explain(*.status).name)]
pub struct Refusal {
    /// Error status.
    pub status: Status,
    /// The refused request.
    pub to: RefusedRequest,
}

impl Refusal {
    /// A refusal of a file request.
    pub const fn of_file(service: u8, status: Status) -> Self {
        Self { status, to: RefusedRequest::File(service) }
    }
}

/// Identification of a refused request.
///
/// Example: [`enum@Error`]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RefusedRequest {
    /// A request to the robot server.
    Robot {
        /// Command number.
        command: u16,
        /// Instance.
        instance: u16,
    },
    /// A request to the file server, by its service.
    File(u8),
}

impl From<&Request> for RefusedRequest {
    fn from(request: &Request) -> Self {
        match request.division() {
            Division::Robot => Self::Robot { command: request.command, instance: request.instance },
            Division::File => Self::File(request.service),
        }
    }
}

impl fmt::Display for RefusedRequest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Robot { command, instance } => write!(f, "0x{command:02X} (instance {instance})"),
            Self::File(service) => write!(f, "file service 0x{service:02X}"),
        }
    }
}

/// The end of a transfer that did not complete.
///
/// ```
/// use armctl_client::yerc::{Cause, Client, Endpoint, FileName, Model, Options, TransferError};
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut robot = Client::connect(Endpoint::simulator(Model::Dx200), Options::auto()).await?;
/// let request = FileName::new("TESTJOB.JBI")?.save();
/// let full = |_: &[u8]| Err("the disk is full");
/// match robot.download(&request, 1_000_000, None, full).await {
///     Err(TransferError { cause: Cause::Caller(why), bytes }) => println!("{why} after {bytes} bytes"),
///     Err(TransferError { cause: Cause::Client(error), .. }) => return Err(error.into()),
///     Ok(end) => panic!("{end:?}"),
/// }
/// robot.close().await?; // ends the transfer at the controller
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct TransferError<E> {
    /// Bytes sent or received before the end. After an upload, the controller may have stored a part of the file, or
    /// all of it.
    pub bytes: u64,
    /// The cause.
    pub cause: Cause<E>,
}

/// The side that caused the end of a transfer.
///
/// Example: [`TransferError`]
#[derive(Debug, Clone)]
pub enum Cause<E> {
    /// The link or the controller.
    Client(Error),
    /// The caller's function that reads or writes the file.
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

/// A transfer without a function of the caller can fail only because of the link or the controller.
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
        let refused = Error::from(Refusal { status: Status::refused(0xA001), to: RefusedRequest::from(&request) });
        assert!(refused.to_string().starts_with("the controller refused 0x7A (instance 300): "), "{refused}");
        let waited = Duration::from_secs(3);
        let unknown = Error::OutcomeUnknown { request: request.clone(), waited, counters: Counters::default() };
        assert_eq!(
            unknown.to_string(),
            "no answer within 3s: the command was sent once, and may or may not have been carried out"
        );
        let ended = Error::Session(SessionBusy::Ended("the session is gone".to_owned()));
        assert!(ended.is_silence() && !ended.is_malformed());
        let cut = Error::CutShort { request, cause: Box::new(ended) };
        assert_eq!(
            cut.to_string(),
            "the session is gone; the command was sent, and may or may not have been carried out"
        );
    }
}
