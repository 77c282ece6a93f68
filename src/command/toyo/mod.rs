//! `toyo`: Toyo controllers over RS-232C host communication.

mod bus;
mod cells;
mod counter;
#[cfg(test)]
mod coverage;
mod host;
mod info;
mod init;
mod io;
pub mod link;
mod numbers;
mod offset;
mod overrides;
mod overview;
mod ports;
mod position;
mod raw;
mod reach;
mod refusal;
mod robot_type;
pub mod simulated;
mod status;
mod task;
#[cfg(test)]
mod testing;
mod timer;
mod trace;

pub use link::Toyo as Family;
pub use overview::overview;

use crate::command::{AtDesk, Verbs, commands};

commands! {
    /// What can be asked of a Toyo controller.
    pub enum Toyo of Family {
        /// All five status pages in words
        Status(status::Status),
        /// Where the axes are
        Position(position::Position),
        /// Take or give back the command of the controller
        Host(host::Host),
        /// Input, output and internal ports
        Io(Verbs<io::Io>),
        /// Counters
        Counter(Verbs<counter::Counter>),
        /// Timers
        Timer(Verbs<timer::Timer>),
        /// The share of their speeds that programs run at
        Override(Verbs<overrides::Override>),
        /// The task that programs and points are those of
        Task(Verbs<task::Task>),
        /// How far coordinates are shifted at present
        Offset(offset::Offset),
        /// Settings and errors of CC-Link
        Bus(bus::Bus),
        /// Clear memory
        Init(init::Init),
        /// Set the robot type of an axis
        RobotType(robot_type::RobotType),
        /// Robot type, versions, axes, task, override
        Info(info::Info),
        /// Send any block, and explain the answer
        Raw(raw::Raw),
        /// The serial ports of this machine
        Ports(AtDesk<ports::Ports>),
    }
}
