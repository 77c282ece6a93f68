//! `yrcx info`: information from remote commands (4.7).

mod alarm;
mod arm;
mod origin;
mod position;
mod robot;
mod servo;
mod slots;
mod tasks;
mod torque;

use armctl_frame::commands;

commands! {
    /// Information commands.
    pub enum Info {
        /// Software versions
        Version(robot::Version),
        /// Model numbers of a robot and its axes
        System(robot::System),
        /// Servo state per axis
        Servo(servo::Servo),
        /// Origin return status
        Origin(origin::Origin),
        /// Selected and current hand system
        Arm(arm::Arm),
        /// Speed settings
        Speed(robot::Speed),
        /// Torque per axis
        Torque(torque::Torque),
        /// Inching distance
        Inch(robot::Inch),
        /// Task states
        Tasks(tasks::Tasks),
        /// Current line of each task
        Line(tasks::Line),
        /// Boards in the option slots
        Slots(slots::Slots),
        /// The last alarm that a remote command caused
        Alarm(alarm::Alarm),
    }
}

pub use alarm::{Part, describe_alarm, entry};
pub use position::PositionArguments;
pub use servo::{AxisServo, servos};
