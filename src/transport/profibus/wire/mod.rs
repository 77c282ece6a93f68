//! The bytes of PROFIBUS DP: telegrams with their function codes, and what the services of a slave carry.
//!
//! Parsing takes what stations send: eight bytes of data come in either of two forms. Emitting writes one form of each.
//! Sections below are those of EN 50170, volume 2.

pub use crate::bytes::{Problem, WireError};

mod configuration;
mod control;
mod diagnosis;
mod parameters;
mod stream;
mod telegram;

pub use configuration::{Configuration, Module};
pub use control::{Control, FrameCount, Service, Station, Status};
pub use diagnosis::{Block, Diagnosis, Flag};
pub use parameters::{GlobalControl, Lock, Parameters, Watchdog};
pub use stream::{Piece, Stream};
pub use telegram::{CHECKSUM, Frame, MAX_DATA, Parsed, START, Telegram};

/// Service access points of a slave.
pub mod sap {
    /// The one that a master asks from.
    pub const MASTER: u8 = 62;
    /// A new address for the slave.
    pub const SET_SLAVE_ADDRESS: u8 = 55;
    /// What the slave shows.
    pub const READ_INPUTS: u8 = 56;
    /// What the slave is shown.
    pub const READ_OUTPUTS: u8 = 57;
    /// Clear, operate, freeze, sync.
    pub const GLOBAL_CONTROL: u8 = 58;
    /// The identifier bytes that the slave wants.
    pub const GET_CFG: u8 = 59;
    /// How the slave is doing.
    pub const SLAVE_DIAG: u8 = 60;
    /// Watchdog, ident number, user parameters.
    pub const SET_PRM: u8 = 61;
    /// The identifier bytes that the master has.
    pub const CHK_CFG: u8 = 62;

    /// The name of the service behind a service access point; data exchange has none.
    pub const fn name(sap: Option<u8>) -> &'static str {
        match sap {
            None => "Data_Exchange",
            Some(50 | 51) => "an acyclic service",
            Some(54) => "a service between masters",
            Some(SET_SLAVE_ADDRESS) => "Set_Slave_Address",
            Some(READ_INPUTS) => "Read_Inputs",
            Some(READ_OUTPUTS) => "Read_Outputs",
            Some(GLOBAL_CONTROL) => "Global_Control",
            Some(GET_CFG) => "Get_Cfg",
            Some(SLAVE_DIAG) => "Slave_Diag",
            Some(SET_PRM) => "Set_Prm",
            Some(CHK_CFG) => "Chk_Cfg",
            Some(_) => "an unknown service",
        }
    }
}

/// The address that all stations hear.
pub const BROADCAST: u8 = 127;
/// The highest address that a station can have.
pub const MAX_STATION: u8 = 125;

#[cfg(test)]
mod tests;
