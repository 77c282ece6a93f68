//! Motion of a program: steps with their positions over time, and what is not drawn.

use std::f64::consts::TAU;

use crate::prelude::basics::*;

/// Number of lines that an arc is drawn with.
const ARC_LINES: u32 = 32;
/// Maximum number of moments that [`simplify`] joins to one line.
const MAX_WINDOW: usize = 64;

/// How a motion gets to its target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// The path to this position is not known, because the position before is not known.
    Start,
    /// A straight line.
    Straight,
    /// An arc.
    Arc,
    /// A free curve. Only its points are known.
    Curve,
    /// Each axis moves by itself. The path is not a straight line.
    Joints,
    /// No motion: the points follow each other by their numbers.
    Order,
}

/// A position at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    /// Seconds from the start; number of the step if the times are not known.
    pub time: f64,
    /// Coordinates in the order of [`Motion::axes`].
    pub at: Vec<f64>,
}

/// A step that moves the robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Name of the target. Two programs are compared by these names.
    pub name: String,
    /// Line of the program, from 1; the number of the point if there is no program.
    pub line: usize,
    /// Text of the line.
    pub text: String,
    /// How the robot gets to the target.
    pub interpolation: Interpolation,
    /// Path with its start and its target; only the target if the start is not known.
    pub track: Vec<Moment>,
}

/// A line that is not in the picture.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct NotDrawn {
    /// Line of the program, from 1; the number of the point if there is no program.
    pub line: usize,
    /// Text of the line.
    pub text: String,
    /// Why the line is not drawn.
    pub reason: String,
}

/// The motion of a program.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Motion {
    /// Name of the program.
    pub program: String,
    /// Frame of the coordinates with its tool, such as `base, tool 1`; `joint` if there are only axes.
    pub frame: String,
    /// Names of the axes. In millimeters, the first three are X, Y and Z of a space.
    pub axes: Vec<&'static str>,
    /// Unit of the coordinates: `mm`, `pulses`.
    pub unit: &'static str,
    /// Whether the times are known.
    pub is_timed: bool,
    /// Whether these are points without a program.
    pub is_points: bool,
    /// Steps in the order of the motion.
    pub steps: Vec<Step>,
    /// Lines that are not drawn.
    pub not_drawn: Vec<NotDrawn>,
    /// What the picture assumes, one sentence each.
    pub notes: Vec<String>,
}

/// A motion, and the motion of an older program.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// The motion.
    pub motion: Motion,
    /// The older motion, if it has the same frame.
    pub old: Option<Motion>,
    /// Difference between the two.
    pub difference: Option<Difference>,
}

/// Difference between the positions of two programs.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Difference {
    /// Whether both programs have the same frame. Other positions cannot be compared.
    pub is_same_frame: bool,
    /// Number of positions of both programs.
    pub compared: usize,
    /// Names of the positions that differ.
    pub changed: Vec<String>,
    /// Names of the positions that only the new program has.
    pub added: Vec<String>,
    /// Names of the positions that only the old program has.
    pub removed: Vec<String>,
    /// Greatest distance between the old and the new position: in space for millimeters, of one axis otherwise.
    pub maximum: f64,
    /// Greatest difference of a rotation, or of any other axis beside X, Y and Z.
    pub maximum_rotation: f64,
    /// Unit of `maximum`.
    pub unit: &'static str,
}

impl Motion {
    /// Whether the coordinates have a space with the planes XY, XZ and YZ. Otherwise the axes are drawn over time.
    pub fn has_space(&self) -> bool {
        self.unit == "mm" && self.axes.len() >= 3
    }

    /// Name of a line: `line`, or `point` if there is no program.
    pub fn noun(&self) -> &'static str {
        if self.is_points { "point" } else { "line" }
    }

    /// Number of a step in the picture; of points, the number of the point.
    pub fn number(&self, index: usize) -> usize {
        self.steps.get(index).filter(|_| self.is_points).map_or(index + 1, |step| step.line)
    }

    /// All moments in order.
    pub fn moments(&self) -> impl Iterator<Item = &Moment> {
        self.steps.iter().flat_map(|step| &step.track)
    }

    /// Time of the last moment.
    pub fn end(&self) -> f64 {
        self.moments().last().map_or(0.0, |moment| moment.time)
    }

    /// Names of all positions. A name that appears again has its number: `C1 (2)`.
    fn positions(&self) -> BTreeMap<(&str, usize), &[f64]> {
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        let named = self.steps.iter().filter_map(|step| {
            let count = counts.entry(&step.name).or_default();
            *count += 1;
            Some(((step.name.as_str(), *count), step.target()?))
        });
        named.collect()
    }
}

impl Step {
    /// Coordinates of the target.
    pub fn target(&self) -> Option<&[f64]> {
        self.track.last().map(|moment| moment.at.as_slice())
    }
}

impl Drawing {
    /// A motion, compared with an older motion if there is one.
    pub fn new(motion: Motion, old: Option<Motion>) -> Self {
        let difference = old.as_ref().map(|old| Difference::between(old, &motion));
        let old = old.filter(|old| !old.steps.is_empty() && is_comparable(old, &motion));
        Self { motion, old, difference }
    }

    /// The older motion, and then the motion, which is drawn above it.
    pub fn motions(&self) -> impl Iterator<Item = (bool, &Motion)> {
        self.old.iter().map(|old| (true, old)).chain([(false, &self.motion)])
    }
}

fn is_comparable(old: &Motion, new: &Motion) -> bool {
    (old.unit, old.axes.len(), &old.frame) == (new.unit, new.axes.len(), &new.frame)
}

impl Difference {
    fn between(old: &Motion, new: &Motion) -> Self {
        let mut difference = Self {
            is_same_frame: is_comparable(old, new) || old.steps.is_empty() || new.steps.is_empty(),
            compared: 0,
            changed: Vec::new(),
            added: Vec::new(),
            removed: Vec::new(),
            maximum: 0.0,
            maximum_rotation: 0.0,
            unit: new.unit,
        };
        if !difference.is_same_frame {
            return difference;
        }
        let (before, after) = (old.positions(), new.positions());
        let text = |(name, count): &(&str, usize)| match count {
            1 => (*name).to_owned(),
            count => format!("{name} ({count})"),
        };
        for (name, target) in &after {
            let Some(was) = before.get(name) else {
                difference.added.push(text(name));
                continue;
            };
            difference.compared += 1;
            if was != target {
                difference.changed.push(text(name));
            }
            let parts: Vec<f64> = was.iter().zip(*target).map(|(old, new)| (new - old).abs()).collect();
            let (space, rest) = parts.split_at(if new.has_space() { 3 } else { 0 });
            let greatest = |parts: &[f64]| parts.iter().copied().fold(0.0, f64::max);
            let distance = space.iter().map(|part| part * part).sum::<f64>().sqrt();
            if new.has_space() {
                difference.maximum = difference.maximum.max(distance);
                difference.maximum_rotation = difference.maximum_rotation.max(greatest(rest));
            } else {
                difference.maximum = difference.maximum.max(greatest(rest));
            }
        }
        difference.removed = before.keys().filter(|name| !after.contains_key(*name)).map(text).collect();
        difference
    }
}

/// Builds a motion from targets, one after the other. The path begins anew where the position before is not known.
#[derive(Debug, Default)]
pub struct Recorder {
    steps: Vec<Step>,
    at: Option<Vec<f64>>,
    time: f64,
    /// Whether a duration is missing.
    has_gaps: bool,
}

impl Recorder {
    /// Adds a step. `via` are the points between the start and the target. `seconds` is computed from the length of the
    /// path in space, and is `None` if the duration is not known.
    pub fn go(&mut self, step: Step, via: &[Vec<f64>], target: Vec<f64>, seconds: impl Fn(&[Vec<f64>]) -> Option<f64>) {
        let Some(from) = self.at.replace(target.clone()) else {
            let track = vec![Moment { time: self.time, at: target }];
            self.steps.push(Step { interpolation: no_path(step.interpolation), track, ..step });
            return;
        };
        let mut points = vec![from];
        points.extend(via.iter().cloned());
        points.push(target);
        let duration = seconds(&points);
        self.has_gaps |= duration.is_none();
        let (began, total) = (self.time, length(&points));
        let mut done = 0.0;
        let mut track = Vec::with_capacity(points.len());
        for (index, at) in points.iter().enumerate() {
            done += index.checked_sub(1).map_or(0.0, |before| distance(&points[before], at));
            let share = if total > 0.0 {
                done / total
            } else if index == 0 {
                0.0
            } else {
                1.0
            };
            track.push(Moment { time: began + duration.unwrap_or_default() * share, at: at.clone() });
        }
        self.time = track.last().map_or(began, |moment| moment.time);
        self.steps.push(Step { track, ..step });
    }

    /// Lets time pass.
    pub fn wait(&mut self, seconds: f64) {
        self.time += seconds;
    }

    /// The position is not known from here on.
    pub fn lose_position(&mut self) {
        self.at = None;
    }

    /// Steps, and whether their times are known. Otherwise, each step takes the same time.
    pub fn finish(mut self) -> (Vec<Step>, bool) {
        let is_timed = !self.has_gaps && self.steps.iter().any(|step| step.track.len() > 1);
        if !is_timed {
            let mut number = 0.0;
            for step in &mut self.steps {
                let times = step.track.first().zip(step.track.last()).map(|(first, last)| (first.time, last.time));
                let (began, ended) = times.unwrap_or_default();
                let count = f64::from(u32::try_from(step.track.len().max(2) - 1).unwrap_or(u32::MAX));
                for (index, moment) in (0_u32..).zip(&mut step.track) {
                    let even = f64::from(index) / count;
                    let share = if ended > began { (moment.time - began) / (ended - began) } else { even };
                    moment.time = number + share;
                }
                number += 1.0;
                if let [moment] = &mut step.track[..] {
                    moment.time = number;
                }
            }
        }
        (self.steps, is_timed)
    }
}

/// Without a known start, a motion is only a point.
fn no_path(interpolation: Interpolation) -> Interpolation {
    if interpolation == Interpolation::Order { interpolation } else { Interpolation::Start }
}

/// Distance in the first three coordinates.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).take(3).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Length of a path in the first three coordinates.
pub fn length(points: &[Vec<f64>]) -> f64 {
    points.iter().zip(points.iter().skip(1)).map(|(a, b)| distance(a, b)).sum()
}

/// Points of an arc from `from` through `via` to `to`, without its ends. With `is_first`, only the part up to `via`,
/// otherwise only the part after `via`. Empty if the points lie on a line.
pub fn arc(from: &[f64], via: &[f64], to: &[f64], is_first: bool) -> Vec<Vec<f64>> {
    let minus = |a: &[f64], b: &[f64]| -> [f64; 3] { std::array::from_fn(|axis| a[axis] - b[axis]) };
    let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let cross =
        |a: &[f64; 3], b: &[f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    if from.len() < 3 || via.len() < 3 || to.len() < 3 {
        return Vec::new();
    }
    let (u, v) = (minus(via, from), minus(to, from));
    let normal = cross(&u, &v);
    let area = dot(&normal, &normal);
    if area.sqrt() < 1e-6 {
        return Vec::new();
    }
    let (uu, vv) = (dot(&u, &u), dot(&v, &v));
    let offset =
        cross(&std::array::from_fn(|axis| uu * v[axis] - vv * u[axis]), &normal).map(|part| part / (2.0 * area));
    let radius = dot(&offset, &offset).sqrt();
    let first = offset.map(|part| -part / radius);
    let second = cross(&normal.map(|part| part / area.sqrt()), &first);
    let angle = |place: &[f64; 3]| {
        let arm: [f64; 3] = std::array::from_fn(|axis| place[axis] - offset[axis]);
        dot(&arm, &second).atan2(dot(&arm, &first)).rem_euclid(TAU)
    };
    let (middle, end) = (angle(&u), angle(&v));
    let (start, stop, a, b) = if is_first { (0.0, middle, from, via) } else { (middle, end, via, to) };
    let point = |index: u32| {
        let share = f64::from(index) / f64::from(ARC_LINES);
        let (sin, cos) = (start + (stop - start) * share).sin_cos();
        let mut place: Vec<f64> = a.iter().zip(b).map(|(a, b)| a + (b - a) * share).collect();
        for axis in 0..3 {
            place[axis] = from[axis] + offset[axis] + radius * (cos * first[axis] + sin * second[axis]);
        }
        place
    };
    (1..ARC_LINES).map(point).collect()
}

/// Removes the moments that lie on the line between their neighbors, also in time, up to a deviation.
pub fn simplify(track: Vec<Moment>, deviation: f64) -> Vec<Moment> {
    let is_near = |from: &Moment, to: &Moment, between: &Moment| {
        let share = if to.time > from.time { (between.time - from.time) / (to.time - from.time) } else { 1.0 };
        let parts = from.at.iter().zip(&to.at).zip(&between.at);
        parts.into_iter().all(|((a, b), at)| (a + (b - a) * share - at).abs() <= deviation)
    };
    let mut kept: Vec<usize> = Vec::new();
    for index in 0..track.len() {
        let Some(last) = kept.last().copied() else {
            kept.push(index);
            continue;
        };
        let is_line = index - last <= MAX_WINDOW
            && track[last + 1..index].iter().all(|moment| is_near(&track[last], &track[index], moment));
        if !is_line {
            kept.push(index - 1);
        }
    }
    kept.extend(track.len().checked_sub(1).filter(|end| kept.last() != Some(end)));
    let mut kept = kept.into_iter().peekable();
    track
        .into_iter()
        .enumerate()
        .filter(|(index, _)| kept.next_if_eq(index).is_some())
        .map(|(_, moment)| moment)
        .collect()
}
