//! EtherNet/IP: both ends of this project with each other, in virtual time and on sockets, and each end with other
//! implementations.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

mod bytes;
mod pcap;
mod peers;
mod sockets;
mod virtual_time;
mod world;
