//! Motion over time: speed ramps along consecutive path segments.

use std::collections::VecDeque;
use std::time::Duration;

use super::alarms::Fault;
use super::geometry::{Arm, FourValues, Geometry};
use crate::Now;
use crate::simulator::run_options::{self, path_length};

/// Seconds to full speed with an acceleration coefficient of 100 %.
const ACCELERATION_TIME: f64 = 0.2;
/// Seconds from full speed to rest after a stop.
const STOP_TIME: f64 = 0.1;

/// Speed over time. A distance is given as the time in seconds that it takes at full speed. A speed is a share of full
/// speed.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Profile {
    /// Acceleration, constant speed and deceleration.
    Ramp { way: f64, speed: f64, up: f64, down: f64 },
    /// Deceleration to rest. It begins at a position and with a speed.
    Brake { from: f64, speed: f64 },
    /// A pause.
    Rest { seconds: f64 },
}

impl Profile {
    /// A ramp to `share` of full speed. `accel` and `decel` are shares of the maximum acceleration and deceleration.
    fn ramp(way: f64, share: f64, accel: f64, decel: f64) -> Self {
        let (up, down) = (accel / ACCELERATION_TIME, decel / ACCELERATION_TIME);
        // On a short path, the motion must decelerate before it reaches `share`.
        let speed = share.min((2.0 * way * up * down / (up + down)).sqrt());
        if way > 0.0 && speed > 0.0 { Self::Ramp { way, speed, up, down } } else { Self::Rest { seconds: 0.0 } }
    }

    fn seconds(&self) -> f64 {
        match *self {
            Self::Ramp { way, speed, up, down } => way / speed + speed / (2.0 * up) + speed / (2.0 * down),
            Self::Brake { speed, .. } => speed * STOP_TIME,
            Self::Rest { seconds } => seconds,
        }
    }

    /// Distance and speed after `seconds`.
    fn at(&self, seconds: f64) -> (f64, f64) {
        match *self {
            Self::Ramp { way, speed, up, down } => {
                let left = self.seconds() - seconds;
                if seconds < speed / up {
                    (up * seconds * seconds / 2.0, up * seconds)
                } else if left < speed / down {
                    (way - down * left * left / 2.0, down * left)
                } else {
                    (speed * (seconds - speed / (2.0 * up)), speed)
                }
            }
            Self::Brake { from, speed } => {
                (from + speed * seconds - seconds * seconds / (2.0 * STOP_TIME), speed - seconds / STOP_TIME)
            }
            Self::Rest { .. } => (0.0, 0.0),
        }
    }
}

/// A path between two positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Path {
    /// Joint interpolation: all axes start and end at the same time.
    Joint { from: FourValues, to: FourValues },
    /// A straight line of the tool.
    Line { from: FourValues, to: FourValues, arm: Arm },
    /// An arc of the tool about `centre`, from `first` toward `second`.
    Arc { from: FourValues, to: FourValues, centre: [f64; 3], first: [f64; 3], second: [f64; 3], angle: f64, arm: Arm },
}

impl Path {
    /// Pulses after a share of the path; `None` if the robot cannot reach the position.
    pub(super) fn at(&self, share: f64, geometry: &Geometry) -> Option<FourValues> {
        let between =
            |from: &FourValues, to: &FourValues| std::array::from_fn(|at| from[at] + (to[at] - from[at]) * share);
        match self {
            Self::Joint { from, to } => Some(between(from, to)),
            Self::Line { from, to, arm } => geometry.pulses(&between(from, to), *arm),
            Self::Arc { from, to, centre, first, second, angle, arm } => {
                let (sin, cos) = (angle * share).sin_cos();
                let place: [f64; 3] = std::array::from_fn(|at| centre[at] + cos * first[at] + sin * second[at]);
                let r = from[3] + (to[3] - from[3]) * share;
                geometry.pulses(&[place[0], place[1], place[2], r], *arm)
            }
        }
    }

    /// An arc through `via`; `None` if the three points are on a line.
    pub(super) fn arc(from: &FourValues, via: &FourValues, to: &FourValues, arm: Arm) -> Option<(Self, f64)> {
        let minus = |a: &[f64; 3], b: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|at| a[at] - b[at]) };
        let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let cross = |a: &[f64; 3], b: &[f64; 3]| -> [f64; 3] {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let place = |pose: &FourValues| [pose[0], pose[1], pose[2]];
        let (a, b) = (minus(&place(via), &place(from)), minus(&place(to), &place(from)));
        let normal = cross(&a, &b);
        let square = dot(&normal, &normal);
        if square < 1e-9 {
            return None;
        }
        let (to_a, to_b) = (dot(&a, &a), dot(&b, &b));
        let (u, v) = (cross(&b, &normal), cross(&normal, &a));
        let offset: [f64; 3] = std::array::from_fn(|at| (u[at] * to_a + v[at] * to_b) / (2.0 * square));
        let centre = std::array::from_fn(|at| from[at] + offset[at]);
        let first: [f64; 3] = offset.map(|part| -part);
        let along = cross(&normal, &first);
        let second: [f64; 3] = along.map(|part| part / square.sqrt());
        let end = minus(&place(to), &centre);
        let turn = dot(&end, &second).atan2(dot(&end, &first));
        let angle = if turn <= 0.0 { turn + std::f64::consts::TAU } else { turn };
        let radius = dot(&first, &first).sqrt();
        Some((Self::Arc { from: *from, to: *to, centre, first, second, angle, arm }, angle * radius))
    }
}

/// What started a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Owner {
    /// The remote command.
    Remote,
    /// A dedicated input.
    Input,
    /// A task, 1 to 16.
    Task(u8),
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum End {
    /// The target was reached.
    Arrived,
    /// The axis has pushed for the requested time.
    Pushed,
    /// The motion ended early, or at a limit.
    Stopped(Fault),
}

/// A path segment with its speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Leg {
    path: Path,
    profile: Profile,
}

impl Leg {
    /// A path that takes `way` seconds at full speed. The motion uses `share` of full speed.
    pub(super) fn new(path: Path, way: f64, share: f64, accel: f64, decel: f64) -> Self {
        Self { path, profile: Profile::ramp(way, share, accel, decel) }
    }

    /// A pause at a position.
    pub(super) fn rest(at: FourValues, time: Duration) -> Self {
        Self { path: Path::Joint { from: at, to: at }, profile: Profile::Rest { seconds: time.as_secs_f64() } }
    }

    fn time(&self) -> Duration {
        Duration::try_from_secs_f64(self.profile.seconds()).unwrap_or(Duration::MAX)
    }

    /// Completed share of the path, for a completed distance `way`.
    fn share(&self, way: f64) -> f64 {
        match self.profile {
            Profile::Ramp { way: all, .. } => (way / all).clamp(0.0, 1.0),
            _ => 1.0,
        }
    }

    /// Length of this share of the path of the tool, in mm.
    fn length_mm(&self, share: f64, geometry: &Geometry) -> f64 {
        path_length(|part| {
            let pulses = self.path.at(part * share, geometry).unwrap_or_default();
            let [x, y, z, _] = geometry.pose(&pulses);
            [x, y, z]
        })
    }
}

/// A running motion.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    pub(super) owner: Owner,
    geometry: Geometry,
    legs: VecDeque<Leg>,
    began: Now,
    /// Reason for a stop, and the deceleration from the position where the stop began.
    stop: Option<(Fault, Profile)>,
    end: End,
    /// Time and position at the start.
    start: (Now, FourValues),
    /// Length of the completed segments in mm, and the completed share of the current segment.
    done: (f64, f64),
    /// Time of the last position.
    now: Now,
}

impl Motion {
    /// Starts a motion now. When the path is complete, the motion ends with `end`.
    pub(super) fn new(owner: Owner, geometry: Geometry, legs: Vec<Leg>, end: End, now: Now) -> Self {
        let from = legs.first().and_then(|leg| leg.path.at(0.0, &geometry)).unwrap_or_default();
        let (start, done) = ((now, from), (0.0, 0.0));
        Self { owner, geometry, legs: legs.into(), began: now, stop: None, end, start, done, now }
    }

    /// Entry for the log of motions, at the last position `to` in pulses. `number` is the index of the robot.
    pub(super) fn entry(&self, number: usize, axes: usize, to: &FourValues, reached: bool) -> run_options::Motion {
        let (length, share) = self.done;
        let length = length + self.legs.front().map_or(0.0, |leg| leg.length_mm(share, &self.geometry));
        let (began, from) = &self.start;
        let pose = |pulses: &FourValues| self.geometry.pose(pulses).into_iter().take(axes).collect();
        run_options::Motion {
            group: format!("robot {}", number + 1),
            from: pose(from),
            to: pose(to),
            unit: "mm",
            distance_mm: Some(length),
            began: *began,
            took: self.now.saturating_sub(*began),
            reached,
        }
    }

    /// Time at which the current segment ends.
    pub(super) fn due(&self) -> Now {
        let time = match (&self.stop, self.legs.front()) {
            (Some((_, brake)), _) => Duration::from_secs_f64(brake.seconds()),
            (None, Some(leg)) => leg.time(),
            (None, None) => Duration::ZERO,
        };
        self.began.saturating_add(time)
    }

    /// Starts to decelerate. If this function is called again, the first reason counts.
    pub(super) fn stop(&mut self, now: Now, fault: Fault) {
        let Some(leg) = self.legs.front() else { return };
        if self.stop.is_none() {
            let seconds = now.saturating_sub(self.began).as_secs_f64().min(leg.profile.seconds());
            let (from, speed) = leg.profile.at(seconds);
            self.stop = Some((fault, Profile::Brake { from, speed: speed.max(0.0) }));
            self.began = now;
        }
    }

    /// Advances to a time. Returns the position, and how the motion ended if it has ended.
    pub(super) fn advance(&mut self, now: Now) -> (Option<FourValues>, Option<End>) {
        let mut place = None;
        loop {
            let due = self.due();
            let over = now >= due;
            let Some(leg) = self.legs.front() else { return (place, Some(self.end.clone())) };
            let seconds = now.min(due).saturating_sub(self.began).as_secs_f64();
            let way = match &self.stop {
                Some((_, brake)) => brake.at(seconds).0,
                None => leg.profile.at(seconds).0,
            };
            let share = if over && self.stop.is_none() { 1.0 } else { leg.share(way) };
            (self.now, self.done.1) = (now.min(due), share);
            place = leg.path.at(share, &self.geometry).or(place);
            match &self.stop {
                _ if !over => return (place, None),
                Some((fault, _)) => return (place, Some(End::Stopped(fault.clone()))),
                None => {
                    self.done = (self.done.0 + leg.length_mm(1.0, &self.geometry), 0.0);
                    self.legs.pop_front();
                    self.began = due;
                }
            }
        }
    }

    /// Direction of each axis in the current segment. The sign is also the sign of the torque.
    pub(super) fn direction(&self) -> FourValues {
        let ends = self
            .legs
            .front()
            .and_then(|leg| Some((leg.path.at(0.0, &self.geometry)?, leg.path.at(1.0, &self.geometry)?)));
        ends.map_or([0.0; 4], |(from, to)| std::array::from_fn(|axis| to[axis] - from[axis]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yrcx::simulator::geometry::Kind;

    const GEOMETRY: Geometry = Geometry { kind: Kind::Cartesian, per_unit: [1.0; 4], hand: None };

    fn to(target: f64, way: f64, share: f64) -> Motion {
        let path = Path::Joint { from: [0.0; 4], to: [target, 0.0, 0.0, 0.0] };
        Motion::new(Owner::Remote, GEOMETRY, vec![Leg::new(path, way, share, 1.0, 1.0)], End::Arrived, Now::ZERO)
    }

    #[test]
    fn ramps_take_their_time() {
        // The distance takes one second at full speed. Each of the two ramps of 0.2 s adds half of its time.
        let mut motion = to(1000.0, 1.0, 1.0);
        assert_eq!(motion.due(), Duration::from_millis(1200));
        let mut last = -1.0;
        for ms in (0..1200).step_by(5) {
            let (place, end) = motion.advance(Duration::from_millis(ms));
            let x = place.unwrap()[0];
            assert!(x > last && x < 1000.0 && end.is_none(), "{ms} {x}");
            last = x;
        }
        assert_eq!(motion.advance(Duration::from_millis(1200)), (Some([1000.0, 0.0, 0.0, 0.0]), Some(End::Arrived)));
        // At a tenth of full speed, the distance takes ten times as long.
        assert_eq!(to(1.0, 1.0, 0.1).due(), Duration::from_millis(10_020));
        // The distance is too short for full speed.
        assert!(to(1.0, 0.05, 1.0).due() < Duration::from_millis(250));
        assert_eq!(to(0.0, 0.0, 1.0).due(), Now::ZERO);
    }

    #[test]
    fn a_stop_brakes_on_the_way() {
        let mut motion = to(1000.0, 1.0, 1.0);
        let before = motion.advance(Duration::from_millis(600)).0.unwrap()[0];
        motion.stop(Duration::from_millis(600), Fault::stopped());
        motion.stop(Duration::from_millis(650), Fault::emergency());
        assert_eq!(motion.due(), Duration::from_millis(700));
        let (place, end) = motion.advance(Duration::from_millis(700));
        assert!((place.unwrap()[0] - before - 50.0).abs() < 1e-6);
        assert_eq!(end, Some(End::Stopped(Fault::stopped())));
    }

    #[test]
    fn arcs_go_through_their_middle_point() {
        let (from, via, to) = ([10.0, 0.0, 0.0, 0.0], [0.0, 10.0, 0.0, 0.0], [0.0, -10.0, 0.0, 90.0]);
        let (arc, length) = Path::arc(&from, &via, &to, Arm::Right).unwrap();
        assert!((length - 15.0 * std::f64::consts::PI).abs() < 1e-9);
        let near = |share: f64, wanted: [f64; 4]| {
            arc.at(share, &GEOMETRY).unwrap().iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-9)
        };
        assert!(near(0.0, from) && near(1.0 / 3.0, [0.0, 10.0, 0.0, 30.0]) && near(1.0, to));
        assert_eq!(Path::arc(&from, &from, &to, Arm::Right), None);
    }
}
