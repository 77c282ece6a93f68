//! Controllers on PROFINET IO, of which this machine is the IO controller, and `yrcx profinet`: stations, their names and
//! addresses, and the maker's file. Those commands open no connection for images, so nothing that the controller would miss
//! when it ends.

mod board;
pub mod bus;
mod check;
mod connect;
mod decode;
mod gsdml;
mod serve;
pub mod simulated;

use crate::command::{Offline, commands};

commands! {
    /// What a station can be asked, and what can be set at it.
    pub enum Profinet {
        /// Read the maker's GSDML file: modules, and the layout for a target
        Gsdml(Offline<gsdml::ReadFile>),
    }
}
