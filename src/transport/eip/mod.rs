//! EtherNet/IP: images to and from an adapter, cyclically over UDP, and messages to it over TCP.
//!
//! Knows bytes of assemblies and no robot.

pub mod status;
pub mod wire;
