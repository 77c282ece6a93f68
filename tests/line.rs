//! Sessions, transports and simulators against lines that lose, double and delay, in virtual time, and against ends that
//! others wrote.

mod eip;
mod faults;
mod peers;
#[cfg(unix)]
mod profibus;
#[cfg(target_os = "linux")]
mod profinet;
mod toyo_faults;
mod toyo_peers;
