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
use crate::command::commands;
use crate::failure::Failure;
use crate::settings::target::devicenet::BUS;

fn board_of(link: &mut Link) -> Result<&mut Board, Failure> {
    link.board(BUS)
}

/// Reason why `--unit` is rejected.
const NO_UNIT: &str = "the node is that of the whole controller";

commands! {
    /// What can be asked on the bus.
    pub enum DeviceNet {
        /// Who is on the bus, without owning anybody
        Scan(scan::Scan),
        /// Who the controller's node is
        Identity(identity::Identify),
        /// Sizes of the images, and who owns the node
        Probe(probe::Probe),
    }
}
