//! Axes: positions, moves and obstacles.
//!
//! The commanded position is the goal of all moves minus the remaining distance of each move. With this rule, moves add
//! up: a pass point is rounded because the next move begins during the deceleration of the last move.

use super::motion::{AXES, Coordinates, Drive, Path, Segment, minus, plus};
use crate::Now;
use crate::simulator::run_options::MotionLog;

/// Owner of the moves that belong to no task: JOG, and return to origin by the host.
pub(super) const HOST: usize = 4;
/// Number of parts into which each phase of constant acceleration is divided for the search of [`Arm::crossing`].
const PIECES: u32 = 16;
/// Number of bisection steps, for a resolution of about 1 ns.
const HALVINGS: u32 = 40;
/// Tolerance in mm for equal positions.
const SAME: f64 = 1e-6;

/// An axis that pushes against an obstacle.
#[derive(Debug, Clone, Copy)]
pub(super) struct WallContact {
    /// Time at which the simulator decides whether the axis is locked.
    pub(super) due: Option<Now>,
    /// Whether the simulator decided that the axis is locked.
    pub(super) locked: bool,
}

#[derive(Debug, Clone, Default)]
pub(super) struct Arm {
    /// Position at the end of all moves.
    pub(super) goal: Coordinates,
    segments: Vec<Segment>,
    interrupted: Vec<InterruptedMoves>,
    walls: [Option<Wall>; AXES],
    changes: u64,
    /// Owning task of each axis.
    pub(super) owners: [usize; AXES],
    /// Whether the origin of each axis is known.
    pub(super) known: [bool; AXES],
    /// Coordinate of the origin sensor of each axis.
    pub(super) sensors: Coordinates,
    /// The current return to origin.
    pub(super) homing: Option<Homing>,
    /// Log of the moves.
    pub(super) motions: Option<MotionLog>,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Homing {
    pub(super) owner: usize,
    pub(super) axes: [bool; AXES],
    /// Whether synchronized axes search their origin together.
    pub(super) together: bool,
}

/// An obstacle of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Wall {
    at: f64,
    /// Whether the axis is on the lower side of the obstacle.
    below: bool,
}

/// Interrupted moves of an owner.
#[derive(Debug, Clone)]
struct InterruptedMoves {
    owner: usize,
    remaining: Vec<RemainingMove>,
    /// Target at which the interrupted moves would have ended.
    target: Coordinates,
}

#[derive(Debug, Clone, Copy)]
struct RemainingMove {
    path: Path,
    done: f64,
    drive: Drive,
}

impl Arm {
    /// Commanded position.
    pub(super) fn commanded(&self, now: Now) -> Coordinates {
        self.segments.iter().fold(self.goal, |place, segment| plus(&place, &segment.remaining_displacement(now)))
    }

    /// Actual position.
    pub(super) fn position(&self, now: Now) -> Coordinates {
        let commanded = self.commanded(now);
        std::array::from_fn(|axis| match self.walls[axis] {
            Some(wall) if wall.depth(commanded[axis]) > 0.0 => wall.at,
            _ => commanded[axis],
        })
    }

    /// Sets the position of the axes at rest.
    pub(super) fn set_position(&mut self, place: Coordinates) {
        self.touch();
        self.segments.clear();
        self.interrupted.clear();
        self.goal = place;
    }

    /// Assigns another coordinate to the current position of an axis.
    pub(super) fn set_coordinate(&mut self, axis: usize, coordinate: f64) {
        self.touch();
        if let Some(wall) = &mut self.walls[axis] {
            wall.at += coordinate - self.goal[axis];
        }
        self.goal[axis] = coordinate;
    }

    /// Sets or removes an obstacle.
    pub(super) fn set_wall(&mut self, axis: usize, at: Option<f64>, now: Now) {
        self.touch();
        let position = self.position(now)[axis];
        self.walls[axis] = at.map(|at| Wall { at, below: position <= at });
    }

    /// Coordinate of the obstacle of an axis, and whether the axis is on the lower side of the obstacle.
    pub(super) fn wall(&self, axis: usize) -> Option<(f64, bool)> {
        self.walls[axis].map(|wall| (wall.at, wall.below))
    }

    /// Number of changes to the moves so far. A different number means that the next position event must be computed
    /// again.
    pub(super) const fn changes(&self) -> u64 {
        self.changes
    }

    /// Counts a change to the moves, so that the simulator computes the next position event again.
    pub(super) const fn touch(&mut self) {
        self.changes += 1;
    }

    /// Distance in mm between an obstacle and a commanded position behind it; 0 without contact.
    pub(super) fn push(&self, axis: usize, now: Now) -> f64 {
        self.walls[axis].map_or(0.0, |wall| wall.depth(self.commanded(now)[axis]).max(0.0))
    }

    pub(super) fn is_moving(&self, now: Now) -> bool {
        self.segments.iter().any(|segment| segment.ends() > now)
    }

    /// Whether a move of the owner runs.
    pub(super) fn is_busy(&self, owner: usize, now: Now) -> bool {
        self.segments.iter().any(|segment| segment.owner == owner && segment.ends() > now)
    }

    pub(super) fn next_end(&self) -> Option<Now> {
        self.segments.iter().map(Segment::ends).min()
    }

    /// Adds a move. The move begins where the last move of the owner ends.
    pub(super) fn begin(&mut self, segment: &Segment) {
        self.touch();
        self.goal = plus(&self.goal, &segment.displacement());
        self.segments.push(*segment);
    }

    /// Removes finished moves.
    pub(super) fn settle(&mut self, now: Now) {
        if self.segments.iter().any(|segment| segment.ends() <= now) {
            self.segments.iter().filter(|segment| segment.ends() <= now).for_each(|segment| self.log(segment, now));
            self.segments.retain(|segment| segment.ends() > now);
            self.touch();
        }
    }

    /// Decelerates all moves. An axis at an obstacle stops at once. [`Arm::resume`] continues the rest of each move.
    pub(super) fn brake(&mut self, now: Now) {
        (0..=HOST).for_each(|owner| self.brake_owner(owner, now));
    }

    /// Decelerates the moves of one owner.
    pub(super) fn brake_owner(&mut self, owner: usize, now: Now) {
        let pushes = (0..AXES).any(|axis| self.belongs_to(axis, owner) && self.push(axis, now) > 0.0);
        self.halt(owner, now, !pushes);
    }

    /// Stops all moves at once. [`Arm::resume`] continues the rest of each move.
    pub(super) fn freeze(&mut self, now: Now) {
        (0..=HOST).for_each(|owner| self.freeze_owner(owner, now));
    }

    /// Stops the moves of one owner at once.
    pub(super) fn freeze_owner(&mut self, owner: usize, now: Now) {
        self.halt(owner, now, false);
    }

    /// Whether interrupted moves of the owner exist.
    pub(super) fn has_interrupted_moves(&self, owner: usize) -> bool {
        self.interrupted.iter().any(|interrupted| interrupted.owner == owner)
    }

    /// Discards the interrupted moves of an owner.
    pub(super) fn discard_interrupted(&mut self, owner: usize) {
        self.interrupted.retain(|interrupted| interrupted.owner != owner);
    }

    /// Continues the interrupted moves of an owner. If the axes were moved after the interruption, they move straight
    /// to the target.
    pub(super) fn resume(&mut self, owner: usize, now: Now) {
        let Some(index) = self.interrupted.iter().position(|interrupted| interrupted.owner == owner) else { return };
        let interrupted = self.interrupted.remove(index);
        let remaining_distance = |axis: usize| {
            interrupted
                .remaining
                .iter()
                .map(|remaining_move| {
                    remaining_move.path.end()[axis] - remaining_move.path.at(remaining_move.done)[axis]
                })
                .sum::<f64>()
        };
        let fits = |axis: usize| (self.goal[axis] + remaining_distance(axis) - interrupted.target[axis]).abs() < SAME;
        if (0..AXES).all(|axis| !self.belongs_to(axis, owner) || fits(axis)) {
            for remaining_move in interrupted.remaining {
                self.begin(&Segment::new(owner, remaining_move.path, remaining_move.done, remaining_move.drive, now));
            }
            return;
        }
        let Some(last) = interrupted.remaining.last() else { return };
        let mut to = self.goal;
        for axis in (0..AXES).filter(|&axis| self.belongs_to(axis, owner)) {
            to[axis] = interrupted.target[axis];
        }
        let length = minus(&to, &self.goal).into_iter().map(f64::abs).fold(0.0, f64::max);
        self.begin(&Segment::new(owner, Path::line(self.goal, to, length), 0.0, last.drive, now));
    }

    /// The next time at which the result of `test` for the coordinate of an axis changes.
    pub(super) fn crossing(&self, axis: usize, test: impl Fn(f64) -> bool, now: Now) -> Option<Now> {
        let is = |at: Now| test(self.commanded(at)[axis]);
        let result_now = is(now);
        let mut phase_times: Vec<Now> =
            self.segments.iter().flat_map(Segment::phase_times).filter(|&at| at > now).collect();
        phase_times.sort_unstable();
        let mut from = now;
        for to in phase_times {
            let piece = to.saturating_sub(from) / PIECES;
            for part in 1..=PIECES {
                let (begin, end) = (from + piece * (part - 1), if part == PIECES { to } else { from + piece * part });
                if is(end) != result_now {
                    return Some(narrow(begin, end, |at| is(at) != result_now));
                }
            }
            from = to;
        }
        None
    }

    fn log(&self, segment: &Segment, now: Now) {
        if let Some(log) = self.motions.as_ref().filter(|_| !segment.is_in_future(now)) {
            log.push(segment.entry(now));
        }
    }

    fn belongs_to(&self, axis: usize, owner: usize) -> bool {
        owner == HOST || self.owners[axis] == owner
    }

    /// Stops the moves of an owner, with or without a ramp. The position where they stop becomes the goal.
    fn halt(&mut self, owner: usize, now: Now, ramp: bool) {
        self.touch();
        let (position, target) = (self.position(now), self.goal);
        let mut remaining = Vec::new();
        for segment in std::mem::take(&mut self.segments) {
            if segment.owner != owner || segment.ends() <= now {
                self.segments.push(segment);
                continue;
            }
            let braked = segment.braked(now);
            let done = if ramp && !segment.is_in_future(now) {
                self.goal = plus(&self.goal, &minus(&braked.end(), &segment.end()));
                self.segments.push(braked);
                braked.done(braked.ends())
            } else {
                self.log(&segment, now);
                self.goal = plus(&self.goal, &segment.remaining_displacement(now));
                segment.done(now)
            };
            remaining.push(RemainingMove { path: segment.path, done, drive: segment.drive });
        }
        if !ramp {
            // An axis at an obstacle stays at the obstacle.
            let commanded = self.commanded(now);
            for axis in 0..AXES {
                if self.belongs_to(axis, owner) {
                    self.goal[axis] += position[axis] - commanded[axis];
                }
            }
        }
        if !remaining.is_empty() {
            self.discard_interrupted(owner);
            self.interrupted.push(InterruptedMoves { owner, remaining, target });
        }
    }
}

impl Wall {
    /// Distance of a coordinate beyond the obstacle.
    fn depth(self, coordinate: f64) -> f64 {
        if self.below { coordinate - self.at } else { self.at - coordinate }
    }
}

/// Finds the time between `before` and `after` at which `condition` becomes true.
fn narrow(mut before: Now, mut after: Now, condition: impl Fn(Now) -> bool) -> Now {
    for _ in 0..HALVINGS {
        let middle = before + after.saturating_sub(before) / 2;
        if middle == before {
            break;
        }
        if condition(middle) { after = middle } else { before = middle }
    }
    after
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    const DRIVE: Drive = Drive { speed: 100.0, up: 0.1, down: 0.1 };

    fn ms(ms: u64) -> Now {
        Duration::from_millis(ms)
    }

    fn to(arm: &mut Arm, place: Coordinates, at: Now) {
        let from = arm.goal;
        let length = minus(&place, &from).into_iter().map(f64::abs).fold(0.0, f64::max);
        arm.begin(&Segment::new(0, Path::line(from, place, length), 0.0, DRIVE, at));
    }

    fn near(a: Coordinates, b: Coordinates) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6)
    }

    #[test]
    fn moves_add_up() {
        let mut arm = Arm::default();
        to(&mut arm, [100.0, 0.0, 0.0, 0.0], ms(0));
        // 100 mm take 1.1 s. The second move begins with the deceleration of the first move.
        to(&mut arm, [100.0, 100.0, 0.0, 0.0], ms(1000));
        assert!(near(arm.commanded(ms(1000)), [95.0, 0.0, 0.0, 0.0]));
        assert!(near(arm.commanded(ms(1050)), [98.75, 1.25, 0.0, 0.0]), "the corner is rounded");
        assert!(near(arm.commanded(ms(2100)), [100.0, 100.0, 0.0, 0.0]));
    }

    #[test]
    fn a_stopped_move_continues() {
        let mut arm = Arm::default();
        to(&mut arm, [100.0, 0.0, 0.0, 0.0], ms(0));
        arm.brake(ms(500));
        assert!(near(arm.goal, [50.0, 0.0, 0.0, 0.0]), "45 mm, and a ramp of 5");
        assert!(!arm.is_moving(ms(600)));
        arm.resume(0, ms(5000));
        assert!(near(arm.commanded(ms(9000)), [100.0, 0.0, 0.0, 0.0]));
        assert!(near(arm.commanded(ms(5100)), [55.0, 0.0, 0.0, 0.0]));
    }

    #[test]
    fn a_stopped_move_continues_to_its_target_after_a_jog() {
        let mut arm = Arm::default();
        to(&mut arm, [100.0, 0.0, 0.0, 0.0], ms(0));
        arm.freeze(ms(500));
        assert!(near(arm.goal, [45.0, 0.0, 0.0, 0.0]));
        arm.settle(ms(500));
        arm.begin(&Segment::new(HOST, Path::line(arm.goal, [0.0, 7.0, 0.0, 0.0], 45.0), 0.0, DRIVE, ms(600)));
        arm.resume(0, ms(5000));
        assert!(near(arm.goal, [100.0, 0.0, 0.0, 0.0]));
    }

    #[test]
    fn an_axis_stops_at_a_wall() {
        let mut arm = Arm::default();
        arm.set_wall(0, Some(30.0), ms(0));
        to(&mut arm, [100.0, 0.0, 0.0, 0.0], ms(0));
        let contact = arm.crossing(0, |x| x > 30.0, ms(0)).unwrap();
        assert!((contact.as_secs_f64() - 0.35).abs() < 1e-6);
        assert!(near(arm.position(ms(500)), [30.0, 0.0, 0.0, 0.0]));
        assert!((arm.push(0, ms(500)) - 15.0).abs() < 1e-6);
        arm.brake(ms(500));
        assert!(near(arm.goal, [30.0, 0.0, 0.0, 0.0]));
        arm.set_wall(0, None, ms(600));
        arm.resume(0, ms(600));
        assert!(near(arm.goal, [100.0, 0.0, 0.0, 0.0]));
    }

    #[test]
    fn a_crossing_is_found_in_both_directions() {
        let mut arm = Arm::default();
        to(&mut arm, [100.0, 0.0, 0.0, 0.0], ms(0));
        let at = arm.crossing(0, |x| x >= 55.0, ms(0)).unwrap();
        assert!(arm.commanded(at)[0] >= 55.0);
        assert!((at.as_secs_f64() - 0.6).abs() < 1e-6);
        assert_eq!(arm.crossing(0, |x| x >= 55.0, at), None);
        assert_eq!(arm.crossing(1, |y| y >= 55.0, ms(0)), None);
    }
}
