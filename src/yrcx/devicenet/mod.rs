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

use self::board::Board;
use super::link::Link;
use armctl_frame::commands;
use armctl_frame::failure::Failure;
use armctl_frame::settings::target::devicenet::BUS;

fn board_of(link: &mut Link) -> Result<&mut Board, Failure> {
    link.board(BUS)
}

/// Reason why `--unit` is rejected.
const NO_UNIT: &str = "the node belongs to the whole controller";

commands! {
    /// Commands on the bus.
    pub enum DeviceNet {
        /// List the nodes on the bus; no node is allocated
        Scan(scan::Scan),
        /// Identity of the controller's node
        Identity(identity::Identify),
        /// Image sizes and owner of the node
        Probe(probe::Probe),
    }
}
