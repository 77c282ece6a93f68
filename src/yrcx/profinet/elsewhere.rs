//! Commands `yrcx profinet` on systems without raw Ethernet: only the command for GSDML files.

mod gsdml;

use armctl_frame::{Offline, commands};

commands! {
    /// Commands that need no station.
    pub enum Profinet {
        /// Read a GSDML file: modules and the layout for a target
        Gsdml(Offline<gsdml::ReadFile>),
    }
}
