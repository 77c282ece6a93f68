//! Commands that send one remote command and change something: speeds (4.2.14 to 4.2.16), torque limit (4.2.22),
//! inching distance (4.2.8), shift, hand and arm (4.2.17 to 4.2.19), servos (4.2.13), motor power (4.2.20), the status
//! of remote commands (4.1).

use serde_json::Value as Json;

use super::arguments::{Hand as HandSystem, UnitArgument};
use super::single_command::one_row;
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;
use armctl_frame::robot::item::WrittenItems;
use armctl_frame::settings_report::number;

commands! {
    /// Commands for the shift.
    pub enum Shift {
        /// Select a coordinate shift
        Select(ShiftSelect),
    }
}

commands! {
    /// Commands for the hand.
    pub enum Hand {
        /// Select the hand
        Select(HandSelect),
    }
}

commands! {
    /// Commands for the arm.
    pub enum Arm {
        /// Select the hand system for coordinates
        Select(ArmSelect),
    }
}

one_row! {
    /// Sets a speed.
    #[command(after_help = "`yrcx info speed` reads the speeds.")]
    Speed(self) "yrcx.speed" -> WrittenItems<Json> {
        /// Speed to set
        setting: SpeedSetting,
        /// Speed in percent, 1 to 100
        percent: String,
    }
    gives self.setting.row().0,
    with draft => draft.with(Key::SpeedPercent, self.percent.trim_end_matches('%')),
    done as answer => {
        let (_, name, setting) = self.setting.row();
        let percent = self.percent.trim_end_matches('%');
        let words = format!("set the {setting} speed to {percent} %");
        NewValue::of(name, number(percent), words).into_item("override", &answer.old)
    };

    /// Limits the torque of an axis, starting with the next motion; the parameter does not change.
    TorqueLimit(self) "yrcx.torque-limit" -> WrittenItems<Json> {
        /// Axis, 1 to 4
        #[arg(long, value_name = "AXIS")]
        axis: String,
        /// Limit in percent of the maximum torque, 1 to 100
        percent: String,
    }
    gives Command::TorqueLimit,
    with draft => draft.with(Key::Axes, self.axis.as_str()).with(Key::Torque, self.percent.trim_end_matches('%')),
    done as answer => {
        let percent = self.percent.trim_end_matches('%');
        let words = format!("limited the torque of axis {} to {percent} %, starting with the next motion", self.axis);
        NewValue::of(self.axis.as_str(), number(percent), words).into_item("torque limit", &answer.old)
    };

    /// Sets the inching distance.
    InchDistance(self) "yrcx.inch-distance" -> WrittenItems<Json> {
        /// Distance from 1 to 10000: pulses, or steps of 0.001 mm for Cartesian and tool axes
        distance: String,
    }
    gives Command::InchAmountSet,
    with draft => draft.with(Key::InchingAmount, self.distance.as_str()),
    done as answer => {
        let words = format!(
            "set the inching distance to {} (pulses, or steps of 0.001 mm for Cartesian and tool axes)",
            self.distance
        );
        NewValue::of("inch-distance", number(&self.distance), words).into_item("inching distance", &answer.old)
    };

    /// Selects a shift.
    ShiftSelect(self) "yrcx.shift.select" -> SetReport {
        /// Shift, 0 to 39
        shift: String,
    }
    gives Command::ShiftSelect,
    with draft => draft.with(Key::Shift, self.shift.as_str()),
    done NewValue::of("shift", number(&self.shift), format!("selected shift {}", self.shift));

    /// Selects a hand.
    HandSelect(self) "yrcx.hand.select" -> SetReport {
        /// Hand, 0 to 31
        hand: String,
    }
    gives Command::HandSelect,
    with draft => draft.with(Key::Hand, self.hand.as_str()),
    done NewValue::of("hand", number(&self.hand), format!("selected hand {}", self.hand));

    /// Selects a hand system.
    #[command(after_help = "`yrcx info arm` reads the hand system.")]
    ArmSelect(self) "yrcx.arm.select" -> SetReport {
        /// Hand system
        side: HandSystem,
    }
    gives Command::ArmSelect,
    with draft => draft.with(Key::Arm, i32::from(self.side == HandSystem::Left)),
    done {
        let side = if self.side == HandSystem::Left { "left" } else { "right" };
        NewValue::of("arm", side, format!("selected the {side}-handed system"))
    };

    /// Switches servos.
    Servo(self) "yrcx.servo" -> SetReport {
        /// New servo state
        state: ServoState,
        /// Apply only to this axis, 1 to 4
        #[arg(long, value_name = "AXIS")]
        axis: Option<String>,
        #[command(flatten)]
        which: UnitArgument,
    }
    gives match self.state {
        ServoState::On => Command::ServoOn,
        ServoState::Off => Command::ServoOff,
        ServoState::Free => Command::ServoFree,
    },
    with draft => draft.with_some(Key::Axes, self.axis.clone()),
    intent {
        let servos = format!("{} of {}", self.describe(), self.which.name());
        match self.state {
            ServoState::On => format!("switch {servos} on"),
            ServoState::Off => format!("switch {servos} off: an axis without brake may drop"),
            ServoState::Free => format!("switch {servos} off and release the brakes: an axis may drop"),
        }
    },
    done {
        let state = match self.state {
            ServoState::On => "on",
            ServoState::Off => "off",
            ServoState::Free => "free",
        };
        let done = NewValue::of("servo", state, format!("switched {} {state}", self.describe()));
        done.with("axis", self.axis.as_deref().map_or(Value::Null, number))
    };

    /// Switches the motor power of all robots.
    Motor(self) "yrcx.motor" -> SetReport {
        /// New motor power state
        state: MotorState,
    }
    gives match self.state {
        MotorState::On => Command::MotorOn,
        MotorState::Off => Command::MotorOff,
        MotorState::Pwr => Command::MotorPower,
    },
    intent match self.state {
        MotorState::On => "switch motor power and the servos of all robots on",
        MotorState::Off => "switch motor power and the servos of all robots off: an axis without brake may drop",
        MotorState::Pwr => "switch motor power on",
    },
    done match self.state {
        MotorState::On => NewValue::of("motor_power", true, "switched motor power and all servos on").with("servo_on", true),
        MotorState::Off => {
            NewValue::of("motor_power", false, "switched motor power and all servos off").with("servo_on", false)
        }
        MotorState::Pwr => NewValue::of("motor_power", true, "switched motor power on"),
    };

    /// Resets the status of remote commands to ready.
    #[command(
        after_help = "armctl resets the status before and after each command, so this command is rarely necessary. \
                      Use this command if the command of another client left an end status. The command does not stop \
                      a motion or a running command. It does not reset an alarm (`yrcx alarm reset`)."
    )]
    StatusReset(self) "yrcx.status-reset" -> SetReport {}
    gives Command::StatusReset,
    done NewValue::of("remote_command_status", "ready", "the controller is ready for a remote command");
}

/// Speed settings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum SpeedSetting {
    /// Speed of jogs and inching
    Manual,
    /// Speed of automatic operation; reduces all other speeds
    Auto,
    /// Speed of programs, and of motions without a speed argument
    Program,
}

impl SpeedSetting {
    /// Command, name in reports, and name in texts.
    const fn row(self) -> (Command, &'static str, &'static str) {
        match self {
            Self::Manual => (Command::SpeedManual, "manual_percent", "manual"),
            Self::Auto => (Command::SpeedAuto, "auto_percent", "automatic"),
            Self::Program => (Command::SpeedProgram, "program_percent", "program"),
        }
    }
}

/// Servo states.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ServoState {
    /// Servo on; motor power must be on
    On,
    /// Servo off, brake applied
    Off,
    /// Servo off, brake released: an axis may drop
    Free,
}

impl Servo {
    fn describe(&self) -> String {
        match &self.axis {
            Some(axis) => format!("the servo of axis {axis}"),
            None => "the servos of all axes".to_owned(),
        }
    }
}

/// Motor power states.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum MotorState {
    /// Motor power and all servos on
    On,
    /// Motor power and all servos off
    Off,
    /// Motor power on, servos unchanged
    Pwr,
}

#[cfg(test)]
mod tests {
    use crate::testing::{Scripted, run_on};

    #[test]
    fn resets_the_end_status_of_another_client() {
        let mut scripted = Scripted::new([]);
        scripted.image.0[0] = 0x4000;
        let (outcome, peer) = run_on(scripted, &["status-reset"]);
        assert_eq!(outcome.unwrap()["new"], "ready");
        assert_eq!((peer.image.0[0], peer.taken.len()), (0, 0));
    }
}
