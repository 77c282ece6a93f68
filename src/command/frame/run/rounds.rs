//! Repeated reads.

use std::time::Duration;

use serde::Serialize;
use tokio::time::Instant;

use super::print::as_value;
use crate::command::frame::condition::Condition;
use crate::command::frame::interrupt::interruptible;
use crate::failure::{Failure, Kind};
use crate::output::Screen;

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

    /// Whether a failure of a robot ends a wait. Any failure in the first round does. Later, a missing answer does not
    /// end the wait, because a robot that answered before may be unreachable for a while.
    pub fn ends_with(&self, failure: &Failure, is_first: bool) -> bool {
        self.is_quiet && !self.allows(failure) && (is_first || failure.kind != Kind::NoAnswer)
    }

    /// Whether the condition is about a robot that does not answer, so that this failure is allowed.
    pub fn allows(&self, failure: &Failure) -> bool {
        failure.kind == Kind::NoAnswer && self.until.as_ref().is_some_and(Condition::is_about_connection)
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

    /// Deadline of `--for`.
    pub fn deadline(&self) -> Option<Instant> {
        self.repeat.within.map(|within| self.began + within)
    }

    pub fn is_first(&self) -> bool {
        self.completed == 0
    }

    /// Whether the condition is true. A condition that can never be true is reported in the first round.
    pub fn is_met(&self, value: &impl Serialize, screen: &Screen) -> Result<bool, Failure> {
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
    pub async fn next(&mut self) -> Result<bool, Failure> {
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
    pub fn end(&self) -> Result<(), Failure> {
        let Some(until) = &self.repeat.until else { return Ok(()) };
        Err(Failure::new(Kind::ConditionNotMet, format!("the condition '{until}' was not met"))
            .hint("use --for to set a longer wait"))
    }
}
