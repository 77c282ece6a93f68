//! Controllers on PROFINET, and `yrcx profinet`: stations, their names and addresses, and the maker's file. No connection
//! for images is opened, so nothing that the controller would miss when it ends.

mod gsdml;

use crate::command::{Offline, commands};

commands! {
    /// What a station can be asked, and what can be set at it.
    pub enum Profinet {
        /// Read the maker's GSDML file: modules, and the layout for a target
        Gsdml(Offline<gsdml::ReadFile>),
    }
}
