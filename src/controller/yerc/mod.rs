//! Yaskawa FS100, DX100, DX200 and YRC1000: the high-speed Ethernet server ("YERC", after the identifier of every frame).
//!
//! UDP, little-endian, one frame a datagram. Sources, by short name in the docs of this folder: FS = FS100 manual
//! HW1481031, DX = DX200 manual HW1481977; section numbers are the same in both unless told otherwise.

pub mod describe;
pub mod files;
pub mod group;
mod model;
pub mod names;
pub mod passing;
pub mod payload;
pub mod query;
pub mod request;
pub mod session;
pub mod signal;
pub mod simulator;
pub mod status;
pub mod subcode;
pub mod table;
pub mod variables;
pub mod wire;

pub use model::Model;
