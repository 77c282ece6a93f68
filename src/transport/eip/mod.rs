//! EtherNet/IP originator and simulated adapter: cyclic images over UDP, explicit messages over TCP.
//!
//! This module handles assemblies and bytes, and nothing specific to robots.

use std::time::Duration;

pub mod adapter;
mod class1;
pub mod client;
pub mod discovery;
mod engine;
pub mod error;
pub mod explicit;
pub mod image_reader;
pub mod link;
pub mod originator;
pub mod probe;
pub mod scanner;
pub mod session;
pub mod settings;
pub mod status;
pub mod tap;
pub mod wire;

/// A moment, as the time since an origin that the driver selects. The time never decreases.
pub type Now = Duration;

/// TCP port of sessions, and UDP port of ListIdentity.
pub const PORT: u16 = 44818;
/// UDP port of cyclic data.
pub const IO_PORT: u16 = 2222;
/// Class code of the assembly object.
pub const ASSEMBLY: u32 = 4;
/// Vendor id of this program. ODVA has not assigned an id to it. Targets use the vendor id only to identify
/// originators.
pub const UNREGISTERED_VENDOR: u16 = 0xFFFF;
