//! PROFIBUS DP: images to and from one slave, as the only master on a line of two wires.
//!
//! Knows bytes of images and no robot.

use std::time::Duration;

pub mod driver;
pub mod error;
pub mod gsd;
mod hearing;
pub mod link;
pub mod listener;
pub mod master;
pub mod port;
mod quiet;
pub mod rates;
pub mod request;
pub mod settings;
pub mod slave;
pub mod survey;
#[cfg(test)]
mod tests;
pub mod wire;

/// A moment, as time passed since an origin of the driver's choice. It never runs backwards.
pub type Now = Duration;
