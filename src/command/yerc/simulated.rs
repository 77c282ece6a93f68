//! The simulated controller at the end of a transport: in this process, or as a server for many clients.

use std::path::Path;
use std::time::Duration;

use crate::controller::yerc::Model;
use crate::controller::yerc::simulator::{Simulator, Start};
use crate::controller::yerc::wire::Division;
use crate::failure::Failure;
use crate::files;
use crate::transport::fault::FaultSpec;
use crate::transport::server::Service;
use crate::transport::sim::Peer;

/// Robot and file server have a port each, which transports count as channels.
pub const fn channel(division: Division) -> usize {
    match division {
        Division::Robot => 0,
        Division::File => 1,
    }
}

const fn division(channel: usize) -> Division {
    if channel == 0 { Division::Robot } else { Division::File }
}

/// The start state: a file's, or the built-in one of the model; busy as often as the faults say.
pub fn start(file: Option<&Path>, model: Model, faults: Option<&FaultSpec>) -> Result<Start, Failure> {
    let start = file.map_or_else(|| Ok(Start::for_model(model)), load)?;
    Ok(match faults {
        Some(faults) => start.with_busy(f64::from(faults.busy.per_10_000()) / 10_000.0),
        None => start,
    })
}

/// More than a controller has room for.
const MOST: u64 = 256 << 20;

fn load(path: &Path) -> Result<Start, Failure> {
    let text = files::text(path, files::SETTINGS).map_err(|error| Failure::io(path.display(), &error))?;
    // Files that the state names lie beside it.
    let folder = path.parent().unwrap_or(Path::new(""));
    let read = |name: &str| {
        let path = folder.join(name);
        files::read(&path, MOST).map_err(|error| format!("{}: {error}", path.display()))
    };
    Start::parse(&text, read).map_err(|error| {
        Failure::usage(format!("{}: {error}", path.display()))
            .hint("`armctl help simulator` shows the form of the file")
    })
}

/// A simulated controller, whose clients have numbers.
#[derive(Debug)]
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

/// The only client of a simulator in this process.
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
