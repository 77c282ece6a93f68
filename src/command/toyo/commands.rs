//! The commands of `toyo`, as its help lists them.

use super::{
    backup, bus, card, coordinate, counter, easy, error, home, host, info, init, io, jog, mvm, offset, orders,
    overrides, palletizing, param, point, ports, position, program, raw, robot_type, rows, run, sim, status, task,
    timer,
};
use crate::command::{Offline, Subcommands, commands};

commands! {
    /// What can be asked of a Toyo controller.
    pub enum Commands {
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
        Error(Subcommands<error::Error>),
        /// Run programs, and move to a point
        Run(Subcommands<run::Run>),
        /// Move one axis, for a time or by small steps
        Jog(jog::Jog),
        /// Parameters: read, change, save, restore
        Param(Subcommands<param::Param>),
        /// Points of the coordinate table
        Point(Subcommands<point::Point>),
        /// Speeds that programs name by their row
        SpeedTable(Subcommands<rows::SpeedTable>),
        /// Acceleration times that programs name by their row
        AccelTable(Subcommands<rows::AccelTable>),
        /// Groups of the MVM table, from which MVM moves along a matrix
        Mvm(Subcommands<mvm::Mvm>),
        /// Torque limits that programs name by their row
        TorqueTable(Subcommands<rows::TorqueTable>),
        /// Sequential programs: read, write, edit, check
        Program(Subcommands<program::Program>),
        /// Palletizing programs
        Palletizing(Subcommands<palletizing::Palletizing>),
        /// Easy programs
        Easy(Subcommands<easy::Easy>),
        /// Save all that is stored in the controller in a folder
        Backup(backup::Backup),
        /// Write back what a backup holds
        Restore(backup::Restore),
        /// Input, output and internal ports
        Io(Subcommands<io::Io>),
        /// Counters
        Counter(Subcommands<counter::Counter>),
        /// Timers
        Timer(Subcommands<timer::Timer>),
        /// The share of their speeds that programs run at
        Override(Subcommands<overrides::Override>),
        /// The task that programs and points are those of
        Task(Subcommands<task::Task>),
        /// How far coordinates are shifted at present
        Offset(offset::Offset),
        /// Supply coordinates to a program
        Coordinate(Subcommands<coordinate::Coordinate>),
        /// Settings and errors of CC-Link
        Bus(bus::Bus),
        /// The memory card
        Card(Subcommands<card::Card>),
        /// Clear memory
        Init(init::Init),
        /// Set the robot type of an axis
        RobotType(robot_type::RobotType),
        /// Robot type, versions, axes, task, override
        Info(info::Info),
        /// Send any block, and explain the answer
        Raw(raw::Raw),
        /// The serial ports of this machine
        Ports(Offline<ports::Ports>),
        /// Programs at the desk, without any controller
        Sim(Subcommands<sim::Sim>),
    }
}
