//! State of a link for callers.

use std::time::Duration;

use super::super::error::ProfibusError;
use super::super::wire::Diagnosis;
use crate::image::view;
pub use crate::image::view::{Input, State};

/// State of a link.
pub type View = view::View<ProfibusError, Statistics, Details>;
/// Receiver of state changes.
pub type Views = view::Views<ProfibusError, Statistics, Details>;

/// Counters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Data exchanges requested, without repetitions.
    pub sent: u64,
    /// Data exchanges answered.
    pub received: u64,
    /// Repeated requests.
    pub repeated: u64,
    /// Bytes that are no telegram.
    pub noise: u64,
    /// Answers without a request.
    pub unexpected: u64,
    /// Cycles missed, for example on a busy computer.
    pub skipped: u64,
}

/// Details that only PROFIBUS has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Details {
    /// Last diagnosis of the slave.
    pub diagnosis: Option<Diagnosis>,
    /// Configuration in use, or reported by the slave.
    pub configuration: Option<Vec<u8>>,
    /// Whether the adapter echoes what is sent.
    pub echoes: bool,
    /// Time between two exchanges.
    pub cycle: Duration,
    /// Watchdog time of the slave.
    pub watchdog: Duration,
}
