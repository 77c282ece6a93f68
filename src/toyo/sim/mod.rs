//! `toyo sim`: offline run of programs.

mod run;
#[cfg(test)]
mod tests;
mod trace;

pub use self::run::{in_file, parameter_writes, rehearse};
pub use self::trace::Stop;

use armctl_frame::{Offline, commands};

commands! {
    /// Commands of the offline simulator. The server is `armctl sim toyo`.
    pub enum Sim {
        /// Run a program file offline and print its timeline
        Run(Offline<run::Run>),
    }
}
