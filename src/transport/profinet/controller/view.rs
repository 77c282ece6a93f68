//! What there is to see of a connection.

use std::net::Ipv4Addr;

use super::super::error::ProfinetError;
use super::super::wire::Mac;
use crate::image::view;
pub use crate::image::view::{Input, State};

/// What there is to see of a connection. There is an image of the device only while it is up.
pub type View = view::View<ProfinetError, Statistics, Details>;
/// The same as it changes.
pub type Views = view::Views<ProfinetError, Statistics, Details>;

/// How far the opening of a connection is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Step {
    /// Looks for the station.
    Resolve,
    /// Gives it an address.
    Address,
    /// Connect is on its way.
    Connect,
    /// Parameters are on their way.
    Parameters,
    /// PrmEnd is on its way.
    PrmEnd,
    /// The device is to call ApplicationReady.
    Ready,
    /// Usable data is to come.
    Data,
}

/// Who the device is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Device {
    /// Its card.
    pub mac: Mac,
    /// Its name.
    pub name: String,
    /// Its address.
    pub address: Ipv4Addr,
    /// Vendor and device.
    pub id: (u16, u16),
}

/// What was counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Frames that left.
    pub sent: u64,
    /// Frames that should have left while the clock was not looked at.
    pub skipped: u64,
    /// Frames that came.
    pub received: u64,
    /// Frames that came twice, late, or out of order.
    pub stale: u64,
    /// Alarms.
    pub alarms: u64,
    /// How often the connection was lost.
    pub losses: u64,
}

/// What only PROFINET has to see.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Details {
    /// How far its opening is.
    pub step: Step,
    /// The device, once it was found.
    pub device: Option<Device>,
}
