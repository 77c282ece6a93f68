//! `toyo sim`: programs at the desk.

mod run;
#[cfg(test)]
mod tests;
mod trace;

use super::Family;
use crate::command::{AtDesk, commands};

commands! {
    /// What can be done with the simulator of a controller; `armctl sim toyo` serves it.
    pub enum Sim of Family {
        /// Run a program file and print what happens and when; takes no robot
        Run(AtDesk<run::Run>),
    }
}
