//! Replacement for `raw` on systems without raw Ethernet sockets. There are no network cards.

use std::io;
use std::time::Duration;

use super::Interface;
use crate::profinet::error::ProfinetError;
use crate::profinet::simulated::Network;

/// What is behind an interface: only an in-process network.
#[derive(Debug, Clone)]
pub enum Link {
    /// An in-process network.
    Simulated(Network),
}

impl Link {
    /// Same as in `raw`.
    pub const fn network(&self) -> Option<&Network> {
        match self {
            Self::Simulated(network) => Some(network),
        }
    }

    /// Returns an error: not supported on this system.
    pub fn socket(&self, _ether_type: u16) -> Result<RawSocket, ProfinetError> {
        Err(ProfinetError::Platform)
    }
}

/// Returns an error: not supported on this system.
pub fn all() -> Result<Vec<Interface>, ProfinetError> {
    Err(ProfinetError::Platform)
}

/// A raw socket. It cannot be created.
#[derive(Debug)]
pub enum RawSocket {}

impl RawSocket {
    /// Same as in `raw`.
    pub fn send(&self, _frame: &[u8]) -> io::Result<()> {
        match *self {}
    }

    /// Same as in `raw`.
    pub fn receive(&self, _buffer: &mut [u8]) -> io::Result<usize> {
        match *self {}
    }

    /// Same as in `raw`.
    pub fn wait(&self, _most: Duration) {
        match *self {}
    }
}
