//! State of a connection for callers.

use std::time::Duration;

use super::super::class1::{Consumer, Producer};
use super::super::error::EipError;
use crate::image::view;
pub use crate::image::view::{Input, State};

/// State of a connection.
pub type View = view::View<EipError, Statistics, Details>;
/// Receiver of state changes.
pub type Views = view::Views<EipError, Statistics, Details>;

/// Counters of the datagrams.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Datagrams sent.
    pub sent: u64,
    /// Datagrams that were omitted because a whole interval was missed, for example on a busy computer.
    pub skipped: u64,
    /// Valid datagrams received.
    pub received: u64,
    /// Sequence numbers that were never received.
    pub lost: u64,
    /// Datagrams that arrived more than half an interval late.
    pub late: u64,
    /// Old and duplicate datagrams, which are dropped.
    pub stale: u64,
    /// Datagrams of a wrong size, which are dropped.
    pub size_error: u64,
}

impl Statistics {
    pub(super) const fn add(&mut self, producer: &Producer, consumer: &Consumer) {
        self.sent += producer.sent;
        self.skipped += producer.skipped;
        self.received += consumer.received;
        self.lost += consumer.lost;
        self.late += consumer.late;
        self.stale += consumer.stale;
        self.size_error += consumer.size_error;
    }
}

/// Details that only EtherNet/IP has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Details {
    /// Run/idle bit that the originator sends to the device.
    pub run: bool,
    /// Actual packet intervals: to the device, and from the device.
    pub intervals: Option<(Duration, Duration)>,
}
