//! Serial line session: one request at a time, one answer to each (TO 1-3).
//!
//! A line has no checksum, and answers have no number. So a late answer could be mistaken for the answer to the next
//! request. The session counts the pending answers and discards them before it sends again.

mod framer;

use std::time::Duration;

pub use self::framer::{Framed, Framer};
use super::request::{BlockError, Request};
use super::table::Command;
use crate::{Now, Risk, Session, Step};

/// Time limits of a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Policy {
    /// From the last character sent to the answer; 1 s in the manual (TO 1-3, ambiguity A3).
    pub timeout: Duration,
    /// Retries of a repeatable request.
    pub retries: u32,
    /// Transmission time of one character.
    pub character: Duration,
}

/// Line statistics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    /// Requests sent, including retries.
    pub sent: u32,
    /// Blocks received, complete or not.
    pub received: u32,
    /// Characters outside of blocks.
    pub noise: u32,
    /// Blocks with missing, changed or additional characters.
    pub garbled: u32,
    /// Late blocks, and answers to other requests.
    pub foreign: u32,
    /// Requests that came back unchanged, and are not answers.
    pub echoes: u32,
    /// Retries after a timeout.
    pub repeats: u32,
}

/// Outcome of an exchange.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Ended {
    /// The answer to the request.
    Answered(String),
    /// No answer.
    NoAnswer,
    /// Only invalid answers: the last one, and the reason.
    Unfitting {
        /// The received block.
        block: String,
        /// The reason.
        why: String,
    },
}

/// Host side of a line, for consecutive exchanges.
#[derive(Debug)]
pub struct LineSession {
    policy: Policy,
    framer: Framer,
    counters: Counters,
    state: State,
    /// Number of pending answers of earlier requests, and their deadline.
    owed: u32,
    owed_until: Now,
    /// Whether the line echoes the sent characters.
    echoes: bool,
    /// Time at which the last line end of the controller is over, and the host may send (TO 1-3: half duplex).
    free: Now,
    /// Time of the last unexpected block.
    stray: Option<Now>,
    /// The last answered order, which a second answer would contradict, and the time of its answer.
    decided: Option<(Decided, Now)>,
    /// An order that received both answers.
    refuted: Option<Decided>,
}

#[derive(Debug)]
enum State {
    /// Idle, or ended with this outcome.
    Ended(Option<Ended>),
    /// Waits until no answer is pending, then sends.
    Settling(Exchange),
    /// Sent; waits for the answer until this time.
    Waiting(Exchange, Now),
    /// An accepted order that is not read back: waits until this time for a contradicting `@NG`.
    Confirming(String, Now),
}

/// A request and its state.
#[derive(Debug)]
struct Exchange {
    text: String,
    /// `None` for a free-text block, whose answer is not checked.
    request: Option<Request>,
    repetitions: u32,
    unfitting: Option<(String, String)>,
    /// Whether an answer outside the manual may be requested once more, to distinguish it from a damaged one.
    may_confirm: bool,
    /// The echo of the request.
    copy: Option<String>,
    /// Earliest time of sending: a noisy line must be quiet first.
    not_before: Now,
    /// The order before this read, which may still receive its other answer.
    follows: Option<Decided>,
    /// Whether an `@NG` arrived: the other answer to that order, or the answer to this read.
    is_refused: bool,
    /// Whether an `@OK` arrived, which cannot answer a read.
    is_contradicted: bool,
    /// Limit of the wait for a quiet line before an order; set at the first poll.
    patience: Option<Now>,
}

/// An order and its answer.
#[derive(Debug, Clone)]
struct Decided {
    order: Request,
    is_accepted: bool,
}

impl Decided {
    /// Text of the answer.
    const fn block(&self) -> &'static str {
        if self.is_accepted { YES } else { NO }
    }
}

/// Required silence before a retry after a garbled block, and before an order after an unexpected block.
const QUIET: Duration = Duration::from_millis(50);
/// Maximum wait for that silence. An order is then sent even on a line that is never quiet.
const PATIENCE: Duration = Duration::from_millis(500);
/// Wait for the answer to a read after an `@NG` that may belong to the order before it.
const BEHIND_A_NO: Duration = Duration::from_millis(200);
/// Time after an `@OK` during which an `@NG` may belong to the same order.
const LATE: Duration = Duration::from_millis(500);
/// Program starts: a program may end within the wait for a quiet line, so the status is read instead.
const RUNS: [Command; 4] = [Command::Spst, Command::Ppst, Command::Sesy, Command::Extp];
/// Reason why an `@OK` is not valid.
const BOTH_CAME: &str = "received both @OK and @NG: one of them is for another client of this line";

impl LineSession {
    /// A line without pending answers.
    pub fn new(policy: Policy) -> Self {
        Self {
            policy,
            framer: Framer::default(),
            counters: Counters::default(),
            state: State::Ended(None),
            owed: 0,
            owed_until: Now::ZERO,
            echoes: false,
            free: Now::ZERO,
            stray: None,
            decided: None,
            refuted: None,
        }
    }

    /// Whether the last order may still receive its other answer: no read was answered since.
    pub fn is_open(&self) -> bool {
        self.decided.is_some()
    }

    /// Takes the order that received both answers, and its outcome.
    pub fn take_refuted(&mut self) -> Option<(Request, Ended)> {
        self.refuted.take().map(|decided| {
            let unfitting = Ended::Unfitting { block: decided.block().to_owned(), why: BOTH_CAME.to_owned() };
            (decided.order, unfitting)
        })
    }

    /// Begins an exchange. An open exchange is abandoned, and its answer discarded. A repeatable request is sent again
    /// after a timeout.
    pub fn begin(&mut self, request: &Request, is_repeatable: bool) {
        self.ask(request.text(), Some(request.clone()), is_repeatable);
    }

    /// Begins an exchange with a free-text block, including `@`; any block is its answer.
    pub fn begin_raw(&mut self, block: &str) {
        self.ask(block.to_owned(), None, false);
    }

    fn ask(&mut self, text: String, request: Option<Request>, is_repeatable: bool) {
        if let State::Waiting(_, deadline) = self.state {
            self.owed += 1;
            self.owed_until = deadline;
        }
        let repetitions = if is_repeatable { self.policy.retries } else { 0 };
        let not_before = Now::ZERO;
        self.state = State::Settling(Exchange {
            text,
            request,
            repetitions,
            unfitting: None,
            may_confirm: is_repeatable,
            copy: None,
            not_before,
            follows: None,
            is_refused: false,
            is_contradicted: false,
            patience: None,
        });
    }

    /// Bytes of an urgent block, such as a stop, to send at once while an answer is pending; otherwise `None`. Its own
    /// answer is discarded, so that the next exchange gets the right one.
    pub fn urgent(&mut self, now: Now, request: &Request) -> Option<Vec<u8>> {
        let waits = matches!(self.state, State::Waiting(..));
        if !waits && (self.owed == 0 || now >= self.owed_until) {
            return None;
        }
        let bytes = format!("{}\r\n", request.text()).into_bytes();
        self.state = State::Ended(None);
        self.owed += if waits { 2 } else { 1 };
        self.owed_until = self.deadline(now, &bytes);
        self.counters.sent += 1;
        Some(bytes)
    }

    /// Resets the session for a reopened line: no answer is pending.
    pub fn renew(&mut self) {
        *self = Self { counters: self.counters, ..Self::new(self.policy) };
    }

    /// Statistics so far.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Whether the line echoes the sent characters.
    pub fn echoes(&self) -> bool {
        self.echoes
    }

    /// Changes the time limits.
    pub fn set_policy(&mut self, policy: Policy) {
        self.policy = policy;
    }

    fn end(&mut self, ended: Ended) -> Step<Ended> {
        self.state = State::Ended(Some(ended.clone()));
        Step::Done(ended)
    }

    /// Handles the deadline of an answer.
    fn silence(&mut self, mut exchange: Exchange, deadline: Now) -> Step<Ended> {
        if exchange.is_refused {
            self.decided.take_if(|(_, at)| deadline >= *at + LATE);
            return self.end(Ended::Answered(NO.to_owned()));
        }
        // Only a copy of the request arrived: an equal answer, or the echo of a line without a controller.
        if let Some(block) = exchange.copy.take().filter(|copy| !self.echoes && exchange.accepts(copy).is_ok()) {
            self.counters.echoes -= 1;
            return self.end(Ended::Answered(block));
        }
        self.owed += 1;
        self.owed_until = deadline + self.policy.timeout;
        if exchange.repetitions > 0 {
            exchange.repetitions -= 1;
            self.counters.repeats += 1;
            self.state = State::Settling(exchange);
            // A retry is the same request, so any of the answers is valid.
            return self.send(deadline);
        }
        self.end(match exchange.unfitting {
            Some((block, why)) => Ended::Unfitting { block, why },
            None => Ended::NoAnswer,
        })
    }

    fn send(&mut self, now: Now) -> Step<Ended> {
        let State::Settling(mut exchange) = std::mem::replace(&mut self.state, State::Ended(None)) else {
            return Step::Wait(Now::MAX);
        };
        let bytes = format!("{}\r\n", exchange.text).into_bytes();
        self.counters.sent += 1;
        if !exchange.is_question() {
            self.decided = None;
        }
        exchange.follows = self.decided.as_ref().map(|(decided, _)| decided.clone());
        self.framer.clear();
        let deadline = self.deadline(now, &bytes);
        self.state = State::Waiting(exchange, deadline);
        Step::Send(bytes)
    }

    /// Deadline for the answer to a block that is sent now.
    fn deadline(&self, now: Now, bytes: &[u8]) -> Now {
        let length = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        now + self.policy.character.saturating_mul(length) + self.policy.timeout
    }

    /// Handles a block while an exchange waits.
    fn take(&mut self, now: Now, mut exchange: Exchange, deadline: Now, framed: Framed) -> State {
        self.counters.received += 1;
        let block = match framed {
            Framed::Block(block) => block,
            Framed::Garbled { text, why } => return self.again(now, exchange, deadline, (text, why.to_owned())),
        };
        if block == exchange.text && exchange.copy.is_none() {
            self.counters.echoes += 1;
            exchange.copy = Some(block);
            return State::Waiting(exchange, deadline);
        }
        match &exchange.follows {
            Some(Decided { is_accepted: true, .. }) if block == NO && !exchange.is_refused => {
                exchange.is_refused = true;
                return State::Waiting(exchange, deadline.min(now + BEHIND_A_NO));
            }
            Some(Decided { is_accepted: false, .. }) if block == YES => exchange.is_contradicted = true,
            _ => {}
        }
        match exchange.accepts(&block) {
            Ok(()) => {
                self.echoes |= exchange.copy.is_some();
                // After retries, the other answers may arrive until this time.
                self.owed_until = deadline;
                if exchange.is_question() {
                    self.asked(now, &mut exchange, &block);
                    return State::Ended(Some(Ended::Answered(block)));
                }
                self.decide(now, exchange.request, block)
            }
            Err(error @ (BlockError::Other { .. } | BlockError::Command { .. })) => {
                self.counters.foreign += 1;
                self.stray = Some(now);
                exchange.unfitting = Some((block, error.to_string()));
                State::Waiting(exchange, deadline)
            }
            // Damage does not repeat exactly: this is the content of the controller.
            Err(_) if exchange.is_confirmed(&block) => {
                self.owed_until = deadline;
                State::Ended(Some(Ended::Answered(block)))
            }
            Err(error) => {
                if exchange.keeps(&block) && std::mem::take(&mut exchange.may_confirm) {
                    exchange.repetitions = exchange.repetitions.max(1);
                }
                self.again(now, exchange, deadline, (block, error.to_string()))
            }
        }
    }

    /// Handles the answer to a read. The controller answers in order, so it sends no older answer now. A device server
    /// may still send blocks of another client.
    fn asked(&mut self, now: Now, exchange: &mut Exchange, block: &str) {
        if exchange.is_contradicted || (exchange.is_refused && block != NO) {
            self.refuted = exchange.follows.take();
            self.decided = None;
        }
        self.decided.take_if(|(_, at)| now >= *at + LATE);
    }

    /// Handles the answer to an order. A contradicting one may follow.
    fn decide(&mut self, now: Now, order: Option<Request>, block: String) -> State {
        let is_accepted = block == YES;
        let waits = is_accepted && order.as_ref().is_some_and(is_waited_for);
        if is_accepted || block == NO {
            self.decided = order.map(|order| (Decided { order, is_accepted }, now));
        }
        if waits { State::Confirming(block, now + QUIET) } else { State::Ended(Some(Ended::Answered(block))) }
    }

    /// Handles contradicting answers to an order.
    fn contradicted(&mut self, now: Now, block: String) -> State {
        self.counters.foreign += 1;
        self.stray = Some(now);
        self.decided = None;
        State::Ended(Some(Ended::Unfitting { block, why: BOTH_CAME.to_owned() }))
    }

    /// Handles a block before a read is sent: it may be the other answer to the order before it.
    fn note_other(&mut self, state: &State, framed: &Framed) {
        let is_question = matches!(state, State::Settling(exchange) if exchange.is_question());
        let other = self.decided.take_if(|(decided, _)| is_question && contradicts(decided.block(), framed));
        self.refuted = other.map(|(decided, _)| decided).or(self.refuted.take());
    }

    /// Handles a garbled answer. A repeatable request is sent again as soon as the line is quiet. Other requests
    /// wait for their deadline.
    fn again(&mut self, now: Now, mut exchange: Exchange, deadline: Now, unfitting: (String, String)) -> State {
        self.counters.garbled += 1;
        exchange.unfitting = Some(unfitting);
        if exchange.repetitions == 0 {
            return State::Waiting(exchange, deadline);
        }
        exchange.repetitions -= 1;
        exchange.not_before = now + QUIET;
        State::Settling(exchange)
    }
}

/// Answers to an order.
const YES: &str = "@OK";
const NO: &str = "@NG";

/// Whether an accepted order waits for a late `@NG`: motions without program starts, and memory clearing. A jog must
/// not wait, because its stop must not be delayed.
fn is_waited_for(order: &Request) -> bool {
    match order.command() {
        Command::Jgst => false,
        Command::Mint => true,
        command => order.risk() == Risk::Motion && !RUNS.contains(&command),
    }
}

/// Whether two answers contradict each other. A device server may send each answer to all clients.
fn contradicts(first: &str, second: &Framed) -> bool {
    let Framed::Block(second) = second else { return false };
    matches!((first, second.as_str()), (YES, NO) | (NO, YES))
}

impl Exchange {
    /// Whether it is a read. Neither `@OK` nor the answer to another read can be mistaken for its answer.
    fn is_question(&self) -> bool {
        self.request.as_ref().is_some_and(|request| !request.row().is_order())
    }

    fn accepts(&self, block: &str) -> Result<(), BlockError> {
        self.request.as_ref().map_or(Ok(()), |request| request.check_answer(block))
    }

    /// Whether the block is an answer with content outside the manual.
    fn keeps(&self, block: &str) -> bool {
        self.request.as_ref().is_some_and(|request| request.answer_kept(block).is_ok())
    }

    /// Whether the same answer arrived before.
    fn is_confirmed(&self, block: &str) -> bool {
        self.unfitting.as_ref().is_some_and(|(before, _)| before == block) && self.keeps(block)
    }
}

impl Session for LineSession {
    type Outcome = Ended;

    fn poll(&mut self, now: Now) -> Step<Ended> {
        match &self.state {
            State::Ended(Some(ended)) => Step::Done(ended.clone()),
            State::Ended(None) => Step::Wait(Now::MAX),
            State::Settling(_) => {
                if now >= self.owed_until {
                    self.owed = 0;
                }
                let quiet = self.stray.map_or(now, |stray| stray + QUIET);
                let State::Settling(exchange) = &mut self.state else { return Step::Wait(Now::MAX) };
                // Any block could answer an order. Repeatable requests, such as a stop, do not wait.
                let quiet = if exchange.may_confirm {
                    now
                } else {
                    quiet.min(*exchange.patience.get_or_insert(now + PATIENCE))
                };
                let settled = if self.owed > 0 { self.owed_until } else { now };
                let at = settled.max(exchange.not_before).max(quiet).max(self.free);
                if at > now { Step::Wait(at) } else { self.send(now) }
            }
            State::Waiting(_, until) | State::Confirming(_, until) if now < *until => Step::Wait(*until),
            State::Waiting(..) | State::Confirming(..) => {
                match std::mem::replace(&mut self.state, State::Ended(None)) {
                    State::Waiting(exchange, deadline) => self.silence(exchange, deadline.max(now)),
                    State::Confirming(block, _) => self.end(Ended::Answered(block)),
                    _ => Step::Wait(Now::MAX),
                }
            }
        }
    }

    fn handle(&mut self, now: Now, bytes: &[u8]) {
        let mut is_answered = false;
        for byte in bytes {
            self.free = if *byte == b'\r' { now + self.policy.character } else { now };
            let (framed, noise) = self.framer.push(*byte);
            self.counters.noise += noise;
            if noise > 0 {
                self.stray = Some(now);
            }
            let Some(framed) = framed else { continue };
            self.state = match std::mem::replace(&mut self.state, State::Ended(None)) {
                State::Waiting(exchange, deadline) => {
                    let state = self.take(now, exchange, deadline, framed);
                    is_answered = matches!(state, State::Ended(_));
                    state
                }
                State::Confirming(first, _) if contradicts(&first, &framed) => self.contradicted(now, first),
                State::Ended(Some(Ended::Answered(first))) if is_answered && contradicts(&first, &framed) => {
                    self.contradicted(now, first)
                }
                state => {
                    self.counters.foreign += 1;
                    self.stray = Some(now);
                    self.owed = self.owed.saturating_sub(1);
                    self.note_other(&state, &framed);
                    state
                }
            };
        }
        if let State::Settling(exchange) = &mut self.state
            && !bytes.is_empty()
            && !exchange.not_before.is_zero()
        {
            exchange.not_before = now + QUIET;
        }
    }
}

#[cfg(test)]
mod tests;
