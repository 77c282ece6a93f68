//! Numbers that no two connections of a process may share.

use std::sync::atomic::{AtomicU16, AtomicU32, Ordering};

use super::super::wire::Uuid;
use super::super::wire::frame::id;

/// Hands them out.
#[derive(Debug)]
pub struct Numbers {
    frame_id: AtomicU16,
    reference: AtomicU16,
    session_key: AtomicU16,
    xid: AtomicU32,
}

impl Numbers {
    /// Begins anywhere, so that what an earlier process left behind is not taken for this one's.
    pub fn random() -> Self {
        Self {
            frame_id: AtomicU16::new(0),
            reference: AtomicU16::new(0),
            session_key: AtomicU16::new(fastrand::u16(..)),
            xid: AtomicU32::new(fastrand::u32(..)),
        }
    }

    /// The id of frames from a device: distinct for each connection, in the range of class 1.
    pub fn frame_id(&self) -> u16 {
        const MANY: u16 = 0x3000;
        let number = self.frame_id.fetch_add(1, Ordering::Relaxed) % MANY;
        id::RT_CLASS_1.start() + 1 + number
    }

    /// The number of a connection in alarms.
    pub fn reference(&self) -> u16 {
        self.reference.fetch_add(1, Ordering::Relaxed).wrapping_add(1)
    }

    /// The key of the next connection.
    pub fn session_key(&self) -> u16 {
        self.session_key.fetch_add(1, Ordering::Relaxed)
    }

    /// The number of the next question of DCP; never 0, which some devices answer with.
    pub fn xid(&self) -> u32 {
        self.xid.fetch_add(1, Ordering::Relaxed).max(1)
    }

    /// A UUID.
    pub fn uuid(&self) -> Uuid {
        Uuid::random()
    }
}
