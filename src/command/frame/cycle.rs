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

/// What the runs took.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct CycleTimes {
    /// Runs that ended.
    n: usize,
    min_ms: u64,
    /// Half of them took no longer.
    median_ms: u64,
    /// 95 of 100 took no longer.
    p95_ms: u64,
    max_ms: u64,
    /// Each of them.
    times_ms: Vec<u64>,
}

impl CycleTimes {
    /// Of the times of runs; nothing where there was none.
    pub fn new(times_ms: &[u64]) -> Option<Self> {
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
            times_ms: times_ms.to_vec(),
        })
    }

    /// Rows of a report.
    pub fn rows(&self) -> Vec<(&'static str, Cell)> {
        vec![
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

/// The failure that ended repeated runs, with how many had ended before it.
pub fn ended_early(failure: Failure, repeat: Repeat, times_ms: &[u64]) -> Failure {
    let Some(count) = repeat.repeat else { return failure };
    let took = CycleTimes::new(times_ms).map(|times| format!("; {}", times.in_a_line())).unwrap_or_default();
    let (done, run) = (times_ms.len(), times_ms.len() + 1);
    let message =
        format!("run {run} of {count}: {}; {done} ended before it{took}", failure.message.trim_end_matches('.'));
    Failure { message, ..failure }
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
        let repeat = Repeat { repeat: Some(20), stats: true };
        let failure = ended_early(Failure::new(Kind::ConditionNotMet, "an alarm came up."), repeat, &[5, 7]);
        assert!(
            failure.message.starts_with("run 3 of 20: an alarm came up; 2 ended before it; they took 5 ms"),
            "{failure}"
        );
    }
}
