//! What passes on the wire of a fieldbus, for records.

use std::fmt;
use std::net::SocketAddr;
use std::sync::Arc;

/// Something that passed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Passed {
    /// A datagram.
    Datagram {
        /// Where it comes from.
        from: SocketAddr,
        /// Where it goes.
        to: SocketAddr,
        /// What it carries.
        bytes: Vec<u8>,
    },
    /// A piece of a TCP stream.
    Segment {
        /// Where it comes from.
        from: SocketAddr,
        /// Where it goes.
        to: SocketAddr,
        /// The piece.
        bytes: Vec<u8>,
    },
    /// A whole frame of a link with frames of its own, which the record names by its link type.
    Frame(Vec<u8>),
}

type Look = dyn Fn(Passed) + Send + Sync;

/// Called with all that passes, from the threads that move it; it must not block.
#[derive(Clone, Default)]
pub struct Tap(Option<Arc<Look>>);

impl Tap {
    /// Calls this.
    pub fn new(tap: impl Fn(Passed) + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(tap)))
    }

    /// Whether somebody listens.
    pub fn is_open(&self) -> bool {
        self.0.is_some()
    }

    /// Tells what passes, if somebody listens.
    pub fn pass(&self, passed: impl FnOnce() -> Passed) {
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
