//! Motion of axes in closed form: ramps, lines and arcs.

use std::f64::consts::TAU;
use std::time::Duration;

use crate::Now;
use crate::simulator::run_options::{self, path_length};

/// Maximum number of axes.
pub(super) const AXES: usize = 4;
/// Number of axes in which a circle can lie.
const SPACE: usize = 3;
/// Minimum area in mm² of the parallelogram that three points form. Points with a smaller area lie on a line.
const FLAT: f64 = 1e-6;

/// Coordinates of all axes in mm.
pub(super) type Coordinates = [f64; AXES];

/// Path speed and ramps of a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Drive {
    /// Path speed in mm/s.
    pub(super) speed: f64,
    /// Acceleration time in seconds.
    pub(super) up: f64,
    /// Deceleration time in seconds.
    pub(super) down: f64,
}

/// Distance over time: up to three phases of constant acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Profile {
    phases: [Phase; 3],
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Phase {
    seconds: f64,
    from: f64,
    to: f64,
}

/// A path in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Path {
    /// A line. The distances of all axes grow in proportion.
    Line { from: Coordinates, to: Coordinates, length: f64 },
    /// An arc. Axes outside of the plane of the arc move in proportion to the path length.
    Arc(Arc),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Arc {
    from: Coordinates,
    to: Coordinates,
    center: Coordinates,
    pub(super) radius: f64,
    /// Unit vectors of the plane. The first vector points to the start.
    basis: [Coordinates; 2],
    angle: f64,
}

/// A move in progress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Segment {
    pub(super) owner: usize,
    pub(super) path: Path,
    /// Length of the skipped part of the path. The move starts after this part.
    skip: f64,
    pub(super) drive: Drive,
    profile: Profile,
    began: Now,
    /// End position. If the move was decelerated early, this position lies before the end of the path.
    end: Coordinates,
    /// Skipped length and start time, before a deceleration.
    start: (f64, Now),
}

impl Drive {
    fn deceleration(self) -> f64 {
        self.speed / self.down
    }
}

impl Profile {
    /// A profile that accelerates, runs at constant speed, and decelerates. A short path has the same accelerations and
    /// a lower speed.
    pub(super) fn trapezoid(length: f64, drive: Drive) -> Self {
        let ramps = drive.speed * (drive.up + drive.down) / 2.0;
        let share = if length < ramps { (length / ramps).sqrt() } else { 1.0 };
        let peak = drive.speed * share;
        Self {
            phases: [
                Phase { seconds: drive.up * share, from: 0.0, to: peak },
                Phase { seconds: ((length - ramps) / drive.speed).max(0.0), from: peak, to: peak },
                Phase { seconds: drive.down * share, from: peak, to: 0.0 },
            ],
        }
    }

    /// A profile that decelerates from a speed to rest.
    fn stop(speed: f64, deceleration: f64) -> Self {
        let rest = Phase { seconds: 0.0, from: 0.0, to: 0.0 };
        Self { phases: [rest, rest, Phase { seconds: speed / deceleration, from: speed, to: 0.0 }] }
    }

    pub(super) fn seconds(&self) -> f64 {
        self.phases.iter().map(|phase| phase.seconds).sum()
    }

    pub(super) fn length(&self) -> f64 {
        self.phases.iter().map(|phase| f64::midpoint(phase.from, phase.to) * phase.seconds).sum()
    }

    /// Distance and speed after a time.
    pub(super) fn at(&self, seconds: f64) -> (f64, f64) {
        let (mut left, mut distance) = (seconds.max(0.0), 0.0);
        for phase in &self.phases {
            let time = left.min(phase.seconds);
            let speed = if phase.seconds > 0.0 {
                phase.from + (phase.to - phase.from) * time / phase.seconds
            } else {
                phase.to
            };
            distance += f64::midpoint(phase.from, speed) * time;
            if left < phase.seconds {
                return (distance, speed);
            }
            left -= phase.seconds;
        }
        (distance, 0.0)
    }

    /// Seconds from the start of the profile to the start of the deceleration.
    fn steady(&self) -> f64 {
        self.phases[0].seconds + self.phases[1].seconds
    }
}

impl Path {
    /// A line. `length` is the distance of the axes that determine the speed.
    pub(super) fn line(from: Coordinates, to: Coordinates, length: f64) -> Self {
        Self::Line { from, to, length }
    }

    pub(super) fn length(&self) -> f64 {
        match self {
            Self::Line { length, .. } => *length,
            Self::Arc(arc) => arc.radius * arc.angle,
        }
    }

    pub(super) fn end(&self) -> Coordinates {
        match self {
            Self::Line { to, .. } => *to,
            Self::Arc(arc) => arc.to,
        }
    }

    /// Position after the given length of the path.
    pub(super) fn at(&self, distance: f64) -> Coordinates {
        let share = if self.length() > 0.0 { (distance / self.length()).clamp(0.0, 1.0) } else { 1.0 };
        match self {
            Self::Line { from, to, .. } => blend(from, to, share),
            Self::Arc(arc) => arc.at(share),
        }
    }

    /// Minimum and maximum coordinate of an axis on the path.
    pub(super) fn range(&self, axis: usize) -> (f64, f64) {
        match self {
            Self::Line { from, to, .. } => (from[axis].min(to[axis]), from[axis].max(to[axis])),
            Self::Arc(arc) => arc.range(axis),
        }
    }

    /// Maximum speed of an axis as a share of the path speed.
    pub(super) fn steepness(&self, axis: usize) -> f64 {
        match self {
            Self::Line { from, to, length } if *length > 0.0 => (to[axis] - from[axis]).abs() / length,
            Self::Line { .. } => 0.0,
            Self::Arc(arc) => {
                let along = (arc.to[axis] - arc.from[axis]).abs() / (arc.radius * arc.angle);
                if axis < SPACE { arc.extent(axis) / arc.radius } else { along }
            }
        }
    }
}

impl Arc {
    /// An arc through `via` to `to`; `None` if the points lie on a line.
    ///
    /// `round` contains the axes in which the circle lies: two or three axes.
    pub(super) fn through_points(
        from: Coordinates,
        via: Coordinates,
        to: Coordinates,
        round: &[usize],
    ) -> Option<Self> {
        let flat =
            |place: Coordinates| std::array::from_fn(|axis| if round.contains(&axis) { place[axis] } else { 0.0 });
        let (p0, p1, p2): (Coordinates, Coordinates, Coordinates) = (flat(from), flat(via), flat(to));
        let (a, b) = (minus(&p0, &p2), minus(&p1, &p2));
        let normal = cross(&a, &b);
        let area = dot(&normal, &normal);
        if area.sqrt() < FLAT {
            return None;
        }
        let (aa, bb) = (dot(&a, &a), dot(&b, &b));
        let center_offset = cross(&std::array::from_fn(|axis| aa * b[axis] - bb * a[axis]), &normal);
        let center: Coordinates = std::array::from_fn(|axis| p2[axis] + center_offset[axis] / (2.0 * area));
        let start_vector = minus(&p0, &center);
        let radius = dot(&start_vector, &start_vector).sqrt();
        // The plane is oriented so that the arc through the middle point turns in the positive direction.
        let axis = cross(&minus(&p1, &p0), &minus(&p2, &p1));
        let size = dot(&axis, &axis).sqrt();
        let first = start_vector.map(|part| part / radius);
        let second = cross(&axis.map(|part| part / size), &first);
        let last = minus(&p2, &center);
        let angle = dot(&last, &second).atan2(dot(&last, &first)).rem_euclid(TAU);
        Some(Self { from, to, center, radius, basis: [first, second], angle })
    }

    fn at(&self, share: f64) -> Coordinates {
        let (sin, cos) = (self.angle * share).sin_cos();
        let along = blend(&self.from, &self.to, share);
        std::array::from_fn(|axis| {
            if self.extent(axis) > 0.0 && share < 1.0 {
                self.center[axis] + self.radius * (cos * self.basis[0][axis] + sin * self.basis[1][axis])
            } else {
                along[axis]
            }
        })
    }

    /// Maximum distance from the center in the direction of an axis.
    fn extent(&self, axis: usize) -> f64 {
        self.radius * self.basis[0][axis].hypot(self.basis[1][axis])
    }

    fn range(&self, axis: usize) -> (f64, f64) {
        let (mut least, mut most) = (self.from[axis].min(self.to[axis]), self.from[axis].max(self.to[axis]));
        let top = self.basis[1][axis].atan2(self.basis[0][axis]).rem_euclid(TAU);
        if self.extent(axis) > 0.0 {
            if top < self.angle {
                most = most.max(self.center[axis] + self.extent(axis));
            }
            if (top + TAU / 2.0).rem_euclid(TAU) < self.angle {
                least = least.min(self.center[axis] - self.extent(axis));
            }
        }
        (least, most)
    }
}

impl Segment {
    /// A move that begins at time `began`, which may be in the future.
    pub(super) fn new(owner: usize, path: Path, skip: f64, drive: Drive, began: Now) -> Self {
        let profile = Profile::trapezoid((path.length() - skip).max(0.0), drive);
        Self { owner, path, skip, drive, profile, began, end: path.end(), start: (skip, began) }
    }

    pub(super) fn ends(&self) -> Now {
        self.began.saturating_add(duration(self.profile.seconds()))
    }

    /// Entry for the log of motions, if the move ends at `now`.
    pub(super) fn entry(&self, now: Now) -> run_options::Motion {
        let (skip, began) = self.start;
        let now = now.min(self.ends());
        let done = self.done(now);
        let to = self.path.at(done);
        run_options::Motion {
            group: if self.owner < AXES { format!("task {}", self.owner + 1) } else { "host".to_owned() },
            from: self.path.at(skip).into(),
            to: to.into(),
            unit: "mm",
            distance_mm: Some(path_length(|share| {
                let [x, y, z, _] = self.path.at(skip + (done - skip) * share);
                [x, y, z]
            })),
            began,
            took: now.saturating_sub(began),
            reached: now >= self.ends()
                && self.end.iter().zip(self.path.end()).all(|(end, aim)| end.total_cmp(&aim).is_eq()),
        }
    }

    /// Time during the deceleration at which `share` of the deceleration is left.
    pub(super) fn handover_time(&self, share: f64) -> Now {
        let ramp = self.profile.seconds() - self.profile.steady();
        self.began.saturating_add(duration(self.profile.seconds() - share * ramp))
    }

    /// Remaining displacement of each axis.
    pub(super) fn remaining_displacement(&self, now: Now) -> Coordinates {
        if now >= self.ends() {
            return [0.0; AXES];
        }
        minus(&self.path.at(self.done(now)), &self.end)
    }

    pub(super) const fn end(&self) -> Coordinates {
        self.end
    }

    /// Displacement of each axis from start to end.
    pub(super) fn displacement(&self) -> Coordinates {
        minus(&self.end, &self.path.at(self.skip))
    }

    /// Completed length of the path.
    pub(super) fn done(&self, now: Now) -> f64 {
        self.skip + self.distance(now)
    }

    /// Returns the move with a deceleration that starts now. A move that already decelerates stays unchanged.
    pub(super) fn braked(self, now: Now) -> Self {
        let (distance, speed) = self.profile.at(self.elapsed(now));
        if self.elapsed(now) >= self.profile.steady() {
            return self;
        }
        let profile = Profile::stop(speed, self.drive.deceleration());
        let skip = self.skip + distance;
        Self { skip, profile, began: now, end: self.path.at(skip + profile.length()), ..self }
    }

    /// Times at which the acceleration changes.
    pub(super) fn phase_times(&self) -> [Now; 4] {
        let [up, run, down] = self.profile.phases.map(|phase| phase.seconds);
        [0.0, up, up + run, up + run + down].map(|seconds| self.began.saturating_add(duration(seconds)))
    }

    pub(super) fn is_in_future(&self, now: Now) -> bool {
        now < self.began
    }

    fn distance(&self, now: Now) -> f64 {
        self.profile.at(self.elapsed(now)).0
    }

    fn elapsed(&self, now: Now) -> f64 {
        now.saturating_sub(self.began).as_secs_f64()
    }
}

/// Duration from seconds; zero if invalid.
pub(super) fn duration(seconds: f64) -> Duration {
    Duration::try_from_secs_f64(seconds).unwrap_or_default()
}

pub(super) fn plus(a: &Coordinates, b: &Coordinates) -> Coordinates {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

pub(super) fn minus(a: &Coordinates, b: &Coordinates) -> Coordinates {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn blend(from: &Coordinates, to: &Coordinates, share: f64) -> Coordinates {
    if share >= 1.0 { *to } else { std::array::from_fn(|axis| from[axis] + (to[axis] - from[axis]) * share) }
}

fn dot(a: &Coordinates, b: &Coordinates) -> f64 {
    (0..SPACE).map(|axis| a[axis] * b[axis]).sum()
}

fn cross(a: &Coordinates, b: &Coordinates) -> Coordinates {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], 0.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-9
    }

    const DRIVE: Drive = Drive { speed: 100.0, up: 0.2, down: 0.4 };

    #[test]
    fn a_long_move_has_a_trapezoid_profile() {
        // The ramp up takes 10 mm, the constant speed 170 mm, and the ramp down 20 mm.
        let profile = Profile::trapezoid(200.0, DRIVE);
        assert!(near(profile.seconds(), 0.2 + 1.7 + 0.4));
        assert!(near(profile.length(), 200.0));
        assert!(near(profile.at(0.1).0, 2.5) && near(profile.at(0.1).1, 50.0));
        assert!(near(profile.at(1.2).0, 110.0) && near(profile.at(1.2).1, 100.0));
        assert!(near(profile.at(2.1).0, 195.0) && near(profile.at(2.1).1, 50.0));
        assert!(near(profile.at(9.0).1, 0.0));
    }

    #[test]
    fn a_short_move_has_a_triangle_profile() {
        // The ramps would need 30 mm. The 7.5 mm are a quarter of this, so the speed and the times are half.
        let profile = Profile::trapezoid(7.5, DRIVE);
        assert!(near(profile.seconds(), 0.3));
        assert!(near(profile.at(0.1).1, 50.0));
        assert!(near(profile.length(), 7.5));
    }

    #[test]
    fn a_quarter_of_a_circle_keeps_its_radius() {
        let half = 50.0 * 2f64.sqrt();
        let arc = Arc::through_points([100.0, 0.0, 5.0, 0.0], [half, half, 0.0, 0.0], [0.0, 100.0, 15.0, 0.0], &[0, 1]);
        let arc = arc.unwrap();
        assert!(near(arc.radius, 100.0));
        let path = Path::Arc(arc);
        assert!(near(path.length(), 100.0 * TAU / 4.0));
        let middle = path.at(path.length() / 2.0);
        assert!(near(middle[0], half) && near(middle[1], half), "{middle:?}");
        assert!(near(middle[2], 10.0), "the axis outside the plane moves in proportion to the path");
        assert!(near(path.at(path.length())[1], 100.0));
        assert!(near(path.range(0).0, 0.0) && near(path.range(0).1, 100.0));
    }

    #[test]
    fn the_range_of_an_arc_exceeds_its_points() {
        // Three quarters of a circle around the origin, clockwise.
        let arc =
            Arc::through_points([0.0, 10.0, 0.0, 0.0], [10.0, 0.0, 0.0, 0.0], [-10.0, 0.0, 0.0, 0.0], &[0, 1]).unwrap();
        let path = Path::Arc(arc);
        assert!(near(path.length(), 10.0 * TAU * 0.75));
        assert!(near(path.range(1).0, -10.0));
        assert!(near(path.at(10.0 * TAU / 4.0)[0], 10.0), "it goes through the second point");
    }

    #[test]
    fn points_on_a_line_give_no_arc() {
        assert_eq!(Arc::through_points([0.0; 4], [1.0, 1.0, 0.0, 0.0], [2.0, 2.0, 0.0, 0.0], &[0, 1]), None);
    }

    #[test]
    fn a_braked_move_stops_before_its_end() {
        let path = Path::line([0.0; 4], [200.0, 0.0, 0.0, 0.0], 200.0);
        let segment = Segment::new(0, path, 0.0, DRIVE, Duration::from_secs(1));
        // After 0.7 s, the move has passed 10 mm of ramp and 50 mm at constant speed. The stop takes 20 mm and 0.4 s.
        let now = Duration::from_millis(1700);
        let braked = segment.braked(now);
        assert!(near(braked.end()[0], 80.0));
        assert_eq!(braked.ends(), Duration::from_millis(2100));
        assert!(near(braked.remaining_displacement(now)[0], -20.0));
        assert!(near(segment.remaining_displacement(now)[0], -140.0));
        assert_eq!(segment.handover_time(1.0), segment.phase_times()[2]);
    }
}
