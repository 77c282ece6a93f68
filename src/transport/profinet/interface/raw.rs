//! Network cards of Linux, and raw Ethernet sockets.

use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::Ipv4Addr;
use std::os::fd::{AsFd, AsRawFd as _, BorrowedFd};
use std::time::Duration;

use nix::net::if_::InterfaceFlags;
use nix::sys::socket::{LinkAddr, SockaddrIn};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use socket2::{Domain, Protocol, Socket, Type};

use super::Interface;
use crate::image::tap::Tap;
use crate::local_error::LocalError;
use crate::profinet::error::ProfinetError;
use crate::profinet::simulated::Network;
use crate::profinet::wire::Mac;
use crate::profinet::wire::dcp::IpSuite;

/// What is behind an interface.
#[derive(Debug, Clone)]
pub enum Link {
    /// A network card.
    Card(LinkAddr),
    /// An in-process network.
    Simulated(Network),
}

impl Link {
    /// The in-process network; `None` for a network card.
    pub const fn network(&self) -> Option<&Network> {
        match self {
            Self::Card(_) => None,
            Self::Simulated(network) => Some(network),
        }
    }

    /// Opens a socket on a network card.
    pub fn socket(&self, ether_type: u16) -> Result<RawSocket, ProfinetError> {
        match self {
            Self::Card(card) => RawSocket::open(card, ether_type),
            Self::Simulated(_) => Err(ProfinetError::Ended),
        }
    }
}

/// Ethernet interfaces of this computer.
pub fn all() -> Result<Vec<Interface>, ProfinetError> {
    let mut found: Vec<Interface> = Vec::new();
    let entries = nix::ifaddrs::getifaddrs().map_err(io::Error::from);
    let entries = entries.map_err(|error| LocalError::new("cannot list the network interfaces", &error))?;
    let entries: Vec<_> = entries.collect();
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
            link: Link::Card(link),
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

/// Non-blocking socket for frames of one EtherType.
#[derive(Debug)]
pub struct RawSocket(Socket);

impl RawSocket {
    fn open(card: &LinkAddr, ether_type: u16) -> Result<Self, ProfinetError> {
        let failed = |error: &io::Error| match error.kind() {
            ErrorKind::PermissionDenied => ProfinetError::Privilege,
            _ => LocalError::new("cannot open a raw Ethernet socket", error).into(),
        };
        let protocol = Protocol::from(i32::from(ether_type.to_be()));
        let socket = Socket::new(Domain::PACKET, Type::RAW, Some(protocol)).map_err(|error| failed(&error))?;
        nix::sys::socket::bind(socket.as_raw_fd(), card).map_err(|error| failed(&error.into()))?;
        socket.set_nonblocking(true).map_err(|error| failed(&error))?;
        Ok(Self(socket))
    }

    /// Sends a frame.
    pub fn send(&self, frame: &[u8]) -> io::Result<()> {
        (&self.0).write_all(frame)
    }

    /// Reads a frame that has already arrived.
    pub fn receive(&self, buffer: &mut [u8]) -> io::Result<usize> {
        (&self.0).read(buffer)
    }

    /// Waits for a frame, at most for `most`.
    pub fn wait(&self, most: Duration) {
        let most = Timespec::try_from(most).ok();
        // A signal ends the wait early, as a shorter timeout would.
        let _ = poll(&mut [PollFd::new(&self.0, PollFlags::IN)], most.as_ref());
    }
}

impl AsFd for RawSocket {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.0.as_fd()
    }
}
