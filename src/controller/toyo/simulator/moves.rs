//! Moves of programs: targets, speeds and checks.

use super::action::{Move, Target, Torque};
use super::errors::code;
use super::motion::{AXES, Arc, Coordinates, Drive, Path, Segment, minus, plus};
use super::position_effects::NEAR;
use super::task::{Flow, Wait};
use super::world::World;
use crate::refuse_if;

/// Number of rows in the coordinate table.
const LAST_POINT: i32 = 999;
/// Maximum radius of a circle in mm. The manual has no value.
const MAX_RADIUS: f64 = 8000.0;

impl World {
    /// Begins a move. After the move, the task continues with step `next`.
    pub(super) fn begin_move(&mut self, index: usize, order: Move, next: usize) -> Result<Flow, u8> {
        let order = match (order.to, self.tasks[index].supplied) {
            (Target::Host, None) => return Ok(Flow::Wait(Wait::Host(order), next)),
            (Target::Host, Some((place, row))) => {
                let order =
                    Move { to: Target::Coordinates(place), speed: if row == 0 { order.speed } else { row }, ..order };
                self.tasks[index].supplied = None;
                order
            }
            _ => order,
        };
        if order.escape && self.ports.is_on(self.settings.escape) {
            return Ok(Flow::To(next));
        }
        let axes = self.machine.tasks[index].axes.clone();
        self.check_motion_allowed(&axes)?;
        let from = self.arm.goal;
        let (base, to) = self.resolve_target(index, &order, &from)?;
        self.within(&axes, &self.line(index, from, base, order.line), code::target)?;
        let path = self.line(index, from, to, order.line);
        self.within(&axes, &path, code::beyond)?;
        Ok(self.begin_path(index, path, &order, next))
    }

    /// Begins an arc through the position of this step to the position of the next step.
    pub(super) fn begin_arc(&mut self, index: usize, step: usize, first: Move) -> Result<Flow, u8> {
        let Some(super::action::Action::Arc(second)) = self.memory.action(index, step + 1) else {
            return Err(code::ARC_DATA);
        };
        let axes = self.machine.tasks[index].clone();
        self.check_motion_allowed(&axes.axes)?;
        refuse_if(axes.space < 2, code::ARC_DATA)?;
        let from = self.arm.goal;
        let (via_base, via) = self.resolve_target(index, &first, &from)?;
        let (to_base, to) = self.resolve_target(index, &second, &via)?;
        let round = &axes.axes[..axes.space];
        let arc = |via: Coordinates, to: Coordinates| {
            Arc::through_points(from, via, to, round).filter(|arc| arc.radius <= MAX_RADIUS).map(Path::Arc)
        };
        if let Some(base) = arc(via_base, to_base) {
            self.within(&axes.axes, &base, code::target)?;
        }
        let path = arc(via, to).ok_or(code::ARC_RADIUS)?;
        self.within(&axes.axes, &path, code::beyond)?;
        Ok(self.begin_path(index, path, &Move { pass: second.pass, ..first }, step + 2))
    }

    /// Checks that a program may move these axes.
    pub(super) fn check_motion_allowed(&self, axes: &[usize]) -> Result<(), u8> {
        refuse_if(axes.is_empty(), code::COMMAND)?;
        refuse_if(!axes.iter().all(|&axis| self.switches.servo[axis]), code::UNEXECUTABLE)
    }

    /// Coordinates of the row whose number is the sum of `point` and a counter.
    pub(super) fn row(&self, index: usize, point: i32, counter: usize) -> Result<Coordinates, u8> {
        let row = point + if counter == 0 { 0 } else { self.counters[counter].into() };
        let row = Some(row).filter(|row| (1..=LAST_POINT).contains(row));
        row.and_then(|row| self.memory.content.point(index, row)).ok_or(code::TABLE)
    }

    /// Checks that a path stays within the soft limits. An axis that is already outside may move inward.
    pub(super) fn within(&self, axes: &[usize], path: &Path, code: fn(usize, bool) -> u8) -> Result<(), u8> {
        let from = path.at(0.0);
        for &axis in axes {
            let (least, most) = path.range(axis);
            refuse_if(most > self.settings.plus[axis] + NEAR && most > from[axis] + NEAR, code(axis, true))?;
            refuse_if(least < self.settings.minus[axis] - NEAR && least < from[axis] - NEAR, code(axis, false))?;
        }
        Ok(())
    }

    /// Targets of a move, without and with the offset. The axes of other tasks keep their positions.
    fn resolve_target(&self, index: usize, order: &Move, from: &Coordinates) -> Result<(Coordinates, Coordinates), u8> {
        let axes = &self.machine.tasks[index].axes;
        refuse_if(!axes.iter().all(|&axis| self.arm.known[axis]), code::ORIGIN_INCOMPLETE)?;
        if axes.iter().any(|&axis| self.machine.driver[axis].is_some()) && !self.synchronized {
            return Err(code::NOT_SYNCHRONIZED);
        }
        let place = self.target(index, order.to)?;
        let base = if order.incremental { plus(from, &place) } else { place };
        let shifted = order.incremental || order.to == Target::Back;
        let to = if shifted { base } else { plus(&base, &self.tasks[index].offset) };
        let own = |place: Coordinates| -> Coordinates {
            let mut own = *from;
            for &axis in axes {
                // A driven axis moves together with its drive axis.
                own[axis] = match self.machine.driver[axis] {
                    Some(driver) => from[axis] + own[driver] - from[driver],
                    None => place[axis],
                };
            }
            own
        };
        Ok((own(base), own(to)))
    }

    /// A line. Its length is the distance in space, or the distance of the axis that moves farthest. The move reaches
    /// its speed along this length.
    fn line(&self, index: usize, from: Coordinates, to: Coordinates, in_space: bool) -> Path {
        let way = minus(&to, &from);
        let axes = &self.machine.tasks[index];
        let longest = way.iter().fold(0.0, |most: f64, part| most.max(part.abs()));
        let space = axes.axes[..axes.space].iter().map(|&axis| way[axis] * way[axis]).sum::<f64>().sqrt();
        Path::line(from, to, if in_space && space > 0.0 { space } else { longest })
    }

    /// Starts the motion along a path.
    fn begin_path(&mut self, index: usize, path: Path, order: &Move, next: usize) -> Flow {
        let task = &mut self.tasks[index];
        task.from = Some(path.at(0.0));
        if path.length() < NEAR {
            return Flow::To(next);
        }
        let moves = |torque: &Torque| (path.end()[torque.axis] - path.at(0.0)[torque.axis]).abs() > NEAR;
        task.limited = task.torque.take_if(|torque| moves(torque));
        task.escape = order.escape;
        let share = task.pass;
        let drive = self.drive(index, order.speed, &path);
        let segment = Segment::new(index, path, 0.0, drive, self.now);
        let wait = if order.pass { Wait::Pass(segment.handover_time(share)) } else { Wait::Motion };
        self.arm.begin(&segment);
        Flow::Wait(wait, next)
    }

    /// Speed and ramps for a path. Row 0 of the speed table means the row of the last SPD.
    fn drive(&self, index: usize, row: i32, path: &Path) -> Drive {
        let task = &self.tasks[index];
        let [speed] = self.memory.content.numbers("T2", if row == 0 { task.speed } else { row });
        let mut speed = f64::from(speed) / 10.0 * f64::from(self.memory.content.percent) / 100.0;
        for axis in 0..AXES {
            let steepness = path.steepness(axis);
            if steepness > 0.0 {
                speed = speed.min(self.machine.top[axis] / steepness);
            }
        }
        let [up, down] = task.ramps.map(|row| self.ramp(row));
        Drive { speed, up, down }
    }

    /// Ramp time in seconds, from a row of the acceleration table.
    pub(super) fn ramp(&self, row: i32) -> f64 {
        let [hundredths] = self.memory.content.numbers("T3", row);
        f64::from(hundredths.max(1)) / 100.0
    }
}
