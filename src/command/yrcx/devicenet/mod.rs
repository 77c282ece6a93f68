//! Controllers on DeviceNet, and `yrcx devicenet`: diagnosis of the nodes with explicit messages. No polls are started,
//! so the end of the command does not affect the controller.

mod board;
pub mod bus;
mod check;
mod connect;
mod decode;
mod discover;
mod identity;
mod probe;
mod scan;
mod serve;
pub mod simulated;

use super::messages::ReadBoard;
use crate::command::commands;

commands! {
    /// Commands on the bus.
    pub enum DeviceNet {
        /// List the nodes on the bus; no node is allocated
        Scan(ReadBoard<scan::Scanned>),
        /// Identity of the controller's node
        Identity(ReadBoard<identity::Identified>),
        /// Image sizes and owner of the node
        Probe(ReadBoard<probe::Probed>),
    }
}
