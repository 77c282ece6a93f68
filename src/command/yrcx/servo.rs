//! `yrcx servo` (4.2.13) and `yrcx motor` (4.2.20).

use clap::{Args, ValueEnum};

use super::arguments::Which;
use super::link;
use super::single::Single;
use crate::command::frame::orders::Done;
use crate::controller::yrcx::order::Draft;
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::Key;
use crate::failure::Failure;

/// Switches servos.
#[derive(Debug, Args)]
pub struct Servo {
    /// What to switch them to
    state: ServoState,
    /// Only this axis, 1 to 4
    #[arg(long, value_name = "AXIS")]
    axis: Option<String>,
    #[command(flatten)]
    which: Which,
}

/// What a servo can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ServoState {
    /// Controlled; motor power must be on
    On,
    /// Off, brake on
    Off,
    /// Off, brake off: an axis may drop
    Free,
}

impl Servo {
    fn told(&self) -> String {
        match &self.axis {
            Some(axis) => format!("the servo of axis {axis}"),
            None => "the servos of all axes".to_owned(),
        }
    }
}

impl Single for Servo {
    type Report = Done;
    const ID: &'static str = "yrcx.servo";

    fn command(&self) -> Command {
        match self.state {
            ServoState::On => Command::ServoOn,
            ServoState::Off => Command::ServoOff,
            ServoState::Free => Command::ServoFree,
        }
    }

    fn fill(&self, draft: Draft) -> Draft {
        draft.with_some(Key::Axes, self.axis.clone())
    }

    fn intent(&self) -> String {
        let servos = format!("{} of {}", self.told(), self.which.name());
        match self.state {
            ServoState::On => format!("switch {servos} on"),
            ServoState::Off => format!("switch {servos} off"),
            ServoState::Free => format!("switch {servos} off and release the brakes: an axis may drop"),
        }
    }

    fn report(&self, _done: &link::Done) -> Result<Done, Failure> {
        let state = match self.state {
            ServoState::On => "on",
            ServoState::Off => "off",
            ServoState::Free => "free",
        };
        Ok(Done::new(format!("switched {} {state}", self.told())))
    }
}

/// Switches motor power, of all robots.
#[derive(Debug, Args)]
pub struct Motor {
    /// What to switch it to
    state: MotorState,
}

/// What motor power can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum MotorState {
    /// Motor power and all servos on
    On,
    /// Motor power and all servos off
    Off,
    /// Motor power on, servos as they are
    Pwr,
}

impl Single for Motor {
    type Report = Done;
    const ID: &'static str = "yrcx.motor";

    fn command(&self) -> Command {
        match self.state {
            MotorState::On => Command::MotorOn,
            MotorState::Off => Command::MotorOff,
            MotorState::Pwr => Command::MotorPower,
        }
    }

    fn intent(&self) -> String {
        match self.state {
            MotorState::On => "switch motor power and the servos of all robots on".to_owned(),
            MotorState::Off => "switch motor power and the servos of all robots off".to_owned(),
            MotorState::Pwr => "switch motor power on".to_owned(),
        }
    }

    fn report(&self, _done: &link::Done) -> Result<Done, Failure> {
        Ok(Done::new(match self.state {
            MotorState::On => "switched motor power and all servos on",
            MotorState::Off => "switched motor power and all servos off",
            MotorState::Pwr => "switched motor power on",
        }))
    }
}

#[cfg(test)]
mod tests {
    use crate::command::yrcx::testing::{example, intent, objection, words};
    use crate::failure::Kind;

    #[test]
    fn each_state_has_its_command() {
        let first = |line: &[&str]| words(line).unwrap().concat()[..3].to_vec();
        assert_eq!(first(&["servo", "on"]), ["0x0034", "0x0000", "0x0000"]);
        assert_eq!(first(&["servo", "off", "--axis", "3", "--unit", "2"]), ["0x2035", "0x0000", "0x0004"]);
        assert_eq!(first(&["motor", "off"])[0], "0x0041");
        assert_eq!(first(&["motor", "pwr"])[0], "0x0043");
        assert_eq!(words(&["servo", "free", "--axis", "4"]).unwrap(), [example("4.2.13-free")]);
        assert_eq!(words(&["motor", "on"]).unwrap(), [example("4.2.20-on")]);
    }

    #[test]
    fn one_axis_or_all_and_motor_power_is_for_no_single_robot() {
        assert_eq!(words(&["servo", "on", "--axis", "1,2"]).unwrap_err().kind, Kind::Usage);
        assert!(words(&["motor", "on", "--unit", "1"]).unwrap_err().message.contains("--unit"));
        assert!(objection(&["servo", "brake"]).contains("free"));
        assert_eq!(intent(&["servo", "on", "--unit", "3"]), "switch the servos of all axes of robot 3 on");
    }
}
