//! Protocols of the controllers, without I/O. Applications use `armctl-client`: this crate can change in each version.
//!
//! Nothing here opens a socket, reads a clock or uses the command line. A session is a state machine: it receives time
//! and bytes and returns the next step. A driver outside of this module moves the bytes. Because of this, the same
//! session can run against a socket, against a simulator in this process, and against a fault injector in virtual time.

#![cfg_attr(
    not(all(feature = "toyo", feature = "yerc", feature = "yrcx")),
    allow(dead_code, reason = "no family uses all of what they share")
)]

use std::time::Duration;

pub mod findings;
pub mod names;
pub mod references;
pub mod sheet;
pub mod similar_word;
pub mod simulator;
mod source;
#[cfg(test)]
mod testing;
pub mod text;
#[cfg(feature = "toyo")]
pub mod toyo;
pub mod units;
pub mod user_input;
#[cfg(feature = "yerc")]
pub mod yerc;
#[cfg(feature = "yrcx")]
pub mod yrcx;

/// Time since an origin that the driver chooses. It never runs backwards.
pub type Now = Duration;

/// Risk of a command. A command with several effects has the highest risk of these effects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Risk {
    /// The command only reads data. It can be repeated.
    Read,
    /// Changes a value that can be set again (a variable, a signal, a counter, a selection), or resets an alarm.
    Write,
    /// Deletes or overwrites data that a person made: jobs, programs, files, points, parameters.
    Destroy,
    /// Moves the robot, switches servo power, or starts a job.
    Motion,
}

impl Risk {
    /// Name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Read => "read",
            Self::Write => "write",
            Self::Destroy => "destroy",
            Self::Motion => "motion",
        }
    }
}

/// Next action that a session requests from its driver.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step<T> {
    /// Send these bytes as one datagram or one write, then poll again.
    Send(Vec<u8>),
    /// A received piece of the payload. Store it, then poll again. Pieces come in order, each exactly once.
    Data(Vec<u8>),
    /// Pass the next piece of outgoing payload to `feed` of the session, then poll again.
    Feed,
    /// Wait until this time, or until bytes arrive.
    Wait(Now),
    /// The session has ended with this outcome. Further polls return the same step.
    Done(T),
}

/// A protocol exchange with one peer, without sockets and without a clock.
pub trait Session {
    /// Result of the session.
    type Outcome;

    /// Returns the next step at `now`. Call it until it returns [`Step::Wait`] or [`Step::Done`].
    fn poll(&mut self, now: Now) -> Step<Self::Outcome>;

    /// Processes bytes that arrived at `now`. Bytes of other exchanges are counted and ignored.
    ///
    /// Pass one datagram, then poll until [`Step::Wait`] before you pass the next datagram. A datagram that is passed
    /// earlier may be dropped.
    fn handle(&mut self, now: Now, bytes: &[u8]);
}

/// Refuses with `error` if `is_refused`.
fn refuse_if<E>(is_refused: bool, error: E) -> Result<(), E> {
    if is_refused { Err(error) } else { Ok(()) }
}
