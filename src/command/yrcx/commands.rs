//! The commands of `yrcx`, as its help lists them.

use super::motion::Moving;
use super::{
    alarm, backup, clock, data, devicenet, eip, info, io, motion, param, point_calc, port, procedures, profibus,
    program, raw, select, servo, speed, status, status_reset, teach, torque_limit, var,
};
use crate::command::{Subcommands, commands};

commands! {
    /// What can be asked of a YRCX controller.
    pub enum Commands {
        /// Signals, servos and position in words
        Status(status::Status),
        /// Move a robot to a point or to coordinates
        Move(Moving<motion::Move>),
        /// Move a robot by distances
        Movei(Moving<motion::Movei>),
        /// Move a robot to a point in the coordinates of its tool
        Movet(Moving<motion::Movet>),
        /// Move one axis to a place
        Drive(Moving<motion::Drive>),
        /// Move one axis by a distance
        Drivei(Moving<motion::Drivei>),
        /// Move a robot to a place on a pallet
        Pallet(Moving<motion::Pallet>),
        /// Push with one axis
        Push(Moving<motion::Push>),
        /// Move an axis until it is stopped
        Jog(motion::Jog),
        /// Move an axis by the inching distance
        Inch(Moving<motion::Inch>),
        /// Set the inching distance
        InchDistance(motion::InchDistance),
        /// Store where the robot is in a point
        Teach(teach::Teach),
        /// Return to origin
        Origin(motion::Origin),
        /// Reset the absolute position of an axis
        AbsReset(motion::AbsReset),
        /// Set a speed
        Speed(speed::Speed),
        /// The shift of the coordinates
        Shift(Subcommands<select::Shift>),
        /// The hand at the robot's end
        Hand(Subcommands<select::Hand>),
        /// The hand system of the arm
        Arm(Subcommands<select::Arm>),
        /// Limit the torque of an axis
        TorqueLimit(torque_limit::TorqueLimit),
        /// Switch servos on or off, or release their brakes
        Servo(servo::Servo),
        /// Switch motor power on or off
        Motor(servo::Motor),
        /// Points
        Point(Subcommands<data::Point>),
        /// Comments of points
        Comment(Subcommands<data::Comment>),
        /// Pallets
        PalletData(Subcommands<data::PalletData>),
        /// Shifts of coordinates
        ShiftData(Subcommands<data::ShiftData>),
        /// Hands
        HandData(Subcommands<data::HandData>),
        /// Points and shifts that the controller computes
        PointCalc(Subcommands<point_calc::PointCalc>),
        /// Save points, pallets, shifts, hands, variables, parameters in a folder
        Backup(backup::Backup),
        /// Write back what a backup holds
        Restore(backup::Restore),
        /// Static variables SGI and SGR
        Var(Subcommands<var::Var>),
        /// Parameters of robots and axes
        Param(Subcommands<param::Param>),
        /// Ports of eight signals
        Port(Subcommands<port::Port>),
        /// Programs and their tasks
        Program(Subcommands<program::Program>),
        /// Versions, positions, servos, tasks, alarms
        Info(Subcommands<info::Info>),
        /// The controller's clock
        Clock(Subcommands<clock::Clock>),
        /// Alarms
        Alarm(Subcommands<alarm::Alarm>),
        /// Signals: what the controller shows and is shown
        Io(Subcommands<io::Io>),
        /// Servos on, by signals
        PowerOn(procedures::PowerOn),
        /// Into emergency stop, by signals
        EmergencyStop(procedures::EmergencyStop),
        /// Out of emergency stop with servos on, by signals
        Recover(procedures::Recover),
        /// Wait for AUTO mode
        AutoMode(procedures::AutoMode),
        /// Reset the robot program, by signals
        Reset(procedures::Reset),
        /// Run the robot program, by signals
        Run(procedures::Run),
        /// Stop the robot program, by signals
        Stop(procedures::Stop),
        /// Reset the status of remote commands
        StatusReset(status_reset::StatusReset),
        /// Send the words of any remote command, and explain the answer
        Raw(raw::Raw),
        /// The network board itself: who it is, which assemblies it has (diagnosis)
        Eip(Subcommands<eip::Eip>),
        /// The bus of a controller on DeviceNet: who is there, sizes, owner (diagnosis)
        Devicenet(Subcommands<devicenet::DeviceNet>),
        /// The line and the stations of PROFIBUS, without owning any
        Profibus(Subcommands<profibus::Profibus>),
    }
}
