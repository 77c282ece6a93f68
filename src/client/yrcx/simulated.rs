//! Adapter from the simulated controller to a link in this process.

use std::time::Duration;

use armctl_controller::yrcx::image::Image;
use armctl_controller::yrcx::simulator::{Simulator, Start};
use armctl_transport::image::ImagePeer;

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

impl ImagePeer for Simulated {
    fn input(&mut self, now: Duration, image: Option<&[u8]>) {
        // A link carries only whole images.
        let image = image.and_then(Image::from_link);
        self.0.input(now, image.as_ref());
    }

    fn output(&mut self, now: Duration) -> Option<Vec<u8>> {
        self.0.advance(now);
        (!self.0.is_silent()).then(|| self.0.output().to_bytes().to_vec())
    }

    fn wake(&self) -> Option<Duration> {
        self.0.wake()
    }
}
