//! Master and slave together, in virtual time.

mod faults;
mod link;
mod sockets;
mod tshark;
mod world;
