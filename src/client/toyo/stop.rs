//! Stop procedure: the order, its repetition, and the check that the robot stands still.

use std::time::Duration;

use armctl_controller::Risk;
use armctl_controller::toyo::layout::Record;
use armctl_controller::toyo::request::{Answer, Request};
use armctl_controller::toyo::session::{ExchangeResult, Policy};
use armctl_controller::toyo::table::commands::Command;
use tokio::time::{Instant, timeout_at};

use super::temporary_changes::HostState;
use super::{Client, Error, jog, status_page};
use crate::{Grant, STOP_EVERY, STOP_WITHIN};

/// Time after which the motion is assumed to be a jog, because a program would have stopped.
const JOG_ASSUMED_AFTER: Duration = Duration::from_secs(1);
/// Poll interval of the position.
const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// Retries of each request while a stop runs.
const REPETITIONS: u32 = 3;

/// Kind of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moving {
    /// A jog: runs until it is stopped.
    Jog,
    /// A program, an origin return, or servo power.
    Program,
}

impl Moving {
    /// The order that stops it (JGST or STOP, TO 2-7).
    pub fn stop(self) -> Request {
        match self {
            Self::Jog => jog("SP", None),
            Self::Program => Request::bare(Command::Stop),
        }
    }
}

struct Attempt {
    is_refused: bool,
    is_busy: bool,
    position: Record,
}

impl Client {
    /// Stops the motion and returns the final position, as [`Client::read_position`] does. The order is repeated until the
    /// robot stands still, regardless of grant and options. Repeating a stop is harmless. After a lost stop the robot
    /// continues to move.
    ///
    /// # Errors
    /// [`Error::StopUnconfirmed`] if no answer confirms it, [`Error::StillMoving`] if the robot still moves.
    pub async fn stop(&mut self, moving: Moving) -> Result<Record, Error> {
        if self.is_dry() {
            self.plan(&moving.stop(), "repeated until the robot stands still");
            self.plan(&status_page(0), "repeated until the robot stands still: whether a program runs");
            if moving == Moving::Program {
                self.plan_if(&Moving::Jog.stop(), "whether something still runs: an axis may be jogging");
                self.plan_if(&status_page(0), "whether something still runs");
            }
            self.plan(&Request::bare(Command::Mpst), "repeated until the robot stands still: position");
            if self.host == HostState::Unknown {
                let on = "whether the controller refuses the stop of a jog, for example while the host is OFF";
                self.plan_to_take_host(Some(on));
                self.plan_if(&Moving::Jog.stop(), on);
            }
            return Err(Error::DryRun);
        }
        self.set_policy(Policy { timeout: STOP_EVERY, retries: REPETITIONS, ..self.configured_policy });
        let mut why = None;
        let until = Instant::now() + STOP_WITHIN;
        let stopped = timeout_at(until, self.stop_until_at_rest(moving, &mut why)).await;
        let stopped = stopped.unwrap_or_else(|_| {
            let silent = || self.unanswered(ExchangeResult::NoAnswer, Risk::Read, Some(&moving.stop()));
            Err(stop_error(why.unwrap_or_else(silent)))
        });
        self.set_policy(self.configured_policy);
        match &stopped {
            Ok(_) => self.end_motion(),
            // Leave the host ON: the next stop needs it.
            Err(_) => self.keep_host(),
        }
        stopped
    }

    /// Sends a stop at once while an answer is pending. [`Client::stop`] would wait for that answer first.
    pub async fn send_urgent(&mut self, moving: Moving) {
        if let Some(bytes) = self.session.begin_urgent(self.started.elapsed(), &moving.stop()) {
            // If the line is broken, the stop that follows reports it.
            self.send(&bytes).await.unwrap_or_default();
        }
    }

    /// Returns only when the robot stands still or the line is lost. `why` holds the latest obstacle.
    async fn stop_until_at_rest(&mut self, moving: Moving, why: &mut Option<Error>) -> Result<Record, Error> {
        let began = Instant::now();
        let stop = moving.stop();
        // Position of the previous attempt, if nothing ran then.
        let mut previous = None;
        loop {
            let attempt = self.try_stop(moving, &stop).await;
            let is_slow = began.elapsed() >= JOG_ASSUMED_AFTER;
            previous = match attempt {
                Ok(Attempt { is_busy: false, position, .. }) if previous.as_ref() == Some(&position) => {
                    return Ok(position);
                }
                Err(error) if self.is_line_lost => return Err(stop_error(error)),
                Ok(Attempt { is_refused, is_busy, position }) => {
                    *why = Some(Error::StillMoving { is_refused });
                    // The next attempt shows any error of this one.
                    if is_refused && moving == Moving::Jog {
                        // Stopping a jog requires host control.
                        self.take_host_to_stop().await.unwrap_or_default();
                        self.transact(&stop, true).await.map(|_| ()).unwrap_or_default();
                    } else if moving == Moving::Program && (is_slow || (!is_busy && previous.is_some())) {
                        // Still moving, perhaps with no program running: an axis was left jogging.
                        self.stop_a_jog().await;
                    }
                    (!is_busy).then_some(position)
                }
                Err(error) => {
                    *why = Some(error);
                    None
                }
            };
            tokio::time::sleep(POLL_INTERVAL).await;
        }
    }

    /// Sends the stop, then reads status and position. The answer `@OK` alone does not show that the robot stands
    /// still.
    async fn try_stop(&mut self, moving: Moving, stop: &Request) -> Result<Attempt, Error> {
        self.send_urgent(moving).await;
        let answer = self.transact(stop, true).await?;
        let mut state = self.status_of(&[0]).await?;
        if moving == Moving::Program && (state.executing() || state.homing()) {
            // An axis may have been left jogging; STOP does not stop a jog.
            self.stop_a_jog().await;
            state = self.status_of(&[0]).await?;
        }
        let position = self.read_position().await?;
        Ok(Attempt { is_refused: answer == Answer::Refused, is_busy: state.executing() || state.homing(), position })
    }

    /// Takes host control without a check of the grant: a stop is always allowed.
    async fn take_host_to_stop(&mut self) -> Result<(), Error> {
        self.take_host_by(&Grant::up_to(Risk::Write)).await
    }

    /// Stops the jog of all axes, and takes host control if required. The next attempt shows any error.
    async fn stop_a_jog(&mut self) {
        let stop = Moving::Jog.stop();
        if matches!(self.transact(&stop, true).await, Ok(Answer::Refused)) && self.take_host_to_stop().await.is_ok() {
            self.transact(&stop, true).await.map(|_| ()).unwrap_or_default();
        }
    }

    /// Sends one stop after a motion was refused before it began. Another motion on the controller is not the concern
    /// of this client.
    pub async fn stop_refused_motion(&mut self, moving: Moving) {
        self.set_policy(self.configured_policy);
        self.transact(&moving.stop(), true).await.map(|_| ()).unwrap_or_default();
        self.end_motion();
    }
}

fn stop_error(why: Error) -> Error {
    if matches!(why, Error::StillMoving { .. }) { why } else { Error::StopUnconfirmed(Box::new(why)) }
}
