//! Errors of a client, and the refusal of a controller.

use std::fmt;
use std::io;
use std::sync::Arc;
use std::time::Duration;

use armctl_controller::toyo::request::{BlockError, Request};
use armctl_controller::toyo::session::Counters;
use armctl_transport::serial::OpenError;
use armctl_transport::session::client::SessionBusy;
use armctl_transport::tcp::ConnectError;
use thiserror::Error;

use crate::NotAuthorized;

/// Why a request has no usable answer.
///
/// ```
/// use armctl_client::toyo::{Client, Command, Endpoint, Error, Options, Refusal, Request, Start, Unanswered};
/// use armctl_client::Risk;
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let start = Box::new(Start::parse("pendant = true")?);
/// let endpoint = Endpoint::Simulator { start, baud: None, faults: None };
/// let mut robot = Client::connect(endpoint, Options::default().with_risk(Risk::Motion)).await?;
/// match robot.ask(&Request::bare(Command::Home)).await {
///     Err(Error::PendantOn) => println!("switch the teach pendant off"),
///     Err(Error::Refused(Refusal(request))) => println!("refused: {}", request.text()),
///     Err(Error::OutcomeUnknown(unanswered)) => {
///         let Unanswered { request, waited, .. } = *unanswered;
///         println!("no answer to {request:?} within {waited:?}: the axes may move");
///     }
///     other => println!("{other:?}"),
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Error)]
#[non_exhaustive]
pub enum Error {
    /// The controller refused (`@NG`).
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The controller refused (`@NG`) a status or position request. A controller refuses these requests only while it
    /// is busy.
    #[error("the controller refused to report its status (@NG)")]
    StatusRefused,
    /// The host has no control: the teach pendant is ON (TO 2-2).
    #[error("the controller refused: the teach pendant is ON, so the host cannot take control")]
    PendantOn,
    /// A read received no valid answer.
    #[error("{0}")]
    NoAnswer(Box<Unanswered>),
    /// An order received no valid answer: the controller may or may not have carried out the order. The order was sent
    /// once.
    #[error("the command was sent, and may or may not have been carried out: {0}")]
    OutcomeUnknown(Box<Unanswered>),
    /// The line was lost after an order was sent and before its answer arrived.
    #[error("{0}; the command was sent, and may or may not have been carried out")]
    LostAfterSending(Box<Self>),
    /// An order was not sent, because the check of the line before the order failed.
    #[error("the command was not sent: {0}")]
    NotSent(Box<Self>),
    /// An answer without the requested content.
    #[error("unexpected answer '{block}': {why}")]
    Malformed {
        /// The received block.
        block: String,
        /// What is wrong with the block.
        why: String,
    },
    /// The client received more characters in one exchange than a controller sends.
    #[error("received {received} characters, but no answer")]
    TooMuchData {
        /// Characters received.
        received: usize,
    },
    /// A request contains a value out of range. Nothing was sent.
    #[error("{0}")]
    InvalidRequest(#[from] BlockError),
    /// A temporary change was not undone.
    #[error("armctl could not undo a temporary change: {block} failed: {}", why(.cause.as_deref()))]
    NotUndone {
        /// The block that undoes the change.
        block: String,
        /// The cause; `None` if the controller refused to undo the change.
        cause: Option<Box<Self>>,
    },
    /// The host is still ON, and this client had switched the host ON. The cause is `None` if the controller refused.
    #[error("armctl switched host control ON, but could not switch it OFF again: {}", why(.0.as_deref()))]
    HostNotReleased(Option<Box<Self>>),
    /// The robot still moves after a stop.
    #[error("the controller {}", stop_answer(*.is_refused))]
    StillMoving {
        /// Whether the controller refused the stop.
        is_refused: bool,
    },
    /// No answer confirms that the robot stands still.
    #[error("armctl cannot confirm that the robot stands still: {0}")]
    StopUnconfirmed(Box<Self>),
    /// The risk of the request is higher than the authorized risk. Nothing was sent.
    #[error(transparent)]
    NotAuthorized(#[from] NotAuthorized),
    /// The session on the line has ended, or another client uses the line.
    #[error("{0}")]
    Session(SessionBusy),
    /// A serial port that cannot be opened.
    #[error("{path}: {error}")]
    Port {
        /// Path of the port.
        path: String,
        /// The cause.
        #[source]
        error: Arc<OpenError>,
    },
    /// A device server that does not accept a connection.
    #[error("{host}, TCP port {port}: {error}")]
    DeviceServer {
        /// Host name or address of the device server.
        host: String,
        /// TCP port of the device server.
        port: u16,
        /// The cause.
        #[source]
        error: Arc<ConnectError>,
    },
    /// The line was lost, and the client could not open the line again.
    #[error(transparent)]
    NotReopened(Box<Self>),
    /// The caller's function that reopens the line failed.
    #[error("{0}")]
    Opener(Arc<dyn std::error::Error + Send + Sync>),
    /// An I/O error of the line: the adapter was unplugged, the peer closed the connection, or the line is broken.
    #[error("{error}")]
    Io {
        /// Whether a session holds the line.
        is_shared: bool,
        /// The cause.
        #[source]
        error: Arc<io::Error>,
    },
    /// A dry run sends nothing and has no answer.
    #[error("a dry run has no answer")]
    DryRun,
}

const fn stop_answer(is_refused: bool) -> &'static str {
    if is_refused { "refuses to stop (@NG)" } else { "answered @OK, but the robot still moves" }
}

fn why(cause: Option<&Error>) -> String {
    cause.map_or("@NG".to_owned(), ToString::to_string)
}

impl Error {
    /// Whether invalid data was received.
    pub fn is_malformed(&self) -> bool {
        match self {
            Self::Malformed { .. } | Self::TooMuchData { .. } => true,
            Self::NoAnswer(unanswered) => unanswered.invalid_answer.is_some(),
            _ => false,
        }
    }
}

/// A refusal (`@NG`) of a request. The protocol has no refusal codes.
///
/// Example: [`enum@Error`]
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the controller refused {} (@NG)", .0.text().trim_start_matches('@'))]
pub struct Refusal(pub Request);

/// Details of a missing answer.
///
/// Example: [`enum@Error`]
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unanswered {
    /// The request; `None` for a free-text block.
    pub request: Option<Request>,
    /// Time limit of each attempt.
    pub waited: Duration,
    /// Line counters so far.
    pub counters: Counters,
    /// The last received block that is not the answer, and the reason why the block is not the answer.
    pub invalid_answer: Option<(String, String)>,
}

impl fmt::Display for Unanswered {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Counters { received, noise, echoes, .. } = self.counters;
        match &self.invalid_answer {
            Some((block, why)) => write!(f, "unexpected answer '{block}': {why}")?,
            None if received == echoes && echoes > 0 => f.write_str("received only an echo of the sent bytes")?,
            None if received == 0 && noise > 0 => write!(f, "no answer, but {noise} stray characters")?,
            None => write!(f, "no answer within {:.1?}", self.waited)?,
        }
        self.request.as_ref().map_or(Ok(()), |request| write!(f, " ({})", request.text()))
    }
}

#[cfg(test)]
mod tests {
    use armctl_controller::toyo::table::Command;

    use super::*;

    #[test]
    fn each_error_has_a_readable_message() {
        let counters = Counters { sent: 4, ..Counters::default() };
        let request = Some(Request::bare(Command::Mpst));
        let silence = Unanswered { request, waited: Duration::from_secs(1), counters, invalid_answer: None };
        let no_answer = Error::NoAnswer(Box::new(silence.clone()));
        assert_eq!(no_answer.to_string(), "no answer within 1.0s (@MPST)");
        let invalid_answer = Some(("@M".to_owned(), "unknown command 'M'".to_owned()));
        let noise = Unanswered { counters: Counters { noise: 7, ..counters }, request: None, ..silence };
        assert_eq!(noise.to_string(), "no answer, but 7 stray characters");
        let malformed = Error::NoAnswer(Box::new(Unanswered { invalid_answer, ..noise }));
        assert!(malformed.is_malformed() && !no_answer.is_malformed());
        assert_eq!(malformed.to_string(), "unexpected answer '@M': unknown command 'M'");
        let message = Error::HostNotReleased(None).to_string();
        assert_eq!(message, "armctl switched host control ON, but could not switch it OFF again: @NG");
        let refusal = Error::from(Refusal(Request::bare(Command::Home)));
        assert_eq!(refusal.to_string(), "the controller refused HOME (@NG)");
        let unseen = Error::StopUnconfirmed(Box::new(Error::StatusRefused)).to_string();
        assert!(
            unseen.starts_with("armctl cannot confirm that the robot stands still: the controller refused"),
            "{unseen}"
        );
    }
}
