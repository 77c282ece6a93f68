//! Handshake of remote commands, scan by scan (chapter 2, sections 1 and 2).

use super::alarms::{Fault, STOP_INPUT};
use super::commands::{self, CommandProgress};
use super::motion::{End, Owner};
use super::motion_commands;
use super::read_commands;
use super::replay;
use super::request::Request;
use super::world::{Link, SCAN, World};
use crate::Now;
use crate::simulator::recording::Replay;
use crate::yrcx::answer::Status;
use crate::yrcx::image::{COMMAND_WORDS, Words};
use crate::yrcx::table::DurationClass;
use crate::yrcx::value::{Key, Values};

const NO_WORDS: Words = [0; COMMAND_WORDS];
const RUN_STATUS: Words = {
    let mut words = NO_WORDS;
    words[0] = Status::Running.word();
    words
};

/// A running command.
#[derive(Debug, Clone)]
struct Running {
    request: Request,
    work: CommandProgress,
    /// Earliest time at which the running status ends.
    not_before: Now,
    /// Whether the master still sends the command. If not, the end of the command is not reported.
    held: bool,
    /// How the motions of this command have ended so far.
    ends: Vec<End>,
}

#[derive(Debug, Clone)]
enum State {
    /// The controller is ready for a command.
    Ready,
    Running(Box<Running>),
    /// The command has ended. The controller waits for the status reset.
    Ended,
}

/// Handshake state and output words.
#[derive(Debug, Clone)]
pub(super) struct Remote {
    state: State,
    shown: Words,
    /// Maximum number of scans with the running status for a quick command.
    run_scans: u32,
    random: fastrand::Rng,
}

impl Remote {
    pub(super) fn new(run_scans: u32, seed: u64) -> Self {
        Self { state: State::Ready, shown: NO_WORDS, run_scans, random: fastrand::Rng::with_seed(seed) }
    }

    pub(super) fn words(&self) -> Words {
        self.shown
    }

    /// Time of the next action if the master changes nothing.
    pub(super) fn due(&self, world: &World) -> Option<Now> {
        let State::Running(running) = &self.state else { return None };
        match &running.work {
            CommandProgress::Power(at, _) => Some(*at),
            CommandProgress::Done(_) => Some(running.not_before),
            // The values change only during a motion.
            CommandProgress::Continuous => {
                let robot = world.robots.get(running.request.robot())?;
                robot.motion.is_some().then(|| world.now.saturating_add(SCAN))
            }
            // The end of a motion causes a scan anyway, so no time is needed here.
            CommandProgress::Motion(_) => None,
        }
    }

    /// Handles one scan of the handshake. Call this function after all other parts have handled the scan.
    pub(super) fn scan(&mut self, world: &mut World, replay: &Replay) {
        let words = (world.link != Link::Down).then(|| world.inputs.command());
        match (&mut self.state, words) {
            (State::Ready, Some(words)) if words[0] != Status::Ready.word() => match replay::answer(replay, &words) {
                Some(recorded) => self.end(recorded),
                None => self.take(world, &words),
            },
            (State::Running(running), Some(words)) if words != running.request.words => running.held = false,
            (State::Ended, Some(words)) if words[0] == Status::Ready.word() => {
                self.state = State::Ready;
                self.shown = NO_WORDS;
            }
            _ => {}
        }
        self.carry_on(world);
    }

    fn take(&mut self, world: &mut World, words: &Words) {
        let request = match Request::read(words) {
            Ok(request) => request,
            Err(fault) => return self.end(refusal(world, fault)),
        };
        match commands::begin(world, &request) {
            Ok(work) => {
                let scans =
                    if matches!(work, CommandProgress::Done(_)) { self.random.u32(0..=self.run_scans) } else { 0 };
                let not_before = world.now.saturating_add(SCAN.saturating_mul(scans));
                let running = Running { request, work, not_before, held: true, ends: Vec::new() };
                self.shown = RUN_STATUS;
                self.state = State::Running(Box::new(running));
            }
            Err(fault) => self.end(abnormal_end(world, &request, fault)),
        }
    }

    fn carry_on(&mut self, world: &mut World) {
        let State::Running(running) = &mut self.state else { return };
        let Some(result) = progress(world, running) else {
            if running.work == CommandProgress::Continuous {
                self.shown = output(world, &running.request);
            }
            return;
        };
        let held = running.held;
        let words = match result {
            Ok(values) => running.request.reply(Status::NormalEnd, &values),
            Err(fault) => abnormal_end(world, &running.request, fault),
        };
        let taken_back = world.link != Link::Down && world.inputs.command()[0] == Status::Ready.word();
        match (held, taken_back) {
            (true, _) => self.end(words),
            (false, true) => {
                self.state = State::Ready;
                self.shown = NO_WORDS;
            }
            // The master replaced this command by another command. The end of this command is not reported, and the
            // other command is ignored.
            (false, false) => self.end(RUN_STATUS),
        }
    }

    fn end(&mut self, words: Words) {
        self.state = State::Ended;
        self.shown = words;
    }
}

/// Result of the command, if it has ended.
fn progress(world: &mut World, running: &mut Running) -> Option<Result<Values, Fault>> {
    match &running.work {
        CommandProgress::Done(values) => (world.now >= running.not_before).then(|| Ok(values.clone())),
        CommandProgress::Power(at, action) => {
            let action = *action;
            (world.now >= *at).then(|| world.act(action).map(|()| Values::default()))
        }
        CommandProgress::Continuous if world.link == Link::Down => Some(Err(world.link_fault())),
        CommandProgress::Continuous => (!running.held).then(|| Ok(Values::default())),
        CommandProgress::Motion(robots) => {
            for robot in robots {
                let end = world.robots.get_mut(*robot).and_then(|robot| robot.take_end(Owner::Remote));
                running.ends.extend(end);
            }
            if running.ends.len() < robots.len() {
                return None;
            }
            let stopped = running.ends.iter().find_map(|end| match end {
                End::Stopped(fault) => Some(fault.clone()),
                End::Arrived | End::Pushed => None,
            });
            Some(match stopped {
                Some(fault) => Err(fault),
                None => motion_commands::positions(world, &running.request).map(|mut values| {
                    values.set(Key::PushResult, i32::from(running.ends.contains(&End::Pushed)));
                    values
                }),
            })
        }
    }
}

/// Words of the running status. For continuous output, they contain the data.
fn output(world: &World, request: &Request) -> Words {
    match read_commands::answer(world, request) {
        Ok(values) => request.reply(Status::Running, &values),
        Err(_) => RUN_STATUS,
    }
}

/// Words of an abnormal end. If the command is a jog that was stopped, they contain the position (4.2.6).
fn abnormal_end(world: &mut World, request: &Request, fault: Fault) -> Words {
    let told = request.row.pace == DurationClass::Jog && fault.alarm == STOP_INPUT;
    let alarm = refusal(world, fault);
    match motion_commands::positions(world, request) {
        Ok(positions) if told => {
            let mut words = request.reply(Status::AbnormalEnd, &positions);
            words[..3].copy_from_slice(&alarm[..3]);
            words
        }
        _ => alarm,
    }
}

/// Words of the answer to a refused command. The function also records the alarm.
fn refusal(world: &mut World, fault: Fault) -> Words {
    let mut words = NO_WORDS;
    words[0] = Status::AbnormalEnd.word();
    words[1] = fault.alarm.group;
    words[2] = fault.alarm.category;
    world.alarms.refuse(&fault);
    world.why = Some(fault);
    words
}
