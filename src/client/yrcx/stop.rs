//! The stop of what a client set in motion.

use armctl_controller::yrcx::alarm::{Alarm, STOP_INPUT};
use armctl_controller::yrcx::answer::Answer;
use armctl_controller::yrcx::order::Order;
use armctl_controller::yrcx::procedure::Procedure;
use armctl_controller::yrcx::session::Ended;
use armctl_controller::yrcx::signal::input;
use armctl_controller::yrcx::table::{Command, Pace};
use armctl_controller::yrcx::value::Values;

use tokio::time::Instant;

use super::error::Error;
use super::{Client, Event};
use crate::STOP_WITHIN;

/// What there was to stop.
#[derive(Debug, Clone, PartialEq)]
pub enum Stopped {
    /// Nothing was sent that moves the robot.
    Nothing,
    /// A motion, by the stop input, which is on again.
    Motion {
        /// Which.
        order: Box<Order>,
        /// Where the robot is, if the answer says so (4.2.6).
        positions: Values,
    },
    /// What goes on by itself, a program or what signals set in motion, by the stop input, which is on again.
    Started,
    /// A command that moves nothing.
    Command(Command),
    /// Nothing: the command had ended already, with this alarm if it did not end well.
    HadEnded(Command, Option<Alarm>),
}

impl Client {
    /// Stops what this client set in motion, whatever was granted: the stop input SI(06) goes off, and on again once the
    /// end is seen (chapter 1, 3.8). Within 3 s it is known whether it was.
    ///
    /// # Errors
    /// [`Error::OutcomeUnknown`] if the end was not seen: the stop input stays off.
    pub async fn stop(&mut self) -> Result<Stopped, Error> {
        self.abandon_sequence();
        let until = Instant::now() + STOP_WITHIN;
        let now = self.now();
        if let Some(exchange) = &mut self.exchange {
            exchange.interrupt(now);
            let order = exchange.order().clone();
            if matches!(order.row().pace, Pace::Motion | Pace::Jog) {
                self.watcher.event(Event::Stopping);
            }
            let outcome = self.until_ended(Some(until)).await?;
            let command = order.command();
            return match outcome.ended {
                Ended::Answered(Answer::Refused { alarm, positions }) if alarm == STOP_INPUT => {
                    Ok(Stopped::Motion { order: Box::new(order), positions })
                }
                Ended::Answered(Answer::Refused { alarm, .. }) => Ok(Stopped::HadEnded(command, Some(alarm))),
                Ended::Answered(_) => Ok(Stopped::HadEnded(command, None)),
                Ended::NotSent(_) => Ok(Stopped::Nothing),
                Ended::Stopped => Ok(Stopped::Command(command)),
                Ended::NoAnswer(_) | Ended::OutcomeUnknown(_) => Err(self.unanswered(&outcome)),
            };
        }
        if !self.has_started {
            return Ok(Stopped::Nothing);
        }
        self.watcher.event(Event::Stopping);
        for procedure in [Some(Procedure::stop()), Procedure::set(input::STOP, true)].into_iter().flatten() {
            self.switch(procedure, until.saturating_duration_since(Instant::now())).await?;
        }
        self.has_started = false;
        Ok(Stopped::Started)
    }

    /// Whether a jog is under way, which nothing but a stop ends.
    pub fn is_jogging(&self) -> bool {
        self.exchange.as_ref().is_some_and(|exchange| exchange.order().row().pace == Pace::Jog)
    }
}
