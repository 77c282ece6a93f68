//! The conversation over a line: one request outstanding, one answer to each (TO 1-3).
//!
//! A line has no checksum and answers have no number, so what comes too late must not be taken for the answer to the
//! next request. The session therefore remembers how many answers it is owed, and lets them pass before it sends again.

mod framer;

use std::time::Duration;

pub use self::framer::{Framed, Framer};
use super::request::{BlockError, Request};
use super::table::Command;
use crate::{Now, Risk, Session, Step};

/// How patient a session is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Policy {
    /// From the last character sent to the answer; the manual says one second (TO 1-3, ambiguity A3).
    pub timeout: Duration,
    /// Repetitions of what may be repeated.
    pub retries: u32,
    /// How long one character is on the line.
    pub character: Duration,
}

/// What the line was like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    /// Requests sent, repetitions included.
    pub sent: u32,
    /// Blocks that came, whole or not.
    pub received: u32,
    /// Characters that belong to no block.
    pub noise: u32,
    /// Blocks with characters missing, changed or too many.
    pub garbled: u32,
    /// Blocks that answer something else, or came too late.
    pub foreign: u32,
    /// Requests that came back as they were, and are no answer.
    pub echoes: u32,
    /// Requests that were sent again after silence.
    pub repeats: u32,
}

/// How an exchange ends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Ended {
    /// With this block, which answers the request.
    Answered(String),
    /// Nothing that may be repeated was answered.
    NoAnswer,
    /// Only blocks came that are no answer: the last one, and why it is none.
    Unfitting {
        /// As it came.
        block: String,
        /// What is wrong with it.
        why: String,
    },
}

/// One end of a line, for one exchange after the other.
#[derive(Debug)]
pub struct LineSession {
    policy: Policy,
    framer: Framer,
    counters: Counters,
    state: State,
    /// Answers that may still come, and until when they are waited for.
    owed: u32,
    owed_until: Now,
    /// Whether the line sends back what is sent.
    echoes: bool,
    /// When the last line end of the controller is over, and the host may send (TO 1-3: half duplex).
    free: Now,
    /// When something came last that nobody asked for.
    stray: Option<Now>,
    /// The last order that was answered, which the other answer would contradict, and when it was answered.
    decided: Option<(Decided, Now)>,
    /// An order to which both answers came.
    refuted: Option<Decided>,
}

#[derive(Debug)]
enum State {
    /// Nothing was asked yet, or the last exchange has ended like this.
    Ended(Option<Ended>),
    /// Waits until the line owes nothing, then sends.
    Settling(Exchange),
    /// Sent; the answer may take until then.
    Waiting(Exchange, Now),
    /// An order that is not read back has a yes: a no may follow until then.
    Confirming(String, Now),
}

/// What is asked, and what came of it so far.
#[derive(Debug)]
struct Exchange {
    text: String,
    /// Answers of a request outside of the table are not checked.
    request: Option<Request>,
    repetitions: u32,
    unfitting: Option<(String, String)>,
    /// Whether an answer with what the manual does not list may be asked for once more, which tells it from a damaged one.
    may_confirm: bool,
    /// The request itself, as it came back.
    copy: Option<String>,
    /// Not before this moment: a line that was noisy gets quiet first.
    not_before: Now,
    /// The order before this question, to which its other answer may still come.
    follows: Option<Decided>,
    /// Whether a no came, which is that other answer or the one to this question.
    is_refused: bool,
    /// Whether a yes came, which answers no question.
    is_contradicted: bool,
    /// Until when an order waits for a line on which something comes that nobody asked for; set at the first look.
    patience: Option<Now>,
}

/// An order and its answer.
#[derive(Debug, Clone)]
struct Decided {
    order: Request,
    is_accepted: bool,
}

impl Decided {
    /// The answer that was taken.
    const fn block(&self) -> &'static str {
        if self.is_accepted { YES } else { NO }
    }
}

/// Silence after a garbled block, before the request is sent again; and after what nobody asked for, before an order.
const QUIET: Duration = Duration::from_millis(50);
/// How long an order waits for that silence. On a line that is never quiet it then goes out.
const PATIENCE: Duration = Duration::from_millis(500);
/// How long the answer to a question is waited for behind a no that may be one to the order before it.
const BEHIND_A_NO: Duration = Duration::from_millis(200);
/// How long behind a yes a no may be one to the same order.
const LATE: Duration = Duration::from_millis(500);
/// What runs may be over before the line is known to stay quiet: it is looked at instead.
const RUNS: [Command; 4] = [Command::Spst, Command::Ppst, Command::Sesy, Command::Extp];
/// Why a yes is none.
const BOTH_CAME: &str = "both @OK and @NG came: one of them answers another client of this line";

impl LineSession {
    /// A line in peace.
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

    /// Whether the other answer to the last order can still come: no question was answered since.
    pub fn is_open(&self) -> bool {
        self.decided.is_some()
    }

    /// The order to which both answers came, once; and why neither counts.
    pub fn take_refuted(&mut self) -> Option<(Request, Ended)> {
        self.refuted.take().map(|decided| {
            let unfitting = Ended::Unfitting { block: decided.block().to_owned(), why: BOTH_CAME.to_owned() };
            (decided.order, unfitting)
        })
    }

    /// Begins an exchange; what `is_repeatable` is sent again after silence. An exchange that had not ended is given
    /// up: its answer is let pass.
    pub fn begin(&mut self, request: &Request, is_repeatable: bool) {
        self.ask(request.text(), Some(request.clone()), is_repeatable);
    }

    /// Begins an exchange with a block that is in no table, `@` included; any block answers it.
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

    /// A block that cannot wait until the line has settled, such as a stop: the bytes to send at once, if anything is
    /// owed, and nothing otherwise. Its answer is let pass, so that the next exchange is answered by its own.
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

    /// The same line, opened anew: nothing is owed any more.
    pub fn renew(&mut self) {
        *self = Self { counters: self.counters, ..Self::new(self.policy) };
    }

    /// What the line was like so far.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Whether the line sends back what is sent.
    pub fn echoes(&self) -> bool {
        self.echoes
    }

    /// The same line with another patience.
    pub fn set_policy(&mut self, policy: Policy) {
        self.policy = policy;
    }

    fn end(&mut self, ended: Ended) -> Step<Ended> {
        self.state = State::Ended(Some(ended.clone()));
        Step::Done(ended)
    }

    /// The time for an answer is over.
    fn silence(&mut self, mut exchange: Exchange, deadline: Now) -> Step<Ended> {
        if exchange.is_refused {
            self.decided.take_if(|(_, at)| deadline >= *at + LATE);
            return self.end(Ended::Answered(NO.to_owned()));
        }
        // Only the request itself came: an answer that looks the same, or the echo of a line without a controller.
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
            // A repetition asks the same again: whichever answer comes is an answer to it.
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

    /// Until when the answer to a block may come that is sent now.
    fn deadline(&self, now: Now, bytes: &[u8]) -> Now {
        let length = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        now + self.policy.character.saturating_mul(length) + self.policy.timeout
    }

    /// What a block means to an exchange that waits.
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
                // If it was asked several times, the other answers may come as late as that.
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
            // Damage does not come twice in the same way: this is what the controller holds.
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

    /// A question has its answer. A controller answers one block after the other: nothing older comes any more, but what
    /// a device server sends of another client, for a while.
    fn asked(&mut self, now: Now, exchange: &mut Exchange, block: &str) {
        if exchange.is_contradicted || (exchange.is_refused && block != NO) {
            self.refuted = exchange.follows.take();
            self.decided = None;
        }
        self.decided.take_if(|(_, at)| now >= *at + LATE);
    }

    /// An order has its answer. The other one may follow.
    fn decide(&mut self, now: Now, order: Option<Request>, block: String) -> State {
        let is_accepted = block == YES;
        let waits = is_accepted && order.as_ref().is_some_and(is_waited_for);
        if is_accepted || block == NO {
            self.decided = order.map(|order| (Decided { order, is_accepted }, now));
        }
        if waits { State::Confirming(block, now + QUIET) } else { State::Ended(Some(Ended::Answered(block))) }
    }

    /// An order has both answers.
    fn contradicted(&mut self, now: Now, block: String) -> State {
        self.counters.foreign += 1;
        self.stray = Some(now);
        self.decided = None;
        State::Ended(Some(Ended::Unfitting { block, why: BOTH_CAME.to_owned() }))
    }

    /// A block came before a question was sent: it may be the other answer to the order before it.
    fn note_other(&mut self, state: &State, framed: &Framed) {
        let is_question = matches!(state, State::Settling(exchange) if exchange.is_question());
        let other = self.decided.take_if(|(decided, _)| is_question && contradicts(decided.block(), framed));
        self.refuted = other.map(|(decided, _)| decided).or(self.refuted.take());
    }

    /// A garbled block was the answer. What may be repeated is asked again as soon as the line is quiet; the rest waits
    /// for its time to run out.
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

/// The answers to an order.
const YES: &str = "@OK";
const NO: &str = "@NG";

/// Whether a no to an order is waited for before anything else is sent: of what moves by itself, but for what runs, and of
/// memory that is cleared. A jog must not be kept from its stop.
fn is_waited_for(order: &Request) -> bool {
    match order.command() {
        Command::Jgst => false,
        Command::Mint => true,
        command => order.risk() == Risk::Motion && !RUNS.contains(&command),
    }
}

/// Whether of two answers that came together one is a yes and the other a no: a device server may send each to all clients.
fn contradicts(first: &str, second: &Framed) -> bool {
    let Framed::Block(second) = second else { return false };
    matches!((first, second.as_str()), (YES, NO) | (NO, YES))
}

impl Exchange {
    /// Whether it asks for data, which neither `@OK` nor the answer to another question can be taken for.
    fn is_question(&self) -> bool {
        self.request.as_ref().is_some_and(|request| !request.row().is_order())
    }

    fn accepts(&self, block: &str) -> Result<(), BlockError> {
        self.request.as_ref().map_or(Ok(()), |request| request.check_answer(block))
    }

    /// Whether a block answers it with something that the manual does not list.
    fn keeps(&self, block: &str) -> bool {
        self.request.as_ref().is_some_and(|request| request.answer_kept(block).is_ok())
    }

    /// Whether the same came before.
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
                // Any block answers an order; what may be repeated, a stop among it, does not wait.
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
