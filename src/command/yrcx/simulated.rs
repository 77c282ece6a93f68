//! The simulated controller at the end of a link: in this process.

use crate::failure::Failure;
use crate::settings::target::Sim;
use crate::transport::image::ImagePeer;

/// A simulator in the start state that the URL names.
pub fn start(_sim: &Sim) -> Result<Box<dyn ImagePeer>, Failure> {
    Err(Failure::usage("this version has no yrcx simulator"))
}
