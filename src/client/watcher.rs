//! Observer of the frames and events of a client.

use std::fmt::Debug;
use std::net::SocketAddr;

use armctl_transport::tap::Direction;

/// Local and remote address of a connection.
///
/// Example: [`Watcher`]
pub type AddressPair = (SocketAddr, SocketAddr);

/// An observer of a client, for example a trace, a log or a counter. `E` is the event type of the controller family. A
/// watcher does not change what the client does.
///
/// ```
/// use std::sync::Arc;
/// use std::sync::atomic::{AtomicU32, Ordering};
///
/// use armctl_client::yerc::{Client, Endpoint, Event, Model, Options, ReadStatus};
/// use armctl_client::{AddressPair, Direction, Watcher};
///
/// #[derive(Debug, Default)]
/// struct Count(Arc<AtomicU32>);
///
/// impl Watcher<Event> for Count {
///     fn frame(&mut self, _: Direction, _: AddressPair, _: &[u8]) {
///         self.0.fetch_add(1, Ordering::Relaxed);
///     }
/// }
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut robot = Client::connect(Endpoint::simulator(Model::Dx200), Options::auto()).await?;
/// let count = Count::default();
/// let frames = Arc::clone(&count.0);
/// robot.watch(count);
/// robot.ask(&ReadStatus).await?;
/// assert_eq!(frames.load(Ordering::Relaxed), 2, "a request and its answer");
/// # Ok(())
/// # }
/// ```
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
