//! PROFINET IO controller and simulated device: cyclic images in Ethernet frames, RPC calls over UDP.
//!
//! This module handles submodules and bytes, and nothing specific to robots.

use std::time::Duration;

pub mod candidate_layouts;
pub mod commission;
pub mod controller;
pub mod device;
pub mod error;
pub mod gsdml;
pub mod interface;
pub mod layout;
pub mod link;
mod link_error;
pub mod network;
mod port;
pub mod settings;
pub mod simulated;
#[cfg(target_os = "linux")]
mod sockets;
#[cfg(not(target_os = "linux"))]
#[path = "no_sockets.rs"]
mod sockets;
#[cfg(test)]
mod tests;
pub mod wire;

/// A moment, as the time since an origin that the driver selects. The time never decreases.
pub type Now = Duration;
