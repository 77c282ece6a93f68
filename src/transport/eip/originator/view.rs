//! What can be seen of a connection.

use std::sync::Arc;
use std::time::Duration;

use super::super::Now;
use super::super::class1::{Consumer, Producer};
use super::super::error::EipError;

/// How a connection is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum State {
    /// Being opened for the first time.
    Opening,
    /// Images travel.
    Open,
    /// Lost, and being opened again.
    Lost,
    /// Being closed.
    Closing,
    /// At its end: closed, or never opened.
    Closed,
}

/// An image from the device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    /// The bytes.
    pub image: Arc<[u8]>,
    /// The number of its datagram.
    pub sequence: u32,
    /// When it came.
    pub at: Now,
    /// In which generation.
    pub generation: u32,
}

/// What was counted, over all generations.
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

/// All that can be seen of a connection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct View {
    /// How it is doing.
    pub state: State,
    /// Counts the openings; 0 before the first.
    pub generation: u32,
    /// The newest image of the device. It stays when the connection is lost: compare the generation.
    pub input: Option<Input>,
    /// The newest change of what is sent that went out at least once.
    pub sent: u64,
    /// Whether the device is told to run.
    pub run: bool,
    /// Why it was lost, or not opened, the last time; while it is open, what went wrong on a socket here.
    pub trouble: Option<EipError>,
    /// The intervals that the device keeps: to it, from it.
    pub intervals: Option<(Duration, Duration)>,
    /// What was counted.
    pub statistics: Statistics,
}
