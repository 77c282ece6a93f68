//! Why something on a DeviceNet does not come about.

use std::time::Duration;

use thiserror::Error;

use super::can::{BusState, PortError};
use super::wire::{Mac, general};
use crate::image::view::BusError;

/// Why something does not come about, or ended.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Error {
    /// Another node has the MAC that was to be ours.
    #[error("MAC {mac}, which was to be this master's, is taken on the bus: by vendor {vendor}, serial {serial:08X}")]
    Duplicate {
        /// The MAC.
        mac: Mac,
        /// The maker of the other.
        vendor: u16,
        /// Its serial number.
        serial: u32,
    },
    /// Another master has the connections of the slave.
    #[error("MAC {mac} does not give its connections, which another has")]
    Owned {
        /// The slave.
        mac: Mac,
    },
    /// The images of the slave have sizes that are not known.
    #[error("MAC {mac} takes {consumed} bytes and sends {produced}; known are {known}")]
    Size {
        /// The slave.
        mac: Mac,
        /// Bytes from it.
        produced: u16,
        /// Bytes to it.
        consumed: u16,
        /// The sizes there are, in words.
        known: String,
    },
    /// The slave says no.
    #[error("{what} of MAC {mac} was refused: {} (general {general:#04x}, additional {additional:#04x})", general::meaning(*general))]
    Refused {
        /// What was asked.
        what: &'static str,
        /// The slave.
        mac: Mac,
        /// The general code.
        general: u8,
        /// The additional one.
        additional: u8,
    },
    /// The slave does not answer.
    #[error("MAC {mac} does not answer {what}: {}", silence(*is_bus_alive, *state))]
    Silent {
        /// The slave.
        mac: Mac,
        /// What was asked.
        what: &'static str,
        /// Whether other nodes were heard.
        is_bus_alive: bool,
        /// How the adapter gets on with the bus.
        state: BusState,
    },
    /// The slave was polled, and does not answer polls any more.
    #[error("MAC {mac} has not answered a poll for {} ms: {}", after.as_millis(),
        if *is_heard { "it is heard, but no image of it comes whole" } else { silence(*is_bus_alive, *state) })]
    Lost {
        /// The slave.
        mac: Mac,
        /// For how long.
        after: Duration,
        /// Whether it was heard meanwhile, and no image came whole.
        is_heard: bool,
        /// Whether other nodes were heard meanwhile.
        is_bus_alive: bool,
        /// How the adapter gets on with the bus.
        state: BusState,
    },
    /// The slave answers something that makes no sense.
    #[error("the answer of MAC {mac} to {what} makes no sense: {why}")]
    Senseless {
        /// The slave.
        mac: Mac,
        /// What was asked.
        what: &'static str,
        /// What is wrong with the answer.
        why: &'static str,
    },
    /// The adapter has taken itself off the bus.
    #[error("the adapter is bus-off: too many errors on the bus")]
    BusOff,
    /// The adapter does not do what it should.
    #[error("{0}")]
    Port(#[from] PortError),
    /// Nothing can be as it is wanted.
    #[error("{0}")]
    Settings(String),
    /// The link was lost meanwhile.
    #[error("the link was lost meanwhile")]
    Outdated,
    /// It is closed.
    #[error("it is closed")]
    Ended,
}

impl BusError for Error {
    const OUTDATED: Self = Self::Outdated;
    const ENDED: Self = Self::Ended;
}

/// What silence means.
const fn silence(is_bus_alive: bool, state: BusState) -> &'static str {
    match (is_bus_alive, state) {
        (_, BusState::Off) => "the adapter is bus-off",
        (true, _) => "other nodes are heard",
        (false, BusState::Passive) => "no node is heard, and nobody acknowledges what is sent (adapter error passive)",
        (false, BusState::Warning) => "no node is heard, and the adapter counts errors",
        (false, BusState::Active) => "no node is heard",
    }
}
