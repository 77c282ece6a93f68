//! Allocator for numbers that must be unique in a process.

use std::sync::atomic::{AtomicU16, AtomicU32, Ordering};

use super::super::wire::Uuid;
use super::super::wire::frame::id;

/// Allocator for numbers. No two connections of this process get the same number.
#[derive(Debug)]
pub struct Identifiers {
    frame_id: AtomicU16,
    reference: AtomicU16,
    session_key: AtomicU16,
    xid: AtomicU32,
}

impl Identifiers {
    /// Creates an allocator with random start values. So the connections of an earlier process are not confused with
    /// new connections.
    pub fn random() -> Self {
        Self {
            frame_id: AtomicU16::new(0),
            reference: AtomicU16::new(0),
            session_key: AtomicU16::new(fastrand::u16(..)),
            xid: AtomicU32::new(fastrand::u32(..)),
        }
    }

    /// Returns a frame id for a device, in the range of RT class 1.
    pub fn frame_id(&self) -> u16 {
        const FRAME_ID_COUNT: u16 = 0x3000;
        let number = self.frame_id.fetch_add(1, Ordering::Relaxed) % FRAME_ID_COUNT;
        id::RT_CLASS_1.start() + 1 + number
    }

    /// Returns an alarm reference.
    pub fn reference(&self) -> u16 {
        self.reference.fetch_add(1, Ordering::Relaxed).wrapping_add(1)
    }

    /// Returns a session key.
    pub fn session_key(&self) -> u16 {
        self.session_key.fetch_add(1, Ordering::Relaxed)
    }

    /// Returns an Xid (transaction id) for a DCP request. It is never 0, because some devices use 0 in answers.
    pub fn xid(&self) -> u32 {
        self.xid.fetch_add(1, Ordering::Relaxed).max(1)
    }

    /// Returns a random UUID.
    pub fn uuid(&self) -> Uuid {
        Uuid::random()
    }
}
