//! `toyo`: Toyo controllers over RS-232C host communication.

mod cells;
mod host;
pub mod link;
mod overview;
mod position;
mod reach;
mod refusal;
pub mod simulated;
mod status;
#[cfg(test)]
mod testing;
mod trace;

pub use link::Toyo as Family;
pub use overview::overview;

use crate::command::commands;

commands! {
    /// What can be asked of a Toyo controller.
    pub enum Toyo of Family {
        /// All five status pages in words
        Status(status::Status),
        /// Where the axes are
        Position(position::Position),
        /// Take or give back the command of the controller
        Host(host::Host),
    }
}
