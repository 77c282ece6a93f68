//! Tests of controller and device in virtual time.

mod commission;
mod faults;
mod opening;
mod simulated;
mod tshark;
mod world;
