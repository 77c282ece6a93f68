//! Hook that records fieldbus traffic.

use std::fmt;
use std::net::SocketAddr;
use std::sync::Arc;

use crate::tap::Direction;

/// A recorded item.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TrafficRecord {
    /// A datagram.
    Datagram {
        /// Sender.
        from: SocketAddr,
        /// Receiver.
        to: SocketAddr,
        /// Payload.
        bytes: Vec<u8>,
    },
    /// A piece of a TCP stream.
    Segment {
        /// Sender.
        from: SocketAddr,
        /// Receiver.
        to: SocketAddr,
        /// Bytes of the piece.
        bytes: Vec<u8>,
    },
    /// Bytes to or from an adapter on this computer, while it is being set up. A recording does not contain them.
    Adapter {
        /// Direction: to the adapter, or from the adapter.
        direction: Direction,
        /// The bytes.
        bytes: Vec<u8>,
    },
    /// A whole frame of a link that has its own frame format. The link type of the recording identifies this format.
    Frame(Vec<u8>),
}

type TapFunction = dyn Fn(TrafficRecord) + Send + Sync;

/// Function that is called with all traffic, on the threads that send and receive. The function must not block.
#[derive(Clone, Default)]
pub struct Tap(Option<Arc<TapFunction>>);

impl Tap {
    /// Creates a tap that calls this function.
    pub fn new(tap: impl Fn(TrafficRecord) + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(tap)))
    }

    /// Whether the tap records anything.
    pub fn is_open(&self) -> bool {
        self.0.is_some()
    }

    /// Records an item. Calls `passed` only if the tap is open.
    pub fn pass(&self, passed: impl FnOnce() -> TrafficRecord) {
        if let Some(tap) = &self.0 {
            tap(passed());
        }
    }
}

impl fmt::Debug for Tap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Tap" } else { "no Tap" })
    }
}
