//! A read, over and over.

use std::time::Duration;

use serde::Serialize;
use tokio::time::Instant;

use super::print::as_value;
use crate::command::frame::condition::Condition;
use crate::command::frame::interrupt::interruptible;
use crate::failure::{Failure, Kind};
use crate::output::Screen;

/// `--watch`, `--count`, `--until`, `--for`.
#[derive(Debug, Default)]
pub struct Repeat {
    /// Pause from start to start.
    pub every: Option<Duration>,
    /// Most runs.
    pub count: Option<u64>,
    /// Stop when this holds.
    pub until: Option<Condition>,
    /// What must hold of a single run.
    pub check: Option<Condition>,
    /// Longest time to wait for the condition.
    pub within: Option<Duration>,
    /// Only the last round is shown.
    pub is_quiet: bool,
}

impl Repeat {
    /// Whether any of them was given.
    pub fn is_wanted(&self) -> bool {
        self.every.is_some() || self.count.is_some() || self.until.is_some()
    }
}

/// The rounds of a watch, from start to start without drift.
#[derive(Debug)]
pub struct Rounds<'a> {
    repeat: &'a Repeat,
    every: Duration,
    began: Instant,
    done: u32,
}

impl<'a> Rounds<'a> {
    /// `every` is the pause where none is given.
    pub fn new(repeat: &'a Repeat, every: Duration) -> Self {
        Self { repeat, every: repeat.every.unwrap_or(every), began: Instant::now(), done: 0 }
    }

    /// When --for runs out.
    pub fn deadline(&self) -> Option<Instant> {
        self.repeat.within.map(|within| self.began + within)
    }

    pub fn is_first(&self) -> bool {
        self.done == 0
    }

    /// Whether the condition holds. One that can never hold is told at the first look.
    pub fn is_met(&self, value: &impl Serialize, screen: &Screen) -> Result<bool, Failure> {
        let Some(until) = &self.repeat.until else { return Ok(false) };
        let value = as_value(value)?;
        if until.holds(&value)? {
            return Ok(true);
        }
        if self.is_first()
            && let Some(why) = until.never(&value)
        {
            screen.note(&why);
        }
        Ok(false)
    }

    /// Whether there is no round after this one.
    pub fn is_last(&self) -> bool {
        let done = self.done.saturating_add(1);
        self.repeat.count.is_some_and(|count| u64::from(done) >= count)
            || self.repeat.within.is_some_and(|within| self.every.saturating_mul(done) > within)
    }

    /// Waits for the next round; `false` when there is none.
    pub async fn next(&mut self) -> Result<bool, Failure> {
        let is_over = self.is_last();
        self.done = self.done.saturating_add(1);
        let next = self.began + self.every.saturating_mul(self.done);
        if !is_over {
            let rest = async {
                // Even where there is no time to rest, signals are heard.
                tokio::task::yield_now().await;
                tokio::time::sleep_until(next).await;
            };
            interruptible(rest).await?;
        }
        Ok(!is_over)
    }

    /// What it means that the rounds are over.
    pub fn end(&self) -> Result<(), Failure> {
        let Some(until) = &self.repeat.until else { return Ok(()) };
        Err(Failure::new(Kind::ConditionNotMet, format!("the condition '{until}' was not met"))
            .hint("--for sets how long to wait for it"))
    }
}
