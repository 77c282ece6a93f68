//! How what moves is stopped, and how it is known to stand.

use std::time::Duration;

use armctl_controller::Risk;
use armctl_controller::toyo::layout::Record;
use armctl_controller::toyo::request::{Answer, Request};
use armctl_controller::toyo::session::{Ended, Policy};
use armctl_controller::toyo::table::commands::Command;
use tokio::time::{Instant, timeout_at};

use super::borrowed::Host;
use super::{Client, Error, jog, status_page};
use crate::{Grant, STOP_EVERY, STOP_WITHIN};

/// What has not come to rest by then is no program.
const SLOW: Duration = Duration::from_secs(1);
/// The pause between two looks.
const LOOK_EVERY: Duration = Duration::from_millis(50);
/// What is asked while a stop is tried, is asked so often.
const REPETITIONS: u32 = 3;

/// What moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moving {
    /// An axis, until it is told to stop.
    Jog,
    /// A program, a return to origin, servo power.
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

/// What came of one attempt.
struct Attempt {
    is_refused: bool,
    is_busy: bool,
    place: Record,
}

impl Client {
    /// Stops what moves, and returns where it has come to stand, as [`Client::place`] does. The order is repeated until
    /// then, whatever was granted and whatever the options say: a stop twice is a stop once, and a lost one lets the robot
    /// move on.
    ///
    /// # Errors
    /// [`Error::StandUnseen`] if nothing tells that it stands, [`Error::MovesOn`] if it moves on.
    pub async fn stop(&mut self, moving: Moving) -> Result<Record, Error> {
        if self.is_dry() {
            self.plan(&moving.stop(), "until it stands");
            self.plan(&status_page(0), "until it stands: whether something is executed");
            if moving == Moving::Program {
                self.plan_if(&Moving::Jog.stop(), "whether something is executed on: an axis may be jogged");
                self.plan_if(&status_page(0), "whether something is executed on");
            }
            self.plan(&Request::bare(Command::Mpst), "until it stands: where");
            if self.host == Host::Unknown {
                let on = "whether the stop of a jog is refused, as it may be while the host is OFF";
                self.plan_to_take_host(Some(on));
                self.plan_if(&Moving::Jog.stop(), on);
            }
            return Err(Error::NotKnown);
        }
        self.set_policy(Policy { timeout: STOP_EVERY, retries: REPETITIONS, ..self.usual });
        let mut why = None;
        let until = Instant::now() + STOP_WITHIN;
        let stopped = timeout_at(until, self.stop_until_it_stands(moving, &mut why)).await;
        let stopped = stopped.unwrap_or_else(|_| {
            let silent = || self.unanswered(Ended::NoAnswer, Risk::Read, Some(&moving.stop()));
            Err(unstopped(why.unwrap_or_else(silent)))
        });
        self.set_policy(self.usual);
        match &stopped {
            Ok(_) => self.has_ended(),
            // The next stop shall find the host as it is.
            Err(_) => self.keep_host(),
        }
        stopped
    }

    /// Sends a stop at once if the line owes an answer, which [`Client::stop`] would wait for first.
    pub async fn send_urgent(&mut self, moving: Moving) {
        if let Some(bytes) = self.session.urgent(self.started.elapsed(), &moving.stop()) {
            // A line that is broken fails again in the stop that follows.
            self.send(&bytes).await.unwrap_or_default();
        }
    }

    /// Ends only when it stands, or the line is gone. `why` is told what is in the way so far.
    async fn stop_until_it_stands(&mut self, moving: Moving, why: &mut Option<Error>) -> Result<Record, Error> {
        let began = Instant::now();
        let stop = moving.stop();
        // Where it was at the last look, if nothing was executed then.
        let mut last = None;
        loop {
            let attempt = self.try_stop(moving, &stop).await;
            let is_slow = began.elapsed() >= SLOW;
            last = match attempt {
                Ok(Attempt { is_busy: false, place, .. }) if last.as_ref() == Some(&place) => return Ok(place),
                Err(error) if self.is_gone => return Err(unstopped(error)),
                Ok(Attempt { is_refused, is_busy, place }) => {
                    *why = Some(Error::MovesOn { is_refused });
                    // What goes wrong here shows in the next attempt.
                    if is_refused && moving == Moving::Jog {
                        // To stop a JOG takes the host, too.
                        self.take_host_to_stop().await.unwrap_or_default();
                        self.transact(&stop, true).await.map(|_| ()).unwrap_or_default();
                    } else if moving == Moving::Program && (is_slow || (!is_busy && last.is_some())) {
                        // It moves on, maybe although nothing is executed: somebody left an axis jogging.
                        self.stop_a_jog().await;
                    }
                    (!is_busy).then_some(place)
                }
                Err(error) => {
                    *why = Some(error);
                    None
                }
            };
            tokio::time::sleep(LOOK_EVERY).await;
        }
    }

    /// Orders the stop, then looks. That it was answered says little: only the robot itself tells that it stands.
    async fn try_stop(&mut self, moving: Moving, stop: &Request) -> Result<Attempt, Error> {
        self.send_urgent(moving).await;
        let answer = self.transact(stop, true).await?;
        let mut state = self.status_of(&[0]).await?;
        if moving == Moving::Program && (state.executing() || state.homing()) {
            // What is executed on may be an axis that somebody left jogging, which STOP does not stop.
            self.stop_a_jog().await;
            state = self.status_of(&[0]).await?;
        }
        let place = self.place().await?;
        Ok(Attempt { is_refused: answer == Answer::Refused, is_busy: state.executing() || state.homing(), place })
    }

    /// Whatever was granted: a stop is always allowed.
    async fn take_host_to_stop(&mut self) -> Result<(), Error> {
        self.take_host_by(&Grant::of(Risk::Write)).await
    }

    /// Tells all axes to stop jogging; takes the host for it where that is needed. What goes wrong shows in the next look.
    async fn stop_a_jog(&mut self) {
        let stop = Moving::Jog.stop();
        if matches!(self.transact(&stop, true).await, Ok(Answer::Refused)) && self.take_host_to_stop().await.is_ok() {
            self.transact(&stop, true).await.map(|_| ()).unwrap_or_default();
        }
    }

    /// What moves was refused before it moved. The stop goes out nevertheless, once; whatever else moves is not this
    /// client's.
    pub async fn give_up(&mut self, moving: Moving) {
        self.set_policy(self.usual);
        self.transact(&moving.stop(), true).await.map(|_| ()).unwrap_or_default();
        self.has_ended();
    }
}

/// Why nobody knows that it stands.
fn unstopped(why: Error) -> Error {
    if matches!(why, Error::MovesOn { .. }) { why } else { Error::StandUnseen(Box::new(why)) }
}
