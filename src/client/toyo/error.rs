//! What can go wrong between a client and a controller, and a controller's "no".

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

/// Why there is no answer, or none to go on with.
#[derive(Debug, Clone, Error)]
#[non_exhaustive]
pub enum Error {
    /// The controller said no (`@NG`).
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// Not even the status or the position is told (`@NG`): the controller is busy.
    #[error("the controller refuses even to tell its status (@NG)")]
    Mute,
    /// The host cannot command: the teach pendant is ON (TO 2-2).
    #[error("the controller refused: the teach pendant is ON, and the host cannot take over")]
    PendantOn,
    /// A question has no answer, or none that fits.
    #[error("{0}")]
    NoAnswer(Box<Unanswered>),
    /// An order has no answer, or none that fits: it may or may not have been carried out. It was sent once.
    #[error("the order was sent, but whether it was carried out is unknown: {0}")]
    OutcomeUnknown(Box<Unanswered>),
    /// The line went away after an order was sent, and before it was answered.
    #[error("{0}; whether the order was carried out is unknown")]
    CutShort(Box<Self>),
    /// An order was not sent, as the line was not at peace before it.
    #[error("the order was not sent: {0}")]
    NotSent(Box<Self>),
    /// An answer that does not hold what was asked for.
    #[error("unexpected answer '{block}': {why}")]
    Malformed {
        /// The answer.
        block: String,
        /// What is wrong with it.
        why: String,
    },
    /// More characters came in one exchange than a controller sends.
    #[error("{received} characters came, and no answer among them")]
    Flooded {
        /// How many were read.
        received: usize,
    },
    /// A request with a value out of its range; nothing was sent.
    #[error("{0}")]
    Unsendable(#[from] BlockError),
    /// What was changed for a while is not put back.
    #[error("what was changed for a while was not put back by {block}: {}", why(.cause.as_deref()))]
    NotPutBack {
        /// The block that puts it back.
        block: String,
        /// Why; `None` where the controller refused.
        cause: Option<Box<Self>>,
    },
    /// The host is ON, which was OFF before.
    #[error("the host was switched ON and could not be switched OFF again: {}", why(.0.as_deref()))]
    HostKept(Option<Box<Self>>),
    /// What should stop moves on.
    #[error("the controller {}", if *.is_refused { "refuses to stop (@NG)" } else { "moves on although it said @OK" })]
    MovesOn {
        /// Whether it said no to the stop.
        is_refused: bool,
    },
    /// Nothing tells that what should stop stands.
    #[error("nothing tells that it stands: {0}")]
    StandUnseen(Box<Self>),
    /// More than the client was granted.
    #[error(transparent)]
    NotAuthorized(#[from] NotAuthorized),
    /// The session that holds the line has ended, or somebody else has the line.
    #[error("{0}")]
    Session(SessionBusy),
    /// A serial port that does not open.
    #[error("{path}: {error}")]
    Port {
        /// Its name.
        path: String,
        /// Why.
        #[source]
        error: Arc<OpenError>,
    },
    /// A device server that cannot be connected to.
    #[error("{host}, TCP port {port}: {error}")]
    DeviceServer {
        /// Name or address.
        host: String,
        /// Its TCP port.
        port: u16,
        /// Why.
        #[source]
        error: Arc<ConnectError>,
    },
    /// A line that is gone and does not open again.
    #[error(transparent)]
    NotReopened(Box<Self>),
    /// Whoever opens the line for the client has failed.
    #[error("{0}")]
    Opener(Arc<dyn std::error::Error + Send + Sync>),
    /// The line has bad news: unplugged, closed by the other side, broken.
    #[error("{error}")]
    Io {
        /// Whether a session holds the line.
        is_shared: bool,
        /// The news.
        #[source]
        error: Arc<io::Error>,
    },
    /// A dry run sends nothing, and so has no answer.
    #[error("a dry run has no answer")]
    NotKnown,
}

/// Why something was not undone, as its errors say.
fn why(cause: Option<&Error>) -> String {
    cause.map_or("@NG".to_owned(), ToString::to_string)
}

impl Error {
    /// Whether something answered that made no sense.
    pub fn is_malformed(&self) -> bool {
        match self {
            Self::Malformed { .. } | Self::Flooded { .. } => true,
            Self::NoAnswer(unanswered) => unanswered.unfitting.is_some(),
            _ => false,
        }
    }
}

/// A controller's "no" (`@NG`) to a request: it has no code.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the controller refused {} (@NG)", .0.text().trim_start_matches('@'))]
pub struct Refusal(pub Request);

/// What came instead of an answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unanswered {
    /// What was sent; `None` for a block that is in no table.
    pub request: Option<Request>,
    /// How long was waited, each time it was sent.
    pub waited: Duration,
    /// What the line was like so far.
    pub counters: Counters,
    /// The last block that came and is no answer, and why it is none.
    pub unfitting: Option<(String, String)>,
}

impl fmt::Display for Unanswered {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Counters { received, noise, echoes, .. } = self.counters;
        match &self.unfitting {
            Some((block, why)) => write!(f, "unexpected answer '{block}': {why}")?,
            None if received == echoes && echoes > 0 => f.write_str("only what was sent came back")?,
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
    fn errors_are_a_sentence() {
        let counters = Counters { sent: 4, ..Counters::default() };
        let request = Some(Request::bare(Command::Mpst));
        let silence = Unanswered { request, waited: Duration::from_secs(1), counters, unfitting: None };
        let silent = Error::NoAnswer(Box::new(silence.clone()));
        assert_eq!(silent.to_string(), "no answer within 1.0s (@MPST)");
        let unfitting = Some(("@M".to_owned(), "there is no command 'M'".to_owned()));
        let noise = Unanswered { counters: Counters { noise: 7, ..counters }, request: None, ..silence };
        assert_eq!(noise.to_string(), "no answer, but 7 stray characters");
        let odd = Error::NoAnswer(Box::new(Unanswered { unfitting, ..noise }));
        assert!(odd.is_malformed() && !silent.is_malformed());
        assert_eq!(odd.to_string(), "unexpected answer '@M': there is no command 'M'");
        let kept = Error::HostKept(None).to_string();
        assert_eq!(kept, "the host was switched ON and could not be switched OFF again: @NG");
        let refusal = Error::from(Refusal(Request::bare(Command::Home)));
        assert_eq!(refusal.to_string(), "the controller refused HOME (@NG)");
        let unseen = Error::StandUnseen(Box::new(Error::Mute)).to_string();
        assert!(unseen.starts_with("nothing tells that it stands: the controller refuses"), "{unseen}");
    }
}
