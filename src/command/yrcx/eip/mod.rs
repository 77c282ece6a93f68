//! Controllers on EtherNet/IP, and `yrcx eip`: the network board itself, by messages. For diagnosis: no connection for
//! images is opened, so nothing that the controller would miss when it ends.

mod board;
pub mod bus;
mod check;
mod cip;
mod connect;
mod decode;
mod discover;
mod identity;
mod message;
mod probe;
mod serve;
pub mod simulated;

use self::board::Board;
use super::link::Link;
use crate::command::commands;
use crate::failure::Failure;
use crate::settings::target::eip::SCHEME;

/// The board of a link that is for it alone.
fn board_of(link: &mut Link) -> Result<&mut Board, Failure> {
    link.board(SCHEME.bus)
}

/// Why `--unit` means nothing here.
const NO_UNIT: &str = "the board is that of the whole controller";

commands! {
    /// What the network board can be asked.
    pub enum Eip {
        /// Identity of the network board
        Identity(identity::Identify),
        /// Find the assemblies of the board, their sizes and connection parameters
        Probe(probe::Probe),
        /// Read an attribute of a board object (raw)
        Get(message::Get),
        /// Write an attribute of a board object (raw)
        Set(message::Set),
    }
}
