//! `yrcx info`: what remote commands tell about the controller (4.7).

mod alarm;
mod position;
mod servo;
mod version;

use crate::command::commands;
use crate::command::yrcx::Family;

commands! {
    /// What the controller tells about itself.
    pub enum Info of Family {
        /// Versions of the software
        Version(version::Version),
        /// Where a robot is
        Position(position::Where),
        /// The servo of each axis
        Servo(servo::Servo),
        /// An alarm of the history, or the latest of a remote command
        Alarm(alarm::Alarm),
    }
}

pub use servo::{AxisServo, servos};
