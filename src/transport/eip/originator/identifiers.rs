//! Allocator for connection serial numbers and ids.

use std::sync::atomic::{AtomicU16, AtomicU32, Ordering};

use super::super::UNREGISTERED_VENDOR;
use super::super::wire::Triad;

/// Allocates numbers that are unique in this process, and probably also unique in the network.
#[derive(Debug)]
pub struct Identifiers {
    originator: u32,
    serial: AtomicU16,
    id: AtomicU32,
}

impl Identifiers {
    /// Creates numbers with random start values. So they are probably different from the numbers of connections that an
    /// earlier process left open.
    pub fn random() -> Self {
        Self::new(fastrand::u32(..), fastrand::u16(..), fastrand::u32(..))
    }

    /// Creates numbers with fixed start values: serial number of the originator, first connection serial number, first
    /// connection id.
    pub const fn new(originator: u32, serial: u16, id: u32) -> Self {
        Self { originator, serial: AtomicU16::new(serial), id: AtomicU32::new(id) }
    }

    pub(super) fn triad(&self) -> Triad {
        let serial = self.serial.fetch_add(1, Ordering::Relaxed);
        Triad { serial, vendor: UNREGISTERED_VENDOR, originator: self.originator }
    }

    pub(super) fn id(&self) -> u32 {
        // 0 is not a valid id, so the next number is used.
        match self.id.fetch_add(1, Ordering::Relaxed) {
            0 => self.id.fetch_add(1, Ordering::Relaxed),
            id => id,
        }
    }
}
