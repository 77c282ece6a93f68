//! Observer of the frames and events of a client.

use std::fmt::Debug;
use std::net::SocketAddr;

use armctl_transport::tap::Direction;

/// Local and remote address of a connection.
pub type AddressPair = (SocketAddr, SocketAddr);

/// An observer of a client, for example a trace, a log or a counter. `E` is the event type of the controller family. A
/// watcher does not change what the client does.
pub trait Watcher<E>: Debug + Send {
    /// A frame was sent or received.
    fn frame(&mut self, direction: Direction, address_pair: AddressPair, bytes: &[u8]) {
        let _ = (direction, address_pair, bytes);
    }

    /// A read was answered. `exchange` gives the request and the answer as text, in the form of recordings.
    fn answered(&mut self, exchange: &dyn Fn() -> (String, String)) {
        let _ = exchange;
    }

    /// An event occurred.
    fn event(&mut self, event: E) {
        let _ = event;
    }
}

impl<E> Watcher<E> for () {}
