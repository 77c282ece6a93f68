//! Event loop of a client: polls the sessions, sends the output image and waits for events.

use std::time::Duration;

use armctl_controller::Now;
use armctl_controller::yrcx::answer::{Answer, Status};
use armctl_controller::yrcx::image::{Image, Words};
use armctl_controller::yrcx::order::Order;
use armctl_controller::yrcx::register::general;
use armctl_controller::yrcx::sequence::{self, Sequence};
use armctl_controller::yrcx::session::{Ended, Exchange, ImageSession as _, Next, Outcome, Policy, Silence};
use armctl_controller::yrcx::signal::{input, output, resting};
use armctl_controller::yrcx::table::DurationClass;
use armctl_transport::image::{Event as LinkEvent, LinkError, image_after_loss};
use armctl_transport::session::client::SessionBusy;
use tokio::time::Instant;

use super::error::Error;
use super::exchange::ends_with_answer;
use super::{Client, Event, Reply, Transport};

/// Poll interval of a session without a deadline.
pub(super) const NO_DEADLINE: Duration = Duration::from_secs(3600);
/// Longest time for which the status reset stays after a command without an answer, also on a link with a longer watchdog
/// time. Images that old do not occur in practice, and the next command waits.
const MAX_SETTLE: Duration = Duration::from_secs(10);
/// Time limit for sending the last change before the connection is closed.
const LEAVE_TIMEOUT: Duration = Duration::from_secs(1);

impl Client {
    /// Waits for the first input image. On a commanding connection, also waits until the resting image is sent:
    /// emergency stop and stop inputs on, everything else off.
    ///
    /// # Errors
    /// [`Error::Silent`] without an image within the time limit.
    pub async fn ready(&mut self) -> Result<(), Error> {
        let until = Instant::now() + self.timeout;
        while self.input.is_none() || (self.is_owner && self.output.last_sent().is_none()) {
            if Instant::now() >= until {
                return Err(Error::Silent);
            }
            self.run_until(until).await?;
        }
        if !self.is_owner && self.input.is_some_and(|image| !output::CPU_OK.is_on(&image)) {
            // A monitoring connection also opens if the controller does not work or the data comes from another device.
            // The client itself must therefore check the image.
            self.watcher.event(Event::CpuNotOk);
        }
        Ok(())
    }

    pub(super) async fn start(&mut self, order: &Order) -> Result<(), Error> {
        if !self.has_commands() {
            return Err(Error::SignalsOnly { command: order.command() });
        }
        self.catch_up().await?;
        self.claim_motion(order.risk()).await?;
        self.reserve_words().await?;
        self.words = general(&self.output.next.command());
        let settle = match &self.transport {
            Transport::Image(link) => link.watchdog().saturating_mul(2).min(MAX_SETTLE),
            Transport::DryRun(_) | Transport::Nothing => Duration::ZERO,
        };
        let policy = Policy { settle, ends_with_answer: ends_with_answer(order), ..self.policy };
        let mut exchange = Exchange::new(order.clone(), policy);
        if let Some(image) = &self.input {
            exchange.handle(self.now(), image);
        }
        self.exchange = Some(exchange);
        Ok(())
    }

    /// Reserves the words of remote commands for the next command. No other command may be running.
    pub(super) async fn reserve_words(&mut self) -> Result<(), Error> {
        self.end_previous_command().await?;
        self.acquire().await?;
        self.check_other_commands().await
    }

    /// Finishes an earlier command of this client and reports its failure. Returns [`Error::CommandRunning`] if the
    /// command is still running.
    async fn end_previous_command(&mut self) -> Result<(), Error> {
        if self.exchange.is_some() {
            self.run_until(Instant::now()).await?;
        }
        let now = self.now();
        while let Some(exchange) = &mut self.exchange {
            if exchange.order().is_continuous() {
                exchange.interrupt(now);
            } else if exchange.is_running() {
                return Err(Error::CommandRunning { command: exchange.order().command() });
            }
            self.run_turn().await?;
        }
        if let Some(outcome) = self.ended.take().filter(|outcome| outcome.ended != Ended::Stopped) {
            let command = outcome.row.command;
            match self.reply(outcome) {
                Ok(Reply { answer: Answer::Refused { alarm, .. }, .. }) => {
                    self.watcher.event(Event::Aborted(command, alarm));
                }
                Ok(_) => {}
                Err(error) => self.watcher.event(Event::Unanswered(error)),
            }
        }
        Ok(())
    }

    /// Runs the event loop until the remote command has ended. If the link is lost during a motion, waits until the
    /// deadline for the link to return.
    pub(super) async fn wait_for_outcome(&mut self, until: Option<Instant>) -> Result<Outcome, Error> {
        loop {
            if let Some(outcome) = self.ended.take() {
                self.await_link(&outcome, until).await;
                return Ok(outcome);
            }
            self.run_turn().await?;
        }
    }

    /// Waits until the link is up again, if the link was lost during a motion. The client can then report the state of
    /// the stop input.
    pub(super) async fn await_link(&mut self, outcome: &Outcome, until: Option<Instant>) {
        let moves = matches!(outcome.row.pace, DurationClass::Motion | DurationClass::Jog);
        if !moves || outcome.ended != Ended::OutcomeUnknown(Silence::LinkLost) {
            return;
        }
        let until = until.unwrap_or_else(|| Instant::now() + self.timeout);
        // An error of this wait is ignored: the next call reports the error.
        while !self.is_up && Instant::now() < until && self.run_until(until).await.is_ok() {}
    }

    pub(super) fn start_sequence(&mut self, mut sequence: Sequence) -> Result<(), Error> {
        if self.sequence.is_some() {
            return Err(Error::ProcedureRunning);
        }
        if let Some(image) = &self.input {
            sequence.handle(self.now(), image);
        }
        self.finished = None;
        self.sequence = Some(sequence);
        Ok(())
    }

    pub(super) async fn wait_for_procedure(&mut self) -> Result<sequence::Outcome, Error> {
        loop {
            if let Some(outcome) = self.finished.take() {
                return Ok(outcome);
            }
            self.run_turn().await?;
        }
    }

    /// Aborts a procedure. Signals that the procedure pulsed go off.
    pub(super) fn abandon_sequence(&mut self) {
        let now = self.now();
        if let Some(mut sequence) = self.sequence.take() {
            sequence.handle_link_loss(now);
            // The outcome is known: aborted.
            let _ = sequence.poll(now, &mut self.output);
        }
    }

    /// Handles all pending events, without waiting.
    pub(super) async fn catch_up(&mut self) -> Result<(), Error> {
        let now = Instant::now();
        while self.event(now).await? {}
        self.check_session()
    }

    /// Waits at most 1 s for short commands to end, for the controller to be ready, and for the last change to be sent. A
    /// running motion continues.
    ///
    /// # Errors
    /// Errors of the link.
    pub async fn leave(&mut self) -> Result<(), Error> {
        self.abandon_sequence();
        if self.is_dry_run() || !self.is_owner {
            return Ok(());
        }
        let now = self.now();
        // A jog counts as a short command here: it does not end by itself, so the client stops it.
        let is_short = |exchange: &Exchange| exchange.order().row().pace != DurationClass::Motion;
        if let Some(exchange) = self.exchange.as_mut().filter(|exchange| is_short(exchange)) {
            exchange.interrupt(now);
        }
        let until = Instant::now() + LEAVE_TIMEOUT;
        while self.is_up && Instant::now() < until {
            let is_done = self.exchange.as_ref().is_none_or(|exchange| !is_short(exchange));
            if is_done && self.has_sent_all() {
                break;
            }
            self.run_until(until).await?;
        }
        if let Some(command) = self.resetting.filter(|_| !self.is_shared && self.is_resetting()) {
            self.watcher.event(Event::NotReleased(command));
        }
        Ok(())
    }

    /// Whether the last change was sent and the controller is ready. A session sends the status reset of a read after
    /// this client has left, and its next client waits for the ready controller.
    fn has_sent_all(&self) -> bool {
        let next = &self.output.next;
        let is_sent = self.output.last_sent() == Some(next);
        if self.is_shared {
            is_sent || self.resetting.is_some() && self.last_output.as_ref() == Some(next)
        } else {
            is_sent && !self.is_resetting()
        }
    }

    /// Whether the output image resets the status of an answered command, and the input image still has this status.
    pub(super) fn is_resetting(&self) -> bool {
        let status = self.input.map(|image| Status::from_word(image.0[0]));
        self.output_image().is_some_and(|output| output.0[0] == Status::Ready.word())
            && status.is_some_and(Status::is_end)
    }

    /// Runs one turn of the event loop: polls, sends, and returns after one event or deadline.
    pub(super) async fn run_turn(&mut self) -> Result<(), Error> {
        self.run_until(Instant::now() + NO_DEADLINE).await
    }

    /// Runs one [`run_turn`](Self::run_turn) with a deadline.
    pub(super) async fn run_until(&mut self, until: Instant) -> Result<(), Error> {
        let mut due = until;
        if !self.in_flight {
            let next = self.poll();
            self.send_output()?;
            self.release();
            match next {
                Some(next) => due = due.min(self.started + next.min(self.now().saturating_add(NO_DEADLINE))),
                // A session has just ended, and the caller waits for its outcome.
                None => return Ok(()),
            }
        }
        self.event(due).await.map(|_| ())
    }

    pub(super) fn now(&self) -> Now {
        self.started.elapsed()
    }

    /// Polls the sessions. Returns the next deadline, or `None` if a session has ended.
    fn poll(&mut self) -> Option<Now> {
        let now = self.now();
        let mut due = Now::MAX;
        let mut has_ended = false;
        if let Some(exchange) = &mut self.exchange {
            match exchange.poll(now, &mut self.output) {
                Next::Wait(until) => due = due.min(until),
                Next::Done(outcome) => {
                    self.exchange = None;
                    self.output.next.set_command(&self.words);
                    self.ended = Some(outcome);
                    self.is_turn_over = true;
                    has_ended = true;
                }
            }
        }
        if let Some(sequence) = &mut self.sequence {
            match sequence.poll(now, &mut self.output) {
                Next::Wait(until) => due = due.min(until),
                Next::Done(outcome) => {
                    self.sequence = None;
                    self.finished = Some(outcome);
                    has_ended = true;
                }
            }
        }
        (!has_ended).then_some(due)
    }

    /// Passes the output image to the transport, if it has changed.
    fn send_output(&mut self) -> Result<(), Error> {
        let Transport::Image(link) = &mut self.transport else { return Ok(()) };
        if !self.is_up || !self.is_owner || self.last_output == Some(self.output.next) {
            return Ok(());
        }
        link.set_output(&self.output.next.to_link(self.size))?;
        self.last_output = Some(self.output.next);
        self.in_flight = true;
        Ok(())
    }

    /// Handles the next event. Returns `false` if there is no event before `until`.
    async fn event(&mut self, until: Instant) -> Result<bool, Error> {
        let link = match &mut self.transport {
            Transport::Image(link) => link,
            Transport::DryRun(_) => return Err(Error::DryRun),
            Transport::Nothing => return Err(Error::Silent),
        };
        let event = link.next(until).await;
        let now = self.now();
        match event {
            LinkEvent::Timeout => return Ok(false),
            LinkEvent::Sent => {
                self.in_flight = false;
                self.output.sent(now);
                if self.is_shared {
                    self.resetting = None;
                }
                self.watcher.event(Event::ImageSent(self.output.next));
            }
            LinkEvent::Image(bytes) => self.handle_image(now, &bytes)?,
            LinkEvent::Lost(why) => self.handle_link_loss(now, why),
            LinkEvent::Reopened => {
                self.is_up = true;
                if self.is_shared {
                    self.adopt_session_output();
                } else {
                    let rest = image_after_loss(&resting().to_link(self.size), &self.output.next.to_link(self.size));
                    self.output.next = Image::from_link(&rest).unwrap_or_else(resting);
                }
                let stop = self.is_owner.then(|| input::STOP.is_on(&self.output.next));
                self.watcher.event(Event::Reopened { stop });
            }
            LinkEvent::OutputChanged(change) => self.apply_change(now, &change),
            LinkEvent::Denied => {
                self.in_flight = false;
                // If the command was already sent, the client continues to observe it until its end.
                self.exchange.take_if(|exchange| exchange.sent().is_none());
                self.sequence = None;
                self.words = Words::default();
                self.adopt_session_output();
                return Err(Error::Session(SessionBusy::ReadOnly));
            }
        }
        Ok(true)
    }

    fn handle_image(&mut self, now: Now, bytes: &[u8]) -> Result<(), Error> {
        let image = Image::from_link(bytes).ok_or(Error::NoImage { bytes: bytes.len() })?;
        self.watcher.event(Event::ImageReceived(image));
        self.input = Some(image);
        if let Some(exchange) = &mut self.exchange {
            exchange.handle(now, &image);
        }
        if let Some(sequence) = &mut self.sequence {
            sequence.handle(now, &image);
        }
        Ok(())
    }

    fn handle_link_loss(&mut self, now: Now, why: LinkError) {
        self.watcher.event(Event::Lost { why, is_reopening: self.check_session().is_ok() });
        self.totals.losses += 1;
        self.is_up = false;
        self.in_flight = false;
        self.last_output = None;
        self.input = None;
        self.output.unlinked();
        self.words = Words::default();
        if let Some(exchange) = &mut self.exchange {
            exchange.handle_link_loss(now);
        }
        if let Some(sequence) = &mut self.sequence {
            sequence.handle_link_loss(now);
        }
    }
}
