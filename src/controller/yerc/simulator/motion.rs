//! Mechanics: control groups, simplified kinematics, and motion over time.
//!
//! The kinematics is a cylinder, so that joint and straight paths differ and both end points are exact. S rotates about
//! the vertical, L is the reach, U the height, and R, B and T rotate the tool. A base moves its robot along X.
//!
//! Positions are stored as fractional pulses, which are finer than the 0.001 mm and 0.0001 degrees of the protocol.
//! Because of this, the controller reports a target in pulses or coordinates exactly as it was commanded.

use std::time::Duration;

use crate::Now;
use crate::simulator::run_options::{self, MotionLog, path_length};

/// Maximum number of axes in the protocol.
pub(super) const AXES: usize = 8;
/// Time in which a group stops after a hold.
pub(super) const STOP_TIME: Duration = Duration::from_millis(100);
/// Maximum speed of a straight motion.
pub(super) const MAX_LINEAR_MM_S: f64 = 1500.0;
/// Maximum rotation speed of the tool.
pub(super) const MAX_ANGULAR_DEG_S: f64 = 180.0;

/// Positions of all axes of a group, in pulses.
pub(super) type Pulses = [f64; AXES];
/// X, Y, Z in mm, Rx, Ry, Rz, Re in degrees.
pub(super) type Pose = [f64; 7];

/// Kind of group.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Family {
    Robot,
    Base,
    Station,
}

impl Family {
    const fn letter(self) -> char {
        match self {
            Self::Robot => 'R',
            Self::Base => 'B',
            Self::Station => 'S',
        }
    }
}

/// An axis: range in pulses, and maximum speed in pulses per second.
#[derive(Debug, Clone, Copy)]
struct Axis {
    min: f64,
    max: f64,
    speed: f64,
}

const fn axis(min: f64, max: f64, speed: f64) -> Axis {
    Axis { min, max, speed }
}

const S_PULSES_PER_DEG: f64 = 1360.0;
const WRIST_PULSES_PER_DEG: f64 = 1000.0;
const T_PULSES_PER_DEG: f64 = 500.0;
const PULSES_PER_MM: f64 = 1000.0;
const REACH_AT_ZERO_MM: f64 = 1000.0;
const HEIGHT_AT_ZERO_MM: f64 = 1200.0;

/// Axes S, L, U, R, B, T, E of a robot.
const ROBOT: [Axis; 7] = [
    axis(-244_800.0, 244_800.0, 200.0 * S_PULSES_PER_DEG),
    axis(-999_000.0, 2_000_000.0, MAX_LINEAR_MM_S * PULSES_PER_MM),
    axis(-2_000_000.0, 2_000_000.0, MAX_LINEAR_MM_S * PULSES_PER_MM),
    axis(-360_000.0, 360_000.0, 400.0 * WRIST_PULSES_PER_DEG),
    axis(-180_000.0, 180_000.0, 400.0 * WRIST_PULSES_PER_DEG),
    axis(-360_000.0, 360_000.0, 600.0 * T_PULSES_PER_DEG),
    axis(-180_000.0, 180_000.0, 200.0 * WRIST_PULSES_PER_DEG),
];
const BASE: [Axis; 1] = [axis(-5_000_000.0, 5_000_000.0, 1000.0 * PULSES_PER_MM)];
const STATION: [Axis; 2] = [axis(-1_000_000.0, 1_000_000.0, 180_000.0); 2];

/// A fitted group and its position.
#[derive(Debug, Clone)]
pub(super) struct Group {
    pub(super) family: Family,
    /// Number of the group among the groups of its family, for example 1 for R1.
    pub(super) number: u16,
    pub(super) axes: usize,
    pub(super) pulses: Pulses,
    pub(super) form: u32,
    pub(super) extended_form: u32,
    pub(super) tool: u32,
}

impl Group {
    /// Parses a group name, for example `R1`, `B2` or `S3`. A robot has 6 or 7 axes, depending on `robot_axes`.
    pub(super) fn parse(name: &str, robot_axes: usize) -> Option<Self> {
        let (letter, number) = (name.chars().next()?, name.get(1..)?.parse().ok().filter(|&number| number > 0)?);
        let (family, axes) =
            [(Family::Robot, robot_axes), (Family::Base, BASE.len()), (Family::Station, STATION.len())]
                .into_iter()
                .find(|(family, _)| family.letter() == letter)?;
        Some(Self { family, number, axes, pulses: [0.0; AXES], form: 0, extended_form: 0, tool: 0 })
    }

    pub(super) fn name(&self) -> String {
        format!("{}{}", self.family.letter(), self.number)
    }

    fn spec(&self) -> &'static [Axis] {
        match self.family {
            Family::Robot => &ROBOT,
            Family::Base => &BASE,
            Family::Station => &STATION,
        }
    }

    /// Index of the first axis that would be outside its range.
    fn beyond_limit(&self, pulses: &Pulses) -> Option<usize> {
        // Tolerance for rounding errors.
        let outside = |(axis, &pulse): (&Axis, &f64)| pulse < axis.min - 1e-6 || pulse > axis.max + 1e-6;
        self.spec().iter().zip(&pulses[..self.axes]).position(outside)
    }

    /// Duration of a joint motion at 100 %, in seconds.
    fn joint_seconds(&self, to: &Pulses) -> f64 {
        self.spec()
            .iter()
            .zip(self.pulses.iter().zip(to))
            .take(self.axes)
            .map(|(axis, (from, to))| (to - from).abs() / axis.speed)
            .fold(0.0, f64::max)
    }
}

/// Tool position of a robot in robot coordinates.
pub(super) fn forward(pulses: &Pulses) -> Pose {
    let turn = pulses[0] / S_PULSES_PER_DEG;
    let reach = REACH_AT_ZERO_MM + pulses[1] / PULSES_PER_MM;
    let (sin, cos) = turn.to_radians().sin_cos();
    [
        reach * cos,
        reach * sin,
        HEIGHT_AT_ZERO_MM + pulses[2] / PULSES_PER_MM,
        wrap(180.0 + pulses[3] / WRIST_PULSES_PER_DEG),
        wrap(pulses[4] / WRIST_PULSES_PER_DEG),
        wrap(turn + pulses[5] / T_PULSES_PER_DEG),
        pulses[6] / WRIST_PULSES_PER_DEG,
    ]
}

/// Pulses for a pose. A wrist axis can have several equivalent angles; the angle nearest to `near` is used.
pub(super) fn inverse(pose: &Pose, near: &Pulses) -> Pulses {
    let reach = pose[0].hypot(pose[1]);
    let turn = if reach < 1e-6 { near[0] / S_PULSES_PER_DEG } else { pose[1].atan2(pose[0]).to_degrees() };
    let wrist = |degrees: f64, near: f64, scale: f64| nearest(degrees, near / scale) * scale;
    [
        turn * S_PULSES_PER_DEG,
        (reach - REACH_AT_ZERO_MM) * PULSES_PER_MM,
        (pose[2] - HEIGHT_AT_ZERO_MM) * PULSES_PER_MM,
        wrist(pose[3] - 180.0, near[3], WRIST_PULSES_PER_DEG),
        wrap(pose[4]) * WRIST_PULSES_PER_DEG,
        wrist(pose[5] - turn, near[5], T_PULSES_PER_DEG),
        pose[6] * WRIST_PULSES_PER_DEG,
        0.0,
    ]
}

/// Normalizes degrees to the range from -180 (excluded) to 180.
pub(super) fn wrap(degrees: f64) -> f64 {
    let rotated = degrees.rem_euclid(360.0);
    // The tolerance keeps a value slightly above 180 from becoming -180.
    if rotated > 180.0 + 1e-9 { rotated - 360.0 } else { rotated }
}

/// The angle that is equivalent to `degrees` and nearest to `near`.
fn nearest(degrees: f64, near: f64) -> f64 {
    near + wrap(degrees - near)
}

/// The nearest integer that fits a protocol word.
#[expect(clippy::cast_possible_truncation, reason = "a float cast saturates, which is what a counter does")]
pub(super) fn whole(value: f64) -> i32 {
    value.round() as i32
}

/// Motion of one group.
#[derive(Debug, Clone)]
pub(super) struct Leg {
    pub(super) group: usize,
    from: Pulses,
    to: Pulses,
    /// Start and end of a straight line of the tool, if the motion is straight.
    line: Option<(Pose, Pose)>,
}

impl Leg {
    fn at(&self, fraction: f64) -> Pulses {
        if fraction >= 1.0 {
            return self.to;
        }
        let joint = std::array::from_fn(|i| lerp(self.from[i], self.to[i], fraction));
        match &self.line {
            None => joint,
            Some((from, to)) => {
                let pose = std::array::from_fn(|i| lerp(from[i], to[i], fraction));
                inverse(&pose, &joint)
            }
        }
    }
}

fn lerp(from: f64, to: f64, fraction: f64) -> f64 {
    from + (to - from) * fraction
}

/// A running motion.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    legs: Vec<Leg>,
    begun: Now,
    length: Duration,
    /// Completed fraction at which an axis reaches its soft limit, with the indexes of the group and the axis.
    limit: Option<(f64, usize, usize)>,
    /// Start time of the deceleration, and the completed fraction at this time.
    braking: Option<(Now, f64)>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// The target was reached.
    Arrived,
    /// A hold stopped the motion.
    Stopped,
    /// An axis reached its soft limit. Contains the indexes of the group and the axis.
    Limit(usize, usize),
}

impl Motion {
    /// Completed fraction of the path at `now`.
    fn fraction(&self, now: Now) -> f64 {
        let length = self.length.as_secs_f64();
        let covered = match self.braking {
            None if length == 0.0 => 1.0,
            None => now.saturating_sub(self.begun).as_secs_f64() / length,
            Some((since, fraction)) => {
                let ramp = STOP_TIME.as_secs_f64();
                let braked = now.saturating_sub(since).as_secs_f64().min(ramp);
                fraction + (braked - braked * braked / (2.0 * ramp)) / length
            }
        };
        covered.min(1.0)
    }

    fn moment_of(&self, fraction: f64) -> Now {
        self.begun.saturating_add(self.length.mul_f64(fraction))
    }

    /// Time at which the motion ends.
    pub(super) fn end(&self) -> Now {
        let planned = self.moment_of(self.limit.map_or(1.0, |(fraction, ..)| fraction));
        match self.braking {
            Some((since, _)) => since.saturating_add(STOP_TIME),
            None => planned,
        }
    }
}

/// All groups, and the running motion.
#[derive(Debug, Clone)]
pub(super) struct Arm {
    pub(super) groups: Vec<Group>,
    motion: Option<Motion>,
    /// Log of the motions.
    pub(super) motions: Option<MotionLog>,
}

impl Arm {
    pub(super) fn new(groups: Vec<Group>) -> Self {
        Self { groups, motion: None, motions: None }
    }

    pub(super) fn find(&self, family: Family, number: u16) -> Option<usize> {
        self.groups.iter().position(|group| group.family == family && group.number == number)
    }

    pub(super) fn is_moving(&self) -> bool {
        self.motion.is_some()
    }

    pub(super) fn motion_end(&self) -> Option<Now> {
        self.motion.as_ref().map(Motion::end)
    }

    /// Distance in mm that the base of robot `number` has moved.
    pub(super) fn base_offset(&self, number: u16) -> f64 {
        self.find(Family::Base, number).map_or(0.0, |base| self.groups[base].pulses[0] / PULSES_PER_MM)
    }

    /// Tool position of a robot in base coordinates.
    pub(super) fn base_pose(&self, robot: usize) -> Pose {
        let group = &self.groups[robot];
        let mut pose = forward(&group.pulses);
        pose[0] += self.base_offset(group.number);
        pose
    }

    /// Starts a joint motion. `share` is the share of the maximum speed (1.0 is 100 %).
    pub(super) fn joint(&mut self, now: Now, targets: &[(usize, Pulses)], share: f64) {
        let seconds = targets.iter().map(|&(group, to)| self.groups[group].joint_seconds(&to)).fold(0.0, f64::max);
        let legs = targets.iter().map(|&(group, to)| self.leg(group, to, false)).collect();
        self.begin(now, legs, Duration::from_secs_f64(seconds / share.max(1e-4)));
    }

    /// Starts a straight motion. The first target belongs to the robot that carries the tool.
    pub(super) fn straight(&mut self, now: Now, targets: &[(usize, Pulses)], speed: Speed) {
        let legs: Vec<_> = targets.iter().map(|&(group, to)| self.leg(group, to, true)).collect();
        let line = legs.iter().find_map(|leg| leg.line);
        let seconds = match line {
            Some((from, to)) => speed.seconds(&from, &to),
            None => 0.0,
        };
        // A moving base may take longer than the tool.
        let others = targets.iter().map(|&(group, to)| (group, self.groups[group].joint_seconds(&to)));
        let base = others
            .filter(|&(group, _)| self.groups[group].family != Family::Robot)
            .map(|(_, seconds)| seconds)
            .fold(0.0, f64::max);
        self.begin(now, legs, Duration::from_secs_f64(seconds.max(base)));
    }

    fn leg(&self, group: usize, to: Pulses, straight: bool) -> Leg {
        let from = self.groups[group].pulses;
        let line = (straight && self.groups[group].family == Family::Robot).then(|| {
            let (start, mut end) = (forward(&from), forward(&to));
            for turn in 3..6 {
                end[turn] = nearest(end[turn], start[turn]);
            }
            (start, end)
        });
        Leg { group, from, to, line }
    }

    fn begin(&mut self, now: Now, legs: Vec<Leg>, length: Duration) {
        let limit = self.first_limit(&legs);
        self.motion = Some(Motion { legs, begun: now, length, limit, braking: None });
    }

    /// Searches for the first soft limit on the path, in small steps and then by bisection.
    fn first_limit(&self, legs: &[Leg]) -> Option<(f64, usize, usize)> {
        const STEPS: u32 = 128;
        let violation = |fraction: f64| {
            legs.iter().find_map(|leg| {
                let axis = self.groups[leg.group].beyond_limit(&leg.at(fraction))?;
                Some((leg.group, axis))
            })
        };
        let step = (1..=STEPS).find(|&step| violation(f64::from(step) / f64::from(STEPS)).is_some())?;
        let (mut inside, mut outside) = (f64::from(step - 1) / f64::from(STEPS), f64::from(step) / f64::from(STEPS));
        for _ in 0..40 {
            let middle = f64::midpoint(inside, outside);
            *(if violation(middle).is_some() { &mut outside } else { &mut inside }) = middle;
        }
        violation(outside).map(|(group, axis)| (inside, group, axis))
    }

    /// Decelerates the motion. [`Arm::advance`] reports the end of the motion.
    pub(super) fn brake(&mut self, now: Now) {
        if let Some(motion) = self.motion.as_mut().filter(|motion| motion.braking.is_none()) {
            motion.braking = Some((now, motion.fraction(now)));
        }
    }

    /// Stops the motion at once, as brakes do without servo power.
    pub(super) fn halt(&mut self, now: Now) {
        self.place(now);
        self.log(now, false);
        self.motion = None;
    }

    /// Updates the positions to `now`. Returns how the motion ended, if it has ended.
    pub(super) fn advance(&mut self, now: Now) -> Option<End> {
        self.place(now);
        let motion = self.motion.as_ref()?;
        let fraction = motion.fraction(now);
        let end = match motion.limit {
            Some((limit, group, axis)) if fraction >= limit || now >= motion.end() && motion.braking.is_none() => {
                Some(End::Limit(group, axis))
            }
            _ if fraction >= 1.0 => Some(End::Arrived),
            _ if motion.braking.is_some() && now >= motion.end() => Some(End::Stopped),
            _ => None,
        }?;
        self.log(now, end == End::Arrived);
        self.motion = None;
        Some(end)
    }

    /// Adds the motion, which ends now, to the log.
    fn log(&self, now: Now, reached: bool) {
        let (Some(log), Some(motion)) = (&self.motions, &self.motion) else { return };
        let fraction = motion.fraction(now).min(motion.limit.map_or(1.0, |(limit, ..)| limit));
        for leg in &motion.legs {
            let group = &self.groups[leg.group];
            let values = |pulses: &Pulses| pulses[..group.axes].to_vec();
            let tool = |share: f64| {
                let [x, y, z, ..] = forward(&leg.at(share * fraction));
                [x, y, z]
            };
            log.push(run_options::Motion {
                group: group.name(),
                from: values(&leg.from),
                to: values(&leg.at(fraction)),
                unit: "pulses",
                distance_mm: (group.family == Family::Robot).then(|| path_length(tool)),
                began: motion.begun,
                took: now.saturating_sub(motion.begun),
                reached,
            });
        }
    }

    fn place(&mut self, now: Now) {
        let Some(motion) = &self.motion else { return };
        let fraction = motion.fraction(now).min(motion.limit.map_or(1.0, |(limit, ..)| limit));
        for leg in &motion.legs {
            self.groups[leg.group].pulses = leg.at(fraction);
        }
    }

    /// Speed of each axis of a group at `now`, in pulses per second.
    pub(super) fn velocity(&self, group: usize, now: Now) -> Pulses {
        const SPAN: Duration = Duration::from_millis(1);
        let Some(motion) = &self.motion else { return [0.0; AXES] };
        let Some(leg) = motion.legs.iter().find(|leg| leg.group == group) else { return [0.0; AXES] };
        let (here, there) = (leg.at(motion.fraction(now)), leg.at(motion.fraction(now + SPAN)));
        std::array::from_fn(|i| (there[i] - here[i]) / SPAN.as_secs_f64())
    }
}

/// Speed of a straight motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Speed {
    /// Speed of the tool tip in mm/s.
    Linear(f64),
    /// Rotation speed of the tool in degrees per second.
    Angular(f64),
}

impl Speed {
    /// Duration of the motion. The linear part or the rotation decides, whichever is slower.
    fn seconds(self, from: &Pose, to: &Pose) -> f64 {
        let way = |range: std::ops::Range<usize>| range.map(|i| (to[i] - from[i]).powi(2)).sum::<f64>().sqrt();
        let (distance, turn) = (way(0..3), way(3..7));
        match self {
            Self::Linear(speed) => (distance / speed).max(turn / MAX_ANGULAR_DEG_S),
            Self::Angular(speed) => (turn / speed).max(distance / MAX_LINEAR_MM_S),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arm() -> Arm {
        Arm::new(["R1", "B1", "S1"].iter().filter_map(|name| Group::parse(name, 6)).collect())
    }

    fn seconds(seconds: f64) -> Now {
        Duration::from_secs_f64(seconds)
    }

    #[test]
    fn zero_pulses_are_a_known_pose() {
        assert_eq!(forward(&[0.0; AXES]).map(whole), [1000, 0, 1200, 180, 0, 0, 0]);
    }

    #[test]
    fn pose_round_trips_through_pulses() {
        let pose = [185.123, -410.007, 125.5, -179.9999, 12.3456, -90.0001, 0.0];
        let back = forward(&inverse(&pose, &[0.0; AXES]));
        for (sent, read) in pose.iter().zip(back) {
            assert_eq!(whole(sent * 10_000.0), whole(read * 10_000.0));
        }
    }

    #[test]
    fn a_joint_motion_takes_the_time_of_its_slowest_axis() {
        let mut arm = arm();
        let mut to = [0.0; AXES];
        to[0] = 200.0 * S_PULSES_PER_DEG / 2.0;
        arm.joint(Now::ZERO, &[(0, to)], 0.1);
        assert_eq!(arm.motion_end(), Some(seconds(5.0)));
        assert_eq!(arm.advance(seconds(2.5)), None);
        assert_eq!(whole(arm.groups[0].pulses[0]), whole(to[0] / 2.0));
        assert_eq!(arm.advance(seconds(5.0)), Some(End::Arrived));
        assert_eq!(arm.groups[0].pulses.map(whole), to.map(whole));
    }

    #[test]
    fn a_straight_motion_stays_on_its_line() {
        let mut arm = arm();
        let target = inverse(&[1000.0, 500.0, 1200.0, 180.0, 0.0, 0.0, 0.0], &[0.0; AXES]);
        arm.straight(Now::ZERO, &[(0, target)], Speed::Linear(100.0));
        assert_eq!(arm.motion_end(), Some(seconds(5.0)));
        arm.advance(seconds(2.5));
        assert_eq!(forward(&arm.groups[0].pulses).map(|value| whole(value * 1000.0))[..2], [1_000_000, 250_000]);
    }

    #[test]
    fn braking_distance_is_half_of_full_speed() {
        let mut arm = arm();
        let mut to = [0.0; AXES];
        to[0] = 100.0 * S_PULSES_PER_DEG;
        arm.joint(Now::ZERO, &[(0, to)], 0.1);
        arm.advance(seconds(1.0));
        arm.brake(seconds(1.0));
        assert_eq!(arm.advance(seconds(1.1)), Some(End::Stopped));
        assert_eq!(whole(arm.groups[0].pulses[0] / S_PULSES_PER_DEG * 100.0), 2100);
        assert!(!arm.is_moving());
    }

    #[test]
    fn a_soft_limit_ends_the_motion_at_the_limit() {
        let mut arm = arm();
        let mut to = [0.0; AXES];
        to[4] = 360_000.0;
        arm.joint(Now::ZERO, &[(0, to)], 1.0);
        let end = arm.motion_end().unwrap();
        assert_eq!(arm.advance(end), Some(End::Limit(0, 4)));
        assert_eq!(whole(arm.groups[0].pulses[4]), 180_000);
    }
}
