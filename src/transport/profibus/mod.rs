//! PROFIBUS DP master of one slave, and a simulated slave. The master must be the only master on its RS-485 line.
//!
//! This module handles the bytes of images, and nothing specific to robots.

use std::time::Duration;

pub mod driver;
pub mod error;
pub mod gsd;
mod line_check;
pub mod link;
pub mod listener;
mod listener_driver;
pub mod master;
pub mod port;
pub mod rates;
pub mod request;
pub mod settings;
pub mod slave;
pub mod survey;
#[cfg(test)]
mod tests;
pub mod wire;

/// A moment, as the time since an origin that the driver selects. The time never decreases.
pub type Now = Duration;
