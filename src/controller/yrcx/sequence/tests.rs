//! Procedures against a small controller in virtual time. The controller behaves as in the timing charts.

use super::*;
use crate::testing::ms;
use crate::yrcx::image::DEDICATED_WORD;
use crate::yrcx::signal::{Side, input, output, resting};

const RPI: u64 = 20;

/// A controller that answers dedicated inputs after 30 ms, as in the timing charts.
struct World {
    output: Output,
    shown: Image,
    now: u64,
    /// Time and content of the dedicated word at each of its changes.
    edges: Vec<(u64, u16)>,
    /// Scheduled changes of outputs.
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
                sequence.handle_link_loss(now);
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

    /// The inputs that were switched, in order. Also checks the intervals between the edges.
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
fn enters_and_leaves_the_emergency_stop() {
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
fn unconfirmed_input_fails_and_is_switched_off() {
    let mut world = World::new(&[]);
    world.deaf = true;
    assert_eq!(world.run(Procedure::power_on()), Outcome::TimedOut { signal: output::SERVO_ON, on: true });
    assert_eq!(world.output.next, resting());
    assert_eq!(world.run(Procedure::auto_mode()), Outcome::TimedOut { signal: output::AUTO_MODE, on: true });
}

#[test]
fn alarm_ends_the_procedure() {
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
fn lost_link_reports_switched_signals() {
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
