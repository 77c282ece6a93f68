//! `yrcx`: OMRON / Yamaha YRCX over a fieldbus, see `buses.rs`.
//!
//! A command that gives one remote command implements `single::Single`: which row of the table, its fields, the report.
//! `servo.rs` is the model of one that changes something, `info.rs` of those that read. What gives several implements
//! `Command` itself, as `status.rs` does. The link has one driver for remote commands and signals; see `link.rs`.
//!
//! To add a command:
//!
//! 1. Its file: arguments (texts go to the codec as they were typed: `draft.with(Key::SpeedPercent, text)` reads them in
//!    the unit of the field and checks their range), the report, `impl Single`. Shared arguments are in `arguments.rs`,
//!    positions in `position.rs`.
//! 2. A line in the list below, or in that of its noun.
//! 3. Tests: `testing::words` gives the words of a command line, `testing::example` those of an example of the manual.
//!    `coverage.rs` has a line for each row of the table.

mod alarm;
mod arguments;
pub mod backup;
pub mod buses;
mod check;
mod clock;
mod connect;
#[cfg(test)]
mod coverage;
mod data;
pub mod decode;
pub mod discover;
pub mod eip;
pub mod explain;
pub mod fieldbus;
#[cfg(test)]
mod gate;
mod hold;
mod info;
mod io;
pub mod link;
mod link_error;
mod motion;
mod numbers;
mod overview;
mod overwrite;
mod param;
mod point_calc;
mod port;
mod position;
mod procedures;
pub mod profibus;
mod program;
mod raw;
mod refusal;
mod select;
pub mod serve;
mod servo;
mod several;
pub mod simulated;
mod single;
mod speed;
mod status;
mod status_reset;
mod teach;
#[cfg(test)]
mod testing;
pub mod top;
mod torque_limit;
pub mod trace;
mod unit;
mod var;

pub use check::check;
pub use hold::hold;
pub use link::Yrcx as Family;
pub use overview::overview;
pub use raw::words;
pub use trace::Recorder;
pub use unit::Unit;

use self::motion::Moving;
use crate::command::{Verbs, commands};

commands! {
    /// What can be asked of a YRCX controller.
    pub enum Yrcx of Family {
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
        Shift(Verbs<select::Shift>),
        /// The hand at the robot's end
        Hand(Verbs<select::Hand>),
        /// The hand system of the arm
        Arm(Verbs<select::Arm>),
        /// Limit the torque of an axis
        TorqueLimit(torque_limit::TorqueLimit),
        /// Switch servos on or off, or release their brakes
        Servo(servo::Servo),
        /// Switch motor power on or off
        Motor(servo::Motor),
        /// Points
        Point(Verbs<data::Point>),
        /// Comments of points
        Comment(Verbs<data::Comment>),
        /// Pallets
        PalletData(Verbs<data::PalletData>),
        /// Shifts of coordinates
        ShiftData(Verbs<data::ShiftData>),
        /// Hands
        HandData(Verbs<data::HandData>),
        /// Points and shifts that the controller computes
        PointCalc(Verbs<point_calc::PointCalc>),
        /// Save points, pallets, shifts, hands, variables, parameters in a folder
        Backup(backup::Backup),
        /// Write back what a backup holds
        Restore(backup::Restore),
        /// Static variables SGI and SGR
        Var(Verbs<var::Var>),
        /// Parameters of robots and axes
        Param(Verbs<param::Param>),
        /// Ports of eight signals
        Port(Verbs<port::Port>),
        /// Programs and their tasks
        Program(Verbs<program::Program>),
        /// Versions, positions, servos, tasks, alarms
        Info(Verbs<info::Info>),
        /// The controller's clock
        Clock(Verbs<clock::Clock>),
        /// Alarms
        Alarm(Verbs<alarm::Alarm>),
        /// Signals: what the controller shows and is shown
        Io(Verbs<io::Io>),
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
        Eip(Verbs<eip::Eip>),
        /// The line and the stations of PROFIBUS, without owning any
        Profibus(Verbs<profibus::Profibus>),
    }
}
