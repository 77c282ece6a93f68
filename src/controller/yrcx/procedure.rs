//! Signal procedures of the timing charts (chapter 1, section 3), as data for a
//! [`Sequence`](super::sequence::Sequence).

use super::signal::{Side, Signal, input, output};
use crate::Risk;

/// A step of a procedure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Requires that an output has this state. If it has not, the procedure does not begin or continue.
    Require {
        /// The output.
        signal: Signal,
        /// Required state.
        on: bool,
        /// Hint if the output has another state.
        hint: &'static str,
    },
    /// Switches an input. Has no effect if the input already has this state.
    Set {
        /// The input.
        signal: Signal,
        /// New state.
        on: bool,
    },
    /// Switches an input from off to on. If the input is on, it is first switched off.
    Rise(Signal),
    /// Waits until an output has this state.
    Await {
        /// The output.
        signal: Signal,
        /// Expected state.
        on: bool,
    },
}

/// A procedure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Procedure {
    /// Name, for example `power-on`.
    pub name: &'static str,
    /// Effect. The text is the end of the sentence "This will …".
    pub intent: String,
    /// Risk of the procedure.
    pub risk: Risk,
    /// Section of the manual in chapter 1. Empty if the manual has no timing chart for this procedure.
    pub section: &'static str,
    /// Steps in order.
    pub steps: Vec<Step>,
    /// Output that aborts the procedure if it switches on during a wait.
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

    /// Switches servos on after power on.
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

    /// Activates the emergency stop.
    pub fn emergency_stop() -> Self {
        let steps = [
            set(input::EMERGENCY_STOP, false),
            wait(output::EMERGENCY_STOP, true),
            wait(output::ALARM, true),
            wait(output::SERVO_ON, false),
        ];
        Self::new("emergency-stop", "put the controller into emergency stop", Risk::Write, "3.1", &steps)
    }

    /// Clears the emergency stop and switches servos on.
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

    /// Waits for AUTO mode. A person must select this mode with the SAFETY connector and the programming box.
    pub fn auto_mode() -> Self {
        let steps = [wait(output::AUTO_MODE, true)];
        Self::new("auto-mode", "wait for AUTO mode", Risk::Read, "3.2", &steps)
    }

    /// Resets the programs to the first line.
    pub fn program_reset() -> Self {
        let steps =
            [Step::Rise(input::PROGRAM_RESET), wait(output::PROGRAM_RESET, true), set(input::PROGRAM_RESET, false)];
        Self::new("program-reset", "reset the robot program", Risk::Write, "3.2", &steps)
    }

    /// Starts the program, also after a stop. If the stop input is off, it is switched on first (3.2, 3.3).
    pub fn run() -> Self {
        let steps = [
            require(output::EMERGENCY_STOP, false, "release the emergency stop, then run the recovery"),
            require(output::ALARM, false, "run the recovery, which resets the alarm"),
            require(output::AUTO_MODE, true, "select AUTO mode, and release the control of the programming box"),
            set(input::EMERGENCY_STOP, true),
            set(input::STOP, true),
            Step::Rise(input::AUTO_START),
            wait(output::PROGRAM_RUNNING, true),
            wait(output::PROGRAM_RESET, false),
            set(input::AUTO_START, false),
        ];
        Self::new("run", "run the robot program", Risk::Motion, "3.2, 3.3", &steps).breaking_on(output::ALARM)
    }

    /// Stops the program. The stop input then stays off until the next run.
    pub fn stop() -> Self {
        let steps = [set(input::STOP, false), wait(output::PROGRAM_RUNNING, false)];
        Self::new("stop", "stop the robot program", Risk::Write, "3.3", &steps)
    }

    /// Whether the procedure switches no inputs.
    pub fn only_awaits(&self) -> bool {
        !self.steps.iter().any(|step| matches!(step, Step::Set { .. } | Step::Rise(_)))
    }

    /// Whether the procedure switches an emergency-stop or stop input off.
    pub fn stops(&self) -> bool {
        let is_stop = |signal: &Signal| [input::STOP, input::EMERGENCY_STOP].contains(signal);
        self.steps.iter().any(|step| matches!(step, Step::Set { signal, on: false } if is_stop(signal)))
    }

    /// All timing charts.
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
