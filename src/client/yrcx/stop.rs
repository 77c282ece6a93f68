//! Stop of a motion or command that this client started.

use armctl_controller::yrcx::alarm::{Alarm, STOP_INPUT};
use armctl_controller::yrcx::answer::Answer;
use armctl_controller::yrcx::order::Order;
use armctl_controller::yrcx::procedure::Procedure;
use armctl_controller::yrcx::session::Ended;
use armctl_controller::yrcx::signal::input;
use armctl_controller::yrcx::table::{Command, DurationClass};
use armctl_controller::yrcx::value::Values;

use tokio::time::Instant;

use super::error::Error;
use super::{Client, Event};
use crate::STOP_TIMEOUT;

/// What a stop ended.
///
/// ```
/// use armctl_client::yrcx::{Client, Options, Start, StopResult};
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut robot = Client::simulated(Start::default(), Options::default()).await?;
/// assert_eq!(robot.stop().await?, StopResult::Nothing, "this client moved nothing");
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub enum StopResult {
    /// No motion was sent, so there was nothing to stop.
    Nothing,
    /// A motion. The stop input was switched off and is on again.
    Motion {
        /// The order.
        order: Box<Order>,
        /// Final position, if the answer contains it (4.2.6).
        positions: Values,
    },
    /// A program, or a motion by signals. The stop input was switched off and is on again.
    Started,
    /// A command without motion.
    Command(Command),
    /// The command had already ended. The alarm is present if the command failed.
    AlreadyEnded(Command, Option<Alarm>),
}

impl Client {
    /// Stops the motion or command that this client started, without a check of the grant. The client switches the stop
    /// input SI(06) off, and on again after it has observed the end (chapter 1, 3.8). The stop takes at most 3 s.
    ///
    /// # Errors
    /// [`Error::OutcomeUnknown`] if the client did not observe the end. The stop input then stays off.
    pub async fn stop(&mut self) -> Result<StopResult, Error> {
        self.abandon_sequence();
        let until = Instant::now() + STOP_TIMEOUT;
        let now = self.now();
        if let Some(exchange) = &mut self.exchange {
            exchange.interrupt(now);
            let order = exchange.order().clone();
            if matches!(order.row().pace, DurationClass::Motion | DurationClass::Jog) {
                self.watcher.event(Event::Stopping);
            }
            let outcome = self.wait_for_outcome(Some(until)).await?;
            let command = order.command();
            return match outcome.ended {
                Ended::Answered(Answer::Refused { alarm, positions }) if alarm == STOP_INPUT => {
                    Ok(StopResult::Motion { order: Box::new(order), positions })
                }
                Ended::Answered(Answer::Refused { alarm, .. }) => Ok(StopResult::AlreadyEnded(command, Some(alarm))),
                Ended::Answered(_) => Ok(StopResult::AlreadyEnded(command, None)),
                Ended::NotSent(_) => Ok(StopResult::Nothing),
                Ended::Stopped => Ok(StopResult::Command(command)),
                Ended::NoAnswer(_) | Ended::OutcomeUnknown(_) => Err(self.unanswered(&outcome)),
            };
        }
        if !self.has_started {
            return Ok(StopResult::Nothing);
        }
        self.watcher.event(Event::Stopping);
        for procedure in [Some(Procedure::stop()), Procedure::set(input::STOP, true)].into_iter().flatten() {
            self.switch(procedure, until.saturating_duration_since(Instant::now())).await?;
        }
        self.has_started = false;
        Ok(StopResult::Started)
    }

    /// Whether a jog is running. Only a stop ends a jog.
    pub fn is_jogging(&self) -> bool {
        self.exchange.as_ref().is_some_and(|exchange| exchange.order().row().pace == DurationClass::Jog)
    }
}
