//! Serial line session: one request at a time, one answer to each request (TO 1-3).
//!
//! A line has no checksum, and answers have no sequence number. Because of this, the session could mistake a late
//! answer for the answer to the next request. To prevent this, it counts the pending answers and discards them before
//! it sends again.

mod framer;

use std::time::Duration;

pub use self::framer::{Framed, Framer};
use super::request::{BlockError, Request};
use super::table::Command;
use crate::{Now, Risk, Session, Step};

/// Time limits of a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Policy {
    /// Time from the last sent character to the answer; 1 s in the manual (TO 1-3, ambiguity A3).
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
    /// Characters received outside of blocks.
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
pub enum ExchangeResult {
    /// The answer to the request.
    Answered(String),
    /// No answer.
    NoAnswer,
    /// Only invalid answers arrived. Contains the last invalid answer and the reason.
    InvalidAnswer {
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
    /// Number of answers to earlier requests that may still arrive. The field below is the time until which they may
    /// arrive.
    pending_answers: u32,
    pending_until: Now,
    /// Whether the line echoes the sent characters.
    echoes: bool,
    /// Time at which the last line end of the controller is completely transmitted. The host may send only after this
    /// time (TO 1-3: half duplex).
    send_allowed_at: Now,
    /// Time of the last unexpected block.
    last_unexpected: Option<Now>,
    /// The last answered order, and the time of its answer. A second, contradicting answer may still arrive.
    last_order: Option<(AnsweredOrder, Now)>,
    /// An order that received both `@OK` and `@NG`.
    refuted: Option<AnsweredOrder>,
}

#[derive(Debug)]
enum State {
    /// No exchange is pending. Contains the outcome of the last exchange, if there was one.
    Ended(Option<ExchangeResult>),
    /// Waits until no answer is pending, then sends.
    Settling(Exchange),
    /// The request was sent. Waits for the answer until this time.
    Waiting(Exchange, Now),
    /// An accepted order that armctl does not read back. Waits until this time for a contradicting `@NG`.
    Confirming(String, Now),
}

/// A request and its state.
#[derive(Debug)]
struct Exchange {
    text: String,
    /// `None` for a free-text block, whose answer is not checked.
    request: Option<Request>,
    repetitions: u32,
    invalid_answer: Option<(String, String)>,
    /// Whether the session may send the request once more after an answer that is not in the manual. If the same answer
    /// arrives again, it is not damaged.
    may_confirm: bool,
    /// The echo of the request.
    echo: Option<String>,
    /// Earliest time of sending. A noisy line must be quiet first.
    not_before: Now,
    /// The order before this read. A contradicting answer to the order may still arrive.
    previous_order: Option<AnsweredOrder>,
    /// Whether an `@NG` arrived. It is either a contradicting answer to `previous_order`, or the answer to this read.
    is_refused: bool,
    /// Whether an `@OK` arrived. An `@OK` cannot answer a read.
    is_contradicted: bool,
    /// Limit of the wait for a quiet line before an order; set at the first poll.
    quiet_deadline: Option<Now>,
}

/// An order, and whether the controller accepted it.
#[derive(Debug, Clone)]
struct AnsweredOrder {
    order: Request,
    is_accepted: bool,
}

impl AnsweredOrder {
    /// Text of the answer.
    const fn block(&self) -> &'static str {
        if self.is_accepted { OK } else { NG }
    }
}

/// Time for which the line must be quiet before a retry after a garbled block, and before an order after an unexpected
/// block.
const QUIET_TIME: Duration = Duration::from_millis(50);
/// Maximum wait for a quiet line. After this time, an order is sent even if the line is not quiet.
const MAX_QUIET_WAIT: Duration = Duration::from_millis(500);
/// Time to wait for the answer to a read, after an `@NG` that may be the answer to the order before the read.
const LATE_ANSWER_WAIT: Duration = Duration::from_millis(200);
/// Time after an `@OK` in which an `@NG` may still be an answer to the same order.
const CONTRADICTION_WINDOW: Duration = Duration::from_millis(500);
/// Program starts. A program may end during the wait for a quiet line, so the session does not wait and the status is
/// read instead.
const PROGRAM_STARTS: [Command; 4] = [Command::Spst, Command::Ppst, Command::Sesy, Command::Extp];
/// Reason why an `@OK` is not valid.
const CONTRADICTORY_ANSWERS: &str = "received both @OK and @NG: one of the two answers is for another client of this \
                                     line";

impl LineSession {
    /// A line without pending answers.
    pub fn new(policy: Policy) -> Self {
        Self {
            policy,
            framer: Framer::default(),
            counters: Counters::default(),
            state: State::Ended(None),
            pending_answers: 0,
            pending_until: Now::ZERO,
            echoes: false,
            send_allowed_at: Now::ZERO,
            last_unexpected: None,
            last_order: None,
            refuted: None,
        }
    }

    /// Whether a contradicting answer to the last order may still arrive. This is possible until a read is answered.
    pub fn is_open(&self) -> bool {
        self.last_order.is_some()
    }

    /// Takes the order that received both `@OK` and `@NG`, and its outcome.
    pub fn take_refuted(&mut self) -> Option<(Request, ExchangeResult)> {
        self.refuted.take().map(|answered| {
            let invalid = ExchangeResult::InvalidAnswer {
                block: answered.block().to_owned(),
                why: CONTRADICTORY_ANSWERS.to_owned(),
            };
            (answered.order, invalid)
        })
    }

    /// Begins an exchange. A pending exchange is abandoned, and its answer is discarded. A repeatable request is sent
    /// again after a timeout.
    pub fn begin(&mut self, request: &Request, is_repeatable: bool) {
        self.start_exchange(request.text(), Some(request.clone()), is_repeatable);
    }

    /// Begins an exchange with a free-text block, including `@`. Any block counts as its answer.
    pub fn begin_raw(&mut self, block: &str) {
        self.start_exchange(block.to_owned(), None, false);
    }

    fn start_exchange(&mut self, text: String, request: Option<Request>, is_repeatable: bool) {
        if let State::Waiting(_, deadline) = self.state {
            self.pending_answers += 1;
            self.pending_until = deadline;
        }
        let repetitions = if is_repeatable { self.policy.retries } else { 0 };
        let not_before = Now::ZERO;
        self.state = State::Settling(Exchange {
            text,
            request,
            repetitions,
            invalid_answer: None,
            may_confirm: is_repeatable,
            echo: None,
            not_before,
            previous_order: None,
            is_refused: false,
            is_contradicted: false,
            quiet_deadline: None,
        });
    }

    /// Returns the bytes of an urgent block, such as a stop, that must be sent at once while an answer is pending;
    /// otherwise `None`. The answer to the urgent block is discarded, so that the next exchange gets its own answer.
    pub fn begin_urgent(&mut self, now: Now, request: &Request) -> Option<Vec<u8>> {
        let waits = matches!(self.state, State::Waiting(..));
        if !waits && (self.pending_answers == 0 || now >= self.pending_until) {
            return None;
        }
        let bytes = format!("{}\r\n", request.text()).into_bytes();
        self.state = State::Ended(None);
        self.pending_answers += if waits { 2 } else { 1 };
        self.pending_until = self.deadline(now, &bytes);
        self.counters.sent += 1;
        Some(bytes)
    }

    /// Resets the session for a reopened line: no answer is pending.
    pub fn reset(&mut self) {
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

    fn end(&mut self, ended: ExchangeResult) -> Step<ExchangeResult> {
        self.state = State::Ended(Some(ended.clone()));
        Step::Done(ended)
    }

    /// Handles the deadline of an answer.
    fn handle_timeout(&mut self, mut exchange: Exchange, deadline: Now) -> Step<ExchangeResult> {
        if exchange.is_refused {
            self.last_order.take_if(|(_, at)| deadline >= *at + CONTRADICTION_WINDOW);
            return self.end(ExchangeResult::Answered(NG.to_owned()));
        }
        // Only a copy of the request arrived. It is either an answer that equals the request, or the echo of a line
        // without a controller.
        if let Some(block) = exchange.echo.take().filter(|echo| !self.echoes && exchange.accepts(echo).is_ok()) {
            self.counters.echoes -= 1;
            return self.end(ExchangeResult::Answered(block));
        }
        self.pending_answers += 1;
        self.pending_until = deadline + self.policy.timeout;
        if exchange.repetitions > 0 {
            exchange.repetitions -= 1;
            self.counters.repeats += 1;
            self.state = State::Settling(exchange);
            // A retry sends the same request, so an answer to any of these requests is valid.
            return self.send(deadline);
        }
        self.end(match exchange.invalid_answer {
            Some((block, why)) => ExchangeResult::InvalidAnswer { block, why },
            None => ExchangeResult::NoAnswer,
        })
    }

    fn send(&mut self, now: Now) -> Step<ExchangeResult> {
        let State::Settling(mut exchange) = std::mem::replace(&mut self.state, State::Ended(None)) else {
            return Step::Wait(Now::MAX);
        };
        let bytes = format!("{}\r\n", exchange.text).into_bytes();
        self.counters.sent += 1;
        if !exchange.is_read() {
            self.last_order = None;
        }
        exchange.previous_order = self.last_order.as_ref().map(|(order, _)| order.clone());
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

    /// Handles a block that arrives while an exchange waits for its answer.
    fn handle_block(&mut self, now: Now, mut exchange: Exchange, deadline: Now, framed: Framed) -> State {
        self.counters.received += 1;
        let block = match framed {
            Framed::Block(block) => block,
            Framed::Garbled { text, why } => {
                return self.retry_when_quiet(now, exchange, deadline, (text, why.to_owned()));
            }
        };
        if block == exchange.text && exchange.echo.is_none() {
            self.counters.echoes += 1;
            exchange.echo = Some(block);
            return State::Waiting(exchange, deadline);
        }
        match &exchange.previous_order {
            Some(AnsweredOrder { is_accepted: true, .. }) if block == NG && !exchange.is_refused => {
                exchange.is_refused = true;
                return State::Waiting(exchange, deadline.min(now + LATE_ANSWER_WAIT));
            }
            Some(AnsweredOrder { is_accepted: false, .. }) if block == OK => exchange.is_contradicted = true,
            _ => {}
        }
        match exchange.accepts(&block) {
            Ok(()) => {
                self.echoes |= exchange.echo.is_some();
                // After retries, the controller may also answer the other attempts. These answers may arrive until this
                // time.
                self.pending_until = deadline;
                if exchange.is_read() {
                    self.handle_read_answer(now, &mut exchange, &block);
                    return State::Ended(Some(ExchangeResult::Answered(block)));
                }
                self.handle_order_answer(now, exchange.request, block)
            }
            Err(error @ (BlockError::Other { .. } | BlockError::Command { .. })) => {
                self.counters.foreign += 1;
                self.last_unexpected = Some(now);
                exchange.invalid_answer = Some((block, error.to_string()));
                State::Waiting(exchange, deadline)
            }
            // The same answer arrived twice. Damage does not repeat exactly, so the controller really stores this
            // content.
            Err(_) if exchange.is_confirmed(&block) => {
                self.pending_until = deadline;
                State::Ended(Some(ExchangeResult::Answered(block)))
            }
            Err(error) => {
                if exchange.is_unlisted_answer(&block) && std::mem::take(&mut exchange.may_confirm) {
                    exchange.repetitions = exchange.repetitions.max(1);
                }
                self.retry_when_quiet(now, exchange, deadline, (block, error.to_string()))
            }
        }
    }

    /// Handles the answer to a read. The controller answers in order, so it sends no older answer after this one. A
    /// device server may still send blocks that belong to another client.
    fn handle_read_answer(&mut self, now: Now, exchange: &mut Exchange, block: &str) {
        if exchange.is_contradicted || (exchange.is_refused && block != NG) {
            self.refuted = exchange.previous_order.take();
            self.last_order = None;
        }
        self.last_order.take_if(|(_, at)| now >= *at + CONTRADICTION_WINDOW);
    }

    /// Handles the answer to an order. A contradicting answer may follow.
    fn handle_order_answer(&mut self, now: Now, order: Option<Request>, block: String) -> State {
        let is_accepted = block == OK;
        let waits = is_accepted && order.as_ref().is_some_and(needs_contradiction_wait);
        if is_accepted || block == NG {
            self.last_order = order.map(|order| (AnsweredOrder { order, is_accepted }, now));
        }
        if waits {
            State::Confirming(block, now + QUIET_TIME)
        } else {
            State::Ended(Some(ExchangeResult::Answered(block)))
        }
    }

    /// Handles contradicting answers to an order.
    fn end_contradicted(&mut self, now: Now, block: String) -> State {
        self.counters.foreign += 1;
        self.last_unexpected = Some(now);
        self.last_order = None;
        State::Ended(Some(ExchangeResult::InvalidAnswer { block, why: CONTRADICTORY_ANSWERS.to_owned() }))
    }

    /// Handles a block that arrives before a read is sent. The block may be a contradicting answer to the order before
    /// the read.
    fn record_contradiction(&mut self, state: &State, framed: &Framed) {
        let is_read = matches!(state, State::Settling(exchange) if exchange.is_read());
        let other = self.last_order.take_if(|(order, _)| is_read && contradicts(order.block(), framed));
        self.refuted = other.map(|(order, _)| order).or(self.refuted.take());
    }

    /// Handles a garbled answer. A repeatable request is sent again as soon as the line is quiet. Other requests
    /// wait for their deadline.
    fn retry_when_quiet(
        &mut self,
        now: Now,
        mut exchange: Exchange,
        deadline: Now,
        invalid_answer: (String, String),
    ) -> State {
        self.counters.garbled += 1;
        exchange.invalid_answer = Some(invalid_answer);
        if exchange.repetitions == 0 {
            return State::Waiting(exchange, deadline);
        }
        exchange.repetitions -= 1;
        exchange.not_before = now + QUIET_TIME;
        State::Settling(exchange)
    }
}

/// Answers to an order.
const OK: &str = "@OK";
const NG: &str = "@NG";

/// Whether the session waits for a late `@NG` after an accepted order. It waits after memory clearing and after
/// motions, except starts of programs. A jog must not wait, because the wait would delay the stop of the jog.
fn needs_contradiction_wait(order: &Request) -> bool {
    match order.command() {
        Command::Jgst => false,
        Command::Mint => true,
        command => order.risk() == Risk::Motion && !PROGRAM_STARTS.contains(&command),
    }
}

/// Whether two answers contradict each other. This can happen because a device server may send each answer to all
/// clients.
fn contradicts(first: &str, second: &Framed) -> bool {
    let Framed::Block(second) = second else { return false };
    matches!((first, second.as_str()), (OK, NG) | (NG, OK))
}

impl Exchange {
    /// Whether the request is a read. Neither an `@OK` nor the answer to another read can be mistaken for the answer to
    /// a read.
    fn is_read(&self) -> bool {
        self.request.as_ref().is_some_and(|request| !request.row().is_order())
    }

    fn accepts(&self, block: &str) -> Result<(), BlockError> {
        self.request.as_ref().map_or(Ok(()), |request| request.check_answer(block))
    }

    /// Whether the block is an answer whose content is not in the manual.
    fn is_unlisted_answer(&self, block: &str) -> bool {
        self.request.as_ref().is_some_and(|request| request.answer_kept(block).is_ok())
    }

    /// Whether the same answer arrived before.
    fn is_confirmed(&self, block: &str) -> bool {
        self.invalid_answer.as_ref().is_some_and(|(before, _)| before == block) && self.is_unlisted_answer(block)
    }
}

impl Session for LineSession {
    type Outcome = ExchangeResult;

    fn poll(&mut self, now: Now) -> Step<ExchangeResult> {
        match &self.state {
            State::Ended(Some(ended)) => Step::Done(ended.clone()),
            State::Ended(None) => Step::Wait(Now::MAX),
            State::Settling(_) => {
                if now >= self.pending_until {
                    self.pending_answers = 0;
                }
                let quiet = self.last_unexpected.map_or(now, |time| time + QUIET_TIME);
                let State::Settling(exchange) = &mut self.state else { return Step::Wait(Now::MAX) };
                // Any block could be mistaken for the answer to an order, so an order waits for a quiet line.
                // Repeatable requests, such as a stop, do not wait.
                let quiet = if exchange.may_confirm {
                    now
                } else {
                    quiet.min(*exchange.quiet_deadline.get_or_insert(now + MAX_QUIET_WAIT))
                };
                let settled = if self.pending_answers > 0 { self.pending_until } else { now };
                let at = settled.max(exchange.not_before).max(quiet).max(self.send_allowed_at);
                if at > now { Step::Wait(at) } else { self.send(now) }
            }
            State::Waiting(_, until) | State::Confirming(_, until) if now < *until => Step::Wait(*until),
            State::Waiting(..) | State::Confirming(..) => {
                match std::mem::replace(&mut self.state, State::Ended(None)) {
                    State::Waiting(exchange, deadline) => self.handle_timeout(exchange, deadline.max(now)),
                    State::Confirming(block, _) => self.end(ExchangeResult::Answered(block)),
                    _ => Step::Wait(Now::MAX),
                }
            }
        }
    }

    fn handle(&mut self, now: Now, bytes: &[u8]) {
        let mut is_answered = false;
        for byte in bytes {
            self.send_allowed_at = if *byte == b'\r' { now + self.policy.character } else { now };
            let (framed, noise) = self.framer.push(*byte);
            self.counters.noise += noise;
            if noise > 0 {
                self.last_unexpected = Some(now);
            }
            let Some(framed) = framed else { continue };
            self.state = match std::mem::replace(&mut self.state, State::Ended(None)) {
                State::Waiting(exchange, deadline) => {
                    let state = self.handle_block(now, exchange, deadline, framed);
                    is_answered = matches!(state, State::Ended(_));
                    state
                }
                State::Confirming(first, _) if contradicts(&first, &framed) => self.end_contradicted(now, first),
                State::Ended(Some(ExchangeResult::Answered(first))) if is_answered && contradicts(&first, &framed) => {
                    self.end_contradicted(now, first)
                }
                state => {
                    self.counters.foreign += 1;
                    self.last_unexpected = Some(now);
                    self.pending_answers = self.pending_answers.saturating_sub(1);
                    self.record_contradiction(&state, &framed);
                    state
                }
            };
        }
        if let State::Settling(exchange) = &mut self.state
            && !bytes.is_empty()
            && !exchange.not_before.is_zero()
        {
            exchange.not_before = now + QUIET_TIME;
        }
    }
}

#[cfg(test)]
mod tests;
