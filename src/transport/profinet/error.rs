//! What can go wrong between a controller and a device.

use std::fmt;
use std::net::Ipv4Addr;
use std::time::Duration;

use thiserror::Error;

use super::wire::dcp;
use super::wire::status::Status;
use super::wire::{Mac, WireError};
use crate::image::view::BusError;
use crate::local::LocalError;

/// Why something did not come about.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ProfinetError {
    /// Nobody has the name or the card that was looked for.
    #[error("{station} was not found: no answer to DCP Identify within {} s", after.as_secs())]
    NotFound {
        /// What was looked for.
        station: String,
        /// How long was waited.
        after: Duration,
    },
    /// Two devices have the name.
    #[error("{station} is there twice: {} and {}", cards.0, cards.1)]
    Duplicate {
        /// What was looked for.
        station: String,
        /// Two of those that have it.
        cards: (Mac, Mac),
    },
    /// The device has no IP address, and is to be given none.
    #[error("{station} has no IP address")]
    NoAddress {
        /// The device.
        station: String,
    },
    /// The device is in another network than this machine.
    #[error("{station} has the address {device}, which is in another network than {here} of this machine")]
    OtherNetwork {
        /// The device.
        station: String,
        /// Its address.
        device: Ipv4Addr,
        /// Ours.
        here: Ipv4Addr,
    },
    /// Another station has the same address.
    #[error("{station} reports that another station has its address {address} too")]
    AddressConflict {
        /// The device.
        station: String,
        /// The address.
        address: Ipv4Addr,
    },
    /// A setting could not be set.
    #[error("{what} was refused: {}", dcp::describe_error(*error))]
    Dcp {
        /// What was to be set.
        what: &'static str,
        /// The error.
        error: u8,
    },
    /// No answer in time.
    #[error("{what} was not answered within {} s", after.as_secs())]
    NoAnswer {
        /// What had been asked.
        what: &'static str,
        /// How long was waited.
        after: Duration,
    },
    /// The device refused.
    #[error("{what} was refused: {status}")]
    Refused {
        /// What had been asked.
        what: &'static str,
        /// The reason.
        status: Status,
    },
    /// The RPC of the device refused.
    #[error("{what} was rejected by the RPC server ({status:#010x})")]
    Rejected {
        /// What had been asked.
        what: &'static str,
        /// The reason.
        status: u32,
    },
    /// An answer that cannot be read.
    #[error("the answer to {what} cannot be read: {error}")]
    Malformed {
        /// What had been asked.
        what: &'static str,
        /// The field that is wrong.
        error: WireError,
    },
    /// An answer that can be read, and makes no sense.
    #[error("the answer to {what} makes no sense: {why}")]
    Senseless {
        /// What had been asked.
        what: &'static str,
        /// What is wrong with it.
        why: &'static str,
    },
    /// The device has other modules than the layout says.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Modules(
        /// What differs, at least one thing.
        Vec<ModuleMismatch>,
    ),
    /// The device took everything and never called ApplicationReady.
    #[error("the device did not get ready within {} s", after.as_secs())]
    NeverReady {
        /// How long was waited.
        after: Duration,
    },
    /// The device is ready, and shows no data that can be used.
    #[error("no usable data within {} s: {missing}", after.as_secs())]
    NoData {
        /// How long was waited.
        after: Duration,
        /// What is missing.
        missing: Unusable,
    },
    /// The device runs, and its data cannot be used at the moment.
    #[error("the data of the device cannot be used: {0}")]
    Unusable(
        /// Why.
        Unusable,
    ),
    /// The device no longer sends.
    #[error("no cyclic frame came for {} ms", after.as_millis())]
    Silent {
        /// How long was waited.
        after: Duration,
    },
    /// The device ended the connection.
    #[error("the device ended the connection: {0}")]
    Aborted(
        /// Its reason.
        Status,
    ),
    /// A module was plugged, and the device waits for parameters anew.
    #[error("a module was plugged in slot {slot}")]
    Plugged {
        /// Where.
        slot: u16,
    },
    /// An alarm of ours was not acknowledged.
    #[error("the acknowledgement of an alarm was not taken by the device")]
    AlarmUnanswered,
    /// The image is for a connection that has ended meanwhile.
    #[error("the connection was lost meanwhile")]
    Outdated,
    /// The connection was closed here.
    #[error("the connection is closed")]
    Ended,
    /// Raw Ethernet is not allowed.
    #[error("PROFINET needs raw Ethernet, which this program is not allowed to open (CAP_NET_RAW)")]
    Privilege,
    /// There is no such interface.
    #[error("there is no network interface '{name}' here")]
    NoInterface {
        /// The name.
        name: String,
        /// Those that there are.
        present: Vec<String>,
    },
    /// The interface is there, and cannot be used.
    #[error("the network interface '{name}' {problem}")]
    Interface {
        /// The name.
        name: String,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// Another program has UDP port 34964.
    #[error("another program on this machine has UDP port 34964 of {address}")]
    PortTaken {
        /// The address.
        address: Ipv4Addr,
    },
    /// A local socket did not work.
    #[error(transparent)]
    Local(#[from] LocalError),
    /// Something that cannot be, such as settings that no connection can have; nothing was sent.
    #[error("{0}")]
    Impossible(
        /// Why it cannot be.
        String,
    ),
}

impl BusError for ProfinetError {
    const OUTDATED: Self = Self::Outdated;
    const ENDED: Self = Self::Ended;
}

impl ProfinetError {
    /// The four bytes of a refusal, if it is one.
    pub const fn status(&self) -> Option<Status> {
        match self {
            Self::Refused { status, .. } | Self::Aborted(status) => Some(*status),
            _ => None,
        }
    }
}

/// A module that is not as the layout says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ModuleMismatch {
    /// Its slot.
    pub slot: u16,
    /// The subslot, where the submodule is the one that differs.
    pub subslot: Option<u16>,
    /// The kind that the device has; none for nothing.
    pub found: Option<u32>,
    /// The kind in the layout; none where it has none.
    pub expected: Option<u32>,
}

impl fmt::Display for ModuleMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "slot {}", self.slot)?;
        let mut what = "module";
        if let Some(subslot) = self.subslot {
            write!(f, ", subslot {subslot:#x}")?;
            what = "submodule";
        }
        match self.found {
            Some(found) => write!(f, " holds {what} {found:#x}")?,
            None => write!(f, " holds no {what}")?,
        }
        match self.expected {
            Some(expected) if self.found == Some(expected) => write!(f, ", which cannot be used now"),
            Some(expected) => write!(f, ", the layout says {expected:#x}"),
            None => write!(f, ", the layout says none"),
        }
    }
}

/// Why data that came cannot be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unusable {
    /// None came.
    Missing,
    /// All of it: data status and transfer status.
    Status(u8, u8),
    /// The device says that the data of this slot and subslot is bad.
    Provider(u16, u16),
    /// The device does not use what it is sent for this slot and subslot.
    Consumer(u16, u16),
}

impl fmt::Display for Unusable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => write!(f, "no cyclic frame came"),
            Self::Status(status, transfer) => {
                let text = super::wire::cyclic::describe_status(*status, *transfer);
                write!(f, "{text} (data status {status:#04x})")
            }
            Self::Provider(slot, subslot) => {
                write!(f, "the device marks the data of slot {slot}, subslot {subslot:#x} as bad (IOPS)")
            }
            Self::Consumer(slot, subslot) => {
                write!(f, "the device does not take the data for slot {slot}, subslot {subslot:#x} (IOCS)")
            }
        }
    }
}
