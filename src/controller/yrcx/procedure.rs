//! The procedures of the timing charts as data (chapter 1, section 3); a [`Sequence`](super::sequence::Sequence) carries
//! them out.

use super::signal::{Side, Signal, input, output};
use crate::Risk;

/// One step of a procedure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// An output must be so, or the procedure does not begin or go on.
    Require {
        /// The output.
        signal: Signal,
        /// How it must be.
        on: bool,
        /// What to do if it is not.
        hint: &'static str,
    },
    /// Switches an input; nothing to do if it is so already.
    Set {
        /// The input.
        signal: Signal,
        /// Where to.
        on: bool,
    },
    /// Switches an input from off to on; first off, if it is on.
    Rise(Signal),
    /// Waits until an output is so.
    Await {
        /// The output.
        signal: Signal,
        /// How it shall become.
        on: bool,
    },
}

/// A procedure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Procedure {
    /// Its name, such as `power-on`.
    pub name: &'static str,
    /// What it does, to complete "This will …".
    pub intent: String,
    /// What it does to the world.
    pub risk: Risk,
    /// Section of the manual, in chapter 1; empty for what is no timing chart.
    pub section: &'static str,
    /// What to do, in order.
    pub steps: Vec<Step>,
    /// An output that must not come on while an output is awaited.
    pub breaks_on: Option<Signal>,
}

impl Procedure {
    fn new(name: &'static str, intent: &str, risk: Risk, section: &'static str, steps: &[Step]) -> Self {
        Self { name, intent: intent.to_owned(), risk, section, steps: steps.to_vec(), breaks_on: None }
    }

    fn breaking_on(mut self, signal: Signal) -> Self {
        self.breaks_on = Some(signal);
        self
    }

    /// Servos on after power on.
    pub fn power_on() -> Self {
        let steps = [
            set(input::EMERGENCY_STOP, true),
            require(output::EMERGENCY_STOP, false, "release the emergency stop, then run the recovery"),
            require(output::ALARM, false, "run the recovery, which resets the alarm"),
            Step::Rise(input::SERVO_ON),
            wait(output::SERVO_ON, true),
            set(input::SERVO_ON, false),
        ];
        Self::new("power-on", "switch the servos on", Risk::Motion, "3.1", &steps).breaking_on(output::ALARM)
    }

    /// Into emergency stop.
    pub fn emergency_stop() -> Self {
        let steps = [
            set(input::EMERGENCY_STOP, false),
            wait(output::EMERGENCY_STOP, true),
            wait(output::ALARM, true),
            wait(output::SERVO_ON, false),
        ];
        Self::new("emergency-stop", "put the controller into emergency stop", Risk::Write, "3.1", &steps)
    }

    /// Out of emergency stop, with servos on.
    pub fn recover() -> Self {
        let steps = [
            set(input::EMERGENCY_STOP, true),
            wait(output::EMERGENCY_STOP, false),
            Step::Rise(input::ALARM_RESET),
            wait(output::ALARM, false),
            set(input::ALARM_RESET, false),
            Step::Rise(input::SERVO_ON),
            wait(output::SERVO_ON, true),
            set(input::SERVO_ON, false),
        ];
        Self::new("recover", "end the emergency stop and switch the servos on", Risk::Motion, "3.1", &steps)
    }

    /// Waits for AUTO mode. People select it, at the SAFETY connector and the programming box.
    pub fn auto_mode() -> Self {
        let steps = [wait(output::AUTO_MODE, true)];
        Self::new("auto-mode", "wait for AUTO mode", Risk::Read, "3.2", &steps)
    }

    /// Back to the first line of the programs.
    pub fn program_reset() -> Self {
        let steps =
            [Step::Rise(input::PROGRAM_RESET), wait(output::PROGRAM_RESET, true), set(input::PROGRAM_RESET, false)];
        Self::new("program-reset", "reset the robot program", Risk::Write, "3.2", &steps)
    }

    /// Runs the program; also after a stop. The stop input goes on first, where it is off (3.2, 3.3).
    pub fn run() -> Self {
        let steps = [
            require(output::EMERGENCY_STOP, false, "release the emergency stop, then run the recovery"),
            require(output::ALARM, false, "run the recovery, which resets the alarm"),
            require(output::AUTO_MODE, true, "select AUTO mode and give up control at the programming box"),
            set(input::EMERGENCY_STOP, true),
            set(input::STOP, true),
            Step::Rise(input::AUTO_START),
            wait(output::PROGRAM_RUNNING, true),
            wait(output::PROGRAM_RESET, false),
            set(input::AUTO_START, false),
        ];
        Self::new("run", "run the robot program", Risk::Motion, "3.2, 3.3", &steps).breaking_on(output::ALARM)
    }

    /// Stops the program. The stop input stays off until the next run.
    pub fn stop() -> Self {
        let steps = [set(input::STOP, false), wait(output::PROGRAM_RUNNING, false)];
        Self::new("stop", "stop the robot program", Risk::Write, "3.3", &steps)
    }

    /// Whether it switches nothing.
    pub fn only_awaits(&self) -> bool {
        !self.steps.iter().any(|step| matches!(step, Step::Set { .. } | Step::Rise(_)))
    }

    /// Whether it takes off what lets the robot move.
    pub fn stops(&self) -> bool {
        let is_stop = |signal: &Signal| [input::STOP, input::EMERGENCY_STOP].contains(signal);
        self.steps.iter().any(|step| matches!(step, Step::Set { signal, on: false } if is_stop(signal)))
    }

    /// Every timing chart.
    pub fn charts() -> [Self; 7] {
        [
            Self::power_on(),
            Self::emergency_stop(),
            Self::recover(),
            Self::auto_mode(),
            Self::program_reset(),
            Self::run(),
            Self::stop(),
        ]
    }

    /// Switches an input; `None` for an output.
    pub fn set(signal: Signal, on: bool) -> Option<Self> {
        let intent = format!("switch {} {}", signal.name(), if on { "on" } else { "off" });
        let steps = [set(signal, on)];
        (signal.side() == Side::Input).then(|| Self::new("set", &intent, signal.risk(on), "", &steps))
    }

    /// Switches an input on and off again; `None` for an output.
    pub fn pulse(signal: Signal) -> Option<Self> {
        let intent = format!("switch {} on and off again", signal.name());
        let steps = [Step::Rise(signal), set(signal, false)];
        (signal.side() == Side::Input).then(|| Self::new("pulse", &intent, signal.risk(true), "", &steps))
    }
}

const fn set(signal: Signal, on: bool) -> Step {
    Step::Set { signal, on }
}

const fn wait(signal: Signal, on: bool) -> Step {
    Step::Await { signal, on }
}

const fn require(signal: Signal, on: bool, hint: &'static str) -> Step {
    Step::Require { signal, on, hint }
}
