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
    /// The controller searches for the station.
    Resolve,
    /// The controller sets the IP address of the station.
    Address,
    /// The controller waits for the answer to Connect.
    Connect,
    /// The controller writes parameters.
    Parameters,
    /// The controller waits for the answer to PrmEnd.
    PrmEnd,
    /// The controller waits for ApplicationReady.
    Ready,
    /// The controller waits for usable data.
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
    /// Number of frames sent.
    pub sent: u64,
    /// Number of frames that were omitted, because their time was missed.
    pub skipped: u64,
    /// Number of frames received.
    pub received: u64,
    /// Number of frames that were duplicate, late, or out of order.
    pub stale: u64,
    /// Number of alarms received.
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
