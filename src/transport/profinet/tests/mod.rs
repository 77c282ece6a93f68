//! The controller against the device, in virtual time.

mod commission;
mod faults;
mod opening;
mod tshark;
mod world;
