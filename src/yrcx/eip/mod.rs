//! Controllers on EtherNet/IP, and `yrcx eip`: diagnosis of the network board with explicit messages. No I/O connection
//! is opened, so the end of the command does not affect the controller.

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
use armctl_frame::commands;
use armctl_frame::failure::Failure;
use armctl_frame::settings::target::eip::SCHEME;

fn board_of(link: &mut Link) -> Result<&mut Board, Failure> {
    link.board(SCHEME.bus)
}

/// Reason why `--unit` is rejected.
const NO_UNIT: &str = "the board belongs to the whole controller";

commands! {
    /// Commands for the network board.
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
