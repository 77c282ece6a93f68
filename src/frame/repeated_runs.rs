//! Repeated runs and their statistics: `--repeat 20 --stats`.

use crate::prelude::basics::*;

/// Repetition of a run. Each run starts after the end of the run before it.
#[derive(Debug, Clone, Copy, clap::Args)]
pub struct Repeat {
    /// Run N times. Each run starts after the end of the previous run. Stop at the first failure
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub repeat: Option<u32>,
    /// Show the duration of the runs: minimum, median, 95th percentile, maximum
    #[arg(long, requires = "repeat")]
    pub stats: bool,
}

impl Repeat {
    /// A single run.
    pub const fn once() -> Self {
        Self { repeat: None, stats: false }
    }

    /// Number of runs.
    pub fn count(self) -> u32 {
        self.repeat.unwrap_or(1)
    }

    /// Text that follows the action in a confirmation: ` 20 times`.
    pub fn describe(self) -> String {
        self.repeat.map(|count| format!(" {count} times, one after the other")).unwrap_or_default()
    }
}

/// Progress of repeated runs.
#[derive(Debug)]
pub struct Runs {
    repeat: Repeat,
    times_ms: Vec<u64>,
}

impl Runs {
    /// Starts with no completed run.
    pub const fn new(repeat: Repeat) -> Self {
        Self { repeat, times_ms: Vec::new() }
    }

    /// Records the duration of a completed run.
    pub fn add(&mut self, elapsed_ms: u64) {
        self.times_ms.push(elapsed_ms);
    }

    /// Whether all runs have ended.
    pub fn is_complete(&self) -> bool {
        self.times_ms.len() >= usize::try_from(self.repeat.count()).unwrap_or(usize::MAX)
    }

    /// Duration of the last run.
    pub fn last_ms(&self) -> Option<u64> {
        self.times_ms.last().copied()
    }

    /// Text for the next run: `run 2 of 20`; `None` if the command runs only once.
    pub fn next(&self) -> Option<String> {
        self.repeat.repeat.map(|count| format!("run {} of {count}", self.times_ms.len() + 1))
    }

    /// Adds the number of completed runs to the failure that ended the runs.
    pub fn add_to_failure(&self, failure: Failure) -> Failure {
        let Some(run) = self.next() else { return failure };
        let duration =
            CycleTimes::new(&self.times_ms).map(|times| format!("; {}", times.format_line())).unwrap_or_default();
        let (done, why) = (self.times_ms.len(), failure.message.trim_end_matches('.'));
        Failure { message: format!("{run}: {why}; completed runs: {done}{duration}"), ..failure }
    }

    /// Statistics for the report.
    pub fn cycle(self) -> Cycle {
        let Self { repeat, times_ms } = self;
        if repeat.repeat.is_none() {
            return Cycle::default();
        }
        Cycle { cycle_times: CycleTimes::new(&times_ms), cycles: times_ms, with_stats: repeat.stats }
    }
}

/// Part of a report for repeated runs.
#[derive(Debug, Default, Serialize, JsonSchema)]
pub struct Cycle {
    /// Time of each run in ms; empty unless the command repeats.
    cycles: Vec<u64>,
    /// Statistics of these times; null unless there are several runs.
    cycle_times: Option<CycleTimes>,
    #[serde(skip)]
    with_stats: bool,
}

impl Cycle {
    /// Table rows for the statistics, if the user requested them.
    pub fn rows(&self) -> Vec<(&'static str, Cell)> {
        self.cycle_times.iter().filter(|_| self.with_stats).flat_map(CycleTimes::rows).collect()
    }
}

/// Statistics of the times of several runs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
struct CycleTimes {
    /// Number of completed runs.
    n: usize,
    min_ms: u64,
    /// Median.
    median_ms: u64,
    /// 95th percentile.
    p95_ms: u64,
    max_ms: u64,
}

impl CycleTimes {
    /// Statistics of the durations; `None` without runs.
    fn new(times_ms: &[u64]) -> Option<Self> {
        let mut sorted = times_ms.to_vec();
        sorted.sort_unstable();
        // Nearest-rank method for the percentile.
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

    fn format_line(&self) -> String {
        let Self { min_ms, median_ms, p95_ms, max_ms, .. } = self;
        format!("duration: minimum {min_ms} ms, median {median_ms}, 95 % within {p95_ms}, maximum {max_ms}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_measured_times() {
        let times = CycleTimes::new(&(1..=20).rev().collect::<Vec<_>>()).unwrap();
        assert_eq!((times.n, times.min_ms, times.median_ms, times.p95_ms, times.max_ms), (20, 1, 10, 19, 20));
        let one = CycleTimes::new(&[7]).unwrap();
        assert_eq!((one.min_ms, one.median_ms, one.p95_ms, one.max_ms), (7, 7, 7, 7));
        assert_eq!(CycleTimes::new(&[]), None);
    }

    #[test]
    fn failure_reports_the_completed_cycles() {
        let mut runs = Runs::new(Repeat { repeat: Some(20), stats: true });
        runs.add(5);
        runs.add(7);
        let failure = runs.add_to_failure(Failure::new(Kind::ConditionNotMet, "an alarm came up."));
        assert!(
            failure.message.starts_with("run 3 of 20: an alarm came up; completed runs: 2; duration: minimum 5 ms"),
            "{failure}"
        );
    }
}
