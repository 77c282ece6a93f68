//! What can be seen of a connection.

use std::sync::Arc;
use std::time::Duration;

use crate::devicenet::Now;
use crate::devicenet::error::Error;

/// How a connection is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum State {
    /// Being opened for the first time.
    Opening,
    /// Images travel, or questions can be asked.
    Open,
    /// Lost, and being opened again.
    Lost,
    /// Being closed.
    Closing,
    /// At its end: closed, or never opened.
    Closed,
}

/// An image from the slave.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    /// The bytes.
    pub image: Arc<[u8]>,
    /// When it came.
    pub at: Now,
    /// In which generation.
    pub generation: u32,
}

/// What was counted, over all generations.
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

/// All that can be seen of a connection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct View {
    /// How it is doing.
    pub state: State,
    /// Counts the openings; 0 before the first.
    pub generation: u32,
    /// Bytes of its images both ways, once they are known: that of one of the profiles.
    pub size: Option<usize>,
    /// The newest image of the slave. It stays when the connection is lost: compare the generation.
    pub input: Option<Input>,
    /// The newest change of what is shown that a poll which was answered has carried.
    pub sent: u64,
    /// Why it was lost, or not opened, the last time.
    pub error: Option<Error>,
    /// The packet rate that the slave keeps.
    pub rate: Option<Duration>,
    /// What was counted.
    pub statistics: Statistics,
}
