//! Sessions, transports and simulators: on links with loss, duplication and delay in virtual time, and with programs of
//! other authors.

mod eip;
mod faults;
mod peers;
#[cfg(unix)]
mod profibus;
#[cfg(target_os = "linux")]
mod profinet;
mod toyo_faults;
mod toyo_peers;
