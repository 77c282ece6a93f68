//! What can be seen of a connection.

use std::time::Duration;

use super::super::class1::{Consumer, Producer};
use super::super::error::EipError;
use crate::image::view;
pub use crate::image::view::{Input, State};

/// What can be seen of a connection.
pub type View = view::View<EipError, Statistics, Details>;
/// The same as it changes.
pub type Views = view::Views<EipError, Statistics, Details>;

/// What was counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Datagrams sent.
    pub sent: u64,
    /// Moments to send that were missed by a whole interval, as by a machine that is too busy.
    pub skipped: u64,
    /// Datagrams that were good.
    pub received: u64,
    /// Numbers that never came.
    pub lost: u64,
    /// Datagrams that came more than half an interval late.
    pub late: u64,
    /// Datagrams that were old or came again, and were passed over.
    pub stale: u64,
    /// Datagrams of a wrong size, which were passed over.
    pub misfit: u64,
}

impl Statistics {
    pub(super) const fn add(&mut self, producer: &Producer, consumer: &Consumer) {
        self.sent += producer.sent;
        self.skipped += producer.skipped;
        self.received += consumer.received;
        self.lost += consumer.lost;
        self.late += consumer.late;
        self.stale += consumer.stale;
        self.misfit += consumer.misfit;
    }
}

/// What only EtherNet/IP has to see.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Details {
    /// Whether the device is told to run.
    pub run: bool,
    /// The intervals that the device keeps: to it, from it.
    pub intervals: Option<(Duration, Duration)>,
}
