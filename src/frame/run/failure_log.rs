//! Failures of a watch. Repeated failures are limited.

use std::time::Instant;

use super::Run;
use super::print::with_robot_name;
use crate::output::log::Level;
use crate::prelude::basics::*;
use crate::repeat_limiter::{Line, RepeatLimiter};

/// Missing answers of a robot that is watched.
pub(super) struct FailureLog<'a> {
    run: &'a Run,
    robot: &'a Robot,
    repeats: RepeatLimiter,
    last: Option<Failure>,
}

impl<'a> FailureLog<'a> {
    pub fn new(run: &'a Run, robot: &'a Robot) -> Self {
        Self { run, robot, repeats: RepeatLimiter::default(), last: None }
    }

    /// Reports a missing answer, unless it was already reported often.
    pub fn report(&mut self, failure: &Failure) {
        let failures = self.limit(failure);
        self.print(failures);
    }

    /// Failures to report now: this failure, unless it was already reported often, and the counts that are due.
    pub fn limit(&mut self, failure: &Failure) -> Vec<Failure> {
        let line = Line::new(Level::Warning, &failure.message, &[("robot", &self.robot.name)]);
        self.last = Some(failure.clone());
        let lines = self.repeats.lines(line, Instant::now());
        self.failures(lines)
    }

    /// Reports the number of missing answers when the robot answers again or the watch ends.
    pub fn end(&mut self) {
        let lines = self.repeats.due(Instant::now(), true);
        let failures = self.failures(lines);
        self.print(failures);
        self.repeats = RepeatLimiter::default();
    }

    fn failures(&self, lines: Vec<Line>) -> Vec<Failure> {
        let failure = |line: Line| Some(Failure { message: line.text, ..self.last.clone()? });
        lines.into_iter().filter_map(failure).collect()
    }

    fn print(&self, failures: Vec<Failure>) {
        for failure in failures {
            self.run.screen.failure(&with_robot_label(self.run, self.robot, failure));
            self.run.redraw.forget();
        }
    }
}

/// Failure with the name of its robot, if several robots are watched.
fn with_robot_label(run: &Run, robot: &Robot, failure: Failure) -> Failure {
    if run.sources.selection.is_plural() { with_robot_name(robot, failure) } else { failure }
}

/// What a watch of several robots has printed in the rounds so far.
pub(super) struct RoundFailures<'a> {
    /// Failures of each robot, in the order of the robots.
    silences: Vec<FailureLog<'a>>,
    summary: Option<String>,
}

impl<'a> RoundFailures<'a> {
    /// State before the first round.
    pub fn nothing(run: &'a Run, robots: &'a [Robot]) -> Self {
        Self { silences: robots.iter().map(|robot| FailureLog::new(run, robot)).collect(), summary: None }
    }

    /// Failures to report now for a robot in this round. `failure` is `None` if the robot did not fail.
    pub fn of(&mut self, index: usize, failure: Option<&Failure>) -> Vec<Failure> {
        match (self.silences.get_mut(index), failure) {
            (Some(silences), Some(failure)) => silences.limit(failure),
            (Some(silences), None) => {
                silences.end();
                Vec::new()
            }
            (None, failure) => failure.cloned().into_iter().collect(),
        }
    }

    /// Line below a table; `None` if it has not changed since the last round.
    pub fn summary(&mut self, summary: String) -> Option<&str> {
        if self.summary.as_ref() == Some(&summary) {
            return None;
        }
        self.summary = Some(summary);
        self.summary.as_deref()
    }
}

impl Drop for FailureLog<'_> {
    fn drop(&mut self) {
        self.end();
    }
}
