//! Jog: a motion that runs until the stop input goes off (4.2.6). The client switches the stop input off at the end of
//! every jog.

use std::time::Duration;

use armctl_controller::yrcx::alarm::STOP_INPUT;
use armctl_controller::yrcx::answer::Answer;
use armctl_controller::yrcx::image::Image;
use armctl_controller::yrcx::order::Order;
use armctl_controller::yrcx::procedure::Procedure;
use armctl_controller::yrcx::session::Outcome;
use armctl_controller::yrcx::signal::input;
use armctl_transport::session::client::SessionBusy;
use tokio::time::Instant;

use super::error::Error;
use super::event_loop::NO_DEADLINE;
use super::{Client, CompletedCommand, Transport};
use crate::{LONGEST_TIMEOUT, Reason};

/// Maximum number of link errors while the client stops a jog.
const MAX_LINK_ERRORS: u32 = 100;

pub(super) struct JogOutcome {
    pub(super) outcome: Outcome,
    /// Whether the jog was still running when the client stopped it.
    is_stopped: bool,
    /// The cause, if the jog ended early.
    early_end: Option<Error>,
}

impl Client {
    /// Jogs for `time` from the moment when the command is sent, then stops and returns the position. A caller that
    /// drops the future must call [`stop`](Self::stop). The stop alarm that ends the jog does not count as a refusal.
    ///
    /// # Errors
    /// The jog was refused or ended by itself, or the client did not observe the end of the jog. In the last case, the
    /// stop input stays off. [`Error::EndedEarly`] if another cause ended the jog early.
    pub async fn jog(&mut self, order: &Order, time: Option<Duration>) -> Result<CompletedCommand, Error> {
        self.authorize_command(order.row().id, order.risk())?;
        if self.is_dry_run() {
            self.plan_order(order, Reason::default());
            for procedure in [false, true].into_iter().filter_map(|on| Procedure::set(input::STOP, on)) {
                self.plan_steps(&procedure);
            }
            return Ok(CompletedCommand::default());
        }
        let JogOutcome { outcome, is_stopped, early_end } = self.run_jog(order, time).await?;
        let done = self.reply(outcome).and_then(|reply| match reply.answer {
            Answer::Refused { alarm: STOP_INPUT, positions } if is_stopped => {
                Ok(CompletedCommand { values: positions, elapsed: reply.elapsed })
            }
            _ => reply.done(order),
        });
        let Some(by) = early_end.map(Box::new) else { return done };
        let ended = done.map(|done| done.values).map_err(Box::new);
        Err(Error::EndedEarly { by, order: Box::new(order.clone()), ended })
    }

    /// Jogs and stops. The stop input stays off if the exchange does not end normally.
    pub(super) async fn run_jog(&mut self, order: &Order, time: Option<Duration>) -> Result<JogOutcome, Error> {
        self.start(order).await?;
        self.set_stop_last_will(true);
        let early_end = self.run_for(time).await.err();
        let (now, is_stopped) = (self.now(), self.exchange.is_some());
        if let Some(exchange) = &mut self.exchange {
            exchange.interrupt(now);
        }
        let mut faults = 0;
        while self.exchange.is_some() && faults < MAX_LINK_ERRORS {
            faults += u32::from(self.run_turn().await.is_err());
        }
        let Some(outcome) = self.ended.take() else {
            return Err(match early_end {
                // The session did not send the jog, so there is no motion to stop.
                Some(denied @ Error::Session(SessionBusy::ReadOnly)) if self.exchange.is_none() => {
                    self.set_stop_last_will(false);
                    denied
                }
                early_end => Error::StillMoving { early_end: early_end.map(Box::new) },
            });
        };
        self.await_link(&outcome, None).await;
        self.set_stop_last_will(false);
        self.count(order, &outcome);
        Ok(JogOutcome { outcome, is_stopped, early_end })
    }

    /// Sets or clears the last will of the session. With the last will, the session switches the stop input off if this
    /// process is killed.
    fn set_stop_last_will(&mut self, on: bool) {
        let Transport::Image(link) = &mut self.transport else { return };
        let mut mask = Image::default();
        input::STOP.set(&mut mask, true);
        let (mask, off) = (mask.to_bytes(), Image::default().to_bytes());
        link.set_last_will(on.then_some((&mask[..], &off[..])));
    }

    /// Runs the event loop until the time has passed or the jog ends.
    async fn run_for(&mut self, time: Option<Duration>) -> Result<(), Error> {
        while let Some(exchange) = &self.exchange {
            let until = match time.zip(exchange.sent()) {
                Some((time, sent)) => self.started + sent + time.min(LONGEST_TIMEOUT),
                None => Instant::now() + NO_DEADLINE,
            };
            if Instant::now() >= until {
                break;
            }
            self.run_until(until).await?;
        }
        Ok(())
    }
}
