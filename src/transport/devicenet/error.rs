//! Errors of DeviceNet connections.

use std::time::Duration;

use thiserror::Error;

use super::can::{BusState, PortError};
use super::wire::{Mac, general};
use crate::image::view::BusError;

/// An error that prevented or ended a connection.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Error {
    /// Another node on the bus has the same MAC as this master.
    #[error("another node has MAC {mac} of this master: vendor {vendor}, serial {serial:08X}")]
    Duplicate {
        /// MAC that both nodes have.
        mac: Mac,
        /// Vendor id of the other node.
        vendor: u16,
        /// Serial number of the other node.
        serial: u32,
    },
    /// Another master owns the connections of the slave.
    #[error("another master owns the connections of MAC {0}")]
    Owned(Mac),
    /// The image sizes of the slave do not match any of the expected profiles.
    #[error("MAC {mac} receives {consumed_size} bytes and sends {produced_size}; armctl supports {known}")]
    Size {
        /// MAC of the slave.
        mac: Mac,
        /// Size of the image from the slave, in bytes.
        produced_size: u16,
        /// Size of the image to the slave, in bytes.
        consumed_size: u16,
        /// Sizes of the expected profiles, as text.
        known: String,
    },
    /// The slave refused a request.
    #[error("MAC {mac} refused {what}: {} (general {general:#04x}, additional {additional:#04x})", general::meaning(*general))]
    Refused {
        /// The request.
        what: &'static str,
        /// MAC of the slave.
        mac: Mac,
        /// General error code of the slave.
        general: u8,
        /// Additional error code of the slave.
        additional: u8,
    },
    /// The slave did not answer.
    #[error("no answer from MAC {mac} to {what}: {}", silence(*is_bus_alive, *state))]
    Silent {
        /// MAC of the slave.
        mac: Mac,
        /// The request.
        what: &'static str,
        /// Whether other nodes sent frames.
        is_bus_alive: bool,
        /// Error state of the adapter.
        state: BusState,
    },
    /// The slave stopped answering polls.
    #[error("no answer from MAC {mac} to a poll for {} ms: {}", after.as_millis(),
        if *is_heard { "frames arrive, but no complete image" } else { silence(*is_bus_alive, *state) })]
    Lost {
        /// MAC of the slave.
        mac: Mac,
        /// Time without an answer.
        after: Duration,
        /// Whether frames of the slave arrived, but no complete image.
        is_heard: bool,
        /// Whether other nodes sent frames during that time.
        is_bus_alive: bool,
        /// Error state of the adapter.
        state: BusState,
    },
    /// The answer of the slave is invalid.
    #[error("MAC {mac} sent an invalid answer to {what}: {why}")]
    Senseless {
        /// MAC of the slave.
        mac: Mac,
        /// The request.
        what: &'static str,
        /// What is wrong with the answer.
        why: &'static str,
    },
    /// The adapter is in the state bus-off.
    #[error("the adapter is bus-off: too many errors on the bus")]
    BusOff,
    /// The adapter failed.
    #[error("{0}")]
    Port(#[from] PortError),
    /// The settings are invalid or contradict each other.
    #[error("{0}")]
    Settings(String),
    /// The link was lost, and the caller has not noticed the loss yet: the image that it wants to send belongs to an
    /// earlier generation of the link.
    #[error("the connection was lost")]
    Outdated,
    /// The connection is closed.
    #[error("the connection is closed")]
    Ended,
}

impl BusError for Error {
    const OUTDATED: Self = Self::Outdated;
    const ENDED: Self = Self::Ended;
}

/// Returns the explanation of a missing answer.
const fn silence(is_bus_alive: bool, state: BusState) -> &'static str {
    match (is_bus_alive, state) {
        (_, BusState::Off) => "the adapter is bus-off",
        (true, _) => "other nodes send frames",
        (false, BusState::Passive) => "no traffic on the bus, and no node acknowledges (adapter error passive)",
        (false, BusState::Warning) => "no traffic on the bus, and the adapter counts errors",
        (false, BusState::Active) => "no traffic on the bus",
    }
}
