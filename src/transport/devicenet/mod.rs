//! DeviceNet master and simulated slave: images to and from a slave of the predefined master/slave set, over a CAN
//! adapter.
//!
//! This module knows connections and bytes, but no robots.

use std::time::Duration;

pub mod can;
pub mod device;
pub mod error;
pub mod hub;
pub mod link;
pub mod monitor;
pub mod network;
pub mod scanner;
pub mod settings;
pub mod wire;

/// A moment, as time since an origin that the driver chooses. It never runs backwards.
pub type Now = Duration;

#[cfg(test)]
mod tests;
