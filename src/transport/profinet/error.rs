//! Errors of PROFINET connections.

use std::fmt;
use std::net::Ipv4Addr;
use std::time::Duration;

use thiserror::Error;

use super::wire::dcp;
use super::wire::status::Status;
use super::wire::{Mac, WireError};
use crate::image::view::BusError;
use crate::local_error::LocalError;

/// An error of a request or connection.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ProfinetError {
    /// No station has this name or MAC address.
    #[error("{station} was not found: no answer to DCP Identify within {} s", after.as_secs())]
    NotFound {
        /// Name or MAC address of the station.
        station: String,
        /// Total waiting time.
        after: Duration,
    },
    /// Two stations have the same name.
    #[error("{station} exists twice: {} and {}", cards.0, cards.1)]
    Duplicate {
        /// Name of the stations.
        station: String,
        /// MAC addresses of two stations with this name.
        cards: (Mac, Mac),
    },
    /// The device has no IP address, and the settings contain none.
    #[error("{0} has no IP address")]
    NoAddress(String),
    /// This computer and the device are in different IP networks.
    #[error("{station} has the address {device}, but this computer has {local_address} in another network")]
    OtherNetwork {
        /// Name of the station.
        station: String,
        /// IP address of the device.
        device: Ipv4Addr,
        /// IP address of this computer.
        local_address: Ipv4Addr,
    },
    /// Another station has the same IP address.
    #[error("{station} reports that another station has the same address {address}")]
    AddressConflict {
        /// Name of the station.
        station: String,
        /// The IP address that both stations have.
        address: Ipv4Addr,
    },
    /// The station refused a DCP setting.
    #[error("{what} was refused: {}", dcp::describe_error(*error))]
    Dcp {
        /// Name of the setting.
        what: &'static str,
        /// DCP error code.
        error: u8,
    },
    /// The device did not answer in time.
    #[error("no answer to {what} within {} s", after.as_secs())]
    NoAnswer {
        /// Name of the request.
        what: &'static str,
        /// Total waiting time.
        after: Duration,
    },
    /// The device refused.
    #[error("{what} was refused: {status}")]
    Refused {
        /// Name of the request.
        what: &'static str,
        /// Status of the answer.
        status: Status,
    },
    /// The RPC server rejected the call.
    #[error("{what} was rejected by the RPC server ({status:#010x})")]
    Rejected {
        /// Name of the request.
        what: &'static str,
        /// Status in the reject message.
        status: u32,
    },
    /// The answer cannot be decoded.
    #[error("cannot decode the answer to {what}: {error}")]
    Malformed {
        /// Name of the request.
        what: &'static str,
        /// The wrong field, and what is wrong with it.
        error: WireError,
    },
    /// The answer can be decoded, but is not valid.
    #[error("invalid answer to {what}: {why}")]
    Senseless {
        /// Name of the request.
        what: &'static str,
        /// What is wrong with the answer.
        why: &'static str,
    },
    /// The modules of the device do not match the layout. Contains at least one difference.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Modules(Vec<ModuleMismatch>),
    /// The device accepted all calls, but never called ApplicationReady.
    #[error("the device was not ready within {} s", .0.as_secs())]
    NeverReady(Duration),
    /// The device is ready, but sends no usable data.
    #[error("no usable data within {} s: {missing}", after.as_secs())]
    NoData {
        /// Waiting time for usable data.
        after: Duration,
        /// Reason why the data is not usable.
        missing: Unusable,
    },
    /// The connection is open, but the data of the device is not usable at the moment.
    #[error("the data of the device is not usable: {0}")]
    Unusable(Unusable),
    /// The device stopped sending, and the watchdog expired.
    #[error("no cyclic frame received for {} ms", .0.as_millis())]
    Silent(Duration),
    /// The device aborted the connection.
    #[error("the device ended the connection: {0}")]
    Aborted(Status),
    /// A module was plugged into the device. The device needs the parameters of this module again.
    #[error("a module was plugged in slot {0}")]
    Plugged(u16),
    /// The device did not accept the acknowledgement of an alarm.
    #[error("the device did not accept the acknowledgement of an alarm")]
    AlarmUnanswered,
    /// The connection was lost, and the caller has not noticed the loss yet: the image that it wants to send belongs to
    /// an older generation.
    #[error("the connection was lost")]
    Outdated,
    /// The connection was closed by this program.
    #[error("the connection is closed")]
    Ended,
    /// The user has no permission for raw Ethernet.
    #[error("PROFINET needs raw Ethernet, but armctl has no permission for it (CAP_NET_RAW)")]
    Privilege,
    /// This system has no raw Ethernet sockets for programs.
    #[error("PROFINET needs Linux: raw Ethernet")]
    Platform,
    /// The network interface does not exist.
    #[error("this computer has no network interface '{name}'")]
    NoInterface {
        /// Name of the interface.
        name: String,
        /// Names of the existing interfaces.
        present: Vec<String>,
    },
    /// The network interface exists, but cannot be used.
    #[error("the network interface '{name}' {problem}")]
    Interface {
        /// Name of the interface.
        name: String,
        /// Why the interface cannot be used.
        problem: &'static str,
    },
    /// Another program uses UDP port 34964.
    #[error("another program on this computer uses UDP port 34964 of {0}")]
    PortTaken(Ipv4Addr),
    /// A local socket failed.
    #[error(transparent)]
    Local(#[from] LocalError),
    /// The settings or the request are invalid; nothing was sent.
    #[error("{0}")]
    Impossible(String),
}

impl BusError for ProfinetError {
    const OUTDATED: Self = Self::Outdated;
    const ENDED: Self = Self::Ended;
}

impl ProfinetError {
    /// Status of a refusal or abort.
    pub const fn status(&self) -> Option<Status> {
        match self {
            Self::Refused { status, .. } | Self::Aborted(status) => Some(*status),
            _ => None,
        }
    }
}

/// A difference between the device and the layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ModuleMismatch {
    /// Slot number.
    pub slot: u16,
    /// Subslot number if the difference is in a submodule; `None` if the difference is in the module.
    pub subslot: Option<u16>,
    /// Ident number in the device; `None` if the slot or subslot is empty.
    pub found: Option<u32>,
    /// Ident number in the layout; `None` if the slot or subslot is empty.
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
            Some(found) => write!(f, " has {what} {found:#x}")?,
            None => write!(f, " has no {what}")?,
        }
        match self.expected {
            Some(expected) if self.found == Some(expected) => write!(f, ", which is not usable now"),
            Some(expected) => write!(f, ", but the layout has {expected:#x}"),
            None => write!(f, ", but the layout has none"),
        }
    }
}

/// Reason why received data is not usable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unusable {
    /// No data was received.
    Missing,
    /// The data status or the transfer status of the whole frame is bad. Contains both statuses.
    Status(u8, u8),
    /// The provider status of this slot and subslot is bad.
    Provider(u16, u16),
    /// The consumer status of this slot and subslot is bad.
    Consumer(u16, u16),
}

impl fmt::Display for Unusable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => write!(f, "no cyclic frame received"),
            Self::Status(status, transfer) => {
                let text = super::wire::cyclic::describe_status(*status, *transfer);
                write!(f, "{text} (data status {status:#04x})")
            }
            Self::Provider(slot, subslot) => {
                write!(f, "the device marks the data of slot {slot}, subslot {subslot:#x} as bad (IOPS)")
            }
            Self::Consumer(slot, subslot) => {
                write!(f, "the device refuses the data for slot {slot}, subslot {subslot:#x} (IOCS)")
            }
        }
    }
}
