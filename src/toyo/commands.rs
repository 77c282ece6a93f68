//! Commands of `toyo` in the order of its help.

use super::link::Toyo;
use super::{
    alarm, backup, bus, card, control_commands, coordinate, counter, easy, eeprom_tables, home, host, info, init, io,
    jog, mvm, offset, overrides, palletizing, param, point, ports, position, program, raw, robot_type, run, sim,
    status, task,
};
use armctl_frame::backup::family_backup::Diff;
use armctl_frame::{Offline, Subcommands, commands};

commands! {
    /// Commands for a Toyo controller.
    pub enum Commands {
        "Status and diagnosis":
        /// Show all status flags
        Status(status::Status),
        /// Current position of the axes
        Position(position::Position),
        /// Alarms
        #[command(alias = "error")]
        Alarm(Subcommands<alarm::Alarm>),
        /// Robot type, versions, axes, task, override
        Info(info::Info),
        /// Settings and errors of CC-Link
        Bus(bus::Bus),
        "Power and operation":
        /// Take or release host control (host ON / OFF)
        Host(host::Host),
        /// Switch servo power
        Servo(control_commands::Servo),
        /// Select run mode or program type
        Mode(control_commands::Mode),
        /// Stop the running program or jog
        Stop(control_commands::Stop),
        /// Reset programs to the first step
        Reset(control_commands::Reset),
        "Motion":
        /// Return to the origin
        #[command(alias = "origin")]
        Home(home::Home),
        /// Jog one axis, for a time or in small steps
        Jog(jog::Jog),
        /// Start programs, move to a point
        Run(Subcommands<run::Run>),
        /// Send coordinates to a waiting RSMV step
        Coordinate(Subcommands<coordinate::Coordinate>),
        /// Speed override (percent)
        Override(Subcommands<overrides::Override>),
        /// Current coordinate offset
        Offset(offset::Offset),
        "Programs":
        /// Sequential programs
        #[command(alias = "job")]
        Program(Subcommands<program::Program>),
        /// Palletizing programs
        Palletizing(Subcommands<palletizing::Palletizing>),
        /// Easy programs
        Easy(Subcommands<easy::Easy>),
        /// Show or select the current task
        Task(Subcommands<task::Task>),
        /// Run programs offline
        Sim(Subcommands<sim::Sim>),
        "Data":
        /// Teach: store the current position as a point
        Teach(point::Teach),
        /// Points of the coordinate table
        Point(Subcommands<point::Point>),
        /// Parameters
        Param(Subcommands<param::Param>),
        /// Speed table
        SpeedTable(Subcommands<eeprom_tables::SpeedTable>),
        /// Acceleration table
        AccelTable(Subcommands<eeprom_tables::AccelTable>),
        /// Torque table
        TorqueTable(Subcommands<eeprom_tables::TorqueTable>),
        /// MVM table (matrix moves)
        Mvm(Subcommands<mvm::Mvm>),
        /// Save all data of the controller to a folder
        Backup(backup::Backup),
        /// Restore a backup
        Restore(backup::Restore),
        /// Compare a backup with another backup or with the controller
        Diff(Diff<Toyo>),
        /// Memory card
        Card(Subcommands<card::Card>),
        /// Clear memory
        Init(init::Init),
        /// Set the robot type of an axis
        RobotType(robot_type::RobotType),
        "Signals":
        /// Input, output and internal ports
        Io(Subcommands<io::Io>),
        /// Counters
        Counter(Subcommands<counter::Counter>),
        /// Timers
        Timer(Subcommands<counter::Timer>),
        "Link":
        /// List the serial ports of this computer
        Ports(Offline<ports::Ports>),
        /// Send any block and decode the answer
        Raw(raw::Raw),
    }
}
