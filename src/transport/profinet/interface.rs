//! Network interfaces of a Linux machine, and raw Ethernet on them.

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
    /// Its name.
    pub name: String,
    /// The address of its card.
    pub mac: Mac,
    /// Its first IPv4 address and network, if it has one.
    pub ip: Option<IpSuite>,
    /// Whether it is switched on.
    pub is_up: bool,
    /// Whether a cable with something at its other end is plugged in.
    pub has_carrier: bool,
    /// Who records what passes outside of connections.
    pub tap: Tap,
    card: Card,
}

/// What is behind an interface.
#[derive(Debug, Clone)]
enum Card {
    /// A card of this machine.
    Real(LinkAddr),
    /// A network in this process.
    Simulated(simulated::Network),
}

/// The Ethernet interfaces of this machine.
///
/// # Errors
/// When the system does not tell.
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
    /// The one of this name.
    ///
    /// # Errors
    /// When there is none, with those that there are.
    pub fn find(name: &str) -> Result<Self, ProfinetError> {
        if let Some(network) = simulated::Network::find(name) {
            return Ok(network.interface());
        }
        let all = all().map_err(|error| LocalError::new("list of network interfaces", &error))?;
        let present = all.iter().map(|interface| interface.name.clone()).collect();
        let found = all.into_iter().find(|interface| interface.name == name);
        found.ok_or(ProfinetError::NoInterface { name: name.to_owned(), present })
    }

    pub(super) fn simulated(name: String, here: Here, network: simulated::Network) -> Self {
        let (mac, ip, card) = (here.mac, Some(here.ip), Card::Simulated(network));
        Self { name, mac, ip, is_up: true, has_carrier: true, tap: Tap::default(), card }
    }

    /// The network in this process that it leads to, if it is none of a card.
    pub const fn network(&self) -> Option<&simulated::Network> {
        match &self.card {
            Card::Real(_) => None,
            Card::Simulated(network) => Some(network),
        }
    }

    /// Whether frames can pass.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn check(&self) -> Result<(), ProfinetError> {
        let problem = match (self.is_up, self.has_carrier) {
            (false, _) => "is switched off",
            (true, false) => "has no carrier: no cable, or nothing switched on at its other end",
            (true, true) => return Ok(()),
        };
        Err(ProfinetError::Interface { name: self.name.clone(), problem })
    }

    /// Its address, which calls need.
    ///
    /// # Errors
    /// When it has none.
    pub fn address(&self) -> Result<IpSuite, ProfinetError> {
        let problem = "has no IPv4 address, which PROFINET needs beside its frames";
        self.ip.ok_or_else(|| ProfinetError::Interface { name: self.name.clone(), problem })
    }

    /// A socket for frames of one type, which does not block.
    ///
    /// # Errors
    /// When that is not allowed, or not possible.
    pub fn raw_socket(&self, ether_type: u16) -> Result<Socket, ProfinetError> {
        let failed = |error: &io::Error| match error.kind() {
            ErrorKind::PermissionDenied => ProfinetError::Privilege,
            _ => LocalError::new("raw Ethernet socket", error).into(),
        };
        let Card::Real(link) = &self.card else { return Err(ProfinetError::Ended) };
        let protocol = Protocol::from(i32::from(ether_type.to_be()));
        let socket = Socket::new(Domain::PACKET, Type::RAW, Some(protocol)).map_err(|error| failed(&error))?;
        nix::sys::socket::bind(socket.as_raw_fd(), link).map_err(|error| failed(&error.into()))?;
        socket.set_nonblocking(true).map_err(|error| failed(&error))?;
        Ok(socket)
    }
}
