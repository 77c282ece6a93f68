//! The controller against the device, in virtual time.

mod faults;
mod opening;
mod world;
