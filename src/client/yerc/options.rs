//! Settings, events and traffic of a client.

use std::time::Duration;

use armctl_controller::Risk;
use armctl_controller::yerc::session::Policy;

use super::{Counters, Model};
use crate::Grant;

/// Settings of a client.
///
/// Example: [`Client`](super::Client)
#[derive(Debug, Clone)]
pub struct Options {
    /// Model of the controller. Without a model, the client reads the model when a request depends on it. A simulator
    /// always uses its own model.
    pub model: Option<Model>,
    /// The highest risk that may be sent.
    pub grant: Grant,
    /// Time limit of one attempt.
    pub timeout: Duration,
    /// Number of retries after a timeout, for a request that changes nothing and for a file block.
    pub retries: u32,
}

impl Options {
    /// Options for this model, read only, with the default limits: 3 s, 3 retries.
    pub fn new(model: Model) -> Self {
        Self { model: Some(model), ..Self::auto() }
    }

    /// Options without a model, read only, with the default limits. The client reads the model from the controller.
    pub fn auto() -> Self {
        let Policy { timeout, retries, .. } = Policy::default();
        Self { model: None, grant: Grant::default(), timeout, retries }
    }

    /// Authorizes this risk and everything below it.
    #[must_use]
    pub fn with_risk(self, risk: Risk) -> Self {
        Self { grant: Grant::up_to(risk), ..self }
    }
}

/// An event of a client, other than a frame.
///
/// Example: [`Watcher`](crate::Watcher)
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Event {
    /// An exchange or transfer ended. During it, the client received frames that do not belong to its requests.
    UnexpectedTraffic(Counters),
    /// The controller may not know that a transfer has ended: it did not confirm an abort, or its last acknowledgement may
    /// be lost. The controller may stay busy until its timer expires.
    TransferLeftOpen,
}

/// Traffic of a client.
///
/// Example: [`Client`](super::Client)
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Totals {
    /// Frames sent.
    pub sent: u64,
    /// Frames received.
    pub received: u64,
    /// Time spent in exchanges and transfers.
    pub waited: Duration,
    /// Completed exchanges and transfers.
    pub exchanges: u32,
    /// Unexpected events on the link: see [`Counters`].
    pub disturbances: u64,
}
