//! Dedicated signals (chapter 1), and general-purpose signals as ports.

use std::time::Duration;

use super::alarms::{AlarmSource, Fault, NOT_ENABLED};
use super::memory::{SI, SO};
use super::motion::Owner;
use super::moves::Homing;
use super::operation_commands::MOTOR_TIME;
use super::robot::Robot;
use super::world::{Action, Link, Mode, World};
use crate::Now;
use crate::yrcx::image::{DEDICATED_WORD, Image};
use crate::yrcx::signal::{Signal, input, output, resting};

/// Minimum interval between edges. An edge that comes earlier is ignored (chapter 1, section 3).
const EDGE_INTERVAL: Duration = Duration::from_millis(100);
/// Delay from the change of an input to the change of the related output.
const REACTION: Duration = Duration::from_millis(20);
/// Number of ports (eight signals each) in the image: SI(00) to SI(157).
const IMAGE_PORTS: usize = 14;

/// Dedicated inputs at the previous scan.
#[derive(Debug, Clone)]
pub(super) struct Dedicated {
    last: u16,
    edge: Option<Now>,
    linked: bool,
}

impl Dedicated {
    pub(super) fn new() -> Self {
        Self { last: resting().0[DEDICATED_WORD], edge: None, linked: true }
    }

    /// Handles changes of the inputs.
    pub(super) fn scan(&mut self, world: &mut World) {
        for port in 0..IMAGE_PORTS {
            let byte = world.inputs.0[DEDICATED_WORD + port / 2].to_le_bytes()[port % 2];
            world.memory.set_port(SI, port_number(port), byte);
        }
        if world.link == Link::Down {
            (self.last, self.linked) = (0, false);
            return;
        }
        let now = world.inputs.0[DEDICATED_WORD];
        let (rose, fell) = (now & !self.last, self.last & !now);
        self.last = now;
        let back = !std::mem::replace(&mut self.linked, true);
        if rose | fell == 0 && !back {
            return;
        }
        let too_soon = self.edge.is_some_and(|edge| world.now.saturating_sub(edge) < EDGE_INTERVAL);
        self.edge = Some(world.now);
        // A stop is always accepted, even less than 100 ms after another edge.
        if has(fell, input::EMERGENCY_STOP) || (back && world.emergency()) {
            world.check_emergency();
        }
        if has(fell, input::STOP) {
            world.stop(&Fault::stopped());
        }
        let pulses = PULSES.iter().filter(|(signal, _)| has(rose, *signal));
        for (signal, react) in pulses {
            // Two edges in the same scan have no interval between them, so both are ignored. The first image of a
            // master has no edges.
            let alone = (rose | fell).is_power_of_two();
            let result = match (world.switches.inputs && !world.switches.boxed, too_soon || !alone || back) {
                (false, _) => Err(ignored(*signal, "dedicated inputs have no effect now")),
                (_, true) => Err(ignored(*signal, "less than 100 ms after another edge")),
                _ => react(world),
            };
            match result {
                Err(fault) if fault.alarm == NOT_ENABLED => world.why = Some(fault),
                Err(fault) => world.note(fault),
                Ok(()) => {}
            }
        }
    }
}

/// What the controller does when an input switches on.
type Reaction = fn(&mut World) -> Result<(), Fault>;

const PULSES: [(Signal, Reaction); 6] = [
    (input::SERVO_ON, |world| {
        world.may_power()?;
        world.later(MOTOR_TIME, Action::MotorOn);
        Ok(())
    }),
    (input::AUTO_START, |world| {
        world.may_run()?;
        world.later(REACTION, Action::AutoStart);
        Ok(())
    }),
    (input::PROGRAM_RESET, |world| {
        world.none_runs()?;
        world.later(REACTION, Action::ProgramReset);
        Ok(())
    }),
    (input::ALARM_RESET, |world| {
        world.later(REACTION, Action::AlarmReset);
        Ok(())
    }),
    (input::ORIGIN, |world| origin(world, &[Homing::Incremental])),
    (input::ORIGIN_ABSOLUTE, |world| {
        let both = [Homing::Absolute, Homing::Incremental];
        let passes = if world.switches.origin_both { &both[..] } else { &both[..1] };
        origin(world, passes)
    }),
];

/// Starts the origin return of all robots. It moves only the axes whose origin return a signal can start.
fn origin(world: &mut World, passes: &[Homing]) -> Result<(), Fault> {
    for robot in 0..world.robots.len() {
        world.may_move(robot, 0)?;
    }
    for robot in 0..world.robots.len() {
        world.begin_origin(robot, passes, Owner::Input)?;
    }
    Ok(())
}

/// Sets the outputs SO(00) to SO(157) in the image.
pub(super) fn show(world: &mut World, image: &mut Image) {
    let alarm = world.alarms.active().is_some();
    let sequence = world.switches.sequence && input::SEQUENCE_CONTROL.is_on(&world.inputs);
    let states = [
        (output::EMERGENCY_STOP, world.emergency()),
        (output::CPU_OK, !world.alarms.is_fatal()),
        (output::SERVO_ON, world.motor),
        (output::ALARM, alarm),
        (output::MP_READY, !alarm && !world.emergency()),
        (output::AUTO_MODE, world.switches.mode == Mode::Auto && !world.switches.boxed),
        (output::ORIGIN_COMPLETE, world.robots.iter().all(Robot::is_at_home)),
        (output::SEQUENCE_RUNNING, sequence && world.may_run().is_ok()),
        (output::PROGRAM_RUNNING, world.is_running()),
        (output::PROGRAM_RESET, world.reset_done),
        (output::WARNING, world.switches.warning),
    ];
    for (signal, on) in states {
        signal.set(image, on);
    }
    for port in 0..IMAGE_PORTS {
        let place = &mut image.0[DEDICATED_WORD + port / 2];
        let mut bytes = place.to_le_bytes();
        if port < 2 {
            world.memory.set_port(SO, port_number(port), bytes[port % 2]);
        } else {
            bytes[port % 2] = world.memory.port(SO, port_number(port));
            *place = u16::from_le_bytes(bytes);
        }
    }
}

fn has(word: u16, signal: Signal) -> bool {
    word >> signal.bit() & 1 == 1
}

fn ignored(signal: Signal, why: &str) -> Fault {
    Fault::new(NOT_ENABLED, AlarmSource::Slot, format!("{signal} was ignored: {why}"))
}

/// Octal number of the port with this index.
fn port_number(index: usize) -> usize {
    index / 8 * 10 + index % 8
}
