//! The procedures of the timing charts (chapter 1, section 3): edges of dedicated inputs that keep their distance, and
//! the outputs that confirm each.

use std::time::Duration;

use super::image::{Image, Output};
use super::session::{ImageSession, Next, edge_due};
use super::signal::{Side, Signal, input, output};
use crate::controller::{Now, Risk};

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

/// How a procedure ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Every step done, every output confirmed.
    Done,
    /// An output was not as required.
    NotPossible {
        /// The output.
        signal: Signal,
        /// How it must be.
        on: bool,
        /// What to do.
        hint: &'static str,
        /// Whether an input was switched before.
        begun: bool,
    },
    /// An output did not become as awaited in time.
    TimedOut {
        /// The output.
        signal: Signal,
        /// How it should have become.
        on: bool,
    },
    /// An output came on that ends the procedure.
    Broken {
        /// The output.
        signal: Signal,
    },
    /// No image came.
    NoImage,
    /// The link went down.
    LinkLost {
        /// Whether an input may have been switched before.
        begun: bool,
    },
}

/// Carries out a procedure.
#[derive(Debug, Clone)]
pub struct Sequence {
    procedure: Procedure,
    patience: Duration,
    at: usize,
    since: Option<Now>,
    input: Option<Image>,
    linked: bool,
    begun: bool,
    /// Inputs that were raised and not yet dropped: a failure must not leave them on.
    raised: Option<Signal>,
    outcome: Option<Outcome>,
}

/// What a step says.
enum Advance {
    Next,
    Wait(Option<Now>),
    End(Outcome),
}

impl Sequence {
    /// Will carry out `procedure`, and wait at most `patience` for each output.
    pub fn new(procedure: Procedure, patience: Duration) -> Self {
        Self {
            procedure,
            patience,
            at: 0,
            since: None,
            input: None,
            linked: true,
            begun: false,
            raised: None,
            outcome: None,
        }
    }

    /// The step it is at; `None` at the end.
    pub fn step(&self) -> Option<Step> {
        self.procedure.steps.get(self.at).copied()
    }

    /// Switches an input if edges may follow each other by now; done once it was sent.
    fn switch(&mut self, now: Now, output: &mut Output, signal: Signal, on: bool) -> Advance {
        if signal.is_on(&output.next) != on {
            if let Some(due) = edge_due(now, output, signal) {
                return Advance::Wait(Some(due));
            }
            signal.set(&mut output.next, on);
            self.begun = true;
        }
        match output.last_sent() {
            Some(sent) if signal.is_on(sent) == on => Advance::Next,
            _ => Advance::Wait(None),
        }
    }

    fn advance(&mut self, now: Now, output: &mut Output, step: Step) -> Advance {
        match step {
            Step::Set { signal, on } => {
                let advance = self.switch(now, output, signal, on);
                if matches!(advance, Advance::Next) && !on && self.raised == Some(signal) {
                    self.raised = None;
                }
                advance
            }
            Step::Rise(signal) => {
                if self.raised != Some(signal) {
                    match self.switch(now, output, signal, false) {
                        Advance::Next => {}
                        other => return other,
                    }
                    if let Some(due) = edge_due(now, output, signal) {
                        return Advance::Wait(Some(due));
                    }
                    self.raised = Some(signal);
                }
                self.switch(now, output, signal, true)
            }
            Step::Require { signal, on, hint } => match self.input {
                Some(image) if signal.is_on(&image) == on => Advance::Next,
                Some(_) => Advance::End(Outcome::NotPossible { signal, on, hint, begun: self.begun }),
                None => Advance::Wait(None),
            },
            Step::Await { signal, on } => match self.input {
                Some(image) if signal.is_on(&image) == on => Advance::Next,
                Some(image) => match self.procedure.breaks_on {
                    Some(breaks) if breaks.is_on(&image) => Advance::End(Outcome::Broken { signal: breaks }),
                    _ => Advance::Wait(None),
                },
                None => Advance::Wait(None),
            },
        }
    }

    fn timed_out(&self, step: Step) -> Outcome {
        match step {
            Step::Await { signal, on } if self.input.is_some() => Outcome::TimedOut { signal, on },
            _ => Outcome::NoImage,
        }
    }

    /// Ends it. An input that was raised for a moment does not stay on.
    fn end(&mut self, output: &mut Output, outcome: Outcome) {
        if let Some(signal) = self.raised.take() {
            signal.set(&mut output.next, false);
        }
        self.outcome = Some(outcome);
    }
}

impl ImageSession for Sequence {
    type Outcome = Outcome;

    fn poll(&mut self, now: Now, output: &mut Output) -> Next<Outcome> {
        while self.outcome.is_none() {
            let since = *self.since.get_or_insert(now);
            let Some(step) = self.step() else {
                self.end(output, Outcome::Done);
                break;
            };
            if !self.linked {
                let begun = self.begun;
                self.end(output, Outcome::LinkLost { begun });
                break;
            }
            let deadline = since.saturating_add(self.patience);
            match self.advance(now, output, step) {
                Advance::Next => {
                    self.at += 1;
                    self.since = None;
                }
                Advance::Wait(_) if now >= deadline => {
                    let outcome = self.timed_out(step);
                    self.end(output, outcome);
                }
                Advance::Wait(due) => return Next::Wait(due.map_or(deadline, |due| due.min(deadline))),
                Advance::End(outcome) => self.end(output, outcome),
            }
        }
        match self.outcome {
            Some(outcome) => Next::Done(outcome),
            None => Next::Wait(now),
        }
    }

    fn handle(&mut self, _now: Now, input: &Image) {
        if self.linked {
            self.input = Some(*input);
        }
    }

    fn lost(&mut self, _now: Now) {
        self.linked = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::yrcx::image::DEDICATED_WORD;
    use crate::controller::yrcx::signal::resting;

    const RPI: u64 = 20;

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    /// A controller that answers dedicated inputs after 30 ms, as the timing charts show.
    struct World {
        output: Output,
        shown: Image,
        now: u64,
        /// Dedicated words as sent, when they changed.
        edges: Vec<(u64, u16)>,
        /// What to do when, and to which output.
        pending: Vec<(u64, Signal, bool)>,
        before: Image,
        deaf: bool,
        cut: Option<u64>,
    }

    impl World {
        fn new(outputs: &[Signal]) -> Self {
            let mut shown = Image::default();
            for signal in outputs {
                signal.set(&mut shown, true);
            }
            let mut output = Output::new(resting());
            output.sent(Now::ZERO);
            Self {
                output,
                shown,
                now: 500,
                edges: Vec::new(),
                pending: Vec::new(),
                before: resting(),
                deaf: false,
                cut: None,
            }
        }

        fn run(&mut self, procedure: Procedure) -> Outcome {
            let mut sequence = Sequence::new(procedure, Duration::from_secs(5));
            sequence.handle(ms(self.now), &self.shown);
            loop {
                let now = ms(self.now);
                if self.cut == Some(self.now) {
                    self.output.unlinked();
                    sequence.lost(now);
                }
                if self.now.is_multiple_of(RPI) {
                    let word = self.output.next.0[DEDICATED_WORD];
                    if self.before.0[DEDICATED_WORD] != word {
                        self.edges.push((self.now, word));
                    }
                    self.output.sent(now);
                    self.react();
                }
                self.settle();
                if self.now % RPI == 10 {
                    sequence.handle(now, &self.shown);
                }
                match sequence.poll(now, &mut self.output) {
                    Next::Done(outcome) => return outcome,
                    Next::Wait(until) => assert!(until > now, "waits for {until:?} at {now:?}"),
                }
                self.now += 5;
                assert!(self.now < 100_000, "never over at {:?}", sequence.step());
            }
        }

        fn react(&mut self) {
            let (next, before) = (self.output.next, self.before);
            self.before = next;
            let rises = |signal: Signal| signal.is_on(&next) && !signal.is_on(&before);
            let falls = |signal: Signal| !signal.is_on(&next) && signal.is_on(&before);
            let mut set = |signal, on| self.pending.push((self.now + 30, signal, on));
            if falls(input::EMERGENCY_STOP) {
                set(output::EMERGENCY_STOP, true);
                set(output::ALARM, true);
                set(output::SERVO_ON, false);
                set(output::PROGRAM_RUNNING, false);
            }
            if rises(input::EMERGENCY_STOP) {
                set(output::EMERGENCY_STOP, false);
            }
            if self.deaf {
                return;
            }
            if rises(input::ALARM_RESET) {
                set(output::ALARM, false);
            }
            if rises(input::SERVO_ON) {
                set(output::SERVO_ON, true);
            }
            if rises(input::PROGRAM_RESET) {
                set(output::PROGRAM_RESET, true);
            }
            if rises(input::AUTO_START) && input::STOP.is_on(&next) {
                set(output::PROGRAM_RUNNING, true);
                set(output::PROGRAM_RESET, false);
            }
            if falls(input::STOP) {
                set(output::PROGRAM_RUNNING, false);
            }
        }

        fn settle(&mut self) {
            for (_, signal, on) in self.pending.extract_if(.., |(at, ..)| *at <= self.now) {
                signal.set(&mut self.shown, on);
            }
        }

        /// What was switched on or off, in order, beside the resting inputs; checks the distances.
        fn seen(&self) -> Vec<String> {
            assert!(self.edges.windows(2).all(|pair| pair[1].0 - pair[0].0 >= 100), "{:?}", self.edges);
            let mut before = resting().0[DEDICATED_WORD];
            let mut seen = Vec::new();
            for (_, word) in &self.edges {
                for dedicated in Signal::of_side(Side::Input) {
                    let bit = 1 << dedicated.signal.bit();
                    if (before ^ word) & bit != 0 {
                        seen.push(format!("{}{}", if word & bit == 0 { '-' } else { '+' }, dedicated.name));
                    }
                }
                before = *word;
            }
            seen
        }
    }

    #[test]
    fn servos_go_on_after_power_on() {
        let mut world = World::new(&[output::CPU_OK, output::MP_READY]);
        assert_eq!(world.run(Procedure::power_on()), Outcome::Done);
        assert_eq!(world.seen(), ["+servo-on", "-servo-on"]);
        assert!(output::SERVO_ON.is_on(&world.shown));
    }

    #[test]
    fn into_emergency_stop_and_out_again() {
        let mut world = World::new(&[output::SERVO_ON]);
        assert_eq!(world.run(Procedure::emergency_stop()), Outcome::Done);
        assert!(!output::SERVO_ON.is_on(&world.shown) && output::ALARM.is_on(&world.shown));
        let hint = Outcome::NotPossible {
            signal: output::EMERGENCY_STOP,
            on: false,
            hint: "release the emergency stop, then run the recovery",
            begun: false,
        };
        assert_eq!(world.run(Procedure::run()), hint);
        assert_eq!(world.run(Procedure::recover()), Outcome::Done);
        let edges = ["-emergency-stop", "+emergency-stop", "+alarm-reset", "-alarm-reset", "+servo-on", "-servo-on"];
        assert_eq!(world.seen(), edges);
        assert!(output::SERVO_ON.is_on(&world.shown) && !output::ALARM.is_on(&world.shown));
    }

    #[test]
    fn reset_run_stop_and_run_again() {
        let mut world = World::new(&[output::SERVO_ON, output::AUTO_MODE]);
        for procedure in [Procedure::auto_mode(), Procedure::program_reset(), Procedure::run()] {
            assert_eq!(world.run(procedure), Outcome::Done);
        }
        assert!(output::PROGRAM_RUNNING.is_on(&world.shown) && !output::PROGRAM_RESET.is_on(&world.shown));
        assert_eq!(world.run(Procedure::stop()), Outcome::Done);
        assert!(!output::PROGRAM_RUNNING.is_on(&world.shown));
        assert_eq!(world.run(Procedure::run()), Outcome::Done);
        let edges = ["+program-reset", "-program-reset", "+auto-start", "-auto-start"];
        let again = ["-stop", "+stop", "+auto-start", "-auto-start"];
        assert_eq!(world.seen(), [edges, again].concat());
    }

    #[test]
    fn what_is_not_confirmed_is_told_and_not_left_on() {
        let mut world = World::new(&[]);
        world.deaf = true;
        assert_eq!(world.run(Procedure::power_on()), Outcome::TimedOut { signal: output::SERVO_ON, on: true });
        assert_eq!(world.output.next, resting());
        assert_eq!(world.run(Procedure::auto_mode()), Outcome::TimedOut { signal: output::AUTO_MODE, on: true });
    }

    #[test]
    fn an_alarm_ends_it_at_once() {
        let mut world = World::new(&[output::AUTO_MODE]);
        world.deaf = true;
        world.pending.push((700, output::ALARM, true));
        assert_eq!(world.run(Procedure::run()), Outcome::Broken { signal: output::ALARM });
        assert!(world.now < 800);
        assert_eq!(world.output.next, resting());
    }

    #[test]
    fn an_input_left_on_falls_before_it_rises() {
        let mut world = World::new(&[]);
        input::ALARM_RESET.set(&mut world.output.next, true);
        world.output.sent(ms(1));
        world.before = world.output.next;
        assert_eq!(world.run(Procedure::pulse(input::ALARM_RESET).unwrap()), Outcome::Done);
        let words: Vec<u16> = world.edges.iter().map(|(_, word)| word >> input::ALARM_RESET.bit() & 1).collect();
        assert_eq!(words, [0, 1, 0]);
        assert!(world.edges.windows(2).all(|pair| pair[1].0 - pair[0].0 >= 100));
    }

    #[test]
    fn a_lost_link_tells_whether_something_was_switched() {
        let mut world = World::new(&[]);
        world.cut = Some(500);
        assert_eq!(world.run(Procedure::power_on()), Outcome::LinkLost { begun: false });
        let mut world = World::new(&[]);
        world.deaf = true;
        world.cut = Some(800);
        assert_eq!(world.run(Procedure::power_on()), Outcome::LinkLost { begun: true });
    }

    #[test]
    fn only_emergency_stop_and_stop_switch_resting_inputs_off() {
        for procedure in Procedure::charts() {
            for step in &procedure.steps {
                if let Step::Set { signal: input::EMERGENCY_STOP, on: false } = step {
                    assert_eq!(procedure.name, "emergency-stop");
                }
                if let Step::Set { signal: input::STOP, on: false } = step {
                    assert_eq!(procedure.name, "stop");
                }
            }
        }
        assert_eq!(Procedure::set(output::ALARM, true), None);
    }
}
