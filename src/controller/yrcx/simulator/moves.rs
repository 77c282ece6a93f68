//! Targets, paths and speeds of commands and programs.

use super::alarms::{AlarmSource, Fault, NO_ABSOLUTE_RESET, NO_PATH, OUT_OF_REACH, POINT_UNIT};
use super::geometry::{Arm, FourValues, Geometry, STEPS, along_tool, from_shift, to_shift};
use super::memory::{Point, PointUnit};
use super::motion::{End, Leg, Motion, Owner, Path};
use super::robot::{Axis, Method, Motor, Robot, over_limit};
use super::world::{Mode, World};
use crate::refuse_if;

/// Full tool speed in mm/s. The constant below is the full rotation speed in degrees/s.
const LINEAR_SPEED: f64 = 1000.0;
const ROTATION_SPEED: f64 = 360.0;
/// Share of full speed during the search for the origin.
const ORIGIN_SHARE: f64 = 0.2;
/// Number of points at which a path is checked before it starts.
const SAMPLES: u32 = 64;
/// Numbers of the parameters for acceleration and deceleration (4.4.2).
const ACCEL: u16 = 257;
const DECEL: u16 = 258;

/// Speed, acceleration and deceleration of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Speed {
    pub(super) rate: Rate,
    /// Acceleration in percent of the maximum. Without a value, the parameters of the axes decide.
    pub(super) accel: Option<i32>,
    pub(super) decel: Option<i32>,
}

/// Kind of speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Rate {
    /// Program speed, multiplied by the automatic speed.
    #[default]
    Program,
    /// Speed in units of 0.01 % of the maximum speed.
    OfMax(i32),
    /// Speed in percent. It is multiplied by the automatic speed.
    Percent(i32),
    /// Speed in mm/s.
    MmS(i32),
    /// Manual speed.
    Manual,
}

/// Coordinate system of a jog or an inching motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Frame {
    Axes,
    Cartesian,
    Tool,
}

/// Axes of an origin return.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Homing {
    All,
    Incremental,
    Absolute,
    Incomplete,
    /// One axis, counted from 0.
    Axis(usize),
}

impl Homing {
    pub(super) fn includes(self, at: usize, axis: &Axis) -> bool {
        match self {
            Self::All => true,
            Self::Incremental => axis.motor != Motor::Absolute,
            Self::Absolute => axis.motor == Motor::Absolute,
            Self::Incomplete => !axis.origin,
            Self::Axis(one) => at == one,
        }
    }
}

impl World {
    /// Kinematics of a robot, with the hand that is selected.
    pub(super) fn geometry(&self, number: usize) -> Result<Geometry, Fault> {
        let robot = self.robot(number)?;
        let hand = robot.hand.and_then(|hand| self.memory.hands.get(hand).copied().flatten());
        Ok(robot.geometry(hand.map(|hand| hand.data)))
    }

    /// Tool position of a robot, in the coordinates of the selected shift.
    pub(super) fn pose(&self, number: usize) -> Result<FourValues, Fault> {
        let robot = self.robot(number)?;
        Ok(to_shift(&self.shift(robot), &self.geometry(number)?.pose(&robot.pulses())))
    }

    fn shift(&self, robot: &Robot) -> [i32; 4] {
        self.memory.shifts.get(robot.shift).copied().unwrap_or_default()
    }

    /// Target in pulses of a move of these axes to a point. The other axes stay in place.
    pub(super) fn point_target(&self, number: usize, axes: u8, point: &Point) -> Result<FourValues, Fault> {
        match point.unit {
            PointUnit::Pulse => self.pulse_target(number, axes, &point.numbers()),
            PointUnit::Mm => self.pose_target(number, axes, &point.numbers(), Arm::of_hand_system(point.hand_system)),
        }
    }

    /// Target in pulses of a move of these axes to positions in pulses.
    pub(super) fn pulse_target(&self, number: usize, axes: u8, pulses: &FourValues) -> Result<FourValues, Fault> {
        Ok(chosen(self.robot(number)?, axes, pulses))
    }

    /// Target in pulses of a move of these coordinates to positions in the shift. The other coordinates stay the same.
    pub(super) fn pose_target(
        &self,
        number: usize,
        axes: u8,
        pose: &FourValues,
        arm: Option<Arm>,
    ) -> Result<FourValues, Fault> {
        let now = self.pose(number)?;
        let wanted = std::array::from_fn(|axis| if axes >> axis & 1 == 1 { pose[axis] } else { now[axis] });
        self.reach(number, &wanted, arm.unwrap_or(self.robot(number)?.arm))
    }

    /// Target in pulses of a move of these axes by the distances in a point.
    pub(super) fn relative_target(&self, number: usize, axes: u8, point: &Point) -> Result<FourValues, Fault> {
        match point.unit {
            PointUnit::Pulse => self.relative_pulses(number, axes, &point.numbers()),
            PointUnit::Mm => self.relative_pose(number, axes, &point.numbers()),
        }
    }

    /// Target of a move by distances in pulses.
    pub(super) fn relative_pulses(&self, number: usize, axes: u8, way: &FourValues) -> Result<FourValues, Fault> {
        let now = self.robot(number)?.pulses();
        self.pulse_target(number, axes, &sum(&now, way))
    }

    /// Target of a move by distances in mm.
    pub(super) fn relative_pose(&self, number: usize, axes: u8, way: &FourValues) -> Result<FourValues, Fault> {
        let arm = self.current_arm(number)?;
        self.pose_target(number, axes, &sum(&self.pose(number)?, way), Some(arm))
    }

    /// Target of a move by distances in tool coordinates.
    pub(super) fn tool_target(&self, number: usize, axes: u8, way: &FourValues) -> Result<FourValues, Fault> {
        let way = std::array::from_fn(|axis| if axes >> axis & 1 == 1 { way[axis] } else { 0.0 });
        self.reach(number, &along_tool(&self.pose(number)?, &way), self.current_arm(number)?)
    }

    /// Target of a move of one axis to a position in mm or degrees.
    pub(super) fn axis_target(&self, number: usize, axis: usize, units: f64) -> Result<FourValues, Fault> {
        self.has_axes(number, 1 << axis)?;
        let per_unit = self.geometry(number)?.per_unit[axis];
        self.pulse_target(number, 1 << axis, &[units * per_unit; 4])
    }

    /// Distances of a point for a move in tool coordinates. Only a point in mm is valid.
    pub(super) fn tool_way(point: &Point) -> Result<FourValues, Fault> {
        match point.unit {
            PointUnit::Mm => Ok(point.numbers()),
            PointUnit::Pulse => {
                Err(Fault::new(POINT_UNIT, AlarmSource::Controller, "tool coordinates need a point in mm"))
            }
        }
    }

    fn current_arm(&self, number: usize) -> Result<Arm, Fault> {
        let robot = self.robot(number)?;
        Ok(self.geometry(number)?.arm(&robot.pulses()).unwrap_or(robot.arm))
    }

    fn reach(&self, number: usize, pose: &FourValues, arm: Arm) -> Result<FourValues, Fault> {
        let robot = self.robot(number)?;
        let world = from_shift(&self.shift(robot), pose);
        let pulses = self.geometry(number)?.pulses(&world, arm).ok_or_else(|| out_of_reach(number))?;
        Ok(chosen(robot, robot.mask(), &pulses))
    }

    /// Starts the motion of a program line.
    pub(super) fn begin_program_move(
        &mut self,
        number: usize,
        owner: Owner,
        target: &FourValues,
        linear: bool,
        speed: Speed,
    ) -> Result<(), Fault> {
        self.may_move(number, self.robot(number)?.mask())?;
        self.at_home(number)?;
        let leg = if linear {
            self.line_leg(number, target, speed)?
        } else {
            let from = self.robot(number)?.pulses();
            self.joint_leg(number, &from, target, speed)?
        };
        self.begin(number, owner, vec![leg], End::Arrived)
    }

    /// Path segment with joint interpolation.
    pub(super) fn joint_leg(
        &self,
        number: usize,
        from: &FourValues,
        to: &FourValues,
        speed: Speed,
    ) -> Result<Leg, Fault> {
        let robot = self.robot(number)?;
        if robot.is_at_home() {
            robot.check_limits(number, to)?;
        }
        let path = Path::Joint { from: *from, to: *to };
        let (accel, decel) = ramps(robot, from, to, speed);
        // Also in joint motions, a speed in mm/s is a share of the maximum tool speed.
        Ok(Leg::new(path, robot.seconds(from, to), self.share(robot, speed.rate), accel, decel))
    }

    /// Path segment along a straight line of the tool.
    pub(super) fn line_leg(&self, number: usize, to: &FourValues, speed: Speed) -> Result<Leg, Fault> {
        let (robot, geometry) = (self.robot(number)?, self.geometry(number)?);
        let from = robot.pulses();
        robot.check_limits(number, to)?;
        let arm = geometry.arm(&from);
        if arm != geometry.arm(to) {
            return Err(Fault::new(
                NO_PATH,
                AlarmSource::Robot(number),
                "the hand system cannot change during a linear move",
            ));
        }
        let (start, end) = (geometry.pose(&from), geometry.pose(to));
        let way = start.iter().zip(&end).take(3).map(|(a, b)| (b - a) * (b - a)).sum::<f64>().sqrt();
        let path = Path::Line { from: start, to: end, arm: arm.unwrap_or(robot.arm) };
        self.tool_leg(number, path, way, end[3] - start[3], speed)
    }

    /// Path segment along an arc of the tool, through one position to another position.
    pub(super) fn arc_leg(&self, number: usize, via: &Point, to: &Point, speed: Speed) -> Result<Leg, Fault> {
        let (robot, geometry) = (self.robot(number)?, self.geometry(number)?);
        let all = robot.mask();
        let (from, via) = (robot.pulses(), self.point_target(number, all, via)?);
        let to = self.point_target(number, all, to)?;
        robot.check_limits(number, &via)?;
        robot.check_limits(number, &to)?;
        let arm = geometry.arm(&from);
        let (start, end) = (geometry.pose(&from), geometry.pose(&to));
        let arc = Path::arc(&start, &geometry.pose(&via), &end, arm.unwrap_or(robot.arm));
        let (path, way) = arc
            .filter(|_| arm == geometry.arm(&to))
            .ok_or_else(|| Fault::new(NO_PATH, AlarmSource::Robot(number), "these points do not form an arc"))?;
        self.tool_leg(number, path, way, end[3] - start[3], speed)
    }

    fn tool_leg(&self, number: usize, path: Path, way: f64, turn: f64, speed: Speed) -> Result<Leg, Fault> {
        let (robot, geometry) = (self.robot(number)?, self.geometry(number)?);
        let mut last = robot.pulses();
        for sample in 1..=SAMPLES {
            let share = f64::from(sample) / f64::from(SAMPLES);
            last = path.at(share, &geometry).ok_or_else(|| out_of_reach(number))?;
            robot.check_limits(number, &last)?;
        }
        let seconds = (way / LINEAR_SPEED).max(turn.abs() / ROTATION_SPEED);
        let (accel, decel) = ramps(robot, &robot.pulses(), &last, speed);
        Ok(Leg::new(path, seconds, self.share(robot, speed.rate), accel, decel))
    }

    /// Arch: up, across, down. `height` is the position of the arch axis in pulses while the robot moves across.
    pub(super) fn arch_legs(
        &self,
        number: usize,
        axis: usize,
        height: f64,
        to: &FourValues,
        speed: Speed,
    ) -> Result<Vec<Leg>, Fault> {
        self.has_axes(number, 1 << axis)?;
        let from = self.robot(number)?.pulses();
        let (mut above, mut beyond) = (from, *to);
        above[axis] = height;
        beyond[axis] = height;
        [(from, above), (above, beyond), (beyond, *to)]
            .iter()
            .map(|(from, to)| self.joint_leg(number, from, to, speed))
            .collect()
    }

    /// Path segment along an axis to its soft limit. At the limit, the motion ends with the alarm of this axis.
    pub(super) fn jog(&self, number: usize, frame: Frame, axis: usize, sign: f64) -> Result<(Leg, End), Fault> {
        let speed = Speed { rate: Rate::Manual, ..Speed::default() };
        let robot = self.robot(number)?;
        let from = robot.pulses();
        if frame == Frame::Axes {
            self.has_axes(number, 1 << axis)?;
            let limits = robot.axes[axis].limits;
            let mut to = from;
            to[axis] = match (robot.is_at_home(), sign < 0.0) {
                // Without a known origin, the limits are not valid, so the axis can move by its whole range.
                (false, _) => from[axis] + sign * (limits.1 - limits.0),
                (true, true) => limits.0,
                (true, false) => limits.1,
            };
            refuse_if((to[axis] - from[axis]) * sign <= 0.0, over_limit(number, axis))?;
            let leg = self.joint_leg(number, &from, &to, speed)?;
            return Ok((leg, End::Stopped(over_limit(number, axis))));
        }
        let mut way = [0.0; 4];
        let mut target = |distance: f64| {
            way[axis] = sign * distance;
            let target = match frame {
                Frame::Tool => self.tool_target(number, super::robot::ALL, &way)?,
                _ => self.relative_pose(number, super::robot::ALL, &way)?,
            };
            self.line_leg(number, &target, speed)
        };
        let (mut near, mut far) = (0.0, 0.001);
        let mut fault = loop {
            match target(far) {
                Ok(_) if far < 1e6 => (near, far) = (far, far * 2.0),
                Ok(_) => break over_limit(number, axis),
                Err(fault) => break fault,
            }
        };
        if near == 0.0 {
            return Err(fault);
        }
        while far - near > 1e-3 {
            let middle = f64::midpoint(near, far);
            match target(middle) {
                Ok(_) => near = middle,
                Err(nearer) => (far, fault) = (middle, nearer),
            }
        }
        Ok((target(near)?, End::Stopped(fault)))
    }

    /// Path segment along an axis by a distance in pulses or in steps of 0.001 mm.
    pub(super) fn inch(&self, number: usize, frame: Frame, axis: usize, amount: f64) -> Result<Leg, Fault> {
        let speed = Speed { rate: Rate::Manual, ..Speed::default() };
        let mask = 1 << axis;
        match frame {
            Frame::Axes => {
                self.has_axes(number, mask)?;
                let from = self.robot(number)?.pulses();
                let to = self.relative_pulses(number, mask, &[amount; 4])?;
                self.joint_leg(number, &from, &to, speed)
            }
            Frame::Cartesian => {
                let to = self.relative_pose(number, mask, &[amount / STEPS; 4])?;
                self.line_leg(number, &to, speed)
            }
            Frame::Tool => {
                let to = self.tool_target(number, mask, &[amount / STEPS; 4])?;
                self.line_leg(number, &to, speed)
            }
        }
    }

    /// Starts an origin return in several passes. Returns whether any axis moves.
    pub(super) fn begin_origin(&mut self, number: usize, passes: &[Homing], owner: Owner) -> Result<bool, Fault> {
        let robot = self.robot(number)?;
        let mut from = robot.pulses();
        let (mut legs, mut homing) = (Vec::new(), 0);
        for pass in passes {
            let mut to = from;
            for (at, axis) in robot.axes.iter().enumerate().filter(|(at, axis)| pass.includes(*at, axis)) {
                // The signal SI(17) does not move axes of the mark type (chapter 1).
                if owner == Owner::Input && axis.method == Method::Mark && axis.origin {
                    continue;
                }
                if axis.method == Method::Mark && !axis.origin {
                    let why = format!("axis {} needs an absolute reset first", at + 1);
                    return Err(Fault::new(NO_ABSOLUTE_RESET, AlarmSource::Axis(number, at), why));
                }
                to[at] = 0.0;
                homing |= 1 << at;
            }
            legs.push(Leg::new(Path::Joint { from, to }, robot.seconds(&from, &to), ORIGIN_SHARE, 1.0, 1.0));
            from = to;
        }
        if homing == 0 {
            return Ok(false);
        }
        self.may_move(number, homing)?;
        self.begin(number, owner, legs, End::Arrived)?;
        self.robot_mut(number)?.homing = homing;
        Ok(true)
    }

    pub(super) fn begin(&mut self, number: usize, owner: Owner, legs: Vec<Leg>, end: End) -> Result<(), Fault> {
        let (geometry, now) = (self.geometry(number)?, self.now);
        let robot = self.robot_mut(number)?;
        robot.ended.retain(|(other, _)| *other != owner);
        robot.kept = None;
        robot.motion = Some(Motion::new(owner, geometry, legs, end, now));
        Ok(())
    }

    /// Converts a speed to a share of full speed.
    pub(super) fn share(&self, robot: &Robot, rate: Rate) -> f64 {
        let percent = |number: i32| f64::from(number) / 100.0;
        let base = percent(if self.switches.mode == Mode::Auto { robot.auto_speed } else { robot.manual_speed });
        match rate {
            Rate::Program => base * percent(robot.program_speed),
            Rate::OfMax(share) => percent(share) / 100.0,
            Rate::Percent(share) => base * percent(share),
            Rate::MmS(speed) => (f64::from(speed) / LINEAR_SPEED).min(1.0),
            Rate::Manual => percent(robot.manual_speed),
        }
    }
}

/// Acceleration and deceleration as shares of the maximum. Each of them is the minimum over the moving axes.
fn ramps(robot: &Robot, from: &FourValues, to: &FourValues, speed: Speed) -> (f64, f64) {
    let least = |parameter| {
        let moving = robot.axes.iter().enumerate().filter(|(at, _)| (from[*at] - to[*at]).abs() > 0.0);
        moving.map(|(_, axis)| axis.parameter(parameter)).min().unwrap_or(100)
    };
    let share =
        |given: Option<i32>, parameter| f64::from(given.unwrap_or_else(|| least(parameter)).clamp(1, 100)) / 100.0;
    (share(speed.accel, ACCEL), share(speed.decel, DECEL))
}

/// Returns the current position with the values of these axes replaced by `numbers`. The value is 0 for an axis that
/// the robot does not have.
fn chosen(robot: &Robot, axes: u8, numbers: &FourValues) -> FourValues {
    let now = robot.pulses();
    std::array::from_fn(|axis| {
        if axis >= robot.axes.len() {
            0.0
        } else if axes >> axis & 1 == 1 {
            numbers[axis]
        } else {
            now[axis]
        }
    })
}

fn sum(a: &FourValues, b: &FourValues) -> FourValues {
    std::array::from_fn(|at| a[at] + b[at])
}

fn out_of_reach(number: usize) -> Fault {
    Fault::new(OUT_OF_REACH, AlarmSource::Robot(number), "the axes cannot move the tool to this position")
}
