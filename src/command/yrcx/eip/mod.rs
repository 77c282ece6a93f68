//! `yrcx eip`: the network board itself, by messages. For diagnosis: no connection for images is opened, so nothing that
//! the controller would miss when it ends.

pub mod board;
mod identity;
mod message;
mod probe;

use crate::command::commands;

/// Why `--unit` means nothing here.
const NO_UNIT: &str = "the board is that of the whole controller";

commands! {
    /// What the network board can be asked.
    pub enum Eip {
        /// Who the board is
        Identity(identity::Identify),
        /// Find the assemblies of the board, their sizes, and what makes a connection
        Probe(probe::Probe),
        /// Read an attribute of an object of the board (raw)
        Get(message::Get),
        /// Change an attribute of an object of the board (raw)
        Set(message::Set),
    }
}
