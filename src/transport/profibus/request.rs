//! One request at a time, repeated until it is answered: the lower half of a master that is alone on its line.
//!
//! The frame count of each station tells a repeated request from a new one. It begins anew after a loss; else the station
//! may answer a new request with the answer to an old one.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use super::Now;
use super::error::Heard;
use super::rates::{IDLE, Rate, SYNC};
use super::wire::{Control, Frame, FrameCount, Piece, Service, Status, Stream, Telegram};

/// Telegrams that are remembered, to know them when an adapter hands them back.
const REMEMBERED: usize = 4;
/// Most characters of an answer.
const LONGEST: usize = 255;

/// Result of a request, or what was heard instead.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// It was answered.
    Answer(Answer),
    /// All attempts are used up.
    NoAnswer {
        /// How many there were.
        attempts: u8,
        /// What came instead.
        heard: Heard,
    },
    /// Another master speaks. Its address, and what it said.
    Foreign(u8, &'static str),
}

/// An answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// All is well, and no more.
    Short,
    /// The state of a station, or data.
    Frame(Frame),
}

/// What was counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counted {
    /// Requests that were sent again.
    pub repeated: u64,
    /// Bytes that were no telegram.
    pub noise: u64,
    /// Answers to nothing that was asked, such as late ones.
    pub unexpected: u64,
}

/// Asks one station after the other.
#[derive(Debug)]
pub struct Requester {
    here: u8,
    rate: Rate,
    slot: Duration,
    retries: u8,
    stream: Stream,
    counts: BTreeMap<u8, FrameCount>,
    pending: Option<Pending>,
    /// The last telegrams that were sent.
    sent: VecDeque<Vec<u8>>,
    echoes: bool,
    /// Noise came since something was sent: what follows may be the inside of a damaged telegram.
    is_spoilt: bool,
    /// Who passed a token, and when.
    token: Option<(u8, Now)>,
    /// Nothing is sent before.
    free: Now,
    counted: Counted,
}

#[derive(Debug)]
struct Pending {
    frame: Frame,
    bytes: Vec<u8>,
    attempts: u8,
    deadline: Now,
    /// What comes does not move the deadline beyond this.
    latest: Now,
    heard: Heard,
}

impl Requester {
    /// A master with this address.
    pub fn new(here: u8, rate: Rate, slot: Duration, retries: u8) -> Self {
        Self {
            here,
            rate,
            slot,
            retries,
            stream: Stream::default(),
            counts: BTreeMap::new(),
            pending: None,
            sent: VecDeque::new(),
            echoes: false,
            is_spoilt: false,
            token: None,
            free: Now::ZERO,
            counted: Counted::default(),
        }
    }

    /// What was counted.
    pub const fn counted(&self) -> Counted {
        self.counted
    }

    /// Whether the adapter hands back what is sent.
    pub const fn echoes(&self) -> bool {
        self.echoes
    }

    /// Whether an answer is waited for.
    pub const fn is_busy(&self) -> bool {
        self.pending.is_some()
    }

    /// When the next request may be sent, or repeated.
    pub fn due(&self) -> Now {
        self.pending.as_ref().map_or(self.free, |pending| pending.deadline)
    }

    /// A request with data to a service access point of a station, or without one.
    pub fn request(&self, service: Service, station: u8, sap: Option<u8>, data: Vec<u8>) -> Frame {
        Frame {
            to: station,
            from: self.here,
            control: Control::Request(service, FrameCount::None),
            to_sap: sap,
            from_sap: sap.map(|_| super::wire::sap::MASTER),
            data,
        }
    }

    /// Asks; the bytes are to be sent at once.
    ///
    /// # Panics
    /// While an answer is waited for.
    pub fn ask(&mut self, now: Now, mut frame: Frame) -> Vec<u8> {
        assert!(self.pending.is_none(), "one request at a time");
        if let Control::Request(service, count) = &mut frame.control
            && service.is_counted()
        {
            *count = *self.counts.entry(frame.to).or_insert(FrameCount::First);
        }
        // What came before belongs to nothing any more.
        self.stream.clear();
        let bytes = frame.emit();
        let (deadline, latest) = self.deadlines(now, bytes.len());
        let heard = Heard::default();
        self.pending = Some(Pending { frame, bytes: bytes.clone(), attempts: 1, deadline, latest, heard });
        self.remember(&bytes);
        bytes
    }

    /// Sends what nobody answers.
    pub fn tell(&mut self, now: Now, telegram: &Telegram) -> Vec<u8> {
        let bytes = telegram.emit();
        self.free = now + self.rate.pace().time(bytes.len()) + self.rate.bits(IDLE);
        self.remember(&bytes);
        bytes
    }

    /// Begins the frame count of a station anew, and gives up what is asked of it.
    pub fn forget(&mut self, station: u8) {
        self.counts.remove(&station);
        self.pending.take_if(|pending| pending.frame.to == station);
    }

    /// Sends nothing before this moment.
    pub fn wait(&mut self, until: Now) {
        self.free = self.free.max(until);
    }

    /// Takes what has arrived; call it again without bytes until there is no outcome any more.
    pub fn handle(&mut self, now: Now, bytes: &[u8]) -> Option<Outcome> {
        self.stream.push(bytes);
        if !bytes.is_empty() {
            self.free = self.free.max(now + self.rate.bits(IDLE));
        }
        let mut outcome = None;
        while outcome.is_none()
            && let Some(piece) = self.stream.next_piece()
        {
            outcome = self.take(now, piece);
        }
        if let Some(pending) = self.pending.as_mut().filter(|_| !bytes.is_empty()) {
            // More of it comes at the speed of the line, and with the delay of the adapter.
            let rest = self.rate.pace().time(self.stream.missing()) + self.slot;
            pending.deadline = (now + rest).max(pending.deadline).min(pending.latest);
        }
        outcome
    }

    /// What is to be sent again, or that nothing came.
    pub fn poll(&mut self, now: Now) -> Option<Result<Vec<u8>, Outcome>> {
        let pending = self.pending.as_mut().filter(|pending| now >= pending.deadline)?;
        pending.heard.noise |= !self.stream.is_empty();
        pending.heard.echo |= self.echoes;
        self.stream.clear();
        if pending.attempts > self.retries {
            let (attempts, heard) = (pending.attempts, pending.heard);
            let station = pending.frame.to;
            self.forget(station);
            self.free = now + self.rate.bits(SYNC);
            return Some(Err(Outcome::NoAnswer { attempts, heard }));
        }
        pending.attempts += 1;
        let bytes = pending.bytes.clone();
        self.counted.repeated += 1;
        let (deadline, latest) = self.deadlines(now, bytes.len());
        if let Some(pending) = &mut self.pending {
            (pending.deadline, pending.latest) = (deadline, latest);
        }
        self.is_spoilt = false;
        Some(Ok(bytes))
    }

    /// When an answer must have begun, and when it must be over.
    fn deadlines(&self, now: Now, len: usize) -> (Now, Now) {
        let begun = now + self.rate.pace().time(len) + self.slot;
        (begun, begun + self.rate.pace().time(LONGEST) + self.slot)
    }

    fn remember(&mut self, bytes: &[u8]) {
        self.is_spoilt = false;
        self.sent.push_back(bytes.to_vec());
        while self.sent.len() > REMEMBERED {
            self.sent.pop_front();
        }
    }

    fn take(&mut self, now: Now, piece: Piece) -> Option<Outcome> {
        let (telegram, bytes) = match piece {
            Piece::Telegram(telegram, bytes) => (telegram, bytes),
            Piece::Noise(..) => {
                self.counted.noise += 1;
                self.is_spoilt = true;
                if let Some(pending) = &mut self.pending {
                    pending.heard.noise = true;
                }
                return None;
            }
        };
        if self.sent.contains(&bytes) {
            self.echoes = true;
            return None;
        }
        let answer = match telegram {
            // Neither has a check sum.
            Telegram::Token { .. } | Telegram::ShortAcknowledge if self.is_spoilt => return None,
            Telegram::Token { from, .. } => return self.heard_token(now, from),
            Telegram::Frame(frame) => match frame.control {
                Control::Request(..) => return Some(Outcome::Foreign(frame.from, "it sent a request")),
                Control::Answer(..) => Answer::Frame(frame),
            },
            Telegram::ShortAcknowledge => Answer::Short,
        };
        let Some(pending) = self.pending.take_if(|pending| answers(&pending.frame, &answer)) else {
            self.counted.unexpected += 1;
            return None;
        };
        if let Control::Request(service, count) = pending.frame.control
            && service.is_counted()
        {
            self.counts.insert(pending.frame.to, count.next());
        }
        // The answer to an attempt before may be on its way, too: it must not answer what comes next.
        let pause = if pending.attempts > 1 { self.slot } else { self.rate.bits(IDLE) };
        self.free = now + pause;
        Some(Outcome::Answer(answer))
    }

    fn heard_token(&mut self, now: Now, from: u8) -> Option<Outcome> {
        let before = self.token.replace((from, now));
        let is_sure = before.is_some_and(|(other, at)| other == from && now.saturating_sub(at) <= CHANCE);
        is_sure.then_some(Outcome::Foreign(from, "it passed the token"))
    }
}

/// Two tokens of one master within this time are no chance.
const CHANCE: Duration = Duration::from_secs(1);

/// Whether an answer fits what was asked.
fn answers(asked: &Frame, answer: &Answer) -> bool {
    match answer {
        // Says nothing of who sent it; whoever asks for a state or for data is not content with it.
        Answer::Short => asked.control != Control::Request(Service::FdlStatus, FrameCount::None),
        Answer::Frame(frame) => {
            let is_from = frame.from == asked.to && frame.to == asked.from;
            let refuses = matches!(
                frame.control,
                Control::Answer(_, Status::NoService | Status::UserError | Status::NoResource | Status::NoData)
            );
            let saps = (frame.to_sap, frame.from_sap);
            // Who refuses may leave the service access points away.
            is_from && (saps == (asked.from_sap, asked.to_sap) || refuses && saps == (None, None))
        }
    }
}
