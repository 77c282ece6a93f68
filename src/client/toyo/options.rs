//! Settings, events and statistics of a client.

use std::time::Duration;

use armctl_controller::Risk;

use super::{Counters, MotionKind, Request, Status};
use crate::Grant;

/// Settings of a client.
///
/// Example: [`Client`](super::Client)
#[derive(Debug, Clone)]
pub struct Options {
    /// The highest risk that may be sent.
    pub grant: Grant,
    /// Time limit of one attempt, from the last character sent to the answer. The manual gives 1 s (TO 1-3).
    pub timeout: Duration,
    /// Number of retries after a timeout. Only a request that changes nothing is repeated.
    pub retries: u32,
}

impl Default for Options {
    /// Read only, 1 s time limit, 3 retries.
    fn default() -> Self {
        Self { grant: Grant::default(), timeout: Duration::from_secs(1), retries: 3 }
    }
}

impl Options {
    /// Authorizes this risk and everything below it.
    #[must_use]
    pub fn with_risk(self, risk: Risk) -> Self {
        Self { grant: Grant::up_to(risk), ..self }
    }
}

/// An event of a client. The client reports a change of the controller before it sends the change. If this process is
/// killed, a log of the events shows how to undo the change.
///
/// Example: [`Watcher`](crate::Watcher)
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Event {
    /// A motion is about to start; `None` after the motion has ended.
    Motion(Option<MotionKind>),
    /// `true`: the client is about to switch the host ON temporarily. `false`: the host is OFF again.
    HostSwitch(bool),
    /// The client is about to make a temporary change. This request undoes the change.
    TemporaryChange(Request),
    /// The change of this undo request was undone, or was never made.
    Undone(Request),
    /// The line is lost, and this undo request was not sent.
    NotUndone(Request),
    /// The client read the state of host control.
    Host {
        /// The status that was read. It includes at least the page with the host state.
        status: Status,
        /// Whether this client switched the host ON.
        is_taken: bool,
    },
    /// The client read the current task, while no temporary change was active.
    Task(Option<i32>),
    /// A lost line is open again.
    Reopened,
}

/// Line statistics.
///
/// Example: [`Client`](super::Client)
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Totals {
    /// Blocks sent and received, and errors.
    pub counters: Counters,
    /// Time spent in exchanges.
    pub waited: Duration,
}
