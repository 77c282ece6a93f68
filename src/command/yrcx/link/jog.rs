//! Jogs: motions that go on until the stop input goes off (4.2.6). Whatever happens, it goes off.

use std::time::Duration;

use tokio::time::Instant;

use super::driver::LONG;
use super::{Done, Link, Transport};
use crate::command::frame::dry_run::Reason;
use crate::command::frame::interrupt::abandoned;
use crate::command::yrcx::refusal;
use crate::controller::yrcx::alarm::STOP_INPUT;
use crate::controller::yrcx::answer::Answer;
use crate::controller::yrcx::image::Image;
use crate::controller::yrcx::order::Order;
use crate::controller::yrcx::procedure::Procedure;
use crate::controller::yrcx::session::Outcome;
use crate::controller::yrcx::signal::input;
use crate::controller::yrcx::table::Pace;
use crate::failure::{Failure, Kind};

/// Faults of the link that are survived while a jog is being stopped. A link that has none but faults is given up.
const MOST_FAULTS: u32 = 100;

/// How a jog ended.
pub(super) struct Seen {
    pub(super) outcome: Outcome,
    /// Whether it had not ended before it was stopped.
    is_stopped: bool,
    /// What ended it before its time.
    cut: Option<Failure>,
}

impl Link {
    /// Jogs for `time` from the moment that the command leaves, or until it is dropped and halted; stops it, and says
    /// where the robot is. That the stop input ended it is no refusal then.
    ///
    /// # Errors
    ///
    /// The jog was refused, ended by itself, or was not seen to end: the stop input stays off then.
    pub async fn jog(&mut self, order: &Order, time: Option<Duration>) -> Result<Done, Failure> {
        self.admit(order.row().id, order.risk())?;
        if self.is_dry() {
            self.note(order, Reason::default());
            for procedure in [false, true].into_iter().filter_map(|on| Procedure::set(input::STOP, on)) {
                self.note_steps(&procedure);
            }
            return Ok(Done::default());
        }
        let Seen { outcome, is_stopped, cut } = self.see_through(order, time).await?;
        let given = self.given(order.row(), outcome);
        let done = given.and_then(|given| match given.answer {
            Answer::Refused { alarm: STOP_INPUT, positions } if is_stopped => {
                Ok(Done { values: positions, elapsed: given.elapsed, replaced: None })
            }
            _ => given.done(order),
        });
        match (cut, done) {
            (None, done) => done,
            (Some(cut), Ok(done)) => {
                let place = refusal::stopped(order, &done.values);
                Err(Failure { message: format!("{}; {STOPPED}{place}", cut.message), ..cut })
            }
            (Some(cut), Err(failure)) => {
                Err(Failure { message: format!("{}; {}", cut.message, failure.message), ..failure })
            }
        }
    }

    /// Jogs, and stops. An exchange that does not end as it should leaves the stop input off.
    pub(super) async fn see_through(&mut self, order: &Order, time: Option<Duration>) -> Result<Seen, Failure> {
        let key = abandoned();
        self.start(order).await?;
        self.bequeath_stop(true);
        let cut = tokio::select! {
            biased;
            key = key => Some(Failure::new(Kind::Interrupted, key)),
            gone = self.go_on(time) => gone.err(),
        };
        let (now, is_stopped) = (self.now(), self.exchange.is_some());
        if let Some(exchange) = &mut self.exchange {
            exchange.interrupt(now);
        }
        let mut faults = 0;
        while self.exchange.is_some() && faults < MOST_FAULTS {
            faults += u32::from(self.turn().await.is_err());
        }
        let Some(outcome) = self.ended.take() else {
            let why = cut.map(|cut| format!("{}; ", cut.message)).unwrap_or_default();
            let message = format!("{why}the axis may still move: nothing reaches the controller any more");
            return Err(Failure::new(Kind::OutcomeUnknown, message).hint("press the emergency stop"));
        };
        self.await_link(&outcome).await;
        self.bequeath_stop(false);
        self.count(order, &outcome);
        Ok(Seen { outcome, is_stopped, cut })
    }

    /// Has a session that holds the link switch the stop input off if this process is killed; or no more.
    fn bequeath_stop(&mut self, on: bool) {
        let Transport::Image(link) = &mut self.transport else { return };
        let mut mask = Image::default();
        input::STOP.set(&mut mask, true);
        let (mask, off) = (mask.to_bytes(), Image::default().to_bytes());
        link.bequeath(on.then_some((&mask[..], &off[..])));
    }

    /// Turns until the jog has gone on for its time, or has ended.
    async fn go_on(&mut self, time: Option<Duration>) -> Result<(), Failure> {
        while let Some(exchange) = &self.exchange {
            let until = match time.zip(exchange.sent()) {
                Some((time, sent)) => self.started + sent + time,
                None => Instant::now() + LONG,
            };
            if Instant::now() >= until {
                break;
            }
            self.turn_until(until).await?;
        }
        Ok(())
    }

    /// Whether a jog is under way.
    pub(super) fn is_jogging(&self) -> bool {
        self.exchange.as_ref().is_some_and(|exchange| exchange.order().row().pace == Pace::Jog)
    }
}

/// What became of what was stopped.
pub(super) const STOPPED: &str = "the robot was stopped by the stop input SI(06), which is on again";
