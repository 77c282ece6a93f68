//! EtherNet/IP: images to and from an adapter, cyclically over UDP, and messages to it over TCP.
//!
//! Knows bytes of assemblies and no robot.

use std::time::Duration;

pub mod adapter;
mod class1;
pub mod client;
pub mod discovery;
mod engine;
pub mod error;
pub mod explicit;
pub mod link;
pub mod originator;
pub mod probe;
pub mod reader;
pub mod scanner;
pub mod session;
pub mod settings;
pub mod status;
pub mod tap;
pub mod wire;

/// A moment, as time passed since an origin of the driver's choice. It never runs backwards.
pub type Now = Duration;

/// TCP port of sessions, and UDP port of ListIdentity.
pub const PORT: u16 = 44818;
/// UDP port of cyclic data.
pub const IO_PORT: u16 = 2222;
/// The class of assemblies.
pub const ASSEMBLY: u32 = 4;
/// Vendors have numbers from the ODVA; this program's maker has none. Targets only tell originators apart by it.
pub const UNREGISTERED_VENDOR: u16 = 0xFFFF;
