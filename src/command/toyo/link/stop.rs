//! How what moves is stopped, and how it is known to stand.

use std::time::Duration;

use tokio::time::Instant;

use super::borrowed::Host;
use super::foreign::Told;
use super::{Link, Moving, SILENCE, jog, status_page};
use crate::command::frame::dry_run::unknown;
use crate::command::toyo::refusal;
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::{Answer, Request};
use crate::controller::toyo::session::Policy;
use crate::controller::toyo::table::commands::Command;
use crate::failure::{Failure, Kind};

/// How long a stop is tried, how often it is sent again after silence, and the pause between two looks.
const WITHIN: Duration = Duration::from_secs(5);
const REPETITIONS: u32 = 3;
/// What has not come to rest by then is no program.
const SLOW: Duration = Duration::from_secs(1);
const LOOK_EVERY: Duration = Duration::from_millis(50);

impl Moving {
    /// The order that stops it.
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

impl Link {
    /// Stops what moves, and returns where it has come to stand. The order is repeated until then, whatever the options
    /// say: a stop twice is a stop once, and a lost one lets the robot move on.
    ///
    /// # Errors
    /// [`Kind::OutcomeUnknown`] if nothing tells that it stands, [`Kind::ConditionNotMet`] if it moves on.
    pub async fn stop(&mut self, moving: Moving) -> Result<Record, Failure> {
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
            return Err(unknown());
        }
        self.set_policy(Policy { timeout: SILENCE, retries: REPETITIONS, ..self.usual });
        // What others have left behind is told when it stands.
        let left = std::mem::take(&mut self.left);
        let told = std::mem::replace(&mut self.told, Told::ALL);
        let stopped = self.stop_until_it_stands(moving).await;
        (self.left, self.told) = (left, told);
        self.set_policy(self.usual);
        self.trace.release();
        match &stopped {
            Ok(_) => self.has_ended(),
            // The next stop shall find the host as it is.
            Err(_) => self.keep_host(),
        }
        stopped
    }

    /// Where the axes are. A refusal is not explained: that takes time, and the controller is busy for a moment.
    pub async fn place(&mut self) -> Result<Record, Failure> {
        self.try_read(&Request::bare(Command::Mpst)).await?.map_err(|_| refusal::mute())
    }

    /// Sends a stop at once if the line owes an answer, which [`Link::stop`] would wait for first.
    pub(super) async fn rush(&mut self, stop: &Request) {
        if let Some(bytes) = self.line.urgent(self.started.elapsed(), stop) {
            // A line that is broken fails again in the stop that follows.
            self.send(&bytes).await.unwrap_or_default();
        }
    }

    async fn stop_until_it_stands(&mut self, moving: Moving) -> Result<Record, Failure> {
        let began = Instant::now();
        let stop = moving.stop();
        // Where it was at the last look, if nothing was executed then.
        let mut last = None;
        loop {
            let attempt = self.try_stop(moving, &stop).await;
            let (is_slow, is_late) = (began.elapsed() >= SLOW, began.elapsed() >= WITHIN);
            last = match attempt {
                Ok(Attempt { is_busy: false, place, .. }) if last.as_ref() == Some(&place) => return Ok(place),
                Ok(Attempt { is_refused, .. }) if is_late => {
                    let how = if is_refused { "refuses to stop (@NG)" } else { "moves on although it said @OK" };
                    return Err(unstopped(Kind::ConditionNotMet, format!("the controller {how}")));
                }
                Err(failure) if is_late || self.is_gone => {
                    let message = format!("nothing tells that it stands: {}", failure.message);
                    return Err(unstopped(Kind::OutcomeUnknown, message));
                }
                Ok(Attempt { is_refused, is_busy, place }) => {
                    // What goes wrong here shows in the next attempt.
                    if is_refused && moving == Moving::Jog {
                        // To stop a JOG takes the host, too.
                        self.take_host().await.unwrap_or_default();
                        self.converse(&stop, true).await.map(|_| ()).unwrap_or_default();
                    } else if moving == Moving::Program && (is_slow || (!is_busy && last.is_some())) {
                        // It moves on, maybe although nothing is executed: somebody left an axis jogging.
                        self.stop_a_jog().await;
                    }
                    (!is_busy).then_some(place)
                }
                Err(_) => None,
            };
            tokio::time::sleep(LOOK_EVERY).await;
        }
    }

    /// Orders the stop, then looks. That it was answered says little: only the robot itself tells that it stands.
    async fn try_stop(&mut self, moving: Moving, stop: &Request) -> Result<Attempt, Failure> {
        self.rush(stop).await;
        let answer = self.converse(stop, true).await?;
        let mut state = self.status_of(&[0]).await?;
        if moving == Moving::Program && (state.executing() || state.homing()) {
            // What is executed on may be an axis that somebody left jogging, which STOP does not stop.
            self.stop_a_jog().await;
            state = self.status_of(&[0]).await?;
        }
        let place = self.place().await?;
        Ok(Attempt { is_refused: answer == Answer::Refused, is_busy: state.executing() || state.homing(), place })
    }
}

impl Link {
    /// Tells all axes to stop jogging; takes the host for it where that is needed. What goes wrong shows in the next look.
    async fn stop_a_jog(&mut self) {
        let stop = Moving::Jog.stop();
        if matches!(self.converse(&stop, true).await, Ok(Answer::Refused)) && self.take_host().await.is_ok() {
            self.converse(&stop, true).await.map(|_| ()).unwrap_or_default();
        }
    }

    /// What moves was refused before it moved. The stop goes out nevertheless, once; whatever else moves is not this
    /// link's.
    pub async fn give_up(&mut self, moving: Moving) {
        self.set_policy(self.usual);
        self.converse(&moving.stop(), true).await.map(|_| ()).unwrap_or_default();
        self.trace.release();
        self.has_ended();
    }
}

fn unstopped(kind: Kind, message: String) -> Failure {
    Failure::new(kind, message).hint(
        "press the emergency stop if anything moves; once the controller answers again, `toyo stop` stops a program, \
         `toyo stop --jog` an axis that was jogged",
    )
}
