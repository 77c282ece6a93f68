//! Frames and RPC calls outside of connections. They go through a network card, or to a simulated device.

use std::io::ErrorKind;
use std::net::{SocketAddr, SocketAddrV4, UdpSocket};
use std::time::{Duration, Instant};

use super::error::ProfinetError;
use super::interface::{Interface, RawSocket};
use super::network::in_frame;
use super::simulated::Network;
use super::wire::frame::{self, Frame};
use super::wire::{Mac, arp, rpc};
use super::{Now, simulated};
use crate::image::tap::{Tap, TrafficRecord};
use crate::local_error::LocalError;

/// Buffer for a frame or datagram.
const BUFFER: usize = 65_536;

/// Sender and receiver of Ethernet frames.
#[derive(Debug)]
pub(super) struct Frames {
    end: End<RawSocket>,
    tap: Tap,
}

/// Sender and receiver of datagrams of one device.
#[derive(Debug)]
pub(super) struct Calls {
    end: End<UdpSocket>,
    tap: Tap,
    cards: (Mac, Mac),
    target: SocketAddrV4,
}

#[derive(Debug)]
enum End<S> {
    Socket(S, Instant),
    Simulated(Network),
}

impl<S> End<S> {
    fn now(&self) -> Now {
        match self {
            Self::Socket(_, start) => start.elapsed(),
            Self::Simulated(network) => network.now(),
        }
    }
}

impl Frames {
    pub(super) fn open(interface: &Interface) -> Result<Self, ProfinetError> {
        Self::of(interface, frame::ETHER_TYPE)
    }

    /// Opens a socket for ARP frames.
    pub(super) fn of_arp(interface: &Interface) -> Result<Self, ProfinetError> {
        Self::of(interface, arp::ETHER_TYPE)
    }

    fn of(interface: &Interface, ether_type: u16) -> Result<Self, ProfinetError> {
        interface.check()?;
        let end = match interface.network() {
            Some(network) => End::Simulated(network.clone()),
            None => End::Socket(interface.raw_socket(ether_type)?, Instant::now()),
        };
        Ok(Self { end, tap: interface.tap.clone() })
    }

    pub(super) fn now(&self) -> Now {
        self.end.now()
    }

    pub(super) fn send(&self, frame: &[u8]) -> Result<(), ProfinetError> {
        self.tap.pass(|| TrafficRecord::Frame(frame.to_vec()));
        match &self.end {
            End::Simulated(network) => network.send_frame(frame),
            End::Socket(socket, _) => {
                socket.send(frame).map_err(|error| LocalError::new("cannot send a frame", &error))?;
            }
        }
        Ok(())
    }

    /// Passes received frames to `take` until it returns a value, or until a timeout.
    pub(super) fn hear<T>(
        &self,
        until: Now,
        mut take: impl FnMut(&Frame<'_>) -> Option<T>,
    ) -> Result<Option<T>, ProfinetError> {
        while let Some(bytes) = self.next(until)? {
            if let Some(made) = Frame::parse(&bytes).ok().and_then(|frame| take(&frame)) {
                return Ok(Some(made));
            }
        }
        Ok(None)
    }

    /// Returns the next frame that arrives before `until`.
    pub(super) fn next(&self, until: Now) -> Result<Option<Vec<u8>>, ProfinetError> {
        let came = self.take(until)?;
        if let Some(bytes) = &came {
            self.tap.pass(|| TrafficRecord::Frame(bytes.clone()));
        }
        Ok(came)
    }

    fn take(&self, until: Now) -> Result<Option<Vec<u8>>, ProfinetError> {
        let (socket, start) = match &self.end {
            End::Simulated(network) => return Ok(network.receive_frame(until)),
            End::Socket(socket, start) => (socket, start),
        };
        let mut buffer = vec![0; BUFFER];
        loop {
            let left = until.saturating_sub(start.elapsed());
            if left.is_zero() {
                return Ok(None);
            }
            socket.wait(left);
            match socket.receive(&mut buffer) {
                Ok(length) => {
                    buffer.truncate(length);
                    return Ok(Some(buffer));
                }
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {}
                Err(error) => return Err(LocalError::new("cannot receive frames", &error).into()),
            }
        }
    }
}

impl Calls {
    /// Opens a socket to the device with this MAC and IP address.
    pub(super) fn open(interface: &Interface, mac: Mac, target: SocketAddrV4) -> Result<Self, ProfinetError> {
        let end = if let Some(network) = interface.network() {
            End::Simulated(network.clone())
        } else {
            let socket = UdpSocket::bind((interface.address()?.address, 0));
            let socket = socket.map_err(|error| LocalError::new("cannot open a UDP socket for calls", &error))?;
            End::Socket(socket, Instant::now())
        };
        Ok(Self { end, tap: interface.tap.clone(), cards: (interface.mac, mac), target })
    }

    pub(super) fn now(&self) -> Now {
        self.end.now()
    }

    pub(super) fn send(&self, bytes: &[u8]) -> Result<(), ProfinetError> {
        self.tap.pass(|| {
            TrafficRecord::Frame(in_frame(self.cards.0, self.cards.1, self.local_address(), self.target, bytes))
        });
        match &self.end {
            End::Simulated(network) => network.send_datagram(self.target, bytes),
            End::Socket(socket, _) => {
                let sent = socket.send_to(bytes, self.target);
                sent.map_err(|error| LocalError::new("cannot call the device", &error))?;
            }
        }
        Ok(())
    }

    /// Returns the next datagram of the device that arrives before `until`.
    pub(super) fn hear(&self, until: Now) -> Result<Option<Vec<u8>>, ProfinetError> {
        let (bytes, from) = match &self.end {
            End::Simulated(network) => match network.receive_datagram(until) {
                Some((from, bytes)) => (bytes, from),
                None => return Ok(None),
            },
            End::Socket(socket, start) => {
                let wait = until.saturating_sub(start.elapsed()).max(Duration::from_millis(1));
                let timed = socket.set_read_timeout(Some(wait));
                timed.map_err(|error| LocalError::new("cannot call the device", &error))?;
                let mut buffer = vec![0; BUFFER];
                // This is a timeout or a signal. The caller checks the time.
                let Ok((length, SocketAddr::V4(from))) = socket.recv_from(&mut buffer) else { return Ok(None) };
                buffer.truncate(length);
                (buffer, from)
            }
        };
        if from.ip() != self.target.ip() {
            return Ok(None);
        }
        self.tap
            .pass(|| TrafficRecord::Frame(in_frame(self.cards.1, self.cards.0, from, self.local_address(), &bytes)));
        Ok(Some(bytes))
    }

    fn local_address(&self) -> SocketAddrV4 {
        match &self.end {
            End::Simulated(_) => SocketAddrV4::new(simulated::OUR_ADDRESS.ip.address, rpc::PORT),
            End::Socket(socket, _) => match socket.local_addr() {
                Ok(SocketAddr::V4(local_address)) => local_address,
                _ => self.target,
            },
        }
    }
}
