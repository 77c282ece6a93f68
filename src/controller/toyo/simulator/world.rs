//! Machine state: switches, power, errors, permissions, time.

use std::time::Duration;

use super::arm::{Arm, HOST, WallContact};
use super::card::Card;
use super::console;
use super::errors::{Errors, code};
use super::io::{OutputAt, Port, Ports};
use super::memory::{Memory, TASKS};
use super::motion::{AXES, Coordinates};
use super::settings::{Machine, Settings, Special, axes_of};
use super::task::{Task, Wait};
use super::trace::{Trace, What};
use crate::Now;
use crate::simulator::timeline::Timeline;
use crate::toyo::field::Mask;
use crate::toyo::table::{Models, supports};

/// Array size for the counters, and below for the timers. Their numbers start at 1, so index 0 is unused.
pub(super) const COUNTERS: usize = 100;
pub(super) const TIMERS: usize = 10;
/// Maximum value of a timer, in 0.1 s.
const MAX_TIMER_TENTHS: u32 = 9999;

/// States that the operator or the host can switch.
#[derive(Debug, Clone, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent switch")]
pub(super) struct Switches {
    pub(super) host: bool,
    pub(super) pendant: bool,
    pub(super) estop: bool,
    pub(super) servo: [bool; AXES],
    pub(super) mode: Mode,
    pub(super) palletizing: bool,
    /// Whether parameter 2 was written after power on.
    pub(super) machine_changed: bool,
    pub(super) slaves_ready: bool,
    pub(super) battery_low: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Mode {
    #[default]
    Automatic,
    Step,
    Program,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Sequential,
    Palletizing,
    Point,
    Easy,
}

/// A running JOG.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Jog {
    pub(super) axis: usize,
    pub(super) word: &'static str,
    /// Coordinate of the soft limit in the JOG direction, and whether this is the upper limit.
    pub(super) limit: Option<(f64, bool)>,
}

#[derive(Debug, Clone)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent state")]
pub(super) struct World {
    pub(super) now: Now,
    pub(super) model: String,
    /// Software version in hundredths.
    pub(super) version: i32,
    pub(super) axes: usize,
    pub(super) robot_types: Vec<i32>,
    /// Total power-on time of the controller before the simulation started.
    pub(super) meter: Duration,
    /// Time that one instruction takes.
    pub(super) tick: Duration,
    pub(super) memory: Memory,
    pub(super) settings: Settings,
    pub(super) machine: Machine,
    pub(super) switches: Switches,
    pub(super) ports: Ports,
    pub(super) arm: Arm,
    /// Whether synchronized axes have found their origin together.
    pub(super) synchronized: bool,
    pub(super) tasks: [Task; TASKS],
    /// Whether programs are stopped and can continue.
    pub(super) stopped: bool,
    /// Whether the pause input is holding programs.
    pub(super) pausing: bool,
    /// Number of steps that task 1 may still execute in step mode. `None` in the other modes.
    pub(super) allowance: Option<u32>,
    pub(super) jog: Option<Jog>,
    /// Whether the host has reset JOG. JOG is refused before this.
    pub(super) jog_ready: bool,
    /// The task to which host commands apply (current task).
    pub(super) current: usize,
    /// Selected palletizing program. The field below is the selected easy program.
    pub(super) pallet: usize,
    pub(super) easy: usize,
    pub(super) counters: [u16; COUNTERS],
    /// Start time and start value of each timer; `None` if the timer was not started.
    pub(super) timers: [Option<(Now, u32)>; TIMERS],
    pub(super) errors: Errors,
    pub(super) card: Card,
    /// Running output pulses: end time, port, and the bits that the controller sets at this time.
    pub(super) pulses: Vec<(Now, Port, Mask)>,
    pub(super) outputs_at: Vec<OutputAt>,
    /// Axes that push against an obstacle.
    pub(super) presses: [Option<WallContact>; AXES],
    /// Time of the next position event. The field below is the number of changes of the arm for which this time was
    /// computed.
    pub(super) crossing: Option<Now>,
    pub(super) watched: u64,
    pub(super) events: Timeline,
    pub(super) trace: Trace,
    /// The last refused block, and the reason for the refusal.
    pub(super) refusal: Option<(String, String)>,
}

impl World {
    /// Advances the time, and handles events in order.
    pub(super) fn advance(&mut self, to: Now) {
        while let Some(at) = self.next().filter(|&at| at <= to) {
            self.now = self.now.max(at);
            self.handle_due_events();
        }
        self.now = self.now.max(to);
    }

    /// Time of the next event.
    pub(super) fn next(&self) -> Option<Now> {
        let tasks = if self.is_held() { None } else { self.tasks.iter().filter_map(Task::due).min() };
        let presses = self.presses.iter().flatten().filter_map(|press| press.due).min();
        let pulses = self.pulses.iter().map(|(at, ..)| *at).min();
        [tasks, self.arm.next_end(), self.crossing, presses, pulses, self.events.due(), self.card.due()]
            .into_iter()
            .flatten()
            .min()
    }

    /// Handles the events that are due.
    fn handle_due_events(&mut self) {
        while let Some(line) = self.events.take(self.now) {
            // A line that is not possible in the current state is ignored. The `why` command and the trace report it.
            if let Err(why) = console::execute(self, &line) {
                self.record_event(What::Console(format!("{line}: {why}")));
                self.refusal = Some((line, why));
            }
        }
        self.card_done();
        self.end_pulses();
        self.crossings();
        self.arrivals();
        self.run_tasks();
        self.settle();
    }

    /// Handles the consequences of a change: tasks whose wait has ended, outputs, and the time of the next position
    /// event.
    pub(super) fn settle(&mut self) {
        self.follow_pause();
        self.arrivals();
        self.end_waits();
        self.refresh();
        self.watch();
    }

    /// Switches the power off and on again.
    pub(super) fn power_cycle(&mut self) {
        self.arm.freeze(self.now);
        self.errors.power_cut();
        self.card.abort();
        if !self.machine.absolute {
            // Incremental encoders count from the position at which power is switched on.
            let place = self.arm.position(self.now);
            self.arm.known = [false; AXES];
            for (axis, counted) in place.into_iter().enumerate() {
                self.arm.sensors[axis] -= counted;
                self.arm.set_coordinate(axis, 0.0);
            }
        }
        self.arm.set_position(self.arm.position(self.now));
        self.ports.clear_outputs();
        self.ports.internal.fill(0);
        self.counters.fill(0);
        self.timers.fill(None);
        self.pulses.clear();
        self.outputs_at.clear();
        self.presses.fill(None);
        self.power_up();
        self.settle();
    }

    /// Applies all stored parameters, including the parameters of the machine.
    pub(super) fn load(&mut self) {
        self.machine = Machine::from_content(&self.memory.content);
        self.settings = Settings::from_content(&self.memory.content);
        for (task, axes) in self.machine.tasks.iter().enumerate() {
            axes.axes.iter().for_each(|axis| self.arm.owners[*axis] = task);
        }
        self.switches.machine_changed = false;
    }

    pub(super) fn power_up(&mut self) {
        self.load();
        self.synchronized = false;
        self.switches = Switches {
            host: false,
            servo: std::array::from_fn(|axis| axis < self.axes && !self.switches.estop),
            mode: Mode::Automatic,
            palletizing: false,
            ..self.switches
        };
        self.reset_program();
        self.jog_ready = false;
        (self.current, self.pallet, self.easy) = (0, 1, 1);
        if axes_of(&self.machine) > self.axes {
            self.fail(code::PARAMETER);
        } else if self.machine.bad_roles {
            self.fail(code::SYNC_PARAMETER);
        }
        if self.switches.estop {
            self.fail(code::EMERGENCY_STOP);
        }
    }

    /// Stops everything after an error.
    pub(super) fn fail(&mut self, code: u8) {
        self.errors.raise(code, self.powered());
        self.record_event(What::Error(code));
        if code::takes_power(code) {
            self.arm.freeze(self.now);
            self.switches.servo.fill(false);
        } else {
            self.arm.brake(self.now);
        }
        if let Some(axis) = code::loses_origin(code) {
            self.arm.known[axis] = false;
        }
        self.end_host_motion();
        for (index, task) in self.tasks.iter_mut().enumerate() {
            // Task 1 keeps its step and can continue. The other tasks end.
            if index == 0 {
                task.running = false;
            } else {
                task.reset();
                self.arm.discard_interrupted(index);
            }
        }
        self.stopped = false;
        self.jog_ready = false;
        self.outputs_at.clear();
    }

    /// Stops programs so that they can continue later.
    pub(super) fn stop(&mut self) {
        self.arm.brake(self.now);
        self.end_host_motion();
        if self.is_running() && !self.stopped {
            self.stopped = true;
            self.record_event(What::Stopped);
        }
    }

    /// Continues stopped programs.
    pub(super) fn continue_programs(&mut self) {
        for index in 0..TASKS {
            if self.tasks[index].running && !self.tasks[index].stopped {
                self.resume_task(index);
            }
        }
    }

    /// Continues the interrupted move of a task.
    pub(super) fn resume_task(&mut self, index: usize) {
        self.arm.resume(index, self.now);
        let task = &mut self.tasks[index];
        if let Wait::Pass(_) = task.wait {
            task.wait = Wait::Motion;
        }
    }

    /// Ends motions that no program started: JOG and return to origin.
    pub(super) fn end_host_motion(&mut self) {
        self.arm.discard_interrupted(HOST);
        self.jog = None;
        if let Some(homing) = self.arm.homing {
            self.abort_homing(homing.owner);
        }
    }

    /// Discards all programs. The next start begins at the first step.
    pub(super) fn reset_program(&mut self) {
        self.tasks.iter_mut().for_each(Task::reset);
        (0..TASKS).for_each(|task| self.arm.discard_interrupted(task));
        self.stopped = false;
        self.pausing = false;
        self.allowance = None;
        self.outputs_at.clear();
        self.jog = None;
    }

    /// Whether any program is running or stopped.
    pub(super) fn is_running(&self) -> bool {
        self.tasks.iter().any(|task| task.running)
    }

    /// Whether STOP or the pause input holds programs.
    pub(super) const fn is_held(&self) -> bool {
        self.stopped || self.pausing
    }

    pub(super) fn is_paused(&self) -> bool {
        self.is_held() && self.is_running()
    }

    /// Whether anything runs (TO 2-2, status 0 bit 1).
    pub(super) fn is_executing(&self) -> bool {
        (self.is_running() && !self.stopped) || self.arm.is_moving(self.now) || self.arm.homing.is_some()
    }

    pub(super) fn kind(&self) -> Kind {
        match (self.settings.special, self.switches.palletizing) {
            (Special::Easy, _) => Kind::Easy,
            (Special::Point, _) => Kind::Point,
            (Special::None, true) => Kind::Palletizing,
            (Special::None, false) => Kind::Sequential,
        }
    }

    /// Whether this controller has a feature that only some models or versions have.
    pub(super) fn supports(&self, only_on: Models) -> bool {
        supports(only_on, &self.model, self.version)
    }

    /// System outputs SY01: error, positioning complete, origin, READY.
    pub(super) fn system_outputs(&self) -> u8 {
        let bits = [self.errors.current.is_some(), !self.arm.is_moving(self.now), self.knows_origin(), self.is_ready()];
        bits.iter().rev().fold(0, |byte, bit| byte << 1 | u8::from(*bit))
    }

    /// Whether the origin of all fitted axes is known.
    pub(super) fn knows_origin(&self) -> bool {
        self.arm.known[..self.axes].iter().all(|known| *known)
    }

    pub(super) fn has_servo(&self) -> bool {
        self.switches.servo[..self.axes].iter().all(|on| *on)
    }

    /// Whether a start is possible (status 4 bit 4).
    pub(super) fn is_ready(&self) -> bool {
        self.has_servo() && self.errors.current.is_none() && !self.switches.machine_changed
    }

    /// Power-on time.
    pub(super) fn powered(&self) -> Duration {
        self.meter.saturating_add(self.now)
    }

    /// Value of a timer in 0.1 s.
    pub(super) fn timer(&self, number: usize) -> u32 {
        let Some(Some((since, from))) = self.timers.get(number) else { return 0 };
        let tenths = u32::try_from(self.now.saturating_sub(*since).as_millis() / 100).unwrap_or(MAX_TIMER_TENTHS);
        from.saturating_add(tenths).min(MAX_TIMER_TENTHS)
    }

    /// Current offset of each axis.
    pub(super) fn offset(&self) -> Coordinates {
        std::array::from_fn(|axis| self.tasks[self.arm.owners[axis]].offset[axis])
    }

    /// A status page (TO 2-2).
    pub(super) fn status(&self, page: i32) -> u8 {
        let waits = self.tasks.iter().any(|task| task.running && matches!(task.wait, Wait::Test(_)));
        let bits: [bool; 8] = match page {
            0 => [
                self.errors.current.is_some(),
                self.is_executing(),
                self.is_paused(),
                self.arm.homing.is_some(),
                self.knows_origin(),
                !self.arm.is_moving(self.now),
                false,
                self.switches.machine_changed,
            ],
            1 => return self.errors.current.unwrap_or_default(),
            2 => {
                let kind = self.kind();
                [
                    matches!(kind, Kind::Palletizing | Kind::Easy),
                    matches!(kind, Kind::Point | Kind::Easy),
                    self.switches.mode == Mode::Step,
                    self.switches.mode == Mode::Program,
                    self.ports.is_on(self.settings.single),
                    false,
                    self.switches.pendant,
                    self.switches.host,
                ]
            }
            3 => [
                self.has_servo(),
                false,
                false,
                false,
                self.switches.slaves_ready,
                self.card.inserted,
                self.card.is_reading(),
                self.card.is_writing(),
            ],
            _ => [
                self.ports.is_on(self.settings.escape),
                self.ports.is_on(self.settings.continuous),
                waits,
                self.ports.is_on(self.settings.pause),
                self.is_ready(),
                false,
                false,
                false,
            ],
        };
        bits.iter().rev().fold(0, |byte, bit| byte << 1 | u8::from(*bit))
    }

    /// Holds programs while the pause input is on.
    fn follow_pause(&mut self) {
        let on = self.ports.is_on(self.settings.pause) && self.is_running();
        if on && !self.pausing {
            self.pausing = true;
            if !self.stopped {
                self.arm.brake(self.now);
                self.end_host_motion();
            }
        } else if !on && self.pausing {
            self.pausing = false;
            if !self.stopped {
                self.continue_programs();
            }
        }
    }
}
