//! History of an axis, for charts and bars.

use std::collections::VecDeque;
use std::time::Duration;

use super::model::Moment;
use armctl_frame::face::sample::Axis;

/// Limit of stored points.
const POINTS: usize = 600;
/// Time range of a chart in intervals, and its minimum.
const MAX_AGE: (u32, Duration) = (120, Duration::from_secs(30));

/// History of an axis. Times are in seconds since the view started.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    name: String,
    unit: &'static str,
    /// Positions with times, newest last.
    pub positions: VecDeque<(f64, f64)>,
    /// Torques with times, newest last.
    pub torques: VecDeque<(f64, f64)>,
    /// Smallest and largest position so far.
    pub range: (f64, f64),
}

impl Track {
    /// Empty history of an axis.
    pub fn new(axis: &Axis) -> Self {
        Self {
            name: axis.name.clone(),
            unit: axis.unit,
            positions: VecDeque::new(),
            torques: VecDeque::new(),
            range: (axis.position, axis.position),
        }
    }

    /// Whether the tracks belong to these axes.
    pub fn fit(tracks: &[Self], axes: &[Axis]) -> bool {
        let same = |(track, axis): (&Self, &Axis)| track.name == axis.name && track.unit == axis.unit;
        tracks.len() == axes.len() && tracks.iter().zip(axes).all(same)
    }

    /// Adds a point, and drops points that no chart shows any more.
    pub fn push(&mut self, now: Moment, every: Duration, axis: &Axis) {
        let (least, most) = self.range;
        self.range = (least.min(axis.position), most.max(axis.position));
        let now = now.as_secs_f64();
        self.positions.push_back((now, axis.position));
        self.torques.extend(axis.torque.map(|torque| (now, torque)));
        let start = now - window(every).as_secs_f64();
        for points in [&mut self.positions, &mut self.torques] {
            while points.len() > POINTS || points.front().is_some_and(|(then, _)| *then < start) {
                points.pop_front();
            }
        }
    }
}

/// Time range of a chart.
pub fn window(every: Duration) -> Duration {
    let (intervals, least) = MAX_AGE;
    every.saturating_mul(intervals).max(least)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(position: f64) -> Axis {
        Axis { name: "S".to_owned(), position, unit: "pulses", torque: Some(1.0), ..Axis::default() }
    }

    #[test]
    fn limits_history_by_time_and_number() {
        let every = Duration::from_millis(500);
        let mut track = Track::new(&axis(0.0));
        for look in 0..1000_u32 {
            track.push(every * look, every, &axis(f64::from(look)));
        }
        assert_eq!(track.positions.len(), 121);
        assert_eq!(track.torques.len(), 121);
        assert_eq!(track.range, (0.0, 999.0), "the range is that of all that was seen");
        let fast = Duration::from_millis(10);
        for look in 0..2000_u32 {
            track.push(every * 1000 + fast * look, fast, &axis(0.0));
        }
        assert_eq!(track.positions.len(), POINTS);
    }

    #[test]
    fn other_axes_start_a_new_track() {
        let tracks = [Track::new(&axis(0.0))];
        assert!(Track::fit(&tracks, &[axis(5.0)]));
        assert!(!Track::fit(&tracks, &[Axis { unit: "mm", ..axis(5.0) }]));
        assert!(!Track::fit(&tracks, &[]));
    }
}
