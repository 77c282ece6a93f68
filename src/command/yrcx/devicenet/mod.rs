//! Controllers on DeviceNet, and `yrcx devicenet`: nodes of the bus, by messages. For diagnosis: nothing is polled, so
//! nothing that the controller would miss when it ends.

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

/// The board of a link that is for it alone.
fn board_of(link: &mut Link) -> Result<&mut Board, Failure> {
    link.board(BUS)
}

/// Why `--unit` means nothing here.
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
