//! DeviceNet: images to and from a slave of the predefined master/slave set, over a CAN adapter.
//!
//! Knows bytes of connections and no robot.

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

/// A moment, as time passed since an origin of the driver's choice. It never runs backwards.
pub type Now = Duration;

#[cfg(test)]
mod tests;
