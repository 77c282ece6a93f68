//! Hook that records the traffic.

use std::fmt;
use std::net::SocketAddrV4;
use std::sync::Arc;

use crate::image::tap;

/// A datagram, or a piece of a TCP stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TappedPacket<'a> {
    /// Whether these bytes are a piece of a TCP stream.
    pub is_tcp: bool,
    /// Sender.
    pub from: SocketAddrV4,
    /// Receiver.
    pub to: SocketAddrV4,
    /// The bytes.
    pub bytes: &'a [u8],
}

type TapFunction = dyn Fn(&TappedPacket<'_>) + Send + Sync;

/// Function that is called with all traffic, on the threads that send and receive. The function must not block.
#[derive(Clone, Default)]
pub struct Tap(Option<Arc<TapFunction>>);

impl Tap {
    /// Creates a tap that calls this function.
    pub fn new(tap: impl Fn(&TappedPacket<'_>) + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(tap)))
    }

    pub(super) fn pass(&self, is_tcp: bool, from: SocketAddrV4, to: SocketAddrV4, bytes: &[u8]) {
        if let Some(tap) = &self.0 {
            tap(&TappedPacket { is_tcp, from, to, bytes });
        }
    }
}

impl From<tap::Tap> for Tap {
    fn from(tap: tap::Tap) -> Self {
        if !tap.is_open() {
            return Self::default();
        }
        Self::new(move |passed| {
            tap.pass(|| {
                let (from, to, bytes) = (passed.from.into(), passed.to.into(), passed.bytes.to_vec());
                if passed.is_tcp {
                    tap::TrafficRecord::Segment { from, to, bytes }
                } else {
                    tap::TrafficRecord::Datagram { from, to, bytes }
                }
            });
        })
    }
}

impl fmt::Debug for Tap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Tap" } else { "no Tap" })
    }
}
