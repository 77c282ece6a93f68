//! `yrcx info`: what remote commands tell about the controller (4.7).

mod alarm;
mod arm;
mod inch;
mod message;
mod origin;
mod position;
mod servo;
mod slots;
mod speed;
mod system;
mod tasks;
mod torque;
mod version;

use crate::command::commands;

commands! {
    /// What the controller tells about itself.
    pub enum Info {
        /// Software versions
        Version(version::Version),
        /// Model numbers of a robot and its axes
        System(system::System),
        /// Current position of a robot
        Position(position::Where),
        /// Servo state per axis
        Servo(servo::Servo),
        /// Origin return status
        Origin(origin::Origin),
        /// Selected and current hand system
        Arm(arm::Arm),
        /// Speed settings
        Speed(speed::Speed),
        /// Torque per axis
        Torque(torque::Torque),
        /// Inching distance
        Inch(inch::Inch),
        /// Task states
        Tasks(tasks::Tasks),
        /// Current line of each task
        Line(tasks::Line),
        /// Boards in the option slots
        Slots(slots::Slots),
        /// Messages from the alarm history
        Message(message::Message),
        /// An alarm from the history, or the last one of a remote command
        Alarm(alarm::Alarm),
    }
}

pub use alarm::AlarmReport;
pub use servo::{AxisServo, servos};
