//! `yrcx profinet` where there is no raw Ethernet: the maker's file alone.

mod gsdml;

use crate::command::{Offline, commands};

commands! {
    /// What needs no station.
    pub enum Profinet {
        /// Read the maker's GSDML file: modules, and the layout for a target
        Gsdml(Offline<gsdml::ReadFile>),
    }
}
