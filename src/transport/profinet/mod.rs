//! PROFINET IO controller and simulated device: cyclic images in Ethernet frames, RPC calls over UDP.
//!
//! This module handles submodules and bytes, and nothing specific to robots.

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

/// A moment, as the time since an origin that the driver selects. The time never decreases.
pub type Now = Duration;
