//! Links to an in-process peer, for example a simulated controller.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::task::coop::consume_budget;
use tokio::time::Instant;

use super::fault::Faults;

/// A peer that exchanges datagrams or bytes of a stream. A byte stream has only channel 0.
pub trait Peer: fmt::Debug {
    /// Handles a datagram or bytes that arrived at `now`.
    fn receive(&mut self, now: Duration, channel: usize, bytes: &[u8]);
    /// Handles a character with a parity error on a serial line. Such a character is not passed to [`Peer::receive`].
    fn damaged(&mut self, _now: Duration, _channel: usize) {}
    /// Returns the next datagram or bytes due at `now`.
    fn transmit(&mut self, now: Duration) -> Option<(usize, Vec<u8>)>;
    /// Time of the next event.
    fn wake(&self) -> Option<Duration>;
}

impl<P: Peer + ?Sized> Peer for Box<P> {
    fn receive(&mut self, now: Duration, channel: usize, bytes: &[u8]) {
        (**self).receive(now, channel, bytes);
    }

    fn damaged(&mut self, now: Duration, channel: usize) {
        (**self).damaged(now, channel);
    }

    fn transmit(&mut self, now: Duration) -> Option<(usize, Vec<u8>)> {
        (**self).transmit(now)
    }

    fn wake(&self) -> Option<Duration> {
        (**self).wake()
    }
}

/// A peer that is shared with other threads.
impl<P: Peer> Peer for Arc<Mutex<P>> {
    fn receive(&mut self, now: Duration, channel: usize, bytes: &[u8]) {
        locked(self).receive(now, channel, bytes);
    }

    fn damaged(&mut self, now: Duration, channel: usize) {
        locked(self).damaged(now, channel);
    }

    fn transmit(&mut self, now: Duration) -> Option<(usize, Vec<u8>)> {
        locked(self).transmit(now)
    }

    fn wake(&self) -> Option<Duration> {
        locked(self).wake()
    }
}

/// Locks a shared peer, even if the last thread that locked it has panicked.
pub fn locked<P>(peer: &Mutex<P>) -> MutexGuard<'_, P> {
    peer.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A peer behind a link with fault injection. It uses tokio's clock, which tests can pause and advance.
#[derive(Debug)]
pub struct InProcess<P> {
    peer: P,
    start: Instant,
    to_peer_faults: Option<Faults>,
    from_peer_faults: Option<Faults>,
    wire: BinaryHeap<Reverse<InFlight>>,
    sent: u64,
}

/// A datagram in transit. The order is by arrival, then by departure.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct InFlight {
    at: Duration,
    order: u64,
    to_peer: bool,
    channel: usize,
    bytes: Vec<u8>,
}

impl<P: Peer> InProcess<P> {
    /// Creates a link to a peer. `faults` contains the faults of both directions.
    pub fn new(peer: P, faults: Option<(Faults, Faults)>) -> Self {
        let (to_peer_faults, from_peer_faults) = faults.unzip();
        Self { peer, start: Instant::now(), to_peer_faults, from_peer_faults, wire: BinaryHeap::new(), sent: 0 }
    }

    /// Sends one datagram to the peer.
    pub fn send(&mut self, channel: usize, bytes: &[u8]) {
        let now = self.start.elapsed();
        self.launch(now, true, channel, bytes);
    }

    /// Waits for one datagram of the peer on `channel`. Datagrams on other channels are dropped, as if their sockets
    /// were closed.
    pub async fn receive(&mut self, channel: usize, buffer: &mut [u8]) -> usize {
        // If a peer always answers at once, this call gives the runtime time to handle Ctrl-C.
        consume_budget().await;
        loop {
            let now = self.start.elapsed();
            while let Some((channel, bytes)) = self.peer.transmit(now) {
                self.launch(now, false, channel, &bytes);
            }
            if self.wire.peek().is_some_and(|Reverse(flight)| flight.at <= now) {
                let Some(Reverse(flight)) = self.wire.pop() else { continue };
                if flight.to_peer {
                    self.peer.receive(now, flight.channel, &flight.bytes);
                } else if flight.channel == channel {
                    let len = flight.bytes.len().min(buffer.len());
                    buffer[..len].copy_from_slice(&flight.bytes[..len]);
                    return len;
                }
                continue;
            }
            let arrival = self.wire.peek().map(|Reverse(flight)| flight.at);
            match arrival.into_iter().chain(self.peer.wake()).min() {
                Some(at) => tokio::time::sleep_until(self.start + at.max(now)).await,
                None => std::future::pending().await,
            }
        }
    }

    fn launch(&mut self, now: Duration, to_peer: bool, channel: usize, bytes: &[u8]) {
        let faults = if to_peer { &mut self.to_peer_faults } else { &mut self.from_peer_faults };
        let flights = match faults {
            Some(faults) => faults.pass(now, bytes),
            None => vec![(now, bytes.to_vec())],
        };
        for (at, bytes) in flights {
            self.sent += 1;
            self.wire.push(Reverse(InFlight { at, order: self.sent, to_peer, channel, bytes }));
        }
    }
}
