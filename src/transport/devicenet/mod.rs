//! DeviceNet master and simulated slave: images to and from a slave of the predefined master/slave connection set, over
//! a CAN adapter.
//!
//! This module handles connections and bytes, and nothing specific to robots.

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

/// A moment, as the time since an origin that the driver selects. The time never decreases.
pub type Now = Duration;

#[cfg(test)]
mod tests;
