//! Image sessions, without link and without clock.
//!
//! The driver sends the [`Output`] cyclically and passes every received image. After each of both, and at a deadline,
//! it polls until the session waits again. A session changes only its own part of the image: an [`Exchange`] the
//! words of the remote command, a [`Sequence`](super::sequence::Sequence) its inputs. So one command runs at a time,
//! in parallel with the bits.

mod exchange;

use std::time::Duration;

use super::image::{Image, Output};
use super::signal::Signal;
use super::table::Pace;
use crate::Now;

pub use exchange::{Ended, Exchange, NotSentReason, Outcome, Silence};

/// Next action of a driver for a session.
#[derive(Debug, Clone, PartialEq)]
pub enum Next<T> {
    /// Wait until this time, or until an image is sent or received.
    Wait(Now),
    /// The session has ended with this outcome. Further polls return the same.
    Done(T),
}

/// A protocol exchange by images; [`Session`](crate::Session) is the counterpart for bytes.
pub trait ImageSession {
    /// Result of the session.
    type Outcome;

    /// Updates the output and returns the next wait.
    fn poll(&mut self, now: Now, output: &mut Output) -> Next<Self::Outcome>;

    /// Takes an input image. Pass the last known one at the start: it may already contain the ready status.
    fn handle(&mut self, now: Now, input: &Image);

    /// Records the loss of the link. No more images follow; poll for the outcome.
    fn lost(&mut self, now: Now);
}

/// Time limits of an exchange.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Policy {
    /// Ready status before the command.
    pub ready: Duration,
    /// First reaction to the command, and return to a valid status.
    pub accept: Duration,
    /// End of a quick command.
    pub quick: Duration,
    /// End of a command that switches servos or motor power.
    pub power: Duration,
    /// End of a motion; `None` without a limit.
    pub motion: Option<Duration>,
    /// Ready status after the command.
    pub release: Duration,
    /// End of an interrupted command.
    pub stop: Duration,
}

impl Policy {
    /// Time limit of a command.
    pub const fn longest(&self, pace: Pace) -> Option<Duration> {
        match pace {
            Pace::Quick => Some(self.quick),
            Pace::Power => Some(self.power),
            Pace::Motion | Pace::Jog => self.motion,
        }
    }
}

impl Default for Policy {
    fn default() -> Self {
        Self {
            ready: Duration::from_secs(3),
            accept: Duration::from_secs(3),
            quick: Duration::from_secs(10),
            power: Duration::from_secs(30),
            motion: None,
            release: Duration::from_secs(3),
            stop: Duration::from_secs(3),
        }
    }
}

/// Minimum interval between two edges of dedicated inputs. The manual requires 100 ms or more at the controller
/// (chapter 1, section 3). The rest covers a late packet and the scan time of 5 ms.
pub const EDGE_INTERVAL: Duration = Duration::from_millis(120);

/// Earliest time of an edge of `signal` after the last one in its word; `None` if it may follow now.
pub(super) fn edge_due(now: Now, output: &Output, signal: Signal) -> Option<Now> {
    let due = output.last_edge(signal.word())?.saturating_add(EDGE_INTERVAL);
    (due > now).then_some(due)
}
