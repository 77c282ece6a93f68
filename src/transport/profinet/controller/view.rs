//! State of a connection for callers.

use std::net::Ipv4Addr;

use super::super::error::ProfinetError;
use super::super::wire::Mac;
use crate::image::view;
pub use crate::image::view::{Input, State};

/// State of a connection. The input image is present only while the connection is open.
pub type View = view::View<ProfinetError, Statistics, Details>;
/// Receiver of state changes.
pub type Views = view::Views<ProfinetError, Statistics, Details>;

/// Step of the opening.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Step {
    /// Searching for the station.
    Resolve,
    /// Setting the IP address of the station.
    Address,
    /// Waiting for the answer to Connect.
    Connect,
    /// Writing parameters.
    Parameters,
    /// Waiting for the answer to PrmEnd.
    PrmEnd,
    /// Waiting for ApplicationReady.
    Ready,
    /// Waiting for usable data.
    Data,
}

/// The device of a connection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Device {
    /// MAC address.
    pub mac: Mac,
    /// Station name.
    pub name: String,
    /// IP address.
    pub address: Ipv4Addr,
    /// Vendor id and device id.
    pub id: (u16, u16),
}

/// Counters of the frames and alarms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Frames sent.
    pub sent: u64,
    /// Frames that were omitted, because their time was missed.
    pub skipped: u64,
    /// Frames received.
    pub received: u64,
    /// Frames that were duplicate, late, or out of order.
    pub stale: u64,
    /// Alarms received.
    pub alarms: u64,
    /// Number of times that the connection was lost.
    pub losses: u64,
}

/// Details that only PROFINET has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Details {
    /// Step of the opening.
    pub step: Step,
    /// The device; `None` until it is found.
    pub device: Option<Device>,
}
