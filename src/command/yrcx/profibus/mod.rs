//! Controllers on PROFIBUS DP, and `yrcx profibus`: diagnosis of the line and its stations. No slave is locked.

mod board;
pub mod bus;
mod check;
mod connect;
mod decode;
mod diag;
mod discover;
mod probe;
mod scan;
mod serve;
pub mod simulated;

use self::board::Board;
use super::link::Link;
use crate::command::commands;
use crate::failure::Failure;
use crate::settings::target::profibus::SCHEME;

fn board_of(link: &mut Link) -> Result<&mut Board, Failure> {
    link.board(SCHEME.bus)
}

/// Reason why `--unit` is rejected.
const NO_UNIT: &str = "the station is that of the whole controller";

commands! {
    /// What a line and its stations can be asked.
    pub enum Profibus {
        /// List the stations of the line, without owning any
        Scan(scan::Scan),
        /// Show diagnosis, ident number and configuration of the station, without owning it
        Probe(probe::Probe),
        /// Show the diagnosis of the station with its blocks in words, without owning it
        Diag(diag::Diag),
    }
}
