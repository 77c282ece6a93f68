//! Tests of master and slave together, in virtual time.

mod faults;
mod link;
mod peers;
mod sockets;
mod tshark;
mod world;
