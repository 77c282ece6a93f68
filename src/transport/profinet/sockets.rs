//! Sockets of one interface, for a thread that waits for frames, datagrams and a timeout at the same time.

use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::{SocketAddr, SocketAddrV4, UdpSocket};
use std::os::unix::net::UnixStream;
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};

use super::error::ProfinetError;
use super::interface::{Interface, RawSocket};
use super::wire::dcp::IpSuite;
use super::wire::frame::ETHER_TYPE;
use super::wire::rpc;
use crate::local_error::LocalError;

/// Maximum number of frames or datagrams that are handled before the clock is checked.
const MAX_PER_WAKEUP: usize = 64;
/// Size of the receive buffer: the size of the longest datagram.
pub(super) const BUFFER: usize = 65_536;

#[derive(Debug)]
pub(super) struct Sockets {
    raw: RawSocket,
    udp: UdpSocket,
    /// Write end of a socket pair. A byte that is written here wakes the thread.
    wake_sender: UnixStream,
    wake_receiver: UnixStream,
}

impl Sockets {
    /// Opens the sockets of an interface. Returns them with the IP address of the interface.
    pub fn open(interface: &Interface) -> Result<(Self, IpSuite), ProfinetError> {
        let raw = interface.raw_socket(ETHER_TYPE)?;
        interface.check()?;
        let ip = interface.address()?;
        let failed =
            |error: &io::Error| ProfinetError::from(LocalError::new("cannot open a UDP socket for calls", error));
        let udp = UdpSocket::bind((ip.address, rpc::PORT)).map_err(|error| match error.kind() {
            ErrorKind::AddrInUse => ProfinetError::PortTaken(ip.address),
            _ => failed(&error),
        })?;
        udp.set_nonblocking(true).map_err(|error| failed(&error))?;
        let (wake_sender, wake_receiver) = UnixStream::pair().map_err(|error| failed(&error))?;
        for end in [&wake_sender, &wake_receiver] {
            end.set_nonblocking(true).map_err(|error| failed(&error))?;
        }
        Ok((Self { raw, udp, wake_sender, wake_receiver }, ip))
    }

    pub fn send_frame(&self, bytes: &[u8]) -> io::Result<()> {
        self.raw.send(bytes)
    }

    pub fn send_datagram(&self, to: SocketAddrV4, bytes: &[u8]) -> io::Result<()> {
        self.udp.send_to(bytes, to).map(|_| ())
    }

    /// Wakes the thread.
    pub fn wake_up(&self) {
        // An error means that the buffer is full. An earlier byte then already wakes the thread.
        let _ = (&self.wake_sender).write(&[0]);
    }

    /// Waits for a wake-up, a frame or a datagram, but at most for `most`.
    pub fn wait(&self, most: Option<Duration>) {
        let most = most.map(|most| Timespec::try_from(most).unwrap_or(Timespec { tv_sec: 1, tv_nsec: 0 }));
        let mut sources = [
            PollFd::new(&self.raw, PollFlags::IN),
            PollFd::new(&self.udp, PollFlags::IN),
            PollFd::new(&self.wake_receiver, PollFlags::IN),
        ];
        if poll(&mut sources, most.as_ref()).is_err_and(|error| error != rustix::io::Errno::INTR) {
            // Without this pause, a permanent error would cause a busy loop.
            std::thread::park_timeout(Duration::from_millis(1));
        }
        let mut rings = [0; 64];
        while (&self.wake_receiver).read(&mut rings).is_ok_and(|read| read > 0) {}
    }

    /// Reads all available frames and datagrams, up to the limit.
    pub fn hear(&self, buffer: &mut [u8], mut frame: impl FnMut(&[u8]), mut datagram: impl FnMut(SocketAddrV4, &[u8])) {
        for _ in 0..MAX_PER_WAKEUP {
            let Ok(length) = self.raw.receive(buffer) else { break };
            frame(&buffer[..length]);
        }
        for _ in 0..MAX_PER_WAKEUP {
            match self.udp.recv_from(buffer) {
                Ok((length, SocketAddr::V4(from))) => datagram(from, &buffer[..length]),
                Ok(_) => {}
                // This error concerns one host ("port unreachable" after an earlier call). The other hosts are not
                // affected.
                Err(error) if error.kind() == ErrorKind::ConnectionRefused => {}
                Err(_) => break,
            }
        }
    }
}
