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
use armctl_frame::commands;
use armctl_frame::failure::Failure;
use armctl_frame::settings::target::profibus::SCHEME;

fn board_of(link: &mut Link) -> Result<&mut Board, Failure> {
    link.board(SCHEME.bus)
}

/// Reason why `--unit` is rejected.
const NO_UNIT: &str = "the station belongs to the whole controller";

commands! {
    /// Commands for a line and its stations.
    pub enum Profibus {
        /// List the stations of the line without locking them
        Scan(scan::Scan),
        /// Show diagnosis, ident number and configuration of the station without locking it
        Probe(probe::Probe),
        /// Show the diagnosis of the station with its blocks decoded, without locking it
        Diag(diag::Diag),
    }
}
