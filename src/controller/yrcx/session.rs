//! Conversations by images, without link and without clock.
//!
//! The driver sends the [`Output`] in its cycle and hands over every image that comes. After each of both, and when a
//! wait is over, it polls until the session waits again. A session changes only what is its own: an [`Exchange`] the
//! words of the remote command, a [`Sequence`](super::sequence::Sequence) the inputs it switches. So one command runs at
//! a time, and the bits live beside it.

mod exchange;

use std::time::Duration;

use super::image::{Image, Output};
use super::signal::Signal;
use super::table::Pace;
use crate::Now;

pub use exchange::{Ended, Exchange, NotSentReason, Outcome, Silence};

/// What a session wants its driver to do.
#[derive(Debug, Clone, PartialEq)]
pub enum Next<T> {
    /// Nothing before this moment, unless an image leaves or comes.
    Wait(Now),
    /// The session has ended with this outcome; polling again yields the same.
    Done(T),
}

/// A conversation by images; what [`Session`](crate::Session) is for bytes.
pub trait ImageSession {
    /// How it ends, good or bad.
    type Outcome;

    /// Changes what is to be sent, and says what to wait for.
    fn poll(&mut self, now: Now, output: &mut Output) -> Next<Self::Outcome>;

    /// Takes an image of the controller. Hand over the last known one at the start: it may say already that the
    /// controller is ready.
    fn handle(&mut self, now: Now, input: &Image);

    /// Tells that the link went down. Nothing comes any more; poll for the outcome.
    fn lost(&mut self, now: Now);
}

/// How long to wait for the controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Policy {
    /// For the ready status, before the command.
    pub ready: Duration,
    /// For a sign that the command was taken, and for a status that makes sense again.
    pub accept: Duration,
    /// For the end of a quick command.
    pub quick: Duration,
    /// For the end of a command that switches servos or motor power.
    pub power: Duration,
    /// For the end of a motion; `None` waits as long as it takes.
    pub motion: Option<Duration>,
    /// For the ready status, after the command.
    pub release: Duration,
    /// For the end of a command that was interrupted.
    pub stop: Duration,
}

impl Policy {
    /// The longest that a command may run.
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

/// Between two edges of dedicated inputs: the manual wants 100 ms or more at the controller (chapter 1, section 3); the
/// rest covers a late packet and the controller's scan of 5 ms.
pub const EDGE_INTERVAL: Duration = Duration::from_millis(120);

/// When an edge of `signal` may follow the last one in its word, unless it may now.
pub(super) fn edge_due(now: Now, output: &Output, signal: Signal) -> Option<Now> {
    let due = output.last_edge(signal.word())?.saturating_add(EDGE_INTERVAL);
    (due > now).then_some(due)
}
