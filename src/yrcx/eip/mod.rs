//! Controllers on EtherNet/IP, and the commands `yrcx eip`, which diagnose the network board with explicit messages.
//! The commands open no I/O connection, so their end does not affect the controller.

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

use super::board_report::ReadBoard;
use armctl_frame::commands;

commands! {
    /// Commands for the network board.
    pub enum Eip {
        /// Show the identity of the network board
        Identity(ReadBoard<identity::IdentityReport>),
        /// Find the assemblies of the board, their sizes and connection parameters
        Probe(probe::Probe),
        /// Read an attribute of a board object (raw)
        Get(message::Get),
        /// Write an attribute of a board object (raw)
        Set(message::Set),
    }
}
