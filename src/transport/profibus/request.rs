//! Requests of a master that is alone on its line. The master sends one request at a time, and repeats it until it is
//! answered or all attempts have failed.
//!
//! For each station, the frame count bit distinguishes a repeated request from a new one. After a loss, the frame count
//! is reset. Otherwise the station could answer a new request with an old answer.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use super::Now;
use super::error::UnexpectedBytes;
use super::rates::{IDLE, Rate, SYNC};
use super::wire::{Control, Frame, FrameCount, Piece, Service, Status, Stream, Telegram, sap};

/// Number of sent telegrams that are kept to detect the echo of an adapter.
const ECHO_HISTORY_LEN: usize = 4;
/// Maximum length of an answer in characters.
const MAX_ANSWER_LEN: usize = 255;

/// Outcome of a request. Also reports traffic of another master.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// The station answered.
    Answer(Answer),
    /// All attempts failed.
    NoAnswer {
        /// Number of attempts.
        attempts: u8,
        /// What was received instead.
        heard: UnexpectedBytes,
    },
    /// Another master is active. Contains its address, and the traffic that shows this.
    Foreign(u8, &'static str),
}

/// An answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// Short acknowledgement.
    Short,
    /// A frame with a status or data.
    Frame(Frame),
}

/// Counters of the requests and answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    /// Number of repeated requests.
    pub repeated: u64,
    /// Number of bytes that are not part of a telegram.
    pub noise: u64,
    /// Number of answers without a pending request, for example late answers.
    pub unexpected: u64,
}

/// Sender of requests.
#[derive(Debug)]
pub struct Requester {
    own_address: u8,
    rate: Rate,
    slot: Duration,
    retries: u8,
    stream: Stream,
    counts: BTreeMap<u8, FrameCount>,
    pending: Option<Pending>,
    /// The last telegrams that were sent.
    sent: VecDeque<Vec<u8>>,
    echoes: bool,
    /// Whether noise was received after the last send. If so, the next bytes may be the inside of a damaged telegram.
    is_garbled: bool,
    /// Sender and time of the last token.
    token: Option<(u8, Now)>,
    /// Earliest time of the next request.
    next_request_at: Now,
    counters: Counters,
}

#[derive(Debug)]
struct Pending {
    frame: Frame,
    bytes: Vec<u8>,
    attempts: u8,
    deadline: Now,
    /// Latest possible deadline. Each received character extends the deadline, but not beyond this time.
    latest: Now,
    heard: UnexpectedBytes,
}

impl Requester {
    /// Creates a requester for a master with this address.
    pub fn new(own_address: u8, rate: Rate, slot: Duration, retries: u8) -> Self {
        Self {
            own_address,
            rate,
            slot,
            retries,
            stream: Stream::default(),
            counts: BTreeMap::new(),
            pending: None,
            sent: VecDeque::new(),
            echoes: false,
            is_garbled: false,
            token: None,
            next_request_at: Now::ZERO,
            counters: Counters::default(),
        }
    }

    /// Counters of the requests and answers.
    pub const fn counters(&self) -> Counters {
        self.counters
    }

    /// Whether the adapter echoes the bytes that are sent.
    pub const fn echoes(&self) -> bool {
        self.echoes
    }

    /// Whether a request waits for its answer.
    pub const fn is_busy(&self) -> bool {
        self.pending.is_some()
    }

    /// Earliest time to send or repeat a request.
    pub fn due(&self) -> Now {
        self.pending.as_ref().map_or(self.next_request_at, |pending| pending.deadline)
    }

    /// Creates a request with data. With `sap`, the request is for this service access point of the station.
    pub fn request(&self, service: Service, station: u8, sap: Option<u8>, data: Vec<u8>) -> Frame {
        Frame {
            to: station,
            from: self.own_address,
            control: Control::Request(service, FrameCount::None),
            to_sap: sap,
            from_sap: sap.map(|_| sap::MASTER),
            data,
        }
    }

    /// Starts a request. The caller must send the returned bytes at once.
    ///
    /// # Panics
    /// If another request waits for its answer.
    pub fn ask(&mut self, now: Now, mut frame: Frame) -> Vec<u8> {
        assert!(self.pending.is_none(), "one request at a time");
        if let Control::Request(service, count) = &mut frame.control
            && service.is_counted()
        {
            *count = *self.counts.entry(frame.to).or_insert(FrameCount::First);
        }
        // Bytes that arrived earlier do not belong to this request.
        self.stream.clear();
        let bytes = frame.emit();
        let (deadline, latest) = self.deadlines(now, bytes.len());
        let heard = UnexpectedBytes::default();
        self.pending = Some(Pending { frame, bytes: bytes.clone(), attempts: 1, deadline, latest, heard });
        self.remember(&bytes);
        bytes
    }

    /// Encodes a telegram that has no answer.
    pub fn encode_unanswered(&mut self, now: Now, telegram: &Telegram) -> Vec<u8> {
        let bytes = telegram.emit();
        self.next_request_at = now + self.rate.pace().time(bytes.len()) + self.rate.bits(IDLE);
        self.remember(&bytes);
        bytes
    }

    /// Cancels the pending request to a station, and resets the frame count of the station.
    pub fn forget(&mut self, station: u8) {
        self.counts.remove(&station);
        self.pending.take_if(|pending| pending.frame.to == station);
    }

    /// Delays the next request until this time.
    pub fn wait(&mut self, until: Now) {
        self.next_request_at = self.next_request_at.max(until);
    }

    /// Handles received bytes. The caller repeats the call without bytes until it returns `None`.
    pub fn handle(&mut self, now: Now, bytes: &[u8]) -> Option<Outcome> {
        self.stream.push(bytes);
        if !bytes.is_empty() {
            self.next_request_at = self.next_request_at.max(now + self.rate.bits(IDLE));
        }
        let mut outcome = None;
        while outcome.is_none()
            && let Some(piece) = self.stream.next_piece()
        {
            outcome = self.take(now, piece);
        }
        if let Some(pending) = self.pending.as_mut().filter(|_| !bytes.is_empty()) {
            // The deadline allows for the missing characters at the bit rate of the line, and for the delay of the
            // adapter.
            let rest = self.rate.pace().time(self.stream.missing()) + self.slot;
            pending.deadline = (now + rest).max(pending.deadline).min(pending.latest);
        }
        outcome
    }

    /// Returns the bytes of a request that must be repeated. After the last attempt, returns the failure.
    pub fn poll(&mut self, now: Now) -> Option<Result<Vec<u8>, Outcome>> {
        let pending = self.pending.as_mut().filter(|pending| now >= pending.deadline)?;
        pending.heard.noise |= !self.stream.is_empty();
        pending.heard.echo |= self.echoes;
        self.stream.clear();
        if pending.attempts > self.retries {
            let (attempts, heard) = (pending.attempts, pending.heard);
            let station = pending.frame.to;
            self.forget(station);
            self.next_request_at = now + self.rate.bits(SYNC);
            return Some(Err(Outcome::NoAnswer { attempts, heard }));
        }
        pending.attempts += 1;
        let bytes = pending.bytes.clone();
        self.counters.repeated += 1;
        let (deadline, latest) = self.deadlines(now, bytes.len());
        if let Some(pending) = &mut self.pending {
            (pending.deadline, pending.latest) = (deadline, latest);
        }
        self.is_garbled = false;
        Some(Ok(bytes))
    }

    /// Deadline for the start of an answer, and latest deadline for its end.
    fn deadlines(&self, now: Now, len: usize) -> (Now, Now) {
        let begun = now + self.rate.pace().time(len) + self.slot;
        (begun, begun + self.rate.pace().time(MAX_ANSWER_LEN) + self.slot)
    }

    fn remember(&mut self, bytes: &[u8]) {
        self.is_garbled = false;
        self.sent.push_back(bytes.to_vec());
        while self.sent.len() > ECHO_HISTORY_LEN {
            self.sent.pop_front();
        }
    }

    fn take(&mut self, now: Now, piece: Piece) -> Option<Outcome> {
        let (telegram, bytes) = match piece {
            Piece::Telegram(telegram, bytes) => (telegram, bytes),
            Piece::Noise(..) => {
                self.counters.noise += 1;
                self.is_garbled = true;
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
            // Tokens and short acknowledgements have no checksum. After noise, they may be a part of a damaged
            // telegram.
            Telegram::Token { .. } | Telegram::ShortAcknowledge if self.is_garbled => return None,
            Telegram::Token { from, .. } => return self.heard_token(now, from),
            Telegram::Frame(frame) => match frame.control {
                Control::Request(..) => return Some(Outcome::Foreign(frame.from, "it sent a request")),
                Control::Answer(..) => Answer::Frame(frame),
            },
            Telegram::ShortAcknowledge => Answer::Short,
        };
        let Some(pending) = self.pending.take_if(|pending| is_answer_to(&pending.frame, &answer)) else {
            self.counters.unexpected += 1;
            if let Some(pending) = self.pending.as_mut().filter(|_| matches!(answer, Answer::Short)) {
                pending.heard.noise = true;
            }
            return None;
        };
        if let Control::Request(service, count) = pending.frame.control
            && service.is_counted()
        {
            self.counts.insert(pending.frame.to, count.next());
        }
        // After a repetition, the answer to the earlier attempt may still arrive. The longer pause ensures that it is
        // not mistaken for the answer to the next request.
        let pause = if pending.attempts > 1 { self.slot } else { self.rate.bits(IDLE) };
        self.next_request_at = now + pause;
        Some(Outcome::Answer(answer))
    }

    fn heard_token(&mut self, now: Now, from: u8) -> Option<Outcome> {
        let before = self.token.replace((from, now));
        let is_sure = before.is_some_and(|(other, at)| other == from && now.saturating_sub(at) <= TOKEN_WINDOW);
        is_sure.then_some(Outcome::Foreign(from, "it passed the token"))
    }
}

/// If two tokens of the same master arrive within this time, they cannot be noise.
const TOKEN_WINDOW: Duration = Duration::from_secs(1);

/// Whether this is a possible answer to the request.
fn is_answer_to(request_name: &Frame, answer: &Answer) -> bool {
    match answer {
        // A short acknowledgement is one byte without a sender or checksum. It answers only the services that have no data
        // to return. Anywhere else it is noise.
        Answer::Short => matches!(request_name.to_sap, Some(sap::SET_PRM | sap::CHK_CFG)),
        Answer::Frame(frame) => {
            let is_from = frame.from == request_name.to && frame.to == request_name.from;
            let refuses = matches!(
                frame.control,
                Control::Answer(_, Status::NoService | Status::UserError | Status::NoResource | Status::NoData)
            );
            let saps = (frame.to_sap, frame.from_sap);
            // A refusal may omit the service access points.
            is_from && (saps == (request_name.from_sap, request_name.to_sap) || refuses && saps == (None, None))
        }
    }
}
