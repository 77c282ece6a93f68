//! Machine state: switches, power, alarms, permissions, time.

use std::collections::BTreeMap;
use std::time::Duration;

use jiff::SignedDuration;
use jiff::civil::DateTime;

use super::alarms::{
    AlarmLog, AlarmSource, EMERGENCY_STOP, Fault, LINK, MOVING, NO_AXIS, NO_ORIGIN, NO_POWER, NO_ROBOT, NOT_AUTO,
};
use super::console;
use super::memory::Memory;
use super::motion::{End, Motion, Owner};
use super::program::Program;
use super::robot::{ALL, Robot, Servo};
use super::task::Task;
use crate::simulator::timeline::Timeline;
use crate::simulator::with_defaults;
use crate::yrcx::alarm::Alarm;
use crate::yrcx::image::Image;
use crate::yrcx::signal::{input, resting};
use crate::{Now, refuse_if};

/// Scan time of the controller (chapter 2, 1.2).
pub(super) const SCAN: Duration = Duration::from_millis(5);

/// Selected mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Mode {
    #[default]
    Auto,
    Manual,
}

/// Switches of the operator, and parameters that the simulator uses.
#[derive(Debug, Clone, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent switch")]
pub(super) struct Switches {
    pub(super) mode: Mode,
    /// Whether the programming box has control.
    pub(super) boxed: bool,
    /// Whether the dedicated inputs are enabled. A safety setting can disable them, and then the controller accepts no
    /// remote commands.
    pub(super) inputs: bool,
    /// Whether the wired emergency stop is pressed.
    pub(super) estop: bool,
    pub(super) warning: bool,
    pub(super) sequence: bool,
    /// Whether SI(17) also starts the origin return of incremental axes ("ABS/ORG").
    pub(super) origin_both: bool,
    /// Whether an interrupted relative motion keeps its target. A repetition of the command then continues to this
    /// target (4.2.2).
    pub(super) keep: bool,
}

/// State of the fieldbus.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Link {
    /// No master has connected yet. The inputs have their resting state.
    Waiting,
    Up,
    /// The link is lost. All inputs are off.
    Down,
}

/// Delayed action.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Action {
    MotorOn,
    MotorPower,
    MotorOff,
    /// Sets the servo state for some axes of a robot.
    Servo(usize, u8, Servo),
    AlarmReset,
    ProgramReset,
    AutoStart,
    /// Switches power off after an emergency stop.
    PowerLoss,
}

with_defaults! {
    #[derive(Debug, Clone)]
    pub(super) struct World {
        pub(super) now: Now,
        pub(super) switches: Switches,
        pub(super) link: Link = Link::Waiting,
        /// Alarm for a lost link. Each fieldbus has its own alarm.
        pub(super) link_alarm: Alarm = LINK,
        /// Time after which the link counts as lost if no master connects.
        pub(super) link_within: Option<Duration>,
        pub(super) inputs: Image = resting(),
        pub(super) motor: bool,
        pub(super) robots: Vec<Robot>,
        pub(super) memory: Memory,
        pub(super) alarms: AlarmLog,
        pub(super) programs: BTreeMap<u8, Program>,
        pub(super) tasks: Vec<Task>,
        pub(super) reset_done: bool,
        /// Date and time, and the time of the simulator at which they were set.
        pub(super) clock: (DateTime, Now),
        /// Software versions, as words of the answer in 4.7.1.
        pub(super) versions: [u16; 7],
        /// Modules by controller and slot (4.7.15).
        pub(super) slots: BTreeMap<u8, [u16; 4]>,
        pub(super) delayed: Vec<(Now, Action)>,
        pub(super) events: Timeline,
        /// Last refusal or abort, for the `why` command.
        pub(super) why: Option<Fault>,
        /// Whether something has changed for which a program may wait. Then one more scan is needed.
        pub(super) restless: bool,
    }
}

impl World {
    /// Time of the next internal event.
    pub(super) fn due(&self) -> Option<Now> {
        let link = self.link_within.filter(|_| self.link == Link::Waiting);
        let motions = self.robots.iter().filter_map(|robot| robot.motion.as_ref()).map(Motion::due);
        let tasks = self.tasks.iter().filter_map(|task| task.due(self.now));
        let delayed = self.delayed.iter().map(|(at, _)| *at);
        let restless = self.restless.then_some(self.now);
        motions.chain(tasks).chain(delayed).chain(self.events.due()).chain(link).chain(restless).min()
    }

    /// Advances the motions to `now`.
    pub(super) fn move_on(&mut self, now: Now) {
        self.now = now;
        self.restless = false;
        for robot in &mut self.robots {
            robot.advance(now);
        }
        let ended: Vec<End> = self.robots.iter_mut().filter_map(|robot| robot.take_end(Owner::Input)).collect();
        for end in ended {
            if let End::Stopped(fault) = end {
                self.note(fault);
            }
        }
    }

    /// Handles the events that are due in this scan.
    pub(super) fn scan(&mut self) {
        let now = self.now;
        if self.link == Link::Waiting && self.link_within.is_some_and(|within| within <= now) {
            self.link = Link::Down;
            self.inputs = Image::default();
            self.raise(
                &Fault::new(self.link_alarm.too_long(), AlarmSource::Slot, "no master connected in time"),
                false,
            );
        }
        while let Some(line) = self.events.take(now) {
            // The lines were checked when the start state was parsed. If a line is not possible in the current state,
            // it has no effect.
            let _refused = console::execute(self, &line);
        }
        for at in (0..self.delayed.len()).rev() {
            if self.delayed.get(at).is_some_and(|(due, _)| *due <= now) {
                let (_, action) = self.delayed.remove(at);
                if let Err(fault) = self.act(action) {
                    self.note(fault);
                }
            }
        }
        self.run_tasks();
    }

    /// Executes a delayed action.
    pub(super) fn act(&mut self, action: Action) -> Result<(), Fault> {
        match action {
            Action::MotorOn | Action::MotorPower => {
                self.may_power()?;
                self.motor = true;
                if action == Action::MotorOn {
                    self.set_servos(Servo::On);
                }
            }
            Action::MotorOff => {
                self.power_off(&Fault::new(NO_POWER, AlarmSource::Controller, "motor power was switched off"));
            }
            Action::PowerLoss => self.power_off(&Fault::emergency()),
            Action::Servo(robot, axes, state) => self.set_servo(robot, axes, state)?,
            Action::AlarmReset => {
                let emergency = self.emergency();
                self.alarms.reset(|alarm| emergency && alarm == EMERGENCY_STOP);
            }
            Action::ProgramReset => self.reset_programs()?,
            Action::AutoStart => self.start_all()?,
        }
        Ok(())
    }

    /// Schedules an action.
    pub(super) fn later(&mut self, after: Duration, action: Action) {
        self.delayed.push((self.now.saturating_add(after), action));
    }

    pub(super) fn emergency(&self) -> bool {
        self.switches.estop || (self.link == Link::Up && !input::EMERGENCY_STOP.is_on(&self.inputs))
    }

    /// Checks that the stop input does not prevent motion.
    pub(super) fn held(&self) -> bool {
        !input::STOP.is_on(&self.inputs)
    }

    /// Records a fault that no remote command reports.
    pub(super) fn note(&mut self, fault: Fault) {
        self.alarms.record(fault.alarm, fault.place);
        self.why = Some(fault);
    }

    /// Handles a serious alarm: stops everything and switches power off.
    pub(super) fn raise(&mut self, fault: &Fault, fatal: bool) {
        self.alarms.raise(fault.alarm, fault.place, fatal);
        self.why = Some(fault.clone());
        self.stop_tasks();
        self.delayed.retain(|(_, action)| matches!(action, Action::PowerLoss | Action::AlarmReset));
        for robot in &mut self.robots {
            robot.halt(fault);
        }
        // An alarm at time 0 belongs to the start state, so power is already off.
        self.later(if self.now.is_zero() { Duration::ZERO } else { SCAN }, Action::PowerLoss);
    }

    /// Stops programs and decelerates motions.
    pub(super) fn stop(&mut self, fault: &Fault) {
        let now = self.now;
        self.stop_tasks();
        self.delayed.retain(|(_, action)| *action != Action::AutoStart);
        for motion in self.robots.iter_mut().filter_map(|robot| robot.motion.as_mut()) {
            motion.stop(now, fault.clone());
        }
    }

    /// Handles a change of an emergency stop.
    pub(super) fn check_emergency(&mut self) {
        if self.emergency() {
            self.raise(&Fault::emergency(), false);
        }
    }

    pub(super) fn master_shows(&mut self, image: Image) {
        self.link = Link::Up;
        self.inputs = image;
    }

    /// Handles the loss of the link.
    pub(super) fn on_master_lost(&mut self) {
        if self.link != Link::Down {
            self.link = Link::Down;
            self.inputs = Image::default();
            self.raise(&self.link_fault(), false);
        }
    }

    /// Fault with which running commands end after the loss of the link.
    pub(super) fn link_fault(&self) -> Fault {
        Fault::new(self.link_alarm, AlarmSource::Slot, "the master has disconnected")
    }

    /// Checks that motor power can be switched on.
    pub(super) fn may_power(&self) -> Result<(), Fault> {
        refuse_if(self.emergency(), Fault::emergency())?;
        self.no_alarm()
    }

    /// Checks that no alarm is active.
    pub(super) fn no_alarm(&self) -> Result<(), Fault> {
        match self.alarms.active() {
            Some(alarm) => Err(active(alarm)),
            None => Ok(()),
        }
    }

    /// Checks that programs can run.
    pub(super) fn may_run(&self) -> Result<(), Fault> {
        self.may_power()?;
        refuse_if(self.held(), Fault::stopped())?;
        if self.switches.mode != Mode::Auto || self.switches.boxed {
            return Err(Fault::new(
                NOT_AUTO,
                AlarmSource::Controller,
                "AUTO mode is not selected, or the box has control",
            ));
        }
        Ok(())
    }

    /// Checks that these axes can move.
    pub(super) fn may_move(&self, number: usize, axes: u8) -> Result<(), Fault> {
        self.may_power()?;
        refuse_if(self.held(), Fault::stopped())?;
        self.has_axes(number, axes)?;
        let robot = self.robot(number)?;
        let off = robot.axes.iter().enumerate().position(|(at, axis)| axes >> at & 1 == 1 && axis.servo != Servo::On);
        if let Some(axis) = off.or((!self.motor).then_some(0)) {
            return Err(Fault::new(
                NO_POWER,
                AlarmSource::Axis(number, axis),
                format!("axis {} has no servo power", axis + 1),
            ));
        }
        if robot.motion.is_some() {
            return Err(Fault::new(MOVING, AlarmSource::Robot(number), format!("robot {} already moves", number + 1)));
        }
        Ok(())
    }

    /// Checks that the origin of all axes of a robot is known.
    pub(super) fn at_home(&self, number: usize) -> Result<(), Fault> {
        let unknown = self.robot(number)?.axes.iter().position(|axis| !axis.origin);
        match unknown {
            Some(axis) => {
                let why = format!("axis {} has not returned to origin", axis + 1);
                Err(Fault::new(NO_ORIGIN, AlarmSource::Axis(number, axis), why))
            }
            None => Ok(()),
        }
    }

    /// Returns the robot with this index.
    pub(super) fn robot(&self, number: usize) -> Result<&Robot, Fault> {
        self.robots.get(number).ok_or_else(|| no_robot(number))
    }

    /// Returns the robot with this index, to change it.
    pub(super) fn robot_mut(&mut self, number: usize) -> Result<&mut Robot, Fault> {
        self.robots.get_mut(number).ok_or_else(|| no_robot(number))
    }

    /// Checks that the robot has these axes.
    pub(super) fn has_axes(&self, number: usize, axes: u8) -> Result<(), Fault> {
        let missing = axes & ALL & !self.robot(number)?.mask();
        if missing == 0 {
            return Ok(());
        }
        let why = format!("robot {} has no axis {}", number + 1, missing.trailing_zeros() + 1);
        Err(Fault::new(NO_AXIS, AlarmSource::Robot(number), why))
    }

    pub(super) fn time(&self) -> DateTime {
        let (then, at) = self.clock;
        then.saturating_add(SignedDuration::try_from(self.now.saturating_sub(at)).unwrap_or(SignedDuration::MAX))
    }

    /// Executes a power cycle. Only stored data remains.
    pub(super) fn power_cycle(&mut self) {
        self.stop_tasks();
        self.delayed.clear();
        self.power_off(&Fault::new(NO_POWER, AlarmSource::Controller, "the controller was switched off"));
        self.alarms.clear();
        self.why = None;
        for axis in self.robots.iter_mut().flat_map(|robot| &mut robot.axes) {
            axis.origin &= axis.motor != super::robot::Motor::Incremental;
            axis.torque_limit = super::robot::FULL_TORQUE;
        }
        self.check_emergency();
    }

    fn power_off(&mut self, fault: &Fault) {
        self.motor = false;
        self.set_servos(Servo::Brake);
        for robot in &mut self.robots {
            robot.halt(fault);
        }
    }

    fn set_servos(&mut self, state: Servo) {
        for axis in self.robots.iter_mut().flat_map(|robot| &mut robot.axes) {
            axis.servo = state;
        }
    }

    fn set_servo(&mut self, number: usize, axes: u8, state: Servo) -> Result<(), Fault> {
        self.has_axes(number, axes)?;
        if state == Servo::On {
            self.may_power()?;
            refuse_if(!self.motor, Fault::new(NO_POWER, AlarmSource::Robot(number), "motor power is off"))?;
        }
        let robot = self.robot_mut(number)?;
        if state != Servo::On {
            robot.halt(&Fault::new(NO_POWER, AlarmSource::Robot(number), "a servo was switched off"));
        }
        let chosen = robot.axes.iter_mut().enumerate().filter(|(at, _)| axes == 0 || axes >> at & 1 == 1);
        for (_, axis) in chosen {
            axis.servo = state;
        }
        Ok(())
    }
}

fn active(alarm: Alarm) -> Fault {
    Fault::new(alarm, AlarmSource::Controller, "an alarm is active; reset it")
}

fn no_robot(number: usize) -> Fault {
    Fault::new(NO_ROBOT, AlarmSource::Controller, format!("no robot {}", number + 1))
}
