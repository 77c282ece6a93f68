//! Yaskawa FS100, DX100, DX200 and YRC1000: high-speed Ethernet server ("YERC", after the frame identifier).
//!
//! The protocol uses UDP and little-endian numbers, with one frame per datagram. Two manuals have short names here: FS
//! = FS100 manual HW1481031, DX = DX200 manual HW1481977. A section number applies to both manuals unless noted
//! otherwise.

pub mod describe;
pub mod files;
pub mod group;
pub mod job;
mod model;
pub mod names;
pub mod payload;
pub mod query;
pub mod read_only_filter;
pub mod recording;
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
