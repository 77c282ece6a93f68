//! Repeated runs and what they took: `--repeat 20 --stats`.

use schemars::JsonSchema;
use serde::Serialize;

use crate::failure::Failure;
use crate::output::view::Cell;

/// How often something is run, one run after the end of the one before.
#[derive(Debug, Clone, Copy, clap::Args)]
pub struct Repeat {
    /// Run it N times, each after the end of the one before; the first failure ends it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub repeat: Option<u32>,
    /// Show how long the runs took: minimum, median, 95th percentile, maximum
    #[arg(long, requires = "repeat")]
    pub stats: bool,
}

impl Repeat {
    /// Of what is not repeated.
    pub const fn once() -> Self {
        Self { repeat: None, stats: false }
    }

    /// How many runs.
    pub fn count(self) -> u32 {
        self.repeat.unwrap_or(1)
    }

    /// What a question says behind what is started: ` 20 times`.
    pub fn in_words(self) -> String {
        self.repeat.map(|count| format!(" {count} times, one after the other")).unwrap_or_default()
    }
}

/// Repeated runs, as one ends after the other.
#[derive(Debug)]
pub struct Runs {
    repeat: Repeat,
    times_ms: Vec<u64>,
}

impl Runs {
    /// None has ended yet.
    pub const fn new(repeat: Repeat) -> Self {
        Self { repeat, times_ms: Vec::new() }
    }

    /// One has ended, after so long.
    pub fn ended(&mut self, elapsed_ms: u64) {
        self.times_ms.push(elapsed_ms);
    }

    /// Whether as many as are wanted have ended.
    pub fn are_over(&self) -> bool {
        self.times_ms.len() >= usize::try_from(self.repeat.count()).unwrap_or(usize::MAX)
    }

    /// How long the last one took.
    pub fn last_ms(&self) -> Option<u64> {
        self.times_ms.last().copied()
    }

    /// How the one that is next is told while it runs: `run 2 of 20`; nothing where it is the only one.
    pub fn next(&self) -> Option<String> {
        self.repeat.repeat.map(|count| format!("run {} of {count}", self.times_ms.len() + 1))
    }

    /// The failure that ends them, with how many had ended before it.
    pub fn early(&self, failure: Failure) -> Failure {
        let Some(run) = self.next() else { return failure };
        let took = CycleTimes::new(&self.times_ms).map(|times| format!("; {}", times.in_a_line())).unwrap_or_default();
        let (done, why) = (self.times_ms.len(), failure.message.trim_end_matches('.'));
        Failure { message: format!("{run}: {why}; {done} ended before it{took}"), ..failure }
    }

    /// What a report says of them.
    pub fn cycle(self) -> Cycle {
        let Self { repeat, times_ms } = self;
        if repeat.repeat.is_none() {
            return Cycle::default();
        }
        Cycle { cycle_times: CycleTimes::new(&times_ms), cycles: times_ms, with_stats: repeat.stats }
    }
}

/// The part of a report about repeated runs.
#[derive(Debug, Default, Serialize, JsonSchema)]
pub struct Cycle {
    /// Time of each of several runs in ms; empty unless the command repeats.
    cycles: Vec<u64>,
    /// Statistics of these times; null unless there are several.
    cycle_times: Option<CycleTimes>,
    #[serde(skip)]
    with_stats: bool,
}

impl Cycle {
    /// Its rows, if they are wanted.
    pub fn rows(&self) -> Vec<(&'static str, Cell)> {
        self.cycle_times.iter().filter(|_| self.with_stats).flat_map(CycleTimes::rows).collect()
    }
}

/// Statistics of the times of runs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
struct CycleTimes {
    /// Runs that ended.
    n: usize,
    min_ms: u64,
    /// Half of them took no longer.
    median_ms: u64,
    /// 95 of 100 took no longer.
    p95_ms: u64,
    max_ms: u64,
}

impl CycleTimes {
    /// Of the times of runs; nothing where there was none.
    fn new(times_ms: &[u64]) -> Option<Self> {
        let mut sorted = times_ms.to_vec();
        sorted.sort_unstable();
        // The smallest time that so many of a hundred runs do not exceed.
        let share = |percent: usize| sorted.get((sorted.len() * percent).div_ceil(100).saturating_sub(1)).copied();
        Some(Self {
            n: sorted.len(),
            min_ms: *sorted.first()?,
            median_ms: share(50)?,
            p95_ms: share(95)?,
            max_ms: *sorted.last()?,
        })
    }

    fn rows(&self) -> [(&'static str, Cell); 5] {
        [
            ("runs", self.n.into()),
            ("minimum (ms)", self.min_ms.into()),
            ("median (ms)", self.median_ms.into()),
            ("95 % within (ms)", self.p95_ms.into()),
            ("maximum (ms)", self.max_ms.into()),
        ]
    }

    fn in_a_line(&self) -> String {
        let Self { min_ms, median_ms, p95_ms, max_ms, .. } = self;
        format!("they took {min_ms} ms at least, {median_ms} in the middle, {p95_ms} for 95 %, {max_ms} at most")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failure::Kind;

    #[test]
    fn shares_are_times_that_were_measured() {
        let times = CycleTimes::new(&(1..=20).rev().collect::<Vec<_>>()).unwrap();
        assert_eq!((times.n, times.min_ms, times.median_ms, times.p95_ms, times.max_ms), (20, 1, 10, 19, 20));
        let one = CycleTimes::new(&[7]).unwrap();
        assert_eq!((one.min_ms, one.median_ms, one.p95_ms, one.max_ms), (7, 7, 7, 7));
        assert_eq!(CycleTimes::new(&[]), None);
    }

    #[test]
    fn a_failure_tells_the_runs_before_it() {
        let mut runs = Runs::new(Repeat { repeat: Some(20), stats: true });
        runs.ended(5);
        runs.ended(7);
        let failure = runs.early(Failure::new(Kind::ConditionNotMet, "an alarm came up."));
        assert!(
            failure.message.starts_with("run 3 of 20: an alarm came up; 2 ended before it; they took 5 ms"),
            "{failure}"
        );
    }
}
