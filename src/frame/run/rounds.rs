//! Rounds of a repeated read.

use tokio::time::{Instant, timeout_at};

use super::print::as_value;
use crate::condition::Condition;
use crate::interrupt::interruptible;
use crate::prelude::basics::*;

/// Minimum time of each read, even if `--for` ends earlier. Otherwise a robot that answers at once could count as a
/// robot that does not answer.
const MIN_READ_TIME: Duration = Duration::from_millis(250);

/// Repetition options: `--watch`, `--count`, `--until`, `--for`.
#[derive(Debug, Default)]
pub struct Repeat {
    /// Interval from the start of a run to the start of the next run.
    pub every: Option<Duration>,
    /// Maximum number of runs.
    pub count: Option<u64>,
    /// Condition that ends the repetition.
    pub until: Option<Condition>,
    /// Condition that a command without repetition must meet.
    pub check: Option<Condition>,
    /// Maximum time to wait for the condition.
    pub within: Option<Duration>,
    /// Whether only the last round is printed.
    pub is_quiet: bool,
}

impl Repeat {
    /// Whether the user gave any of the options.
    pub fn is_wanted(&self) -> bool {
        self.every.is_some() || self.count.is_some() || self.until.is_some()
    }

    /// Whether a failure of a robot ends a wait. In the first round, any failure ends the wait. Later, a missing answer
    /// does not end the wait, because a robot that answered before may be unreachable for a while.
    pub fn ends_with(&self, failure: &Failure, is_first: bool) -> bool {
        self.is_quiet && !self.allows(failure) && (is_first || failure.kind != Kind::NoAnswer)
    }

    /// Whether the condition is about a robot that does not answer, so that this failure is allowed.
    pub fn allows(&self, failure: &Failure) -> bool {
        failure.kind == Kind::NoAnswer && self.until.as_ref().is_some_and(Condition::is_about_connection)
    }
}

/// End of `--for`. Each function that waits for a robot has a deadline as an argument, so that no wait lasts longer.
#[derive(Debug, Clone, Copy)]
pub struct Deadline(Option<(Instant, Duration)>);

impl Deadline {
    /// No deadline, for a command that runs once.
    pub const NONE: Self = Self(None);

    /// Result of `work` with a robot, or a missing answer when the time is over.
    pub async fn bound<T>(self, robot: &Robot, work: impl Future<Output = Result<T>>) -> Result<T> {
        let Some((end, within)) = self.0 else { return work.await };
        let end = end.max(Instant::now() + MIN_READ_TIME);
        timeout_at(end, work).await.unwrap_or_else(|_| {
            let (label, typed, within) = (robot.label(), robot.as_typed(), duration::display(within));
            Err(Failure::new(Kind::NoAnswer, format!("{label}: no answer within {within} (--for)"))
                .hint(format!("use a longer --for, or find the reason with `armctl robots check {typed}`")))
        })
    }

    /// Whether the time is over.
    fn is_over(self) -> bool {
        self.0.is_some_and(|(end, _)| Instant::now() >= end)
    }
}

/// Rounds of a watch, at fixed intervals that do not drift.
#[derive(Debug)]
pub struct Rounds<'a> {
    repeat: &'a Repeat,
    every: Duration,
    began: Instant,
    completed: u32,
}

impl<'a> Rounds<'a> {
    /// Creates the rounds. `every` is the default interval.
    pub fn new(repeat: &'a Repeat, every: Duration) -> Self {
        Self { repeat, every: repeat.every.unwrap_or(every), began: Instant::now(), completed: 0 }
    }

    /// End of `--for`.
    pub fn deadline(&self) -> Deadline {
        Deadline(self.repeat.within.map(|within| (self.began + within, within)))
    }

    /// Whether `--for` ended a later round before a robot answered. Such a round is no missing answer, because a robot
    /// that answered before might have answered with more time. A missing answer in the first round always counts.
    pub fn is_cut(&self, failure: &Failure) -> bool {
        !self.is_first() && failure.kind == Kind::NoAnswer && self.deadline().is_over()
    }

    pub fn is_first(&self) -> bool {
        self.completed == 0
    }

    /// Whether the condition of `--until` is true. In the first round, a note is printed if the condition can never be
    /// true.
    pub fn is_met(&self, value: &impl Serialize, screen: &Screen) -> Result<bool> {
        let Some(until) = &self.repeat.until else { return Ok(false) };
        let value = as_value(value)?;
        if until.is_met(&value)? {
            return Ok(true);
        }
        if self.is_first()
            && let Some(why) = until.check_keys(&value)
        {
            screen.note(&why);
        }
        Ok(false)
    }

    /// Whether this is the last round.
    pub fn is_last(&self) -> bool {
        let done = self.completed.saturating_add(1);
        self.repeat.count.is_some_and(|count| u64::from(done) >= count)
            || self.repeat.within.is_some_and(|within| self.every.saturating_mul(done) > within)
    }

    /// Waits for the next round. Returns `false` if there is no further round.
    pub async fn next(&mut self) -> Result<bool> {
        let is_over = self.is_last();
        self.completed = self.completed.saturating_add(1);
        let next = self.began + self.every.saturating_mul(self.completed);
        if !is_over {
            let rest = async {
                // Signals must be handled even without a pause between rounds.
                tokio::task::yield_now().await;
                tokio::time::sleep_until(next).await;
            };
            interruptible(rest).await?;
        }
        Ok(!is_over)
    }

    /// Result of the repetition after the last round.
    pub fn end(&self) -> Result<()> {
        let Some(until) = &self.repeat.until else { return Ok(()) };
        Err(Failure::new(Kind::ConditionNotMet, format!("the condition '{until}' was not met"))
            .hint("use `armctl status` to see the present state; --for sets a longer wait"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::{Sources, target};

    fn robot() -> Robot {
        let simulator = "sim:".parse::<target::Target>().unwrap();
        Sources::default().at(&simulator, Family::Yerc).unwrap()
    }

    fn repeat(within: Duration) -> Repeat {
        Repeat { within: Some(within), ..Repeat::default() }
    }

    async fn answer_after(time: Duration) -> Result<()> {
        tokio::time::sleep(time).await;
        Ok(())
    }

    #[tokio::test(start_paused = true)]
    async fn the_deadline_bounds_every_look() {
        let (robot, within) = (robot(), Duration::from_secs(1));
        let repeat = repeat(within);
        let mut rounds = Rounds::new(&repeat, Duration::from_millis(200));
        let silent = || std::future::pending::<Result<()>>();
        let failure = rounds.deadline().bound(&robot, silent()).await.unwrap_err();
        assert_eq!((failure.kind, rounds.began.elapsed()), (Kind::NoAnswer, within), "{failure}");
        assert!(!rounds.is_cut(&failure), "the robot never answered");
        // A read that begins just before the end has little time. If it fails, a robot that answered before may still
        // be reachable.
        rounds.completed = 1;
        rounds.deadline().bound(&robot, silent()).await.unwrap_err();
        assert_eq!(rounds.began.elapsed(), within + MIN_READ_TIME);
        assert!(rounds.is_cut(&failure));
        let answer = answer_after(MIN_READ_TIME / 2);
        assert_eq!(rounds.deadline().bound(&robot, answer).await, Ok(()));
    }

    #[tokio::test(start_paused = true)]
    async fn without_a_deadline_nothing_is_cut() {
        let hour = Duration::from_secs(3600);
        assert_eq!(Deadline::NONE.bound(&robot(), answer_after(hour)).await, Ok(()));
    }
}
