//! PROFINET IO: images to and from a device, cyclically in Ethernet frames, and calls to it over UDP.
//!
//! Knows bytes of submodules and no robot.

use std::time::Duration;

#[cfg(target_os = "linux")]
pub mod commission;
pub mod controller;
pub mod device;
pub mod error;
pub mod gsdml;
pub mod guess;
#[cfg(target_os = "linux")]
pub mod interface;
pub mod layout;
#[cfg(target_os = "linux")]
pub mod link;
mod link_error;
#[cfg(target_os = "linux")]
pub mod network;
#[cfg(target_os = "linux")]
mod port;
pub mod settings;
#[cfg(target_os = "linux")]
pub mod simulated;
#[cfg(target_os = "linux")]
mod sockets;
#[cfg(test)]
mod tests;
pub mod wire;

/// A moment, as time passed since an origin of the driver's choice. It never runs backwards.
pub type Now = Duration;
