//! A command for several robots. It runs in parallel, with one connection for each robot.

use std::time::Instant;

use super::failure_log::RoundFailures;
use super::print::{ReportPosition, envelopes, with_robot_name, with_time};
use super::rounds::Rounds;
use super::{DEFAULT_INTERVAL, Granted, Run, RunError, failure_of, run_parallel};
use crate::output::envelope::Envelope;
use crate::prelude::basics::*;
use crate::{AnyCommand, Outcome};

/// Time after which a watch tries again to reach a robot that did not answer.
const RECONNECT_EVERY: Duration = Duration::from_secs(2);

impl Run {
    /// Runs on several robots in parallel, with one connection for each robot. Prints the reports in the order of the
    /// robots.
    pub(super) async fn run_many(&self, command: &dyn AnyCommand, robots: &[Robot]) -> Result<(), RunError> {
        if command.is_endless() && !self.gate.dry_run {
            return self.watch_each(command, robots).await;
        }
        if self.gate.dry_run || !self.repeat.is_wanted() {
            let outcomes = self.collect(command, robots).await;
            let place = (ReportPosition::First, &mut RoundFailures::nothing(self, robots));
            let printed = self.print_many(command, robots, &outcomes, place);
            let printed = printed.map_err(|failure| self.mark_unprinted(command.intent(None).risk, failure))?;
            self.verdict(&outcomes)?;
            return Ok(self.check(&printed)?);
        }
        let rounds = Rounds::new(&self.repeat, DEFAULT_INTERVAL);
        let end = rounds.deadline();
        let mut links = run_parallel(robots.iter().map(|robot| self.connect(command, robot, end))).await;
        let verdict = self.run_connected(command, robots, (&mut links, rounds)).await;
        let mut closed = Ok(());
        for (link, _) in links.into_iter().flatten() {
            closed = closed.and(link.close(&self.screen).await);
        }
        verdict?;
        Ok(closed?)
    }

    async fn run_connected(
        &self,
        command: &dyn AnyCommand,
        robots: &[Robot],
        (links, mut rounds): (&mut [Result<Granted>], Rounds<'_>),
    ) -> Result<(), RunError> {
        let end = rounds.deadline();
        let mut last: Option<Vec<Outcome>> = None;
        let mut reported = RoundFailures::nothing(self, robots);
        let mut reconnect_at = Instant::now() + RECONNECT_EVERY;
        loop {
            let reconnects = Instant::now() >= reconnect_at;
            if reconnects {
                reconnect_at = Instant::now() + RECONNECT_EVERY;
            }
            let attempts = robots.iter().zip(&mut *links).map(|(robot, link)| async move {
                // A robot that did not answer before may be reachable now.
                if matches!(link, Err(failure) if failure.kind == Kind::NoAnswer && reconnects) {
                    *link = self.connect(command, robot, end).await;
                }
                match link {
                    Ok((link, grant)) => self.attempt(command, robot, &mut **link, (grant, end)).await,
                    Err(failure) => command.without_answer(robot, failure.clone()),
                }
            });
            let mut outcomes = run_parallel(attempts).await;
            let is_cut = failures(&outcomes).any(|failure| rounds.is_cut(&failure));
            if is_cut {
                outcomes = last.take().unwrap_or(outcomes);
            }
            let place = self.round(rounds.is_first(), false);
            let is_met = if is_cut {
                false
            } else if self.repeat.is_quiet {
                rounds.is_met(&envelopes(robots, command.id(), &outcomes)?, &self.screen)?
            } else {
                let envelopes = self.print_many(command, robots, &outcomes, (place, &mut reported))?;
                rounds.is_met(&envelopes, &self.screen)?
            };
            let ends = |failure: Failure| self.repeat.ends_with(&failure, rounds.is_first());
            let goes_on = !is_met && !is_cut && !failures(&outcomes).any(ends) && rounds.next().await?;
            if self.repeat.is_quiet && !goes_on {
                self.print_many(command, robots, &outcomes, (ReportPosition::First, &mut reported))?;
            }
            if is_met {
                return Ok(());
            }
            if !goes_on {
                self.verdict(&outcomes)?;
                return rounds.end().map_err(RunError::from);
            }
            last = Some(outcomes);
        }
    }

    /// Common result for several robots.
    fn verdict(&self, outcomes: &[Outcome]) -> Result<(), RunError> {
        let failures: Vec<Failure> = failures(outcomes).filter(|failure| !self.repeat.allows(failure)).collect();
        self.failed(&failures, outcomes.len())
    }

    /// Common result for failures that were already reported.
    fn failed(&self, failures: &[Failure], robots: usize) -> Result<(), RunError> {
        let Some(first) = failures.first() else { return Ok(()) };
        let failure = if failures.len() == robots && failures.iter().all(|failure| failure.kind == first.kind) {
            let all =
                if first.kind == Kind::ConditionNotMet { "no robot passed the check" } else { "all robots failed" };
            Failure::new(first.kind, all)
        } else {
            Failure::new(Kind::Mixed, format!("{} of {robots} robots failed", failures.len()))
        };
        Err(RunError { failure, envelope: None, is_reported: !self.is_for_people() })
    }

    /// Watches several robots in parallel, each on its own connection. Returns when all watches have ended.
    async fn watch_each(&self, command: &dyn AnyCommand, robots: &[Robot]) -> Result<(), RunError> {
        let watches = robots.iter().map(|robot| async move {
            let watched = self.watch(command, robot, Some(ReportPosition::LineOf(robot))).await;
            let Err(stopped) = watched else { return Ok(()) };
            if stopped.failure.kind != Kind::Interrupted && !stopped.is_reported {
                if self.is_for_people() {
                    self.screen.failure(&with_robot_name(robot, stopped.failure.clone()));
                } else {
                    self.emit(with_time(Envelope::of(robot, command.id(), Err(stopped.failure.clone()))))?;
                }
            }
            Err(stopped.failure)
        });
        let failures: Vec<Failure> = run_parallel(watches).await.into_iter().filter_map(Result::err).collect();
        if let Some(interrupted) = failures.iter().find(|failure| failure.kind == Kind::Interrupted) {
            return Err(interrupted.clone().into());
        }
        self.failed(&failures, robots.len())
    }
}

/// Failures of robots, and failures that their reports state.
fn failures(outcomes: &[Outcome]) -> impl Iterator<Item = Failure> {
    outcomes.iter().filter_map(failure_of)
}
