//! Data behind the metrics: the newest sample of each robot, and counters since the robot appeared.

use std::rc::Rc;

use super::page::labels;
use crate::command::fleet::also::AlsoCommand;
use crate::command::fleet::poll::{Event, PollResult, RobotId};
use crate::command::fleet::service::kind;
use armctl_frame::face::overview::OverviewReport;
use armctl_frame::face::sample::{Axis, Traffic};
use armctl_frame::prelude::*;

/// Upper limits of the histogram buckets for poll times, in seconds. Longer times are only in the last bucket (`+Inf`).
const RANGES: [f64; 9] = [0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5];

/// Data of all robots.
#[derive(Debug, Default)]
pub struct Board {
    /// Extra commands.
    pub also: Rc<[AlsoCommand]>,
    /// Polled robots by id.
    pub robots: BTreeMap<RobotId, RobotMetrics>,
    /// Whether the last changed inventory could not be read.
    pub is_inventory_broken: bool,
}

/// Data of one robot.
#[derive(Debug, Default)]
pub struct RobotMetrics {
    /// Encoded labels.
    pub labels: String,
    /// Encoded labels with the target and the place of the robot.
    pub info: String,
    /// Newest sample, while the robot answers.
    pub last_poll: Option<Arc<PollResult>>,
    /// Whether the robot has been polled yet.
    pub is_known: bool,
    /// Time of the last answer, in seconds since 1970.
    pub answered: Option<f64>,
    /// Number of polls.
    pub polls: u64,
    /// Failed polls by kind of failure.
    pub failures: BTreeMap<String, u64>,
    /// Polls omitted because the previous poll took too long.
    pub missed_polls: u64,
    /// Number of times that the backoff became longer.
    pub backoffs: u64,
    /// Current backoff; `None` while the robot answers.
    pub pause: Option<Duration>,
    /// Histogram of poll times.
    pub times: Times,
    /// Traffic on the link.
    pub traffic: Traffic,
}

/// Histogram of times.
#[derive(Debug, Default)]
pub struct Times {
    counts: [u64; RANGES.len()],
    /// Sum of all times in seconds.
    pub sum: f64,
    /// Number of times.
    pub count: u64,
}

impl Times {
    fn add(&mut self, time: Duration) {
        let seconds = time.as_secs_f64();
        for (count, up_to) in self.counts.iter_mut().zip(RANGES) {
            *count += u64::from(seconds <= up_to);
        }
        self.sum += seconds;
        self.count += 1;
    }

    /// Cumulative counts with their upper limits.
    pub fn buckets(&self) -> Vec<(f64, u64)> {
        RANGES.into_iter().zip(self.counts).collect()
    }
}

impl Board {
    /// Applies an event; `now` is in seconds since 1970.
    pub fn record_event(&mut self, event: &Event, now: f64) {
        match event {
            Event::Appeared(robot) => {
                let id = [("robot", robot.name.as_str()), ("family", robot.family.name())];
                let failures = ["no_answer", "refused", "malformed"].map(|kind| (kind.to_owned(), 0));
                let own = labels("", &id);
                let place = robot.place.levels().into_iter().filter_map(|(key, value)| Some((key, value?)));
                let info: Vec<(&str, &str)> = [("target", robot.target.value.url())].into_iter().chain(place).collect();
                let info = labels(&own, &info);
                let seen = RobotMetrics { labels: own, info, failures: failures.into(), ..RobotMetrics::default() };
                self.robots.insert(RobotId::for_robot(robot), seen);
            }
            Event::Gone(robot) => _ = self.robots.remove(&RobotId::for_robot(robot)),
            Event::Polled(look) => {
                let Some(seen) = self.robots.get_mut(&RobotId::for_robot(&look.robot)) else { return };
                seen.is_known = true;
                seen.polls += 1;
                seen.missed_polls += look.missed;
                seen.times.add(look.took);
                seen.traffic.add(look.traffic);
                seen.answered = Some(now);
                seen.pause = None;
                seen.last_poll = Some(Arc::clone(look));
            }
            Event::Failed { robot, failure, pause, traffic } => {
                let Some(seen) = self.robots.get_mut(&RobotId::for_robot(robot)) else { return };
                seen.is_known = true;
                seen.polls += 1;
                *seen.failures.entry(kind(failure)).or_default() += 1;
                seen.backoffs += u64::from(seen.pause.is_some_and(|last| *pause > last));
                seen.pause = Some(*pause);
                seen.traffic.add(*traffic);
                seen.last_poll = None;
            }
            Event::Inventory(read) => self.is_inventory_broken = read.is_err(),
        }
    }
}

impl RobotMetrics {
    /// Overview of the newest sample, if the robot is reachable.
    pub fn line(&self) -> Option<&OverviewReport> {
        self.last_poll.as_ref().map(|look| &look.sample.line).filter(|line| line.state.reachable)
    }

    /// Axes measured in `unit`, each with a unique label.
    pub fn axes(&self, unit: &str) -> Vec<(String, &Axis)> {
        let whole = self.last_poll.as_ref().and_then(|look| look.sample.full.as_ref());
        let mut named: Vec<(String, &Axis)> = Vec::new();
        for axis in whole.into_iter().flat_map(|whole| &whole.axes).filter(|axis| axis.unit == unit) {
            let mut name = axis.name.clone();
            // Axis names come from the controller. A duplicate label would make the whole page invalid.
            while named.iter().any(|(known, _)| *known == name) {
                name.push('\'');
            }
            named.push((name, axis));
        }
        named.into_iter().map(|(name, axis)| (labels(&self.labels, &[("axis", &name)]), axis)).collect()
    }
}
