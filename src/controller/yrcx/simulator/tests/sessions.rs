//! Client sessions against the simulator in virtual time: the master sends every 20 ms, and receives the image of the
//! controller every 20 ms.

use super::*;
use crate::testing::ms;
use crate::yrcx::image::Output;
use crate::yrcx::order::Order;
use crate::yrcx::procedure::Procedure;
use crate::yrcx::sequence::{self, Sequence};
use crate::yrcx::session::{Ended, Exchange, ImageSession, Next, NotSentReason, Outcome, Policy, Silence};

const RPI: u64 = 20;

struct MasterLink {
    simulator: Simulator,
    output: Output,
    now: u64,
    /// Time at which the link is lost.
    cut: Option<u64>,
    linked: bool,
}

impl MasterLink {
    fn new(start: &str) -> Self {
        let mut simulator = Simulator::new(Start::parse(start).unwrap());
        let mut output = Output::new(resting());
        simulator.input(Now::ZERO, Some(&output.next));
        output.sent(Now::ZERO);
        Self { simulator, output, now: 500, cut: None, linked: true }
    }

    /// Advances the time by 5 ms.
    fn step<S: ImageSession>(&mut self, session: &mut S) {
        let now = ms(self.now);
        if self.cut == Some(self.now) {
            self.linked = false;
            self.output.unlinked();
            self.simulator.input(now, None);
            session.handle_link_loss(now);
        }
        if self.linked && self.now.is_multiple_of(RPI) {
            self.simulator.input(now, Some(&self.output.next));
            self.output.sent(now);
        }
        self.simulator.advance(now);
        if self.linked && self.now % RPI == 10 {
            session.handle(now, self.simulator.output());
        }
    }

    fn run_with<S: ImageSession>(&mut self, session: &mut S, mut hook: impl FnMut(u64, &mut S)) -> S::Outcome {
        session.handle(ms(self.now), self.simulator.output());
        loop {
            self.step(session);
            hook(self.now, session);
            let now = ms(self.now);
            let next = session.poll(now, &mut self.output);
            self.now += 5;
            match next {
                Next::Done(outcome) => return outcome,
                Next::Wait(until) => assert!(until > now, "waits for {until:?} at {now:?}"),
            }
            assert!(self.now < 1_000_000, "never over");
        }
    }

    fn exchange(&mut self, draft: Draft) -> Outcome {
        self.run_with(&mut Exchange::new(draft.build().unwrap(), Policy::default()), |_, _| {})
    }

    fn procedure(&mut self, procedure: Procedure) -> sequence::Outcome {
        self.run_with(&mut Sequence::new(procedure, Duration::from_secs(5)), |_, _| {})
    }

    /// Position of axis 1 at rest.
    fn place(&mut self) -> i32 {
        self.simulator.advance(ms(self.now + 60_000));
        geometry::whole(self.simulator.world.robots[0].pulses()[0])
    }

    fn is_on(&self, signal: Signal) -> bool {
        signal.is_on(self.simulator.output())
    }
}

fn by_300() -> Draft {
    Command::MoveiMm.order().with(Key::Axes, "1").with(Key::Axis1, "300").with(Key::Report, "mm")
}

fn order(draft: Draft) -> Order {
    draft.build().unwrap()
}

#[test]
fn a_motion_and_a_read() {
    let mut line = MasterLink::new("");
    let outcome = line.exchange(by_300());
    let Ended::Answered(Answer::Done(values)) = outcome.ended else { panic!("{outcome:?}") };
    assert_eq!(values.axes(), Some([300_000, 0, 0, 0]));
    assert!(outcome.ran && outcome.released && !outcome.stop_held);
    let outcome = line.exchange(Command::ServoStatus.order());
    let Ended::Answered(Answer::Done(values)) = outcome.ended else { panic!("{outcome:?}") };
    assert_eq!(values.axes(), Some([1; 4]));
    assert!(outcome.elapsed <= ms(2 * RPI + 5), "{:?}", outcome.elapsed);
    assert!(outcome.released && outcome.leftover.is_none());
}

#[test]
fn every_answer_is_understood() {
    for (id, words, _) in examples::examples() {
        let order = Order::parse(&words).unwrap();
        if order.row().pace == crate::yrcx::table::DurationClass::Jog {
            continue;
        }
        let outcome =
            MasterLink::new("run_scans = 9").run_with(&mut Exchange::new(order, Policy::default()), |_, _| {});
        assert!(matches!(outcome.ended, Ended::Answered(Answer::Done(_))), "{id} {outcome:?}");
    }
}

#[test]
fn a_refusal_is_an_answer() {
    let mut line = MasterLink::new("");
    let outcome = line.exchange(Command::MovePulse.order().with(Key::Axes, "1").with(Key::Axis1, i32::MAX));
    let Ended::Answered(Answer::Refused { alarm, .. }) = outcome.ended else { panic!("{outcome:?}") };
    assert_eq!(alarm.to_string(), "2.334");
    assert!(outcome.released);
}

#[test]
fn resets_or_awaits_the_command_of_another_master() {
    let mut line = MasterLink::new("");
    let left = |line: &mut MasterLink, order: &Order| {
        line.output.next.set_command(order.words());
        line.simulator.input(ms(line.now), Some(&line.output.next));
        line.now += 10;
        line.simulator.advance(ms(line.now));
        line.output = Output::new(resting());
    };
    left(&mut line, &order(Command::ServoStatus.order()));
    let outcome = line.exchange(by_300());
    assert_eq!(outcome.leftover, Some(Status::NormalEnd));
    assert!(matches!(outcome.ended, Ended::Answered(Answer::Done(_))));
    left(&mut line, &order(by_300()));
    let outcome = line.exchange(Command::ServoStatus.order());
    assert_eq!(outcome.leftover, Some(Status::Running), "its motion was carried out to its end");
    assert!(matches!(outcome.ended, Ended::Answered(Answer::Done(_))));
    left(&mut line, &order(by_300().with(Key::SpeedPercent, 1)));
    let outcome = line.exchange(Command::ServoStatus.order());
    assert_eq!(outcome.ended, Ended::NotSent(NotSentReason::NotReady(Status::Running)));
    assert_eq!(line.place(), 900_000);
}

#[test]
fn a_link_lost_at_any_moment_neither_loses_nor_doubles_a_motion() {
    let mut seen = [0; 3];
    for cut in (500..1300).step_by(5) {
        let mut line = MasterLink::new("");
        line.cut = Some(cut);
        let outcome = line.exchange(by_300());
        let place = line.place();
        match outcome.ended {
            Ended::NotSent(hindrance) => {
                assert_eq!((hindrance, place), (NotSentReason::LinkLost, 0), "{cut}");
                seen[0] += 1;
            }
            Ended::OutcomeUnknown(silence) => {
                assert_eq!(silence, Silence::LinkLost, "{cut}");
                assert!((0..=300_000).contains(&place), "{cut} {place}");
                assert!(!outcome.released);
                seen[1] += 1;
            }
            Ended::Answered(Answer::Done(values)) => {
                assert_eq!((values.int(Key::Axis1), place), (Some(300_000), 300_000), "{cut}");
                seen[2] += 1;
            }
            other => panic!("{cut} {other:?}"),
        }
        assert_eq!(line.is_on(output::ALARM), !line.linked, "{cut}");
        assert_eq!(line.is_on(output::SERVO_ON), line.linked, "{cut}");
    }
    assert!(seen.iter().all(|count| *count > 3), "{seen:?}");
}

#[test]
fn an_interrupt_at_any_moment_leaves_a_robot_at_rest() {
    let mut seen = [0; 3];
    for at in (500..1400).step_by(15) {
        let mut line = MasterLink::new("");
        let mut exchange = Exchange::new(order(by_300()), Policy::default());
        let outcome = line.run_with(&mut exchange, |now, exchange| {
            if now == at {
                exchange.interrupt(ms(now));
            }
        });
        let place = line.place();
        match outcome.ended {
            Ended::NotSent(NotSentReason::Interrupted) => {
                assert_eq!(place, 0);
                seen[0] += 1;
            }
            Ended::Answered(Answer::Refused { alarm, .. }) => {
                assert_eq!(alarm.to_string(), "12.400");
                assert!((0..300_000).contains(&place));
                seen[1] += 1;
            }
            Ended::Answered(Answer::Done(_)) => {
                assert_eq!(place, 300_000);
                seen[2] += 1;
            }
            other => panic!("{at} {other:?}"),
        }
        assert!(!outcome.stop_held && input::STOP.is_on(&line.output.next), "{at}");
        assert!(line.is_on(output::SERVO_ON) && !line.is_on(output::ALARM));
    }
    assert!(seen.iter().all(|count| *count > 0), "{seen:?}");
}

#[test]
fn stopped_jog_returns_its_position() {
    let mut line = MasterLink::new("");
    let jog = Command::JogPulse.order().with(Key::Axes, "1").with(Key::Direction, "+").with(Key::Report, "pulse");
    let mut exchange = Exchange::new(order(jog), Policy::default());
    let outcome = line.run_with(&mut exchange, |now, exchange| {
        if now == 1500 {
            exchange.interrupt(ms(now));
        }
    });
    let Ended::Answered(Answer::Refused { positions, .. }) = outcome.ended else { panic!("{outcome:?}") };
    let there = line.place();
    assert!(there > 100_000);
    assert_eq!(positions.int(Key::Axis1), Some(there));
}

#[test]
fn continuous_output_until_it_is_ended() {
    let mut line = MasterLink::new("");
    let draft = Command::PositionPulse.order().with(Key::Robot, 2).with(Key::Continuous, "on");
    let mut exchange = Exchange::new(order(draft), Policy::default());
    let mut shown = None;
    let outcome = line.run_with(&mut exchange, |now, exchange| {
        shown = exchange.running().or(shown.take());
        if now == 3000 {
            exchange.interrupt(ms(now));
        }
    });
    assert_eq!(outcome.ended, Ended::Stopped);
    assert!(outcome.released);
    let Some(Answer::Running(values)) = shown else { panic!("{shown:?}") };
    assert_eq!(values.axes(), Some([0, 9000, 0, 0]));
}

#[test]
fn the_procedures_of_the_timing_charts() {
    let mut line = MasterLink::new("servo = false");
    assert_eq!(line.procedure(Procedure::power_on()), sequence::Outcome::Done);
    assert!(line.is_on(output::SERVO_ON));
    assert_eq!(line.procedure(Procedure::auto_mode()), sequence::Outcome::Done);
    assert_eq!(line.procedure(Procedure::program_reset()), sequence::Outcome::Done);
    assert_eq!(line.procedure(Procedure::run()), sequence::Outcome::Done);
    assert!(line.is_on(output::PROGRAM_RUNNING));
    assert_eq!(line.procedure(Procedure::stop()), sequence::Outcome::Done);
    assert_eq!(line.procedure(Procedure::run()), sequence::Outcome::Done);
    assert_eq!(line.procedure(Procedure::emergency_stop()), sequence::Outcome::Done);
    assert!(!line.is_on(output::PROGRAM_RUNNING) && !line.is_on(output::SERVO_ON));
    assert!(matches!(line.procedure(Procedure::run()), sequence::Outcome::NotPossible { begun: false, .. }));
    assert_eq!(line.procedure(Procedure::recover()), sequence::Outcome::Done);
    assert_eq!(line.procedure(Procedure::run()), sequence::Outcome::Done);
}

#[test]
fn procedure_errors_name_the_missing_signal() {
    let mut line = MasterLink::new("mode = \"manual\"");
    let timed_out = sequence::Outcome::TimedOut { signal: output::AUTO_MODE, on: true };
    assert_eq!(line.procedure(Procedure::auto_mode()), timed_out);
    line.simulator.console(ms(line.now), "estop on").unwrap();
    line.simulator.advance(ms(line.now + 20));
    line.now += 20;
    assert!(matches!(line.procedure(Procedure::power_on()), sequence::Outcome::NotPossible { .. }));
    let timed_out = sequence::Outcome::TimedOut { signal: output::EMERGENCY_STOP, on: false };
    assert_eq!(line.procedure(Procedure::recover()), timed_out);
    line.simulator.console(ms(line.now), "estop off").unwrap();
    assert_eq!(line.procedure(Procedure::recover()), sequence::Outcome::Done);
    line.cut = Some(line.now + 180);
    let outcome = line.procedure(Procedure::pulse(input::PROGRAM_RESET).unwrap());
    assert_eq!(outcome, sequence::Outcome::LinkLost { begun: true });
}

#[test]
fn a_recovery_after_a_lost_link() {
    let mut line = MasterLink::new("");
    line.cut = Some(1000);
    assert_eq!(line.exchange(by_300()).ended, Ended::OutcomeUnknown(Silence::LinkLost));
    line.cut = None;
    line.linked = true;
    line.output = Output::new(resting());
    let outcome = line.exchange(by_300());
    assert_eq!(outcome.leftover, Some(Status::AbnormalEnd));
    let Ended::Answered(Answer::Refused { alarm, .. }) = outcome.ended else { panic!("{outcome:?}") };
    assert_eq!(alarm.to_string(), "12.551");
    assert_eq!(line.procedure(Procedure::recover()), sequence::Outcome::Done);
    assert!(matches!(line.exchange(by_300()).ended, Ended::Answered(Answer::Done(_))));
    assert_eq!(line.place(), 300_000, "the relative motion went on to its target");
}
