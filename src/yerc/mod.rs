//! `yerc`: Yaskawa FS100, DX100, DX200 and YRC1000 over the high-speed Ethernet server.

mod alarm;
mod axes;
mod batch_split;
mod check;
pub mod commands;
mod complete;
mod connect;
mod control_commands;
pub mod decode;
mod explain;
pub mod face;
mod failure;
pub mod file;
#[cfg(test)]
mod gate_tests;
mod hours;
mod info;
mod io;
mod item_requests;
mod job;
pub mod link;
mod model_cache;
mod motion;
mod moves;
mod names;
mod number_arguments;
mod overview;
mod position;
mod prelude;
mod raw;
mod register;
mod selected_job;
mod serve;
pub mod simulator_start;
mod status;
mod teach;
mod teach_panel;
#[cfg(test)]
mod testing;
pub mod top;
mod trace;
mod var;
mod wireshark;
