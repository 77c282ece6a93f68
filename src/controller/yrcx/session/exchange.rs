//! Exchange of one remote command, from ready status to ready status or to the answer (chapter 2, sections 1.2 and 2).

use std::fmt;
use std::time::Duration;

use super::{EDGE_INTERVAL, ImageSession, Next, Policy, edge_due};
use crate::yrcx::answer::{Answer, Status};
use crate::yrcx::image::{COMMAND_WORDS, Image, Output, Words};
use crate::yrcx::order::Order;
use crate::yrcx::signal::input;
use crate::yrcx::table::{DurationClass, Row, STATUS_RESET};
use crate::yrcx::value::Values;
use crate::{Now, Risk};

/// Outcome of an exchange.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The row of the command.
    pub row: &'static Row,
    /// The answer, or the reason why there is none.
    pub ended: Ended,
    /// WO0 to WO15 with the end status.
    pub words: Option<Words>,
    /// Time from the first sending of the command to the end status.
    pub elapsed: Duration,
    /// Status that the controller had before the command, if another master or an earlier command left it.
    pub leftover: Option<Status>,
    /// Whether the running status was received. A short command may skip it.
    pub ran: bool,
    /// Whether the controller is ready again. `false` if the exchange [ended with the answer](Policy::ends_with_answer).
    pub released: bool,
    /// Whether the stop input was left off, because the end of the motion was not received.
    pub stop_held: bool,
}

/// Result of an exchange.
#[derive(Debug, Clone, PartialEq)]
pub enum Ended {
    /// The controller answered. An alarm is also an answer.
    Answered(Answer),
    /// The command was not sent, so the controller did nothing.
    NotSent(NotSentReason),
    /// The user stopped continuous output.
    Stopped,
    /// No answer to a command that can be repeated without harm.
    NoAnswer(Silence),
    /// No answer to a command that changes something. The controller may or may not have carried out the command, or
    /// may still execute it.
    OutcomeUnknown(Silence),
}

/// Why a command was not sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NotSentReason {
    /// No image was received.
    NoImage,
    /// The link was lost, or the driver does not send images.
    LinkLost,
    /// The controller was not ready. It executes another command, or it keeps this status although the master sends the
    /// status reset.
    NotReady(Status),
    /// The user interrupted the exchange.
    Interrupted,
}

/// Why there is no answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Silence {
    /// The link was lost after the command was sent.
    LinkLost,
    /// The controller stayed ready, and ignored the command.
    NotTaken,
    /// The command was still running at the deadline.
    TooLong,
    /// The running status ended, but no end status followed.
    Vanished,
    /// The controller has a status that is not in the manual.
    Undocumented(u16),
    /// The user interrupted the wait. For a motion, the stop input was switched off before.
    Interrupted,
}

impl fmt::Display for NotSentReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoImage => f.write_str("the controller sends no data"),
            Self::LinkLost => f.write_str("the connection is down"),
            Self::NotReady(status) => write!(f, "the controller is not ready for a command: its status is {status}"),
            Self::Interrupted => f.write_str("interrupted"),
        }
    }
}

impl fmt::Display for Silence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LinkLost => f.write_str("the connection was lost"),
            Self::NotTaken => f.write_str("the controller did not start the command"),
            Self::TooLong => f.write_str("the command still ran at the end of the wait"),
            Self::Vanished => f.write_str("the controller ended the run status without a result"),
            Self::Undocumented(word) => write!(f, "the controller reports the undocumented status {word:#06x}"),
            Self::Interrupted => {
                f.write_str("the controller did not confirm the end of the command within the time for a stop")
            }
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    /// The session sends the data words without a command word, until the controller is ready.
    Prepare,
    /// The session sends the command word.
    Command,
    /// The session has sent the status reset since this time.
    Release(Now),
    Over,
}

/// A remote command and its answer.
#[derive(Debug, Clone)]
pub struct Exchange {
    order: Order,
    policy: Policy,
    phase: Phase,
    started: Option<Now>,
    input: Option<Image>,
    linked: bool,
    /// Time of the first sending of the command word.
    sent: Option<Now>,
    /// Time at which the status was last valid.
    sane: Now,
    interrupted: Option<Now>,
    /// Time from which the ready status does not come from before the end of the last command.
    settled: Now,
    /// Whether the stop input is off because of an interruption.
    stopping: bool,
    running: Option<Answer>,
    outcome: Outcome,
}

impl Exchange {
    /// Creates a session for `order`.
    pub fn new(order: Order, policy: Policy) -> Self {
        let outcome = Outcome {
            row: order.row(),
            ended: Ended::NotSent(NotSentReason::NoImage),
            words: None,
            elapsed: Duration::ZERO,
            leftover: None,
            ran: false,
            released: false,
            stop_held: false,
        };
        Self {
            order,
            policy,
            phase: Phase::Prepare,
            started: None,
            input: None,
            linked: true,
            sent: None,
            sane: Now::ZERO,
            interrupted: None,
            settled: Now::ZERO,
            stopping: false,
            running: None,
            outcome,
        }
    }

    /// The order that the session carries out.
    pub fn order(&self) -> &Order {
        &self.order
    }

    /// The answer. It is available before the controller is ready again.
    pub fn answer(&self) -> Option<&Answer> {
        match (self.phase, &self.outcome.ended) {
            (Phase::Release(_) | Phase::Over, Ended::Answered(answer)) => Some(answer),
            _ => None,
        }
    }

    /// Time of the first sending of the command.
    pub fn sent(&self) -> Option<Now> {
        self.sent
    }

    /// Whether the controller has the running status.
    pub fn is_running(&self) -> bool {
        self.phase == Phase::Command && self.sent.is_some() && self.status() == Some(Status::Running)
    }

    /// New values of continuous output after the last call of this function (4.7.4).
    pub fn running(&mut self) -> Option<Answer> {
        self.running.take()
    }

    /// Time since the first sending of the command; zero before it.
    pub fn elapsed(&self, now: Now) -> Duration {
        self.sent.map_or(Duration::ZERO, |sent| now.saturating_sub(sent))
    }

    /// Interrupts the exchange. If the command was not sent, it is dropped. A motion is stopped with SI(06), and the
    /// session waits for its end. Continuous output is ended. Any other command ends soon by itself.
    pub fn interrupt(&mut self, now: Now) {
        self.interrupted.get_or_insert(now);
    }

    fn status(&self) -> Option<Status> {
        self.input.map(|image| Status::from_word(image.0[0]))
    }

    /// Sends the data words with the status reset. Sets the command word when the controller is ready and the data
    /// words were sent.
    fn prepare(&mut self, now: Now, output: &mut Output) {
        let mut words = *self.order.words();
        words[0] = Status::Ready.word();
        output.next.set_command(&words);
        if self.interrupted.is_some() {
            return self.finish(now, output, Ended::NotSent(NotSentReason::Interrupted));
        }
        if !self.linked {
            return self.finish(now, output, Ended::NotSent(NotSentReason::LinkLost));
        }
        let data_sent = output.last_sent().is_some_and(|sent| sent.command() == words);
        match self.status() {
            // The status reset was already sent together with the data words.
            Some(Status::Ready) if data_sent && now < self.settled => {}
            Some(Status::Ready) if data_sent && self.order.row().code == STATUS_RESET => {
                return self.finish(now, output, Ended::Answered(Answer::Done(Values::default())));
            }
            Some(Status::Ready) if data_sent => {
                output.next.set_command(self.order.words());
                self.sane = now;
                self.phase = Phase::Command;
                return;
            }
            Some(Status::Ready) | None => {}
            Some(status) => self.outcome.leftover = self.outcome.leftover.or(Some(status)),
        }
        if now >= self.ready_until(now) {
            let hindrance = match self.status() {
                Some(Status::Ready) | None => NotSentReason::NoImage,
                Some(status) => NotSentReason::NotReady(status),
            };
            self.finish(now, output, Ended::NotSent(hindrance));
        }
    }

    /// Sends the command word until the end status arrives.
    fn command(&mut self, now: Now, output: &mut Output) {
        let shown = output.last_sent().is_some_and(|sent| sent.command() == *self.order.words());
        if self.sent.is_none() && shown {
            self.sent = Some(now);
            self.sane = now;
        }
        if !self.linked {
            // The driver may have sent the command without a call of `sent`, so the command counts as sent.
            return self.finish(now, output, self.unanswered(Silence::LinkLost));
        }
        let status = self.status().unwrap_or(Status::Ready);
        if self.sent.is_none() {
            if status != Status::Ready || self.interrupted.is_some() {
                // The status belongs to a command of another master, because the command of this session was not sent.
                // This session removes its own command word.
                self.phase = Phase::Prepare;
                self.prepare(now, output);
            } else if now >= self.deadline() {
                self.finish(now, output, Ended::NotSent(NotSentReason::LinkLost));
            }
            return;
        }
        if status.is_end() {
            return self.take_end(now, output);
        }
        if status == Status::Running {
            self.outcome.ran = true;
            self.sane = now;
        }
        match self.interrupted {
            Some(_) if self.order.is_continuous() => return self.finish(now, output, Ended::Stopped),
            Some(since) => {
                if self.moves() {
                    self.hold_stop(output);
                }
                if now >= since.saturating_add(self.policy.stop) {
                    return self.finish(now, output, self.unanswered(Silence::Interrupted));
                }
            }
            None => {}
        }
        if now >= self.deadline() {
            let silence = match status {
                Status::Running => Silence::TooLong,
                Status::Other(word) => Silence::Undocumented(word),
                _ if self.outcome.ran => Silence::Vanished,
                _ => Silence::NotTaken,
            };
            self.finish(now, output, self.unanswered(silence));
        }
    }

    fn take_end(&mut self, now: Now, output: &mut Output) {
        let words = self.input.unwrap_or_default().command();
        if let Some(answer) = Answer::parse(&self.order, &words) {
            self.outcome.words = Some(words);
            self.finish(now, output, Ended::Answered(answer));
        }
    }

    /// Ends the exchange. After this, the session sends only the status reset.
    fn finish(&mut self, now: Now, output: &mut Output, ended: Ended) {
        let is_jog_at_large = self.order.row().pace == DurationClass::Jog && matches!(ended, Ended::OutcomeUnknown(_));
        if (self.stopping && !matches!(ended, Ended::Answered(_))) || is_jog_at_large {
            // The robot may still move, for example in a jog without an end. For this reason the stop input stays off.
            input::STOP.set(&mut output.next, false);
            self.outcome.stop_held = true;
            self.stopping = false;
        }
        self.outcome.ended = ended;
        self.outcome.elapsed = now.saturating_sub(self.sent.unwrap_or(now));
        output.next.set_command(&[0; COMMAND_WORDS]);
        if self.policy.ends_with_answer && matches!(self.outcome.ended, Ended::Answered(_)) && !self.stopping {
            self.phase = Phase::Over;
            return;
        }
        self.phase = Phase::Release(now);
        self.release(now, output);
    }

    /// Waits for the ready status. Then switches the stop input on again.
    ///
    /// After a command without an answer, an image with its end status can still be on its way. The next command would
    /// take this status for its own. Therefore the status reset stays for the longest time that an image needs.
    fn release(&mut self, now: Now, output: &mut Output) {
        let Phase::Release(since) = self.phase else { return };
        if self.is_unanswered() && self.linked && !self.outcome.stop_held {
            self.take_late_end(now);
        }
        let is_settled = !self.is_unanswered() || !self.linked || now >= since.saturating_add(self.policy.settle);
        let never_sent = matches!(self.outcome.ended, Ended::NotSent(_));
        let reset_sent = output.last_sent().is_some_and(|sent| sent.command() == [0; COMMAND_WORDS]);
        self.outcome.released = self.linked && reset_sent && self.status() == Some(Status::Ready);
        let patient = self.linked && (now < self.release_until(since) || !is_settled);
        if !patient && self.stopping {
            self.outcome.stop_held = true;
            self.stopping = false;
        }
        if self.stopping && edge_due(now, output, input::STOP).is_none() {
            input::STOP.set(&mut output.next, true);
            self.stopping = false;
        }
        let restored = !self.stopping
            && output.last_sent().is_none_or(|sent| input::STOP.is_on(sent) == input::STOP.is_on(&output.next));
        let was_given_up = matches!(
            self.outcome.ended,
            Ended::OutcomeUnknown(Silence::Interrupted) | Ended::NoAnswer(Silence::Interrupted)
        );
        if never_sent || (restored && is_settled && (self.outcome.released || was_given_up)) || !patient {
            self.phase = Phase::Over;
        }
    }

    /// Takes an end status that arrives after the time limit. No other command was sent, so it belongs to this command.
    fn take_late_end(&mut self, now: Now) {
        if !self.status().is_some_and(Status::is_end) {
            return;
        }
        let words = self.input.unwrap_or_default().command();
        if let Some(answer) = Answer::parse(&self.order, &words) {
            self.outcome.words = Some(words);
            self.outcome.ended = Ended::Answered(answer);
            self.outcome.elapsed = self.elapsed(now);
        }
    }

    const fn is_unanswered(&self) -> bool {
        matches!(self.outcome.ended, Ended::NoAnswer(_) | Ended::OutcomeUnknown(_))
    }

    fn hold_stop(&mut self, output: &mut Output) {
        if !self.stopping && input::STOP.is_on(&output.next) {
            input::STOP.set(&mut output.next, false);
            self.stopping = true;
        }
    }

    fn moves(&self) -> bool {
        matches!(self.order.row().pace, DurationClass::Motion | DurationClass::Jog)
    }

    fn unanswered(&self, silence: Silence) -> Ended {
        match self.order.risk() {
            Risk::Read => Ended::NoAnswer(silence),
            Risk::Write | Risk::Destroy | Risk::Motion => Ended::OutcomeUnknown(silence),
        }
    }

    fn started_or(&self, now: Now) -> Now {
        self.started.unwrap_or(now)
    }

    /// Deadline for the ready status before the command.
    fn ready_until(&self, now: Now) -> Now {
        self.started_or(now).max(self.settled).saturating_add(self.policy.ready)
    }

    /// Deadline for the ready status after the command. After a stop, it is the deadline of the stop. It is extended if the edge of the
    /// stop input needs more time.
    fn release_until(&self, since: Now) -> Now {
        let over = since.saturating_add(self.policy.release);
        let edge = since.saturating_add(EDGE_INTERVAL * 2);
        self.interrupted.map_or(over, |stop| over.min(stop.saturating_add(self.policy.stop).max(edge)))
    }

    /// Deadline of a command that was sent.
    fn deadline(&self) -> Now {
        let sane = self.sane.saturating_add(self.policy.accept);
        if self.status() != Some(Status::Running) {
            return sane;
        }
        match (self.policy.longest(self.order.row().pace), self.order.is_continuous()) {
            (Some(longest), false) => self.sent.unwrap_or(self.sane).saturating_add(longest),
            _ => Now::MAX,
        }
    }

    /// Time of the next action if no image arrives before it.
    fn due(&self, now: Now, output: &Output) -> Now {
        match self.phase {
            Phase::Prepare if now < self.settled => self.settled,
            Phase::Prepare => self.ready_until(now),
            Phase::Command => match self.interrupted {
                Some(since) => self.deadline().min(since.saturating_add(self.policy.stop)),
                None => self.deadline(),
            },
            Phase::Release(since) => {
                let settled = since.saturating_add(self.policy.settle);
                let over = match self.release_until(since) {
                    over if self.is_unanswered() && now < settled => over.min(settled),
                    over => over,
                };
                match edge_due(now, output, input::STOP) {
                    Some(edge) if self.stopping => over.min(edge),
                    _ => over,
                }
            }
            Phase::Over => now,
        }
    }
}

impl ImageSession for Exchange {
    type Outcome = Outcome;

    fn poll(&mut self, now: Now, output: &mut Output) -> Next<Outcome> {
        if self.started.is_none() {
            self.started = Some(now);
            if output.next.command()[0] != 0 {
                // The command of a client that has died. Its end status can still arrive.
                self.settled = now.saturating_add(self.policy.settle);
            }
        }
        match self.phase {
            Phase::Prepare => self.prepare(now, output),
            Phase::Command => self.command(now, output),
            Phase::Release(_) => self.release(now, output),
            Phase::Over => {}
        }
        match self.phase {
            Phase::Over => Next::Done(self.outcome.clone()),
            _ => Next::Wait(self.due(now, output)),
        }
    }

    fn handle(&mut self, _now: Now, input: &Image) {
        if !self.linked || self.phase == Phase::Over {
            return;
        }
        // The signals in an image also change without a command. Therefore only the command words are compared.
        let changed = || self.input.map(|known| known.command()) != Some(input.command());
        if self.phase == Phase::Command && self.order.is_continuous() && changed() {
            let running = Answer::parse(&self.order, &input.command());
            self.running = running.filter(|answer| matches!(answer, Answer::Running(_))).or(self.running.take());
        }
        self.input = Some(*input);
    }

    fn handle_link_loss(&mut self, _now: Now) {
        self.linked = false;
    }
}

#[cfg(test)]
mod tests;
