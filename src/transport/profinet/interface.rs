//! Linux network interfaces and raw Ethernet sockets.

use std::io::{self, ErrorKind};
use std::net::Ipv4Addr;
use std::os::fd::AsRawFd as _;

use nix::net::if_::InterfaceFlags;
use nix::sys::socket::{LinkAddr, SockaddrIn};
use socket2::{Domain, Protocol, Socket, Type};

use super::controller::Here;
use super::error::ProfinetError;
use super::simulated;
use super::wire::Mac;
use super::wire::dcp::IpSuite;
use crate::image::tap::Tap;
use crate::local::LocalError;

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
    /// Recorder of traffic outside of connections.
    pub tap: Tap,
    card: Card,
}

#[derive(Debug, Clone)]
enum Card {
    /// A network card.
    Real(LinkAddr),
    /// An in-process network.
    Simulated(simulated::Network),
}

/// Ethernet interfaces of this computer.
pub fn all() -> io::Result<Vec<Interface>> {
    let mut found: Vec<Interface> = Vec::new();
    let entries: Vec<_> = nix::ifaddrs::getifaddrs().map_err(io::Error::from)?.collect();
    for entry in &entries {
        let Some(link) = entry.address.and_then(|address| address.as_link_addr().copied()) else { continue };
        let Some(mac) = link.addr().map(Mac).filter(|mac| mac.0 != [0; 6]) else { continue };
        found.push(Interface {
            name: entry.interface_name.clone(),
            mac,
            ip: None,
            is_up: entry.flags.contains(InterfaceFlags::IFF_UP),
            has_carrier: entry.flags.contains(InterfaceFlags::IFF_RUNNING),
            tap: Tap::default(),
            card: Card::Real(link),
        });
    }
    for entry in &entries {
        let ipv4 = |address: Option<nix::sys::socket::SockaddrStorage>| {
            address.and_then(|address| address.as_sockaddr_in().map(SockaddrIn::ip))
        };
        let (Some(address), Some(mask)) = (ipv4(entry.address), ipv4(entry.netmask)) else { continue };
        let interface = found.iter_mut().find(|interface| interface.name == entry.interface_name);
        if let Some(interface) = interface.filter(|interface| interface.ip.is_none()) {
            interface.ip = Some(IpSuite { address, mask, gateway: Ipv4Addr::UNSPECIFIED });
        }
    }
    Ok(found)
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
        let all = all().map_err(|error| LocalError::new("cannot list the network interfaces", &error))?;
        let present = all.iter().map(|interface| interface.name.clone()).collect();
        let found = all.into_iter().find(|interface| interface.name == name);
        found.ok_or(ProfinetError::NoInterface { name: name.to_owned(), present })
    }

    pub(super) fn simulated(name: String, here: Here, network: simulated::Network) -> Self {
        let (mac, ip, card) = (here.mac, Some(here.ip), Card::Simulated(network));
        Self { name, mac, ip, is_up: true, has_carrier: true, tap: Tap::default(), card }
    }

    /// The in-process network behind this interface; `None` for a network card.
    pub const fn network(&self) -> Option<&simulated::Network> {
        match &self.card {
            Card::Real(_) => None,
            Card::Simulated(network) => Some(network),
        }
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

    /// Returns the IP address of the interface. RPC calls need it.
    pub fn address(&self) -> Result<IpSuite, ProfinetError> {
        let problem = "has no IPv4 address, but PROFINET needs one";
        self.ip.ok_or_else(|| ProfinetError::Interface { name: self.name.clone(), problem })
    }

    /// Opens a non-blocking socket for frames of one EtherType.
    pub fn raw_socket(&self, ether_type: u16) -> Result<Socket, ProfinetError> {
        let failed = |error: &io::Error| match error.kind() {
            ErrorKind::PermissionDenied => ProfinetError::Privilege,
            _ => LocalError::new("cannot open a raw Ethernet socket", error).into(),
        };
        let Card::Real(link) = &self.card else { return Err(ProfinetError::Ended) };
        let protocol = Protocol::from(i32::from(ether_type.to_be()));
        let socket = Socket::new(Domain::PACKET, Type::RAW, Some(protocol)).map_err(|error| failed(&error))?;
        nix::sys::socket::bind(socket.as_raw_fd(), link).map_err(|error| failed(&error.into()))?;
        socket.set_nonblocking(true).map_err(|error| failed(&error))?;
        Ok(socket)
    }
}
