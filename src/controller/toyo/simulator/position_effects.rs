//! Effects of axis positions: position outputs, limits, obstacles.

use std::time::Duration;

use super::arm::WallContact;
use super::errors::code;
use super::io::OutputAt;
use super::motion::AXES;
use super::settings::Signal;
use super::task::Wait;
use super::trace::What;
use super::world::World;
use crate::Now;

/// Tolerance in mm for equal positions.
pub(super) const NEAR: f64 = 1e-6;
/// Time after which a motor that pushes against an obstacle has an overload.
const OVERLOAD_AFTER: Duration = Duration::from_secs(1);

impl World {
    /// Records an event, if the trace is on.
    pub(super) fn record_event(&mut self, what: What) {
        if self.trace.is_watched() {
            self.trace.record(self.now, self.arm.position(self.now), what);
        }
    }

    /// Sets outputs as soon as an axis passes a position. If the axis has already passed it, sets the outputs at once.
    pub(super) fn output_at(&mut self, output: OutputAt) -> Result<(), u8> {
        self.ports.output(output.port).ok_or(code::PORT)?;
        // In a loop, the same request arrives again and again. It counts only once.
        self.outputs_at.retain(|other| *other != output);
        self.outputs_at.push(output);
        self.follow_outputs();
        self.arm.touch();
        Ok(())
    }

    /// Sets the outputs whose positions are passed.
    fn follow_outputs(&mut self) {
        let place = self.arm.commanded(self.now);
        let ports = &mut self.ports;
        self.outputs_at.retain(|output| {
            let passed = is_beyond(place[output.axis], output.at_least, output.place);
            if passed {
                ports.set_output(output.port, output.mask);
            }
            !passed
        });
    }

    pub(super) fn end_pulses(&mut self) {
        let (now, ports) = (self.now, &mut self.ports);
        self.pulses.retain(|(at, port, mask)| {
            if *at <= now {
                ports.set_output(*port, *mask);
            }
            *at > now
        });
    }

    /// Handles the position events that are due.
    pub(super) fn crossings(&mut self) {
        if self.crossing.is_some_and(|at| at <= self.now) {
            self.crossing = None;
            self.watched = u64::MAX;
            self.follow_outputs();
            self.follow_limit();
            (0..AXES).for_each(|axis| self.follow_wall(axis));
        }
        for axis in 0..AXES {
            if self.presses[axis].is_some_and(|press| press.due.is_some_and(|due| due <= self.now)) {
                self.judge_contact(axis);
            }
        }
    }

    fn follow_limit(&mut self) {
        let place = self.arm.commanded(self.now);
        let beyond = self.jog.and_then(|jog| {
            let (bound, upwards) = jog.limit?;
            is_past(place[jog.axis], upwards, bound).then(|| code::beyond(jog.axis, upwards))
        });
        if let Some(code) = beyond {
            self.fail(code);
        }
    }

    fn follow_wall(&mut self, axis: usize) {
        let push = self.arm.push(axis, self.now);
        if push <= 0.0 {
            self.presses[axis] = None;
            return;
        }
        if self.arm.homing.is_some_and(|homing| homing.axes[axis]) {
            return self.fail(code::homing(axis));
        }
        let limited = self.tasks[self.arm.owners[axis]].limited.filter(|torque| torque.axis == axis);
        if push >= self.machine.overflow[axis] - NEAR && limited.is_none_or(|torque| torque.overflow) {
            return self.fail(code::overflow(axis));
        }
        if self.presses[axis].is_none() {
            let due = self.now.saturating_add(limited.map_or(OVERLOAD_AFTER, |torque| torque.judge));
            self.presses[axis] = Some(WallContact { due: Some(due), locked: false });
        }
    }

    fn judge_contact(&mut self, axis: usize) {
        if self.arm.push(axis, self.now) <= 0.0 {
            self.presses[axis] = None;
            return;
        }
        let owner = self.arm.owners[axis];
        let limited = self.tasks[owner].limited.filter(|torque| torque.axis == axis);
        let Some(torque) = limited else {
            self.presses[axis] = None;
            return self.fail(code::overload(axis));
        };
        self.presses[axis] = Some(WallContact { due: None, locked: true });
        if torque.torque_end || torque.lock_end {
            self.arm.freeze_owner(owner, self.now);
            self.arm.discard_interrupted(owner);
            self.end_wait(owner);
        }
    }

    /// Handles moves that have ended.
    pub(super) fn arrivals(&mut self) {
        self.arm.settle(self.now);
        self.end_homing();
        if !self.arm.is_moving(self.now) {
            self.jog = None;
        }
        if self.is_held() {
            return;
        }
        for index in 0..self.tasks.len() {
            let task = &self.tasks[index];
            if !task.running || task.stopped || self.arm.is_busy(index, self.now) || !self.has_arrived(index) {
                continue;
            }
            match task.wait {
                Wait::Motion => self.end_wait(index),
                Wait::End => self.end(index),
                _ => {}
            }
        }
    }

    /// Whether the axes of a task are in position, and whether the move may end there.
    fn has_arrived(&self, index: usize) -> bool {
        if self.machine.tasks[index].axes.iter().any(|&axis| self.arm.push(axis, self.now) > 0.0) {
            return false;
        }
        // A move with torque end or lock end does not end on arrival, unless AE is on.
        self.tasks[index].limited.is_none_or(|torque| torque.arrival_end || !(torque.torque_end || torque.lock_end))
    }

    /// Updates the outputs that show the status of the controller.
    pub(super) fn refresh(&mut self) {
        for place in 0..self.settings.signals.len() {
            let (bit, signal) = self.settings.signals[place];
            let on = self.signal(signal);
            self.ports.switch(bit, on);
        }
        if self.trace.is_watched() {
            let position = self.arm.position(self.now);
            self.trace.outputs(self.now, position, self.ports.outputs());
        }
    }

    fn signal(&self, signal: Signal) -> bool {
        let own = |task: usize| self.machine.tasks[task].axes.iter().copied();
        let pressing = |task: usize| {
            let limited = self.tasks[task].limited.filter(|torque| self.arm.push(torque.axis, self.now) > 0.0)?;
            self.presses[limited.axis].map(|press| (limited, press))
        };
        match signal {
            Signal::Paused => self.is_paused(),
            Signal::InputWait => self.status(4) & 0b100 != 0,
            Signal::Ready => self.is_ready(),
            Signal::Battery => self.switches.battery_low,
            Signal::Positioned(task) => own(task).len() > 0 && !self.arm.is_busy(task, self.now),
            Signal::Origin(task) => own(task).len() > 0 && own(task).all(|axis| self.arm.known[axis]),
            Signal::Load(task) => pressing(task).is_some_and(|(torque, _)| {
                let [limit, load] = self.memory.content.numbers("T5", torque.table);
                limit >= load
            }),
            Signal::Limit(task) => pressing(task).is_some(),
            Signal::Locked(task) => pressing(task).is_some_and(|(_, press)| press.locked),
            Signal::Area(axis) => {
                let (at_least, place) = self.settings.areas[axis];
                self.arm.known[axis] && is_beyond(self.arm.commanded(self.now)[axis], at_least, place)
            }
        }
    }

    /// Finds the time of the next position event after a change of the moves.
    pub(super) fn watch(&mut self) {
        if self.watched == self.arm.changes() {
            return;
        }
        self.watched = self.arm.changes();
        self.crossing = None;
        if !self.arm.is_moving(self.now) {
            // With the axes at rest, an axis pushes only if its commanded position is beyond its obstacle.
            (0..AXES).filter(|&axis| self.arm.push(axis, self.now) <= 0.0).for_each(|axis| self.presses[axis] = None);
            return;
        }
        let mut first: Option<Now> = None;
        let mut add = |at: Option<Now>| first = first.into_iter().chain(at).min();
        for output in &self.outputs_at {
            let test = |x| is_beyond(x, output.at_least, output.place);
            add(self.arm.crossing(output.axis, test, self.now));
        }
        for (_, signal) in &self.settings.signals {
            if let Signal::Area(axis) = *signal {
                let (at_least, place) = self.settings.areas[axis];
                add(self.arm.crossing(axis, |x| is_beyond(x, at_least, place), self.now));
            }
        }
        if let Some((axis, (bound, upwards))) = self.jog.and_then(|jog| Some((jog.axis, jog.limit?))) {
            add(self.arm.crossing(axis, |x| is_past(x, upwards, bound), self.now));
        }
        for axis in 0..AXES {
            let Some((at, below)) = self.arm.wall(axis) else { continue };
            let depth = |x: f64| if below { x - at } else { at - x };
            let overflow = self.machine.overflow[axis];
            add(self.arm.crossing(axis, |x| depth(x) > 0.0, self.now));
            add(self.arm.crossing(axis, |x| depth(x) >= overflow, self.now));
        }
        self.crossing = first;
    }
}

/// Whether a coordinate has reached a position. `at_least` selects the direction.
fn is_beyond(coordinate: f64, at_least: bool, place: f64) -> bool {
    if at_least { coordinate >= place - NEAR } else { coordinate <= place + NEAR }
}

fn is_past(coordinate: f64, upwards: bool, limit: f64) -> bool {
    if upwards { coordinate > limit + NEAR } else { coordinate < limit - NEAR }
}
