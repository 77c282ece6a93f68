//! Numbers that tell connections apart.

use std::sync::atomic::{AtomicU16, AtomicU32, Ordering};

use super::super::UNREGISTERED_VENDOR;
use super::super::wire::Triad;

/// Numbers that are unique in a process, and very likely elsewhere.
#[derive(Debug)]
pub struct Numbers {
    originator: u32,
    serial: AtomicU16,
    id: AtomicU32,
}

impl Numbers {
    /// Begins anywhere, so that what an earlier process left open is not hit.
    pub fn random() -> Self {
        Self::new(fastrand::u32(..), fastrand::u16(..), fastrand::u32(..))
    }

    /// Serial number of the originator, and where the numbers of connections and their ids begin.
    pub const fn new(originator: u32, serial: u16, id: u32) -> Self {
        Self { originator, serial: AtomicU16::new(serial), id: AtomicU32::new(id) }
    }

    pub(super) fn triad(&self) -> Triad {
        let serial = self.serial.fetch_add(1, Ordering::Relaxed);
        Triad { serial, vendor: UNREGISTERED_VENDOR, originator: self.originator }
    }

    pub(super) fn id(&self) -> u32 {
        // 0 is no id.
        match self.id.fetch_add(1, Ordering::Relaxed) {
            0 => self.id.fetch_add(1, Ordering::Relaxed),
            id => id,
        }
    }
}
