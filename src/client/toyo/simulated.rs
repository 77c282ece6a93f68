//! Adapter from the simulated controller to a transport peer, in this process or on a server.

use std::time::Duration;

use armctl_controller::toyo::simulator::{Simulator, Start};
use armctl_transport::sim::Peer;

/// A simulated controller.
#[derive(Debug)]
#[doc(hidden)]
pub struct Simulated(pub Simulator);

impl Simulated {
    /// A controller in this start state.
    pub fn new(start: Start) -> Self {
        Self(Simulator::new(start))
    }
}

impl Peer for Simulated {
    fn receive(&mut self, now: Duration, _channel: usize, bytes: &[u8]) {
        self.0.receive(now, bytes);
    }

    fn damaged(&mut self, now: Duration, _channel: usize) {
        self.0.damaged(now);
    }

    fn transmit(&mut self, now: Duration) -> Option<(usize, Vec<u8>)> {
        self.0.transmit(now).map(|bytes| (0, bytes))
    }

    fn wake(&self) -> Option<Duration> {
        self.0.wake()
    }
}
