//! Replacement for `raw` on systems without raw Ethernet sockets. There are no network cards.

use std::io;
use std::time::Duration;

use super::Interface;
use crate::profinet::error::ProfinetError;

/// Address of a network card. It cannot be created.
#[derive(Debug, Clone)]
pub enum Card {}

/// Returns an error: not supported on this system.
pub fn all() -> Result<Vec<Interface>, ProfinetError> {
    Err(ProfinetError::Platform)
}

/// A raw socket. It cannot be created.
#[derive(Debug)]
pub enum RawSocket {}

impl RawSocket {
    /// Same as in `raw`.
    pub fn open(card: &Card, _ether_type: u16) -> Result<Self, ProfinetError> {
        match *card {}
    }

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
