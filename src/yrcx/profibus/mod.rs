//! Controllers on PROFIBUS DP, and the commands `yrcx profibus`, which diagnose the line and its stations. The commands
//! do not lock a slave.

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

use super::board_report::ReadBoard;
use armctl_frame::commands;

commands! {
    /// Commands for a line and its stations.
    pub enum Profibus {
        /// List the stations of the line without locking them
        Scan(ReadBoard<scan::Stations>),
        /// Show diagnosis, ident number and configuration of the station without locking it
        Probe(ReadBoard<probe::ProbeReport>),
        /// Show the diagnosis of the station with its blocks decoded, without locking it
        Diag(ReadBoard<diag::DiagnosisReport>),
    }
}
