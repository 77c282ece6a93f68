//! Exchanges against a scripted controller in virtual time: the master sends every 20 ms, the controller scans every
//! 5 ms and sends its image every 20 ms.

use super::*;
use crate::testing::ms;
use crate::yrcx::alarm::{Alarm, STOP_INPUT};
use crate::yrcx::signal::{Side, Signal, resting};
use crate::yrcx::table::Command;
use crate::yrcx::value::{Key, Values};

const STEP: u64 = 5;
const RPI: u64 = 20;

/// How the simulated controller handles the next command.
#[derive(Debug, Clone)]
#[expect(clippy::struct_excessive_bools, reason = "a script is made of switches")]
struct Script {
    /// Run time of the command; `None` without an end.
    runs: Option<u64>,
    /// Whether the controller sends the running status.
    shows_run: bool,
    answer: Words,
    /// Whether the controller reacts to commands.
    takes: bool,
    /// Whether the controller reacts to the status reset.
    resets: bool,
    /// Words from WO1 on while the command runs.
    running: Words,
    /// Whether the controller accepts only one command.
    once: bool,
}

impl Default for Script {
    fn default() -> Self {
        let mut answer = [0; 16];
        answer[0] = 0x0200;
        Self { runs: Some(100), shows_run: true, answer, takes: true, resets: true, running: [0; 16], once: false }
    }
}

/// A controller, an order, and what was observed.
struct World {
    script: Script,
    exchange: Exchange,
    output: Output,
    now: u64,
    /// Image that the controller sends. The field below is the end time of the command.
    shown: Image,
    started: Option<u64>,
    /// Changed images that the master sent, with their times.
    sent: Vec<(u64, Image)>,
    /// Time at which the link is lost.
    cut: Option<u64>,
    interrupt: Option<u64>,
    updates: Vec<Values>,
    /// Age of the images that arrive from the controller, and the images that are on their way.
    late: u64,
    on_the_way: Vec<(u64, Image)>,
}

impl World {
    fn new(order: Order, script: Script) -> Self {
        Self {
            script,
            exchange: Exchange::new(order, Policy::default()),
            output: Output::new(resting()),
            now: 0,
            shown: Image::default(),
            started: None,
            sent: Vec::new(),
            cut: None,
            interrupt: None,
            updates: Vec::new(),
            late: 0,
            on_the_way: Vec::new(),
        }
    }

    fn run(&mut self) -> Outcome {
        let mut wake = Now::ZERO;
        for _ in 0..200_000 {
            let now = ms(self.now);
            let mut poll = now >= wake;
            if self.cut == Some(self.now) {
                self.exchange.handle_link_loss(now);
                self.output.unlinked();
                poll = true;
            }
            if self.interrupt == Some(self.now) {
                self.exchange.interrupt(now);
                poll = true;
            }
            let linked = self.cut.is_none_or(|cut| self.now < cut);
            if linked && self.now.is_multiple_of(RPI) {
                if self.sent.last().is_none_or(|(_, last)| *last != self.output.next) {
                    self.sent.push((self.now, self.output.next));
                }
                self.output.sent(now);
                poll = true;
            }
            if let Some(sent) = self.output.last_sent().copied() {
                self.scan(&sent);
            }
            if linked && self.now % RPI == 10 {
                self.on_the_way.push((self.now, self.shown));
                let arrived = self.on_the_way.iter().rev().find(|(sent, _)| sent + self.late <= self.now);
                self.exchange.handle(now, &arrived.map_or_else(Image::default, |(_, image)| *image));
                if let Some(Answer::Running(values)) = self.exchange.running() {
                    self.updates.push(values);
                }
                poll = true;
            }
            if poll {
                match self.exchange.poll(now, &mut self.output) {
                    Next::Done(outcome) => {
                        assert_eq!(self.output.next.command(), [0; 16], "no command word is left behind");
                        return outcome;
                    }
                    Next::Wait(until) => {
                        assert!(until > now, "waits for {until:?} at {now:?}");
                        wake = until;
                    }
                }
            }
            self.now += STEP;
        }
        panic!("never over");
    }

    fn scan(&mut self, image: &Image) {
        let wi0 = image.0[0];
        let status = Status::from_word(self.shown.0[0]);
        let mut show = |status: Status, words: &Words| {
            let mut words = *words;
            words[0] = status.word();
            self.shown.set_command(&words);
        };
        match (self.started, wi0) {
            (None, 0) if status != Status::Ready && self.script.resets => show(Status::Ready, &[0; 16]),
            (None, code) if code != 0 && status == Status::Ready && self.script.takes => {
                self.started = Some(self.now);
                if self.script.shows_run {
                    show(Status::Running, &self.script.running);
                }
            }
            (Some(_), 0) if self.exchange.order().is_continuous() => {
                show(Status::Ready, &[0; 16]);
                self.started = None;
            }
            (Some(started), _) => {
                if self.script.shows_run {
                    show(Status::Running, &self.script.running);
                }
                if !input::STOP.is_on(image) && self.script.answer[0] == 0x0200 {
                    self.script.answer = [0; 16];
                    self.script.answer[..3].copy_from_slice(&[0x4000, STOP_INPUT.group, STOP_INPUT.category]);
                    self.script.runs = Some(self.now - started + 50);
                }
                if self.script.runs.is_some_and(|runs| self.now >= started + runs) {
                    let answer = self.script.answer;
                    show(Status::from_word(answer[0]), &answer);
                    self.started = None;
                    self.script.takes = !self.script.once;
                }
            }
            _ => {}
        }
    }

    /// WI0 of each changed image, and whether the data words are those of the order.
    fn commands(&self) -> Vec<(u16, bool)> {
        let data = |image: &Image| image.command()[1..] == self.exchange.order().words()[1..];
        let mut seen: Vec<(u16, bool)> = self.sent.iter().map(|(_, image)| (image.0[0], data(image))).collect();
        seen.dedup();
        seen
    }
}

fn move_to_19() -> Order {
    Command::MovePtp.order().with(Key::Point, 19).with(Key::SpeedPercent, 50).build().unwrap()
}

fn jog() -> Order {
    let order = Command::JogPulse.order().with(Key::Axes, "1").with(Key::Direction, "-");
    order.with(Key::Report, "pulse").build().unwrap()
}

fn servo_status() -> Order {
    Command::ServoStatus.order().build().unwrap()
}

#[test]
fn data_goes_first_then_the_command_then_the_reset() {
    let mut world = World::new(move_to_19(), Script::default());
    let outcome = world.run();
    assert_eq!(world.commands(), [(0, false), (0, true), (1, true), (0, false)]);
    assert_eq!(outcome.ended, Ended::Answered(Answer::Done(Values::default())));
    assert!(outcome.ran && outcome.released && !outcome.stop_held);
    assert_eq!(outcome.leftover, None);
    assert_eq!(outcome.words.unwrap()[0], 0x0200);
    assert!((ms(100)..ms(140)).contains(&outcome.elapsed), "{:?}", outcome.elapsed);
}

#[test]
fn long_command_is_sent_once() {
    let mut world = World::new(move_to_19(), Script { runs: Some(300_000), ..Script::default() });
    let outcome = world.run();
    assert!(matches!(outcome.ended, Ended::Answered(Answer::Done(_))));
    assert_eq!(world.commands(), [(0, false), (0, true), (1, true), (0, false)]);
}

#[test]
fn the_run_status_may_be_missed() {
    let mut answer = [0; 16];
    answer[..8].copy_from_slice(&[0x0200, 0, 1, 1, 2, 1, 9, 9]);
    let script = Script { runs: Some(0), shows_run: false, answer, ..Script::default() };
    let outcome = World::new(servo_status(), script).run();
    assert!(!outcome.ran);
    let Ended::Answered(Answer::Done(values)) = outcome.ended else { panic!("{outcome:?}") };
    assert_eq!(values.axes(), Some([1, 1, 2, 1]), "the answer of the scan that shows the end");
}

#[test]
fn a_command_without_data_goes_as_soon_as_the_controller_is_ready() {
    let mut world = World::new(servo_status(), Script { runs: Some(0), shows_run: false, ..Script::default() });
    let ready = Image::default();
    world.exchange.handle(ms(0), &ready);
    world.output.sent(ms(0));
    let outcome = world.run();
    let (at, image) = world.sent[0];
    assert_eq!((at, image.0[0]), (0, 0), "the first image was on its way");
    let (at, image) = world.sent[1];
    assert_eq!((at, image.0[0]), (20, 0x0503));
    assert!(outcome.elapsed <= ms(10));
    assert!(world.exchange.answer().is_some());
}

#[test]
fn a_refusal_is_an_answer() {
    let mut answer = [0; 16];
    answer[..3].copy_from_slice(&[0x4000, 12, 76]);
    let outcome = World::new(move_to_19(), Script { answer, ..Script::default() }).run();
    let refused = Answer::Refused { alarm: Alarm::new(12, 76), positions: Values::default() };
    assert_eq!(outcome.ended, Ended::Answered(refused));
    assert!(outcome.released);
}

#[test]
fn an_end_status_of_another_master_is_reset_first() {
    for status in [Status::NormalEnd, Status::AbnormalEnd] {
        let mut world = World::new(move_to_19(), Script::default());
        world.shown.0[..3].copy_from_slice(&[status.word(), 7, 7]);
        world.exchange.handle(ms(0), &world.shown.clone());
        let outcome = world.run();
        assert_eq!(outcome.leftover, Some(status));
        assert!(matches!(outcome.ended, Ended::Answered(Answer::Done(_))));
        assert_eq!(world.commands(), [(0, false), (0, true), (1, true), (0, false)]);
    }
}

#[test]
fn the_next_command_waits_for_the_reset_of_an_answered_one() {
    let mut world = World::new(servo_status(), Script { runs: Some(0), ..Script::default() });
    world.exchange = Exchange::new(servo_status(), Policy { ends_with_answer: true, ..Policy::default() });
    let outcome = world.run();
    assert!(matches!(outcome.ended, Ended::Answered(Answer::Done(_))) && !outcome.released);
    assert_eq!(world.commands(), [(0, true), (0x0503, true)], "the reset is not sent yet");
    assert_eq!(world.shown.0[0], Status::NormalEnd.word());
    // The controller takes a command only if it is ready.
    world.exchange = Exchange::new(move_to_19(), Policy::default());
    world.exchange.handle(ms(world.now), &world.shown.clone());
    assert!(matches!(world.run().ended, Ended::Answered(Answer::Done(_))));
    assert_eq!(world.commands(), [(0, false), (0x0503, false), (0, true), (1, true), (0, false)]);
}

#[test]
fn a_status_reset_waits_for_the_ready_status() {
    let reset = || Command::StatusReset.order().build().unwrap();
    let mut world = World::new(reset(), Script::default());
    world.shown.0[0] = Status::AbnormalEnd.word();
    world.exchange.handle(ms(0), &world.shown.clone());
    let outcome = world.run();
    assert_eq!(outcome.ended, Ended::Answered(Answer::Done(Values::default())));
    assert_eq!(outcome.leftover, Some(Status::AbnormalEnd));
    let mut world = World::new(reset(), Script { runs: None, ..Script::default() });
    world.shown.0[0] = Status::Running.word();
    world.started = Some(0);
    assert_eq!(world.run().ended, Ended::NotSent(NotSentReason::NotReady(Status::Running)));
}

#[test]
fn does_not_touch_a_command_of_another_master() {
    let mut world = World::new(move_to_19(), Script { runs: None, ..Script::default() });
    world.shown.0[0] = Status::Running.word();
    world.started = Some(0);
    let outcome = world.run();
    assert_eq!(outcome.ended, Ended::NotSent(NotSentReason::NotReady(Status::Running)));
    assert!(world.commands().iter().all(|(wi0, _)| *wi0 == 0));
    assert_eq!(world.now, 3000);
}

#[test]
fn ignores_the_answer_to_another_command() {
    // The status changes after the session decided to send the command, and before the command is sent.
    let mut exchange = Exchange::new(servo_status(), Policy::default());
    let mut output = Output::new(resting());
    output.sent(ms(0));
    exchange.handle(ms(1), &Image::default());
    exchange.poll(ms(1), &mut output);
    assert_eq!(output.next.0[0], 0x0503);
    let mut foreign = Image::default();
    foreign.0[0] = 0x0200;
    exchange.handle(ms(2), &foreign);
    exchange.poll(ms(2), &mut output);
    assert_eq!(output.next.0[0], 0, "back to the reset");
    assert_eq!(exchange.answer(), None);
}

#[test]
fn error_of_a_lost_link_depends_on_the_sent_words() {
    let before = |cut, order: Order| {
        let mut world = World::new(order, Script { runs: None, ..Script::default() });
        world.cut = Some(cut);
        world.run().ended
    };
    assert_eq!(before(5, move_to_19()), Ended::NotSent(NotSentReason::LinkLost));
    assert_eq!(before(200, move_to_19()), Ended::OutcomeUnknown(Silence::LinkLost));
    assert_eq!(before(200, servo_status()), Ended::NoAnswer(Silence::LinkLost));
}

#[test]
fn keeps_the_answer_if_the_link_is_lost_later() {
    let mut world = World::new(move_to_19(), Script { runs: Some(100), resets: false, ..Script::default() });
    world.cut = Some(200);
    let outcome = world.run();
    assert!(matches!(outcome.ended, Ended::Answered(Answer::Done(_))));
    assert!(!outcome.released);
}

#[test]
fn silence_has_its_reason() {
    let ended = |order: Order, script| World::new(order, script).run();
    let deaf = Script { takes: false, ..Script::default() };
    let outcome = ended(servo_status(), deaf.clone());
    assert_eq!(outcome.ended, Ended::NoAnswer(Silence::NotTaken));
    assert!(outcome.released);
    assert_eq!(ended(move_to_19(), deaf).ended, Ended::OutcomeUnknown(Silence::NotTaken));

    let endless = Script { runs: None, ..Script::default() };
    assert_eq!(ended(servo_status(), endless).ended, Ended::NoAnswer(Silence::TooLong));

    let mut answer = [0; 16];
    answer[0] = 0x1234;
    let odd = Script { answer, ..Script::default() };
    assert_eq!(ended(move_to_19(), odd).ended, Ended::OutcomeUnknown(Silence::Undocumented(0x1234)));

    // The controller becomes ready without an end status, and accepts no more commands.
    let vanishing = Script { answer: [0; 16], once: true, ..Script::default() };
    assert_eq!(ended(move_to_19(), vanishing).ended, Ended::OutcomeUnknown(Silence::Vanished));
}

#[test]
fn interrupt_stops_a_motion_and_restores_the_stop_input() {
    let mut world = World::new(jog(), Script { runs: None, ..Script::default() });
    world.interrupt = Some(500);
    let outcome = world.run();
    let Ended::Answered(Answer::Refused { alarm, positions }) = outcome.ended else { panic!("{outcome:?}") };
    assert_eq!((alarm, positions.axes()), (STOP_INPUT, Some([0; 4])));
    assert!(outcome.released && !outcome.stop_held);
    let edges: Vec<(u64, bool)> = world.stop_edges();
    let [(_, true), (off, false), (on, true)] = edges[..] else { panic!("{edges:?}") };
    assert!((500..=520).contains(&off));
    assert!(on - off >= 100, "{edges:?}");
    assert!(world.sent.iter().all(|(_, image)| input::EMERGENCY_STOP.is_on(image)));
}

#[test]
fn stops_a_jog_whose_end_is_not_observed() {
    let odd = Script { answer: [0x1234; 16], ..Script::default() };
    let vanishing = Script { answer: [0; 16], once: true, ..Script::default() };
    for script in [Script { takes: false, ..Script::default() }, odd, vanishing] {
        let mut world = World::new(jog(), script);
        let outcome = world.run();
        assert!(matches!(outcome.ended, Ended::OutcomeUnknown(_)) && outcome.stop_held, "{outcome:?}");
        assert!(!world.stop_edges().last().unwrap().1);
        // A motion ends by itself.
        let mut world = World::new(move_to_19(), world.script);
        assert!(!world.run().stop_held && world.stop_edges().len() == 1);
    }
}

#[test]
fn a_motion_that_does_not_end_keeps_the_stop_input_off() {
    let mut answer = [0; 16];
    answer[0] = 0x4000;
    let mut world = World::new(move_to_19(), Script { runs: None, answer, ..Script::default() });
    world.interrupt = Some(500);
    let outcome = world.run();
    assert_eq!(outcome.ended, Ended::OutcomeUnknown(Silence::Interrupted));
    assert!(world.now <= 3500, "it is told within 3 s: {}", world.now);
    assert!(outcome.stop_held);
    assert!(!input::STOP.is_on(&world.output.next));
}

#[test]
fn an_interrupt_before_the_command_is_sent_leaves_no_trace() {
    let mut world = World::new(move_to_19(), Script::default());
    world.shown.0[0] = Status::Running.word();
    world.started = Some(0);
    world.interrupt = Some(50);
    assert_eq!(world.run().ended, Ended::NotSent(NotSentReason::Interrupted));
    assert_eq!(world.stop_edges().len(), 1);
}

#[test]
fn continuous_output_goes_on_until_it_is_ended() {
    let order = Command::PositionPulse.order().with(Key::Continuous, "on").build().unwrap();
    let mut running = [0; 16];
    running[4] = 5;
    let mut world = World::new(order, Script { runs: None, running, ..Script::default() });
    world.interrupt = Some(60_000);
    let outcome = world.run();
    assert_eq!(outcome.ended, Ended::Stopped);
    assert!(outcome.released, "the status reset ends it");
    assert_eq!(world.updates.len(), 1, "told once while nothing changes");
    assert_eq!(world.updates[0].axes(), Some([5, 0, 0, 0]));
    assert_eq!(world.stop_edges().len(), 1, "nothing moves, nothing is stopped");
}

#[test]
fn keeps_bits_outside_the_command() {
    let mut world = World::new(move_to_19(), Script::default());
    let general = Signal::parse(Side::Input, "57").unwrap();
    general.set(&mut world.output.next, true);
    let bits = world.output.next.0[16..].to_vec();
    world.run();
    assert!(world.sent.iter().all(|(_, image)| image.0[16..] == bits));
}

impl World {
    fn stop_edges(&self) -> Vec<(u64, bool)> {
        let mut edges: Vec<(u64, bool)> = Vec::new();
        for (at, image) in &self.sent {
            let on = input::STOP.is_on(image);
            if edges.last().is_none_or(|(_, last)| *last != on) {
                edges.push((*at, on));
            }
        }
        edges
    }
}

/// A time limit that is shorter than the age of images that a link allows.
const HASTY: Policy = Policy { accept: ms(100), settle: ms(640), ..Policy::DEFAULT };

#[test]
fn an_end_status_after_the_time_limit_belongs_to_the_command_that_is_still_the_last_one() {
    let mut world = World { late: 300, ..World::new(move_to_19(), Script { runs: Some(40), ..Script::default() }) };
    world.exchange.policy = HASTY;
    let outcome = world.run();
    assert!(matches!(outcome.ended, Ended::Answered(Answer::Done(_))), "{:?}", outcome.ended);
    assert!(outcome.released);
    let commands = world.commands();
    assert_eq!(commands.iter().filter(|(code, _)| *code != 0).count(), 1, "{commands:?}");
}

#[test]
fn the_status_reset_stays_after_a_command_without_an_answer_while_an_image_can_be_on_its_way() {
    let mut world = World::new(servo_status(), Script { takes: false, ..Script::default() });
    world.exchange.policy = HASTY;
    assert_eq!(world.run().ended, Ended::NoAnswer(Silence::NotTaken));
    let reset = world.sent.last().map(|(at, image)| (*at, image.0[0])).unwrap();
    assert_eq!(reset.1, 0);
    assert!(world.now >= reset.0 + 620, "the reset of {} ms ended at {} ms", reset.0, world.now);
}

#[test]
fn a_command_waits_for_the_late_end_of_a_command_that_a_dead_client_left() {
    let mut world = World::new(servo_status(), Script::default());
    world.exchange.policy = HASTY;
    world.output.next.set_command(move_to_19().words());
    assert!(matches!(world.run().ended, Ended::Answered(_)));
    let command = servo_status().words()[0];
    let first = world.sent.iter().find(|(_, image)| image.0[0] == command).unwrap();
    assert!(first.0 >= 640, "sent after {} ms", first.0);
}
