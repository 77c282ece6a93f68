//! State of a connection for callers.

use std::net::Ipv4Addr;

use super::super::error::ProfinetError;
use super::super::wire::Mac;
use crate::image::view;
pub use crate::image::view::{Input, State};

/// State of a connection. It has an input image only while it is open.
pub type View = view::View<ProfinetError, Statistics, Details>;
/// Receiver of state changes.
pub type Views = view::Views<ProfinetError, Statistics, Details>;

/// Step of the opening.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Step {
    /// Looking for the station.
    Resolve,
    /// Setting its IP address.
    Address,
    /// Connect was called.
    Connect,
    /// Writing parameters.
    Parameters,
    /// PrmEnd was called.
    PrmEnd,
    /// Waiting for ApplicationReady.
    Ready,
    /// Waiting for usable data.
    Data,
}

/// The device.
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

/// Counters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Frames sent.
    pub sent: u64,
    /// Frames omitted because their time was missed.
    pub skipped: u64,
    /// Frames received.
    pub received: u64,
    /// Frames that were duplicate, late, or out of order.
    pub stale: u64,
    /// Alarms received.
    pub alarms: u64,
    /// Number of losses.
    pub losses: u64,
}

/// Details that only PROFINET has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Details {
    /// Step of the opening.
    pub step: Step,
    /// The device, once found.
    pub device: Option<Device>,
}
