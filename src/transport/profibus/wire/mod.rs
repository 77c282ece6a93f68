//! PROFIBUS DP codec: telegrams with function codes, and the data of the services of a slave.
//!
//! A telegram with eight data bytes has two possible forms. The decoder accepts both. The encoder always writes the
//! variable-length form. Section numbers refer to EN 50170, volume 2.

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

/// Service access points (SAP) of a slave.
pub mod sap {
    /// SAP of the master.
    pub const MASTER: u8 = 62;
    /// Change the address of the slave.
    pub const SET_SLAVE_ADDRESS: u8 = 55;
    /// Read the input image.
    pub const READ_INPUTS: u8 = 56;
    /// Read the output image.
    pub const READ_OUTPUTS: u8 = 57;
    /// Send clear, operate, freeze or sync.
    pub const GLOBAL_CONTROL: u8 = 58;
    /// Read the configuration of the slave.
    pub const GET_CFG: u8 = 59;
    /// Read the diagnosis.
    pub const SLAVE_DIAG: u8 = 60;
    /// Set the parameters: watchdog, ident number, user parameters.
    pub const SET_PRM: u8 = 61;
    /// Check the configuration.
    pub const CHK_CFG: u8 = 62;

    /// Name of the service that belongs to a SAP. Without a SAP, the service is data exchange.
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

/// Broadcast address.
pub const BROADCAST: u8 = 127;
/// Highest address of a station.
pub const MAX_STATION: u8 = 125;

#[cfg(test)]
mod tests;
