//! Minimal client: a blocking socket, without sessions and retries, and nearly without checks.

use std::io;
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::time::Duration;

use armctl_controller::yerc::files::FileName;
use armctl_controller::yerc::wire::{HEADER_LEN, LAST_BLOCK, MAX_FRAME};

use crate::peers::{ACK, BLOCK, STATUS_ANSWER, STATUS_REQUEST, block};

/// The loopback interface loses nothing. If a datagram is still lost, the run ends after this time and does not hang.
const TIMEOUT: Duration = Duration::from_secs(5);

fn open(peer: SocketAddr) -> io::Result<UdpSocket> {
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0))?;
    socket.connect(peer)?;
    socket.set_read_timeout(Some(TIMEOUT))?;
    Ok(socket)
}

/// A client that does not decode answers.
pub struct Echo(UdpSocket);

impl Echo {
    pub fn open(peer: SocketAddr) -> io::Result<Self> {
        Ok(Self(open(peer)?))
    }

    /// Sends one datagram and receives one.
    pub fn round_trip(&mut self) -> io::Result<()> {
        let mut buffer = [0; MAX_FRAME];
        self.0.send(&[0; STATUS_REQUEST])?;
        let len = self.0.recv(&mut buffer)?;
        if len == STATUS_ANSWER { Ok(()) } else { Err(io::Error::other("an answer of another size")) }
    }
}

/// A file client that accepts the blocks in the order in which they arrive.
pub struct Download {
    socket: UdpSocket,
    request: Vec<u8>,
    ack: Vec<u8>,
}

impl Download {
    pub fn open(peer: SocketAddr) -> io::Result<Self> {
        let request = FileName::new("BIG.DAT").map_err(io::Error::other)?.save().frame(0);
        let mut ack = request[..HEADER_LEN].to_vec();
        ack[6..8].fill(0);
        ack[ACK] = 1;
        Ok(Self { socket: open(peer)?, request, ack })
    }

    /// Fetches the file and returns its size.
    pub fn run(&mut self) -> io::Result<u64> {
        let mut buffer = [0; MAX_FRAME];
        let mut bytes = 0;
        self.socket.send(&self.request)?;
        for expected in 1.. {
            let len = self.socket.recv(&mut buffer)?;
            let frame = &buffer[..len];
            if len < HEADER_LEN || block(frame) & !LAST_BLOCK != expected {
                return Err(io::Error::other("another block is due"));
            }
            bytes += (len - HEADER_LEN) as u64;
            self.ack[BLOCK..BLOCK + 4].copy_from_slice(&frame[BLOCK..BLOCK + 4]);
            self.socket.send(&self.ack)?;
            if block(frame) & LAST_BLOCK != 0 {
                break;
            }
        }
        Ok(bytes)
    }
}
