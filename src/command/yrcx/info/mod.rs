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
        /// Versions of the software
        Version(version::Version),
        /// Model numbers of a robot and its axes
        System(system::System),
        /// Where a robot is, once or as it changes
        Position(position::Where),
        /// The servo of each axis
        Servo(servo::Servo),
        /// Whether the origin is known
        Origin(origin::Origin),
        /// Hand systems: the selected one and the arm's
        Arm(arm::Arm),
        /// Speed settings
        Speed(speed::Speed),
        /// Torque of the axes
        Torque(torque::Torque),
        /// The inching amount
        Inch(inch::Inch),
        /// What tasks do
        Tasks(tasks::Tasks),
        /// Which line each task stands at
        Line(tasks::Line),
        /// What is in the option slots
        Slots(slots::Slots),
        /// Messages of the alarm history
        Message(message::Message),
        /// An alarm of the history, or the latest of a remote command
        Alarm(alarm::Alarm),
    }
}

pub use alarm::AlarmReport;
pub use servo::{AxisServo, servos};
