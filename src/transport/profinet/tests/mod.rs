//! Tests of controller and device in virtual time.

#[cfg(target_os = "linux")]
mod commission;
mod faults;
mod opening;
#[cfg(target_os = "linux")]
mod simulated;
mod tshark;
mod world;
