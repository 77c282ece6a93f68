//! Remote commands with one answer (chapter 2).

use std::time::Duration;

use armctl_controller::Risk;
use armctl_controller::yrcx::answer::Answer;
use armctl_controller::yrcx::image::Words;
use armctl_controller::yrcx::order::Order;
use armctl_controller::yrcx::recording::words_text;
use armctl_controller::yrcx::session::{Ended, Exchange, Outcome};
use armctl_controller::yrcx::signal::input;
use armctl_controller::yrcx::table::DurationClass;
use armctl_controller::yrcx::value::Values;
use armctl_transport::session::client::SessionBusy;
use tokio::time::Instant;

use super::error::{Error, Refusal};
use super::{Client, Event};
use crate::Reason;

/// Result of a completed command.
///
/// Example: [`Client`]
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CompletedCommand {
    /// Data of the answer. The names are those of the fields in the table row of the command (chapter 4 of the manual).
    /// Empty in a dry run. See [`Values`] for the units.
    pub values: Values,
    /// Time from the first attempt to the end.
    pub elapsed: Duration,
}

/// A whole answer, which may be a refusal.
///
/// ```
/// use armctl_client::yrcx::{Answer, Client, Command, Key, Options, Reply, Start};
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut robot = Client::simulated(Start::default(), Options::default()).await?;
/// let read = Command::PointGet.order().with(Key::Point, 29_999).build()?;
/// let Reply { answer, words, .. } = robot.raw(&read).await?;
/// match answer {
///     Answer::Done(values) | Answer::Running(values) => println!("{values:?}"),
///     Answer::Refused { alarm, .. } => println!("refused: {}, status {:#06x}", alarm.text(), words[0]),
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Reply {
    /// The decoded answer.
    pub answer: Answer,
    /// Words WO0 to WO15 of the answer.
    pub words: Words,
    /// Time from the first attempt to the end.
    pub elapsed: Duration,
}

impl Reply {
    /// Converts the reply to the result or the refusal.
    pub(super) fn of(self, order: &Order) -> Result<CompletedCommand, Refusal> {
        match self.answer {
            Answer::Done(values) | Answer::Running(values) => Ok(CompletedCommand { values, elapsed: self.elapsed }),
            Answer::Refused { alarm, positions } => Err(Refusal { order: order.clone(), alarm, positions }),
        }
    }

    pub(super) fn done(self, order: &Order) -> Result<CompletedCommand, Error> {
        self.of(order).map_err(|refusal| Box::new(refusal).into())
    }
}

/// Whether a command has ended when its answer arrives. Only a read has: a failure of the status reset then concerns the
/// next command, which waits for the ready status anyway. So the caller gets the answer one scan and two images earlier.
pub(super) fn ends_with_answer(order: &Order) -> bool {
    order.risk() == Risk::Read && !order.is_continuous()
}

impl Client {
    /// Sends a remote command and waits for its end; a refusal is returned as an error. Only a read is repeated, within
    /// the time limit. A read ends with its answer, any other command when the controller is ready again. A dry run
    /// plans the command.
    ///
    /// # Errors
    /// [`Error::Refused`] with the alarm. After [`Error::NotSent`] and [`Error::NoAnswer`], the command can be repeated
    /// without harm. After [`Error::OutcomeUnknown`], it must not be repeated.
    pub async fn ask(&mut self, order: &Order) -> Result<CompletedCommand, Error> {
        self.raw(order).await?.done(order)
    }

    /// Sends a command like [`ask`](Self::ask), but returns a refusal as a value.
    pub async fn try_ask(&mut self, order: &Order) -> Result<Result<CompletedCommand, Refusal>, Error> {
        Ok(self.raw(order).await?.of(order))
    }

    /// Sends a command like [`ask`](Self::ask), but returns the whole answer.
    pub async fn raw(&mut self, order: &Order) -> Result<Reply, Error> {
        self.authorize_command(order.row().id, order.risk())?;
        if self.is_dry_run() {
            self.plan_order(order, Reason::default());
            if order.risk() == Risk::Read {
                return Err(Error::DryRun);
            }
            let answer = Answer::Done(Values::default());
            return Ok(Reply { answer, words: Words::default(), elapsed: Duration::ZERO });
        }
        let start = Instant::now();
        let total_timeout = self.timeout.saturating_mul(self.retries.saturating_add(1));
        let mut repetitions = if order.risk() == Risk::Read { self.retries } else { 0 };
        loop {
            let outcome = self.transact(order).await?;
            match outcome.ended {
                Ended::NotSent(_) | Ended::NoAnswer(_) if repetitions > 0 && start.elapsed() < total_timeout => {
                    repetitions -= 1;
                }
                _ => {
                    let reply = self.reply(outcome)?;
                    if order.risk() == Risk::Read {
                        self.watcher.answered(&|| (words_text(order.words()), words_text(&reply.words)));
                    }
                    return Ok(reply);
                }
            }
        }
    }

    /// Sends a remote command and waits until the command has ended. Returns `None` as soon as the controller executes
    /// the command, if the command has not ended by then. The command continues, and the client sends no other command
    /// until it ends.
    ///
    /// # Errors
    /// [`Error::NotHeld`] if the end of the connection would stop the command; also the errors of [`ask`](Self::ask).
    pub async fn begin(&mut self, order: &Order) -> Result<Option<CompletedCommand>, Error> {
        if !self.is_held {
            return Err(Error::NotHeld);
        }
        if self.is_dry_run() {
            return self.ask(order).await.map(Some);
        }
        self.authorize_command(order.row().id, order.risk())?;
        self.start(order).await?;
        loop {
            if let Some(outcome) = self.ended.take() {
                return self.reply(outcome)?.done(order).map(Some);
            }
            if self.exchange.as_ref().is_some_and(Exchange::is_running) {
                return Ok(None);
            }
            self.run_turn().await?;
        }
    }

    async fn transact(&mut self, order: &Order) -> Result<Outcome, Error> {
        if order.row().pace == DurationClass::Jog {
            return Ok(self.run_jog(order, None).await?.outcome);
        }
        self.start(order).await?;
        let outcome = self.wait_for_outcome(None).await?;
        self.count(order, &outcome);
        Ok(outcome)
    }

    /// Counts a finished command. Reports to the watcher if the controller still had the status of an earlier command,
    /// or did not become ready for the next command.
    pub(super) fn count(&mut self, order: &Order, outcome: &Outcome) {
        self.totals.commands += 1;
        self.totals.waited += outcome.elapsed;
        // A status that this client or another client of the session is resetting is no surprise.
        let is_expected = self.resetting.take().is_some() || self.is_shared;
        if let Some(status) = outcome.leftover.filter(|_| !is_expected) {
            self.watcher.event(Event::StatusReset(order.command(), status));
        }
        if matches!(outcome.ended, Ended::Answered(_)) && !outcome.released {
            if ends_with_answer(order) {
                self.resetting = Some(order.command());
            } else {
                self.watcher.event(Event::NotReleased(order.command()));
            }
        }
        // For a motion, the command ends when the motion ends. For a start of a program, the command ends while the
        // program still runs.
        self.has_started |= order.risk() == Risk::Motion && order.row().pace == DurationClass::Quick;
    }

    pub(super) fn reply(&self, outcome: Outcome) -> Result<Reply, Error> {
        match outcome.ended {
            Ended::Answered(answer) => {
                Ok(Reply { answer, words: outcome.words.unwrap_or_default(), elapsed: outcome.elapsed })
            }
            _ => Err(self.unanswered(&outcome)),
        }
    }

    pub(super) fn unanswered(&self, outcome: &Outcome) -> Error {
        let command = outcome.row.command;
        match outcome.ended {
            Ended::NotSent(why) => Error::NotSent { command, why },
            Ended::NoAnswer(why) => Error::NoAnswer { command, why },
            Ended::OutcomeUnknown(why) => {
                let stop = self.is_up.then(|| input::STOP.is_on(&self.output.next));
                let ended = match self.check_session() {
                    Err(Error::Session(SessionBusy::Ended(why))) => Some(why),
                    _ => None,
                };
                Error::OutcomeUnknown { command, why, stop, is_stop_held: outcome.stop_held, ended }
            }
            Ended::Answered(_) | Ended::Stopped => Error::NoReport { what: outcome.row.id },
        }
    }

    /// Authorizes a command, and checks that this connection may command the controller.
    pub(super) fn authorize_command(&self, name: &str, risk: Risk) -> Result<(), Error> {
        self.authorize(name, risk)?;
        if !self.is_owner && !self.is_dry_run() {
            return Err(Error::MonitorOnly { what: name.to_owned() });
        }
        Ok(())
    }
}
