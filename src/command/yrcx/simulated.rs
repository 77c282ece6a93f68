//! The simulated controller at the end of a link in this process.

use std::path::Path;
use std::time::Duration;

use anyhow::Context as _;

use crate::controller::yrcx::image::Image;
use crate::controller::yrcx::simulator::{Simulator, Start};
use crate::failure::Failure;
use crate::files;
use crate::settings::target::Sim;
use crate::transport::image::ImagePeer;

/// A simulator in this process, in the start state that the URL names.
pub fn in_process(sim: &Sim) -> Result<Simulated, Failure> {
    Ok(Simulated(Simulator::new(start(sim.state.as_deref())?)))
}

/// Whether the URL asks for what only a network can do wrong.
pub fn has_faults(sim: &Sim) -> bool {
    sim.fault.is_some() || sim.mischief.is_some()
}

/// The start state: a file's, or the built-in one.
pub fn start(file: Option<&Path>) -> Result<Start, Failure> {
    let Some(path) = file else { return Ok(Start::default()) };
    let text = files::text(path, files::SETTINGS).with_context(|| path.display().to_string())?;
    Start::parse(&text).map_err(|error| {
        Failure::usage(format!("{}: {error}", path.display()))
            .hint("`armctl help simulator` shows the form of the file")
    })
}

/// A simulated controller.
#[derive(Debug)]
pub struct Simulated(pub Simulator);

impl ImagePeer for Simulated {
    fn input(&mut self, now: Duration, image: Option<&[u8]>) {
        // A link carries whole images; anything else would be nobody's.
        let image = image.and_then(Image::from_link);
        self.0.input(now, image.as_ref());
    }

    fn output(&mut self, now: Duration) -> Option<Vec<u8>> {
        self.0.advance(now);
        Some(self.0.output().to_bytes().to_vec())
    }

    fn wake(&self) -> Option<Duration> {
        self.0.wake()
    }
}
