//! The controller against the device, in virtual time.

#[cfg(target_os = "linux")]
mod commission;
mod faults;
mod opening;
mod tshark;
mod world;
