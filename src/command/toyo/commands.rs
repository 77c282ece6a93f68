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
        /// Show all status flags
        Status(status::Status),
        /// Return to the origin
        Home(home::Home),
        /// Current position of the axes
        Position(position::Position),
        /// Take or release host control (host ON / OFF)
        Host(host::Host),
        /// Select run mode or program type
        Mode(orders::Mode),
        /// Switch servo power
        Servo(orders::Servo),
        /// Stop the running program or jog
        Stop(orders::Stop),
        /// Reset programs to the first step
        Reset(orders::Reset),
        /// Errors
        Error(Subcommands<error::Error>),
        /// Start programs, move to a point
        Run(Subcommands<run::Run>),
        /// Jog one axis, for a time or in small steps
        Jog(jog::Jog),
        /// Parameters: read, change, save, restore
        Param(Subcommands<param::Param>),
        /// Points of the coordinate table
        Point(Subcommands<point::Point>),
        /// Speed table
        SpeedTable(Subcommands<rows::SpeedTable>),
        /// Acceleration table
        AccelTable(Subcommands<rows::AccelTable>),
        /// MVM table (matrix moves)
        Mvm(Subcommands<mvm::Mvm>),
        /// Torque table
        TorqueTable(Subcommands<rows::TorqueTable>),
        /// Sequential programs: read, write, edit, check
        Program(Subcommands<program::Program>),
        /// Palletizing programs
        Palletizing(Subcommands<palletizing::Palletizing>),
        /// Easy programs
        Easy(Subcommands<easy::Easy>),
        /// Save everything the controller stores to a folder
        Backup(backup::Backup),
        /// Restore a backup
        Restore(backup::Restore),
        /// Input, output and internal ports
        Io(Subcommands<io::Io>),
        /// Counters
        Counter(Subcommands<counter::Counter>),
        /// Timers
        Timer(Subcommands<timer::Timer>),
        /// Speed override (percent)
        Override(Subcommands<overrides::Override>),
        /// Show or select the current task
        Task(Subcommands<task::Task>),
        /// Current coordinate offset
        Offset(offset::Offset),
        /// Send coordinates to a waiting RSMV step
        Coordinate(Subcommands<coordinate::Coordinate>),
        /// Settings and errors of CC-Link
        Bus(bus::Bus),
        /// Memory card: read, write
        Card(Subcommands<card::Card>),
        /// Clear memory
        Init(init::Init),
        /// Set the robot type of an axis
        RobotType(robot_type::RobotType),
        /// Robot type, versions, axes, task, override
        Info(info::Info),
        /// Send any block and decode the answer
        Raw(raw::Raw),
        /// List the serial ports of this machine
        Ports(Offline<ports::Ports>),
        /// Run programs offline
        Sim(Subcommands<sim::Sim>),
    }
}
