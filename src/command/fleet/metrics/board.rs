//! What is known of the robots, for whoever reads it as metrics: the latest look at each, and counts since it appeared.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use super::page::labels;
use crate::command::face::overview::OverviewReport;
use crate::command::face::sample::{Axis, Traffic};
use crate::command::fleet::poll::{Event, Look, RobotId};
use crate::command::fleet::service::kind;

/// The upper ends of the ranges that poll times are counted in, in seconds. One that is longer is in none of them.
const RANGES: [f64; 9] = [0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5];

/// All that is known.
#[derive(Debug, Default)]
pub struct Board {
    /// Those that are looked at, by name.
    pub robots: BTreeMap<RobotId, Seen>,
    /// Whether the inventory could be read when it had changed last.
    pub is_inventory_broken: bool,
}

/// What is known of a robot.
#[derive(Debug, Default)]
pub struct Seen {
    /// Its labels, as a page has them.
    pub labels: String,
    /// The latest look, as long as it answers.
    pub look: Option<Arc<Look>>,
    /// Whether anything is known of it yet.
    pub is_known: bool,
    /// When it answered last: seconds since 1970.
    pub answered: Option<f64>,
    /// Looks that were begun.
    pub polls: u64,
    /// Those that failed, by the class of the failure.
    pub failures: BTreeMap<String, u64>,
    /// Those that were left out, because the one before took too long.
    pub missed: u64,
    /// How often a pause was made longer.
    pub backoffs: u64,
    /// How long it is left alone; nothing while it answers.
    pub pause: Option<Duration>,
    /// How long looks took.
    pub times: Times,
    /// What went over its link.
    pub traffic: Traffic,
}

/// Counts of times, by range.
#[derive(Debug, Default)]
pub struct Times {
    counts: [u64; RANGES.len()],
    /// All times together, in seconds.
    pub sum: f64,
    /// How many.
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

    /// How many were no longer than each of some times.
    pub fn buckets(&self) -> Vec<(f64, u64)> {
        RANGES.into_iter().zip(self.counts).collect()
    }
}

impl Board {
    /// Takes what was told at a moment: seconds since 1970.
    pub fn take(&mut self, event: &Event, now: f64) {
        match event {
            Event::Appeared(robot) => {
                let id = [("robot", robot.name.as_str()), ("family", robot.family.name())];
                let failures = ["no_answer", "refused", "malformed"].map(|kind| (kind.to_owned(), 0));
                let seen = Seen { labels: labels("", &id), failures: failures.into(), ..Seen::default() };
                self.robots.insert(RobotId::of(robot), seen);
            }
            Event::Gone(robot) => _ = self.robots.remove(&RobotId::of(robot)),
            Event::Looked(look) => {
                let Some(seen) = self.robots.get_mut(&RobotId::of(&look.robot)) else { return };
                seen.is_known = true;
                seen.polls += 1;
                seen.missed += look.missed;
                seen.times.add(look.took);
                seen.traffic.add(look.traffic);
                seen.answered = Some(now);
                seen.pause = None;
                seen.look = Some(Arc::clone(look));
            }
            Event::Failed { robot, failure, pause, traffic } => {
                let Some(seen) = self.robots.get_mut(&RobotId::of(robot)) else { return };
                seen.is_known = true;
                seen.polls += 1;
                *seen.failures.entry(kind(failure)).or_default() += 1;
                seen.backoffs += u64::from(seen.pause.is_some_and(|last| *pause > last));
                seen.pause = Some(*pause);
                seen.traffic.add(*traffic);
                seen.look = None;
            }
            Event::Inventory(read) => self.is_inventory_broken = read.is_err(),
        }
    }
}

impl Seen {
    /// The line of the latest look, if it is there and tells how the robot is.
    pub fn line(&self) -> Option<&OverviewReport> {
        self.look.as_ref().map(|look| &look.sample.line).filter(|line| line.state.reachable)
    }

    /// The axes of the latest look that are measured in `unit`, each with a label that no other one has.
    pub fn axes(&self, unit: &str) -> Vec<(String, &Axis)> {
        let whole = self.look.as_ref().and_then(|look| look.sample.whole.as_ref());
        let mut named: Vec<(String, &Axis)> = Vec::new();
        for axis in whole.into_iter().flat_map(|whole| &whole.axes).filter(|axis| axis.unit == unit) {
            let mut name = axis.name.clone();
            // A controller names its axes as somebody has set it: twice the same would spoil the whole page.
            while named.iter().any(|(known, _)| *known == name) {
                name.push('\'');
            }
            named.push((name, axis));
        }
        named.into_iter().map(|(name, axis)| (labels(&self.labels, &[("axis", &name)]), axis)).collect()
    }
}
