//! What can be seen of a connection.

use std::time::Duration;

use crate::devicenet::error::Error;
use crate::image::view;
pub use crate::image::view::{Input, State};

/// What can be seen of a connection. What is sent has left when a poll with it was answered.
pub type View = view::View<Error, Statistics, Details>;
/// The same as it changes.
pub type Views = view::Views<Error, Statistics, Details>;

/// What was counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Polls sent.
    pub sent: u64,
    /// Polls answered with a whole image.
    pub received: u64,
    /// Polls without an answer in time.
    pub missed: u64,
    /// Frames of answers that did not belong together or had a wrong size, and were dropped.
    pub wrong: u64,
    /// Whole answers that nobody waited for any more, and were dropped.
    pub late: u64,
    /// Moments to poll that were missed by a whole cycle.
    pub skipped: u64,
}

/// What only DeviceNet has to see.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Details {
    /// Bytes of the images both ways, once they are known: that of one of the profiles.
    pub size: Option<usize>,
    /// The packet rate that the slave keeps.
    pub rate: Option<Duration>,
}
