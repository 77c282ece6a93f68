//! Image sessions, without link and without clock.
//!
//! The driver sends the [`Output`] cyclically and passes every received image. After a sent image, after a received
//! image, and at a deadline, the driver polls until the session waits again. A session changes only its own part of the
//! image: an [`Exchange`] changes the words of the remote command, a [`Sequence`](super::sequence::Sequence) its
//! inputs. Because of this, one remote command can run at the same time as changes of the bits.

mod exchange;

use std::time::Duration;

use super::image::{Image, Output};
use super::signal::Signal;
use super::table::DurationClass;
use crate::Now;

pub use exchange::{Ended, Exchange, NotSentReason, Outcome, Silence};

/// Next action of a driver for a session.
#[derive(Debug, Clone, PartialEq)]
pub enum Next<T> {
    /// Wait until this time, or until an image is sent or received.
    Wait(Now),
    /// The session has ended with this outcome. Further polls return the same outcome.
    Done(T),
}

/// A protocol exchange by images. [`Session`](crate::Session) is the corresponding trait for bytes.
pub trait ImageSession {
    /// Result of the session.
    type Outcome;

    /// Updates the output and returns the next wait.
    fn poll(&mut self, now: Now, output: &mut Output) -> Next<Self::Outcome>;

    /// Handles an input image. Pass the last received image at the start, because it may already contain the ready
    /// status.
    fn handle(&mut self, now: Now, input: &Image);

    /// Records that the link was lost. The session receives no more images; poll for the outcome.
    fn handle_link_loss(&mut self, now: Now);
}

/// Time limits of an exchange. Each field is the maximum time until its event.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Policy {
    /// Until the controller is ready for the command.
    pub ready: Duration,
    /// Until the controller reacts to the command, or returns to a valid status.
    pub accept: Duration,
    /// Until a quick command ends.
    pub quick: Duration,
    /// Until a command ends that switches servos or motor power.
    pub power: Duration,
    /// Until a motion ends; `None` without a limit.
    pub motion: Option<Duration>,
    /// Until the controller is ready again after the command.
    pub release: Duration,
    /// Time for which the status reset stays after a command without an answer: the longest time in which an image gets
    /// to the controller, and its answer back, on a link that is not lost.
    pub settle: Duration,
    /// Until an interrupted command ends.
    pub stop: Duration,
    /// Whether the exchange ends with the answer. It sends the status reset, but the next exchange waits for the ready
    /// status.
    pub ends_with_answer: bool,
}

impl Policy {
    const DEFAULT: Self = Self {
        ready: Duration::from_secs(3),
        accept: Duration::from_secs(3),
        quick: Duration::from_secs(10),
        power: Duration::from_secs(30),
        motion: None,
        release: Duration::from_secs(3),
        settle: Duration::ZERO,
        stop: Duration::from_secs(3),
        ends_with_answer: false,
    };

    /// Time limit of a command, by its duration class.
    pub const fn longest(&self, pace: DurationClass) -> Option<Duration> {
        match pace {
            DurationClass::Quick => Some(self.quick),
            DurationClass::Power => Some(self.power),
            DurationClass::Motion | DurationClass::Jog => self.motion,
        }
    }
}

impl Default for Policy {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Minimum interval between two edges of dedicated inputs. The manual requires at least 100 ms at the controller
/// (chapter 1, section 3). The additional 20 ms allow for a late packet and for the scan time of 5 ms.
pub const EDGE_INTERVAL: Duration = Duration::from_millis(120);

/// Earliest time at which `signal` may change after the last edge in its word; `None` if it may change now.
pub(super) fn edge_due(now: Now, output: &Output, signal: Signal) -> Option<Now> {
    let due = output.last_edge(signal.word())?.saturating_add(EDGE_INTERVAL);
    (due > now).then_some(due)
}
