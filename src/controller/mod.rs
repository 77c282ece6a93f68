//! What each controller understands.
//!
//! Nothing in here opens a socket, reads a clock or knows the command line. A session is a state machine that is handed
//! time and bytes and says what to do next; a driver elsewhere moves the bytes. The same session therefore runs against
//! a socket, a simulator in this process, and a fault injector in virtual time.

use std::time::Duration;

pub mod findings;
pub mod names;
pub mod nearest;
pub mod sheet;
pub mod simulator;
mod source;
#[cfg(test)]
mod testing;
pub mod text;
pub mod toyo;
pub mod typed;
pub mod units;
pub mod yerc;
pub mod yrcx;

/// A moment, as time passed since an origin of the driver's choice. It never runs backwards.
pub type Now = Duration;

/// What a command does to the world; the higher one wins where a command does several things.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Risk {
    /// Reads only: may be repeated at will.
    Read,
    /// Changes what can be set again: a variable, a signal, a counter, a selection, an alarm reset.
    Write,
    /// Deletes or overwrites what a person wrote or taught: jobs, programs, files, points, parameters.
    Destroy,
    /// Moves the robot, or gives it power or a job to move by.
    Motion,
}

impl Risk {
    /// As messages name it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Read => "read",
            Self::Write => "write",
            Self::Destroy => "destroy",
            Self::Motion => "motion",
        }
    }
}

/// What a session wants its driver to do next.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step<T> {
    /// Send these bytes to the peer as one datagram (or one write), then poll again.
    Send(Vec<u8>),
    /// Take this piece of incoming payload; pieces come in order, each exactly once. Then poll again.
    Data(Vec<u8>),
    /// Provide the next piece of outgoing payload through the session's own `feed`, then poll again.
    Feed,
    /// Nothing to do before this moment, unless bytes arrive.
    Wait(Now),
    /// The session has ended with this outcome; polling again yields the same step.
    Done(T),
}

/// A conversation with one peer, without sockets and without a clock.
pub trait Session {
    /// How the conversation ends, good or bad.
    type Outcome;

    /// Says what to do at `now`. Call until it answers [`Step::Wait`] or [`Step::Done`].
    fn poll(&mut self, now: Now) -> Step<Self::Outcome>;

    /// Takes bytes that arrived from the peer at `now`. Bytes that do not belong here are counted and ignored. Hand
    /// over one datagram, then poll to the end before the next: what comes in between may be passed over as lost.
    fn handle(&mut self, now: Now, bytes: &[u8]);
}
