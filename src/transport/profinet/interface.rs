//! Ethernet interfaces: network cards of Linux, and in-process networks of every system.

#[cfg(target_os = "linux")]
mod raw;
#[cfg(not(target_os = "linux"))]
#[path = "interface/no_raw.rs"]
mod raw;

use super::controller::LocalAddress;
use super::error::ProfinetError;
use super::simulated;
use super::wire::Mac;
use super::wire::dcp::IpSuite;
use crate::image::tap::Tap;

use self::raw::Link;
pub use self::raw::{RawSocket, all};

/// An Ethernet interface.
#[derive(Debug, Clone)]
pub struct Interface {
    /// Interface name.
    pub name: String,
    /// MAC address.
    pub mac: Mac,
    /// First IPv4 address of the interface, with its network.
    pub ip: Option<IpSuite>,
    /// Whether the interface is up.
    pub is_up: bool,
    /// Whether the interface has a carrier (a cable and a peer).
    pub has_carrier: bool,
    /// Recorder for traffic that belongs to no connection.
    pub tap: Tap,
    link: Link,
}

impl Interface {
    /// Finds an interface by name.
    ///
    /// # Errors
    /// The interface does not exist. The error lists the existing interfaces.
    pub fn find(name: &str) -> Result<Self, ProfinetError> {
        if let Some(network) = simulated::Network::find(name) {
            return Ok(network.interface());
        }
        let all = all()?;
        let present = all.iter().map(|interface| interface.name.clone()).collect();
        let found = all.into_iter().find(|interface| interface.name == name);
        found.ok_or(ProfinetError::NoInterface { name: name.to_owned(), present })
    }

    pub(super) fn simulated(name: String, local_address: LocalAddress, network: simulated::Network) -> Self {
        let (mac, ip, link) = (local_address.mac, Some(local_address.ip), Link::Simulated(network));
        Self { name, mac, ip, is_up: true, has_carrier: true, tap: Tap::default(), link }
    }

    /// The in-process network behind this interface; `None` for a network card.
    pub const fn network(&self) -> Option<&simulated::Network> {
        self.link.network()
    }

    /// Checks that the interface can transmit frames.
    pub fn check(&self) -> Result<(), ProfinetError> {
        let problem = match (self.is_up, self.has_carrier) {
            (false, _) => "is switched off",
            (true, false) => "has no carrier: no cable, or the device at its other end is off",
            (true, true) => return Ok(()),
        };
        Err(ProfinetError::Interface { name: self.name.clone(), problem })
    }

    /// Returns the IP address of the interface, which RPC calls need.
    pub fn address(&self) -> Result<IpSuite, ProfinetError> {
        let problem = "has no IPv4 address, but PROFINET needs one";
        self.ip.ok_or_else(|| ProfinetError::Interface { name: self.name.clone(), problem })
    }

    /// Opens a non-blocking socket for frames of one EtherType.
    pub fn raw_socket(&self, ether_type: u16) -> Result<RawSocket, ProfinetError> {
        self.link.socket(ether_type)
    }
}
