//! `toyo`: Toyo controllers over RS-232C host communication.

pub mod backup;
mod bus;
mod card;
mod cells;
mod check;
mod chosen;
mod connect;
mod coordinate;
mod copies;
mod counter;
#[cfg(test)]
mod coverage;
mod debts;
pub mod decode;
mod easy;
mod error;
pub mod explain;
mod files;
#[cfg(test)]
mod gate;
mod home;
mod host;
mod info;
mod init;
mod io;
mod items;
mod jog;
mod letters;
pub mod link;
mod mvm;
mod numbers;
mod offset;
mod orders;
mod overrides;
mod overview;
mod palletizing;
mod param;
mod point;
pub mod ports;
mod position;
mod program;
mod raw;
mod refusal;
mod robot_type;
mod rows;
mod run;
pub mod serve;
mod sim;
pub mod simulated;
mod status;
mod stores;
mod task;
mod tasks;
#[cfg(test)]
mod testing;
mod timer;
pub mod top;
mod trace;
mod values;
mod waiting;
mod wear;

pub use check::check;
pub use connect::hold;
pub use link::Toyo as Family;
pub use overview::overview;

use crate::command::{AtDesk, Verbs, commands};

commands! {
    /// What can be asked of a Toyo controller.
    pub enum Toyo of Family {
        /// All five status pages in words
        Status(status::Status),
        /// Return to the origin
        Home(home::Home),
        /// Where the axes are
        Position(position::Position),
        /// Take or give back the command of the controller
        Host(host::Host),
        /// Choose how programs run, or which kind of them
        Mode(orders::Mode),
        /// Switch servo power
        Servo(orders::Servo),
        /// Stop what runs, or what is jogged
        Stop(orders::Stop),
        /// Put programs back to their beginning
        Reset(orders::Reset),
        /// Errors
        Error(Verbs<error::Error>),
        /// Run programs, and move to a point
        Run(Verbs<run::Run>),
        /// Move one axis, for a time or by small steps
        Jog(jog::Jog),
        /// Parameters: read, change, save, restore
        Param(Verbs<param::Param>),
        /// Points of the coordinate table
        Point(Verbs<point::Point>),
        /// Speeds that programs name by their row
        SpeedTable(Verbs<rows::SpeedTable>),
        /// Acceleration times that programs name by their row
        AccelTable(Verbs<rows::AccelTable>),
        /// Groups of the MVM table, from which MVM moves along a matrix
        Mvm(Verbs<mvm::Mvm>),
        /// Torque limits that programs name by their row
        TorqueTable(Verbs<rows::TorqueTable>),
        /// Sequential programs: read, write, edit, check
        Program(Verbs<program::Program>),
        /// Palletizing programs
        Palletizing(Verbs<palletizing::Palletizing>),
        /// Easy programs
        Easy(Verbs<easy::Easy>),
        /// Save all that is stored in the controller in a folder
        Backup(backup::Backup),
        /// Write back what a backup holds
        Restore(backup::Restore),
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
        /// Supply coordinates to a program
        Coordinate(Verbs<coordinate::Coordinate>),
        /// Settings and errors of CC-Link
        Bus(bus::Bus),
        /// The memory card
        Card(Verbs<card::Card>),
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
        /// Programs at the desk, without any controller
        Sim(Verbs<sim::Sim>),
    }
}
