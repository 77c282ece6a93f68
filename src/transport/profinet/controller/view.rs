//! What there is to see of a connection.

use std::net::Ipv4Addr;
use std::sync::Arc;

use super::super::Now;
use super::super::error::ProfinetError;
use super::super::wire::Mac;

/// How far a connection is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum State {
    /// It is being opened, for the first time or again.
    Opening,
    /// Data goes both ways.
    Open,
    /// The device runs, but its data cannot be used, or it is lost: it opens itself again.
    Lost,
    /// It is being closed.
    Closing,
    /// It is closed.
    Closed,
}

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

/// What the device shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    /// Its image.
    pub image: Arc<[u8]>,
    /// When it came.
    pub at: Now,
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

/// What there is to see of a connection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct View {
    /// How far it is.
    pub state: State,
    /// How far its opening is.
    pub step: Step,
    /// How often it was up; 0 before the first time.
    pub generation: u32,
    /// What the device shows; `None` unless it is up.
    pub input: Option<Input>,
    /// The last change of the output image that has left.
    pub sent: u64,
    /// What went wrong last.
    pub trouble: Option<ProfinetError>,
    /// The device, once it was found.
    pub device: Option<Device>,
    /// What was counted.
    pub statistics: Statistics,
}
