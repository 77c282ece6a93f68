//! Commands of `yrcx` in the order of its help.

use super::link::Yrcx;
use super::motion::Moving;
use super::{
    alarm, backup, clock, control_commands, data, devicenet, eip, info, io, motion, param, point_calc, port,
    procedure_commands, profibus, profinet, program, raw, status, teach, var,
};
use armctl_frame::backup::family_backup::{Diff, Restore};
use armctl_frame::{Subcommands, commands};

commands! {
    /// Commands for a YRCX controller.
    pub enum Commands {
        "Status and diagnosis":
        /// Show signals, servos and position
        Status(status::Status),
        /// Information from the controller
        Info(Subcommands<info::Info>),
        /// Alarms
        Alarm(Subcommands<alarm::Alarm>),
        /// Current position of a robot
        Position(info::PositionArguments),
        /// The controller's clock
        Clock(Subcommands<clock::Clock>),
        "Power and operation":
        /// Switch servos on or off, or release their brakes
        Servo(control_commands::Servo),
        /// Switch motor power on or off
        Motor(control_commands::Motor),
        /// Switch servos on with the dedicated inputs
        PowerOn(procedure_commands::PowerOn),
        /// Trigger the emergency-stop input SI(00)
        EmergencyStop(procedure_commands::EmergencyStop),
        /// Clear the emergency stop and switch servos on
        Recover(procedure_commands::Recover),
        /// Wait for AUTO mode
        AutoMode(procedure_commands::AutoMode),
        /// Start the robot program with the dedicated inputs
        Run(procedure_commands::Run),
        /// Stop the robot program with the dedicated inputs
        Stop(procedure_commands::Stop),
        /// Reset the robot program with the dedicated inputs
        Reset(procedure_commands::Reset),
        "Motion":
        /// Move a robot to a point or to coordinates
        Move(Moving<motion::Move>),
        /// Relative move
        Movei(Moving<motion::Movei>),
        /// Move to a point in tool coordinates
        Movet(Moving<motion::Movet>),
        /// Move one axis to an absolute position
        Drive(Moving<motion::Drive>),
        /// Move one axis by a relative distance
        Drivei(Moving<motion::Drivei>),
        /// Move to a pallet position
        Pallet(Moving<motion::Pallet>),
        /// Push with one axis
        Push(Moving<motion::Push>),
        /// Jog: move an axis until you stop it
        Jog(motion::Jog),
        /// Move an axis by the inching distance
        Inch(Moving<motion::Inch>),
        /// Set the inching distance
        InchDistance(control_commands::InchDistance),
        /// Return to origin
        #[command(alias = "home")]
        Origin(motion::Origin),
        /// Reset the absolute position of an axis
        AbsReset(motion::AbsReset),
        /// Set a speed
        Speed(control_commands::Speed),
        /// Coordinate shift selection
        Shift(Subcommands<control_commands::Shift>),
        /// Hand (end effector) selection
        Hand(Subcommands<control_commands::Hand>),
        /// Arm hand system
        Arm(Subcommands<control_commands::Arm>),
        /// Limit the torque of an axis
        TorqueLimit(control_commands::TorqueLimit),
        "Programs":
        /// Programs and their tasks
        #[command(alias = "job")]
        Program(Subcommands<program::Program>),
        "Data":
        /// Teach: store the current position as a point
        Teach(teach::Teach),
        /// Points
        Point(Subcommands<data::Point>),
        /// Point comments
        Comment(Subcommands<data::Comment>),
        /// Pallets
        PalletData(Subcommands<data::PalletData>),
        /// Coordinate shifts
        ShiftData(Subcommands<data::ShiftData>),
        /// Hands
        HandData(Subcommands<data::HandData>),
        /// Calculate points and shifts on the controller
        PointCalc(Subcommands<point_calc::PointCalc>),
        /// Static variables SGI and SGR
        Var(Subcommands<var::Var>),
        /// Parameters of robots and axes
        Param(Subcommands<param::Param>),
        /// Save points, data, variables and parameters to a folder
        Backup(backup::Backup),
        /// Restore a backup
        Restore(Restore<Yrcx>),
        /// Compare a backup with another backup or with the controller
        Diff(Diff<Yrcx>),
        "Signals":
        /// Read and switch dedicated and general I/O (SI / SO)
        Io(Subcommands<io::Io>),
        /// I/O ports of eight signals
        Port(Subcommands<port::Port>),
        "Link":
        /// Diagnose the EtherNet/IP board
        Eip(Subcommands<eip::Eip>),
        /// Diagnose DeviceNet
        Devicenet(Subcommands<devicenet::DeviceNet>),
        /// Diagnose PROFIBUS
        Profibus(Subcommands<profibus::Profibus>),
        /// Diagnose PROFINET
        Profinet(Subcommands<profinet::Profinet>),
        /// Reset the remote command status
        StatusReset(control_commands::StatusReset),
        /// Send the words of any remote command and decode the answer
        Raw(raw::Raw),
    }
}
