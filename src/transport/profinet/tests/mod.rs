//! The controller against the device, in virtual time.

mod faults;
mod opening;
#[cfg(target_os = "linux")]
mod simulated;
mod tshark;
mod world;
