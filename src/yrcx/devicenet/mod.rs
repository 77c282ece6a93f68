//! Controllers on DeviceNet, and the commands `yrcx devicenet`, which diagnose the nodes with explicit messages. The
//! commands start no polls, so their end does not affect the controller.

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

use super::board_report::ReadBoard;
use armctl_frame::commands;

commands! {
    /// Commands for DeviceNet.
    pub enum DeviceNet {
        /// List the nodes on the bus, without allocating a node
        Scan(ReadBoard<scan::ScanReport>),
        /// Show the identity of the controller's node
        Identity(ReadBoard<identity::IdentityReport>),
        /// Show the image sizes and the owner of the node
        Probe(ReadBoard<probe::ProbeReport>),
    }
}
