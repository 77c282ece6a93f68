//! A network card as the medium to stations.

use std::io::{ErrorKind, Read as _, Write as _};
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4, UdpSocket};
use std::time::Instant;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use socket2::Socket;

use super::Now;
use super::error::ProfinetError;
use super::interface::Interface;
use super::medium::{Arrived, Medium};
use super::wire::dcp::IpSuite;
use super::wire::{Mac, arp, frame, rpc};
use crate::image::tap::{Passed, Tap};

/// Room for a frame or a datagram.
const BUFFER: usize = 65_536;

/// Frames of PROFINET and ARP on an interface, and datagrams where it has an address.
#[derive(Debug)]
pub struct Card {
    interface: Interface,
    start: Instant,
    raw: Socket,
    arp: Socket,
    udp: Option<UdpSocket>,
    tap: Tap,
    buffer: Vec<u8>,
}

impl Card {
    /// Opens it.
    ///
    /// # Errors
    /// When there is no such interface, frames cannot pass, or sockets cannot be had.
    pub fn open(name: &str, tap: Tap) -> Result<Self, ProfinetError> {
        let interface = Interface::find(name)?;
        let raw = interface.raw_socket(frame::ETHER_TYPE)?;
        let arp = interface.raw_socket(arp::ETHER_TYPE)?;
        interface.check()?;
        let bound = interface.ip.map(|ip| {
            let udp = UdpSocket::bind((ip.address, 0))?;
            udp.set_nonblocking(true).map(|()| udp)
        });
        let udp = bound.transpose().map_err(|error| ProfinetError::local("UDP socket for calls", &error))?;
        Ok(Self { interface, start: Instant::now(), raw, arp, udp, tap, buffer: vec![0; BUFFER] })
    }

    /// What is there already.
    fn take(&mut self) -> Result<Option<Arrived>, ProfinetError> {
        for mut socket in [&self.raw, &self.arp] {
            match socket.read(&mut self.buffer) {
                Ok(length) => {
                    let bytes = self.buffer[..length].to_vec();
                    self.tap.pass(|| Passed::Frame(bytes.clone()));
                    return Ok(Some(Arrived::Frame(bytes)));
                }
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {}
                Err(error) => return Err(ProfinetError::local("hearing frames", &error)),
            }
        }
        let Some(udp) = &self.udp else { return Ok(None) };
        // Nothing, or what a host says of an earlier call (port unreachable): the clock goes on.
        let Ok((length, SocketAddr::V4(from))) = udp.recv_from(&mut self.buffer) else { return Ok(None) };
        let bytes = self.buffer[..length].to_vec();
        if let Ok(to) = udp.local_addr() {
            self.tap.pass(|| Passed::Datagram { from: from.into(), to, bytes: bytes.clone() });
        }
        Ok(Some(Arrived::Datagram(from, bytes)))
    }
}

impl Medium for Card {
    fn here(&self) -> (Mac, Option<IpSuite>) {
        (self.interface.mac, self.interface.ip)
    }

    fn now(&self) -> Now {
        self.start.elapsed()
    }

    fn send(&mut self, frame: &[u8]) -> Result<(), ProfinetError> {
        self.tap.pass(|| Passed::Frame(frame.to_vec()));
        (&self.raw).write_all(frame).map_err(|error| ProfinetError::local("sending a frame", &error))
    }

    fn call(&mut self, to: Ipv4Addr, bytes: &[u8]) -> Result<(), ProfinetError> {
        let Some(udp) = &self.udp else { return Err(self.interface.address().err().unwrap_or(ProfinetError::Ended)) };
        let to = SocketAddrV4::new(to, rpc::PORT);
        if let Ok(from) = udp.local_addr() {
            self.tap.pass(|| Passed::Datagram { from, to: to.into(), bytes: bytes.to_vec() });
        }
        let sent = udp.send_to(bytes, to);
        sent.map(|_| ()).map_err(|error| ProfinetError::local("calling the device", &error))
    }

    fn next(&mut self, until: Now) -> Result<Option<Arrived>, ProfinetError> {
        loop {
            if let Some(arrived) = self.take()? {
                return Ok(Some(arrived));
            }
            let left = until.saturating_sub(self.now());
            if left.is_zero() {
                return Ok(None);
            }
            let wait = Timespec::try_from(left).ok();
            let mut sources = vec![PollFd::new(&self.raw, PollFlags::IN), PollFd::new(&self.arp, PollFlags::IN)];
            sources.extend(self.udp.as_ref().map(|udp| PollFd::new(udp, PollFlags::IN)));
            // An interruption is like a time that was shorter.
            let _ = poll(&mut sources, wait.as_ref());
        }
    }
}
