//! `toyo sim`: programs at the desk.

mod run;
#[cfg(test)]
mod tests;
mod trace;

pub use self::run::rehearse;
pub use self::trace::Stop;

use crate::command::{Offline, commands};

commands! {
    /// What can be done with the simulator of a controller; `armctl sim toyo` serves it.
    pub enum Sim {
        /// Run a program file offline and print its timeline
        Run(Offline<run::Run>),
    }
}
