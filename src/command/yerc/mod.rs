//! `yerc`: Yaskawa FS100, DX100, DX200 and YRC1000 over the high-speed Ethernet server.

mod alarm;
mod axes;
mod check;
mod chosen;
pub mod commands;
mod complete;
mod connect;
pub mod decode;
mod each;
mod explain;
pub mod face;
mod failure;
pub mod file;
#[cfg(test)]
mod gated;
mod hours;
mod info;
mod io;
mod job;
pub mod link;
mod motion;
mod moves;
mod names;
mod numbers;
mod orders;
mod overview;
mod panel;
mod parts;
mod position;
mod raw;
mod register;
mod serve;
pub mod simulated;
mod status;
mod teach;
#[cfg(test)]
mod testing;
mod told;
pub mod top;
mod trace;
mod var;
mod writes;
