//! Controllers on PROFINET IO: this machine is the IO controller of a device.

mod board;
pub mod bus;
mod check;
mod connect;
mod decode;
mod serve;
pub mod simulated;
