//! What can be seen of a link.

use std::sync::Arc;
use std::time::Duration;

use super::super::Now;
use super::super::error::ProfibusError;
use super::super::wire::Diagnosis;

/// How a link is doing.
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
    /// Exchanges that were asked for, without repetitions.
    pub sent: u64,
    /// Exchanges that were answered.
    pub received: u64,
    /// Requests that were sent again.
    pub repeated: u64,
    /// Bytes that were no telegram.
    pub noise: u64,
    /// Answers to nothing that was asked.
    pub unexpected: u64,
    /// Cycles that were missed, as by a machine that is too busy.
    pub skipped: u64,
}

/// All that can be seen of a link.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct View {
    /// How it is doing.
    pub state: State,
    /// Counts the openings; 0 before the first.
    pub generation: u32,
    /// The newest image of the slave. It stays when the link is lost: compare the generation.
    pub input: Option<Input>,
    /// The newest change of what is sent that has left.
    pub sent: u64,
    /// Why it was lost, or not opened, the last time.
    pub error: Option<ProfibusError>,
    /// What the slave said of itself the last time.
    pub diagnosis: Option<Diagnosis>,
    /// The configuration that is in force, or that the slave wants.
    pub configuration: Option<Vec<u8>>,
    /// Whether the adapter hands back what is sent.
    pub echoes: bool,
    /// Time between two exchanges.
    pub cycle: Duration,
    /// How long the slave waits for us.
    pub watchdog: Duration,
    /// What was counted.
    pub statistics: Statistics,
}
