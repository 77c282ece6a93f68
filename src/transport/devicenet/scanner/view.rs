//! State of a connection for callers.

use std::time::Duration;

use crate::devicenet::error::Error;
use crate::image::view;
pub use crate::image::view::{Input, State};

/// State of a connection. A change counts as sent when the slave has answered a poll that contained the change.
pub type View = view::View<Error, Statistics, Details>;
/// Receiver of state changes.
pub type Views = view::Views<Error, Statistics, Details>;

/// Counters of the polls and frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Polls sent.
    pub sent: u64,
    /// Polls to which the slave answered with a whole image.
    pub received: u64,
    /// Polls to which no answer arrived in time.
    pub missed: u64,
    /// Frames dropped because of a wrong count or size.
    pub wrong: u64,
    /// Complete answers that came too late and were dropped.
    pub late: u64,
    /// Polls that were not sent, because the whole cycle before them was missed.
    pub skipped: u64,
}

/// Details that only DeviceNet has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Details {
    /// Image size in bytes, the same in both directions; `None` until it is known.
    pub size: Option<usize>,
    /// Packet rate that the slave has accepted.
    pub rate: Option<Duration>,
}
