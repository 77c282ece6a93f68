//! Adapter from the simulated controller to a transport peer: for one client in this process, or for many clients of a
//! server.

use std::time::Duration;

use armctl_controller::yerc::simulator::Simulator;
use armctl_controller::yerc::wire::Division;
use armctl_transport::server::Service;
use armctl_transport::sim::Peer;

/// Channel of a server: the robot server and the file server have one port each.
pub(super) const fn channel(division: Division) -> usize {
    match division {
        Division::Robot => 0,
        Division::File => 1,
    }
}

const fn division(channel: usize) -> Division {
    if channel == 0 { Division::Robot } else { Division::File }
}

/// A simulated controller with numbered clients.
#[derive(Debug)]
#[doc(hidden)]
pub struct Simulated(pub Simulator);

impl Service for Simulated {
    fn receive(&mut self, now: Duration, channel: usize, client: u64, bytes: &[u8]) {
        self.0.receive(now, division(channel), client, bytes);
    }

    fn transmit(&mut self, now: Duration) -> Option<(usize, u64, Vec<u8>)> {
        let outgoing = self.0.transmit(now)?;
        Some((channel(outgoing.division), outgoing.peer, outgoing.bytes))
    }

    fn wake(&self) -> Option<Duration> {
        self.0.wake()
    }
}

const ONLY_CLIENT: u64 = 0;

impl Peer for Simulated {
    fn receive(&mut self, now: Duration, channel: usize, bytes: &[u8]) {
        Service::receive(self, now, channel, ONLY_CLIENT, bytes);
    }

    fn transmit(&mut self, now: Duration) -> Option<(usize, Vec<u8>)> {
        Service::transmit(self, now).map(|(channel, _, bytes)| (channel, bytes))
    }

    fn wake(&self) -> Option<Duration> {
        Service::wake(self)
    }
}
