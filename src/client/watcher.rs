//! Who is told what happens on a line.

use std::fmt::Debug;
use std::net::SocketAddr;

use armctl_transport::tap::Direction;

/// Own and other address of a connection.
pub type Ends = (SocketAddr, SocketAddr);

/// Looks on: a trace, a log, a counter. `E` is what a client of the family notices beside frames. Nobody needs to: a client
/// that nobody watches does the same.
pub trait Watcher<E>: Debug + Send {
    /// These bytes left, or arrived.
    fn frame(&mut self, direction: Direction, ends: Ends, bytes: &[u8]) {
        let _ = (direction, ends, bytes);
    }

    /// This was noticed.
    fn event(&mut self, event: E) {
        let _ = event;
    }
}

/// Nobody.
impl<E> Watcher<E> for () {}
