//! Replacement for `sockets` on systems without raw Ethernet sockets.

use std::io;
use std::net::SocketAddrV4;
use std::time::Duration;

use super::error::ProfinetError;
use super::interface::Interface;
use super::wire::dcp::IpSuite;

/// Same as in `sockets`.
pub(super) const BUFFER: usize = 65_536;

/// Sockets of an interface. They cannot be created.
#[derive(Debug)]
pub(super) enum Sockets {}

impl Sockets {
    /// Returns an error: not supported on this system.
    pub fn open(_interface: &Interface) -> Result<(Self, IpSuite), ProfinetError> {
        Err(ProfinetError::Platform)
    }

    /// Same as in `sockets`.
    pub fn send_frame(&self, _bytes: &[u8]) -> io::Result<()> {
        match *self {}
    }

    /// Same as in `sockets`.
    pub fn send_datagram(&self, _to: SocketAddrV4, _bytes: &[u8]) -> io::Result<()> {
        match *self {}
    }

    /// Same as in `sockets`.
    pub fn wake_up(&self) {
        match *self {}
    }

    /// Same as in `sockets`.
    pub fn wait(&self, _most: Option<Duration>) {
        match *self {}
    }

    /// Same as in `sockets`.
    pub fn hear(&self, _buffer: &mut [u8], _frame: impl FnMut(&[u8]), _datagram: impl FnMut(SocketAddrV4, &[u8])) {
        match *self {}
    }
}
