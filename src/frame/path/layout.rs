//! Panels of a picture: planes of a space, or axes over time, with their ranges and lines.

use super::Plane;
use super::model::{Drawing, Interpolation, Motion};

/// Minimum height of a range, as a share of the greatest range of a space.
const MIN_SHARE: f64 = 0.12;
/// Space around the content of a range, as a share of the range.
const MARGIN: f64 = 0.06;

/// Lowest and highest value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    pub least: f64,
    pub most: f64,
}

/// What a panel shows in one direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Direction {
    /// Name with unit, such as `X (mm)`.
    pub label: String,
    /// Index of the axis; `None` for the time.
    pub axis: Option<usize>,
    pub range: Range,
    /// Whether all values are the same.
    pub is_constant: bool,
}

/// A part of a picture with its own coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Title, such as `XY`.
    pub title: String,
    pub x: Direction,
    pub y: Direction,
    pub traces: Vec<Trace>,
}

/// A motion in a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Whether this is the older motion.
    pub is_old: bool,
    pub strokes: Vec<Stroke>,
    /// Targets of the steps, each with the index of its step.
    pub targets: Vec<(usize, [f64; 2])>,
}

/// Connected lines of the same kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    pub interpolation: Interpolation,
    pub points: Vec<[f64; 2]>,
}

impl Range {
    /// Range of values; `None` without values.
    fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        values.fold(None, |range, value| {
            let Self { least, most } = range.unwrap_or(Self { least: value, most: value });
            Some(Self { least: least.min(value), most: most.max(value) })
        })
    }

    /// Length of the range.
    pub fn length(self) -> f64 {
        self.most - self.least
    }

    /// Range with at least this length, around the same middle.
    pub fn widened(self, length: f64) -> Self {
        let more = ((length - self.length()) / 2.0).max(0.0);
        Self { least: self.least - more, most: self.most + more }
    }

    /// Round values inside the range, at most about `count`.
    pub fn ticks(self, count: f64) -> Vec<f64> {
        let raw = self.length() / count.max(1.0);
        if !(raw.is_finite() && raw > 0.0) {
            return Vec::new();
        }
        let power = 10_f64.powf(raw.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|part| part * power).find(|step| *step >= raw * 0.999);
        let step = step.unwrap_or(raw);
        let mut ticks = Vec::new();
        let mut tick = (self.least / step).ceil() * step;
        while tick <= self.most + step * 1e-9 && ticks.len() < 100 {
            // A value near zero would be shown as -0.
            ticks.push(if tick.abs() < step * 1e-9 { 0.0 } else { tick });
            tick += step;
        }
        ticks
    }
}

/// Panels of a drawing: XY, XZ and YZ of a space, otherwise each axis over time.
pub fn panels(drawing: &Drawing) -> Vec<Panel> {
    let motion = &drawing.motion;
    if motion.has_space() {
        let ranges = [0, 1, 2].map(|axis| range(drawing, axis));
        let greatest = ranges.iter().map(|range| range.length()).fold(0.0, f64::max);
        // A motion without any length gets a space of one unit.
        let least = if greatest > 0.0 { greatest * MIN_SHARE } else { 1.0 };
        let direction = |axis: usize| {
            let wide = ranges[axis].widened(least);
            direction(drawing, Some(axis), wide.widened(wide.length() * (1.0 + 2.0 * MARGIN)))
        };
        let panel = |plane: Plane| {
            let (x, y) = plane.axes();
            let title = format!("{}{}", motion.axes[x], motion.axes[y]);
            panel(drawing, title, direction(x), direction(y))
        };
        return Plane::ALL.map(panel).into();
    }
    let time = Range::of(drawing.motions().flat_map(|(_, motion)| motion.moments().map(|moment| moment.time)));
    let time = time.unwrap_or(Range { least: 0.0, most: 1.0 });
    let time = if time.length() > 0.0 { time } else { time.widened(1.0) };
    let of_axis = |axis: usize| {
        let values = range(drawing, axis);
        let length = if values.length() > 0.0 { values.length() } else { 2.0 };
        let y = direction(drawing, Some(axis), values.widened(length * (1.0 + 2.0 * MARGIN)));
        panel(drawing, motion.axes[axis].to_owned(), direction(drawing, None, time), y)
    };
    (0..motion.axes.len()).map(of_axis).collect()
}

fn range(drawing: &Drawing, axis: usize) -> Range {
    let values = drawing.motions().flat_map(|(_, motion)| motion.moments());
    Range::of(values.filter_map(|moment| moment.at.get(axis).copied())).unwrap_or(Range { least: 0.0, most: 0.0 })
}

fn direction(drawing: &Drawing, axis: Option<usize>, range: Range) -> Direction {
    let motion = &drawing.motion;
    let label = match axis {
        Some(axis) => format!("{} ({})", motion.axes[axis], motion.unit),
        None if motion.is_timed => "time (s)".to_owned(),
        None => "step".to_owned(),
    };
    let is_constant = axis.is_some_and(|axis| self::range(drawing, axis).length() == 0.0);
    Direction { label, axis, range, is_constant }
}

fn panel(drawing: &Drawing, title: String, x: Direction, y: Direction) -> Panel {
    let traces = drawing.motions().map(|(is_old, motion)| trace(is_old, motion, x.axis, y.axis)).collect();
    Panel { title, x, y, traces }
}

fn trace(is_old: bool, motion: &Motion, x: Option<usize>, y: Option<usize>) -> Trace {
    let mut trace = Trace { is_old, strokes: Vec::new(), targets: Vec::new() };
    for (index, step) in motion.steps.iter().enumerate() {
        let places = step.track.iter().map(|moment| {
            let value =
                |axis: Option<usize>| axis.map_or(moment.time, |axis| moment.at.get(axis).copied().unwrap_or_default());
            [value(x), value(y)]
        });
        let points: Vec<[f64; 2]> = places.collect();
        trace.targets.extend(points.last().map(|target| (index, *target)));
        match trace.strokes.last_mut() {
            Some(last) if last.interpolation == step.interpolation && last.points.last() == points.first() => {
                last.points.extend(points.into_iter().skip(1));
            }
            _ => trace.strokes.push(Stroke { interpolation: step.interpolation, points }),
        }
    }
    trace
}
