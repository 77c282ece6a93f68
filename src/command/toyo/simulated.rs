//! The simulated controller at the end of a line: in this process, or served to others.

use std::path::Path;
use std::time::Duration;

use anyhow::Context as _;

use crate::controller::toyo::simulator::{Simulator, Start};
use crate::failure::Failure;
use crate::files;
use crate::transport::fault::LineFaultSpec;
use crate::transport::sim::Peer;

/// The start state: a file's, or the built-in one with so many axes; busy as often as the faults say.
pub fn start(file: Option<&Path>, axes: Option<u8>, faults: Option<&LineFaultSpec>) -> Result<Start, Failure> {
    let start = match (file, axes) {
        (None, None) => Start::default(),
        (None, Some(axes)) => Start::parse(&format!("axes = {axes}")).map_err(Failure::usage)?,
        (Some(file), None) => load(file)?,
        (Some(_), Some(_)) => {
            return Err(Failure::usage("the number of axes is given twice").hint("write it into the state file alone"));
        }
    };
    Ok(match faults {
        Some(faults) => start.with_busy(f64::from(faults.busy.per_10_000()) / 10_000.0),
        None => start,
    })
}

fn load(path: &Path) -> Result<Start, Failure> {
    let text = files::text(path, files::SETTINGS).with_context(|| path.display().to_string())?;
    Start::parse(&text).map_err(|error| {
        Failure::usage(format!("{}: {error}", path.display()))
            .hint("`armctl help simulator` shows the form of the file")
    })
}

/// A simulated controller.
#[derive(Debug)]
pub struct Simulated(pub Simulator);

impl Simulated {
    /// In its start state.
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
