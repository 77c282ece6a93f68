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

/// Counters of the data exchanges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Number of requests for a data exchange, without repetitions.
    pub sent: u64,
    /// Number of data exchanges to which the slave answered.
    pub received: u64,
    /// Number of repeated requests.
    pub repeated: u64,
    /// Number of bytes that are not part of a telegram.
    pub noise: u64,
    /// Number of answers without a pending request.
    pub unexpected: u64,
    /// Number of cycles that were missed, for example because the computer was busy.
    pub skipped: u64,
}

/// Details that only PROFIBUS has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Details {
    /// Last diagnosis of the slave.
    pub diagnosis: Option<Diagnosis>,
    /// Configuration that is in use, or that the slave reports.
    pub configuration: Option<Vec<u8>>,
    /// Whether the adapter echoes the bytes that are sent.
    pub echoes: bool,
    /// Time between two exchanges.
    pub cycle: Duration,
    /// Watchdog time of the slave.
    pub watchdog: Duration,
}
