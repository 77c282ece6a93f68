//! What can be seen of a link.

use std::time::Duration;

use super::super::error::ProfibusError;
use super::super::wire::Diagnosis;
use crate::image::view;
pub use crate::image::view::{Input, State};

/// What can be seen of a link.
pub type View = view::View<ProfibusError, Statistics, Details>;
/// The same as it changes.
pub type Views = view::Views<ProfibusError, Statistics, Details>;

/// What was counted.
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

/// What only PROFIBUS has to see.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Details {
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
}
