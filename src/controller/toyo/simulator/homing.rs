//! Return to origin, and JOG.

use super::arm::{HOST, Homing};
use super::errors::code;
use super::motion::{AXES, Coordinates, Drive, Path, Segment};
use super::position_effects::NEAR;
use super::task::Wait;
use super::trace::What;
use super::world::{Jog, World};
use crate::Now;

/// Distance in mm from the origin sensor, at which the slow approach begins.
const BACK_OFF: f64 = 1.0;
/// Mechanical end of an axis in mm.
const END: f64 = 8000.0;

impl World {
    /// Begins the return to origin of some axes, in the order of P07.
    ///
    /// An axis with a known origin first moves close to the origin at high speed (E13). Then the axis searches its
    /// sensor at middle speed, backs off, and approaches the sensor slowly.
    pub(super) fn begin_homing(&mut self, owner: usize, axes: &[usize]) {
        let mut begin = self.now;
        for rank in 1..=4 {
            let mut end = begin;
            for &axis in axes {
                if self.settings.sequence[axis] == rank {
                    end = end.max(self.seek_origin(owner, axis, begin));
                }
            }
            begin = end;
        }
        for &axis in axes {
            self.arm.known[axis] = false;
        }
        let axes = std::array::from_fn(|axis| axes.contains(&axis));
        self.arm.homing = Some(Homing { owner, axes, together: false });
    }

    /// Adds the moves of one axis, and returns the time at which they end.
    fn seek_origin(&mut self, owner: usize, axis: usize, begin: Now) -> Now {
        let [slow, middle, fast] = self.machine.origin[axis];
        let sensor = self.arm.sensors[axis];
        let back = if self.machine.upwards[axis] { -BACK_OFF } else { BACK_OFF };
        let mut legs = vec![(sensor, middle), (sensor + back, slow), (sensor, slow)];
        if self.arm.known[axis] {
            legs.insert(0, (self.machine.fast[axis], fast));
        }
        let (ramp, mut at, mut from) = (self.ramp(1), begin, self.arm.goal);
        for (coordinate, speed) in legs {
            let mut to = from;
            to[axis] = coordinate;
            let length = (to[axis] - from[axis]).abs();
            if length > NEAR {
                let drive = Drive { speed: speed.min(self.machine.top[axis]), up: ramp, down: ramp };
                let segment = Segment::new(owner, Path::line(from, to, length), 0.0, drive, at);
                at = segment.ends();
                self.arm.begin(&segment);
            }
            from = to;
        }
        at
    }

    /// Completes a return to origin whose moves have ended: sets the coordinates of the axes.
    pub(super) fn end_homing(&mut self) {
        let Some(homing) = self.arm.homing else { return };
        if self.arm.is_busy(homing.owner, self.now) {
            return;
        }
        self.arm.homing = None;
        for axis in (0..AXES).filter(|&axis| homing.axes[axis]) {
            self.arm.set_coordinate(axis, self.settings.origin[axis]);
            self.arm.sensors[axis] = self.settings.origin[axis];
            self.arm.known[axis] = true;
        }
        self.synchronized |= homing.together;
        self.record_event(What::Origin);
    }

    /// Aborts a return to origin. It cannot be continued: a task that continues later starts the return to origin
    /// again.
    pub(super) fn abort_homing(&mut self, owner: usize) {
        if self.arm.homing.take_if(|homing| homing.owner == owner).is_some() {
            self.arm.discard_interrupted(owner);
            if let Some(task) = self.tasks.get_mut(owner) {
                task.wait = Wait::Ready(self.now);
            }
        }
    }

    /// Begins a JOG of one axis. The word is, for example, `+C` or `-L`.
    pub(super) fn begin_jog(&mut self, axis: usize, word: &'static str) -> Result<(), u8> {
        let upwards = word.starts_with('+');
        let sign = if upwards { 1.0 } else { -1.0 };
        let from = self.arm.goal;
        let [low, high] = self.settings.jog[axis];
        let bound = if upwards { self.settings.plus[axis] } else { self.settings.minus[axis] };
        let limit = self.arm.known[axis].then_some((bound, upwards));
        let mut to: Coordinates = from;
        let inches = word.ends_with('C');
        to[axis] = if inches { from[axis] + sign * self.settings.inch[axis] } else { sign * END };
        let length = (to[axis] - from[axis]).abs();
        let path = Path::line(from, to, length);
        if inches && limit.is_some() {
            self.within(&[axis], &path, code::target)?;
        }
        // At a limit, the axis cannot move farther in this direction.
        if limit.is_some_and(|(bound, _)| sign * (from[axis] - bound) > -NEAR) && !inches {
            return Err(code::beyond(axis, upwards));
        }
        if length < NEAR {
            return Ok(());
        }
        let ramp = self.ramp(1);
        let speed = if word.ends_with('H') { high } else { low }.min(self.machine.top[axis]);
        self.arm.begin(&Segment::new(HOST, path, 0.0, Drive { speed, up: ramp, down: ramp }, self.now));
        self.jog = Some(Jog { axis, word, limit });
        Ok(())
    }

    /// Decelerates a JOG.
    pub(super) fn end_jog(&mut self) {
        if self.jog.take().is_some() {
            self.arm.brake_owner(HOST, self.now);
            self.arm.discard_interrupted(HOST);
        }
    }

    /// Searches the origin of a drive axis together with its driven axis.
    pub(super) fn synchronize(&mut self, drive: usize) {
        let driven = self.machine.driver.iter().position(|driver| *driver == Some(drive));
        let axes: Vec<usize> = std::iter::once(drive).chain(driven).collect();
        self.begin_homing(HOST, &axes);
        if let Some(homing) = &mut self.arm.homing {
            homing.together = true;
        }
    }
}
