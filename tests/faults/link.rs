//! A faulty link between a session and a controller, in virtual time.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::time::Duration;

use armctl_controller::yerc::request::Request;
use armctl_controller::yerc::wire::Status;
use armctl_controller::{Now, Session, Step};
use armctl_transport::fault::{FaultSpec, Faults};

/// Time that a controller needs for an answer.
const SERVICE_TIME: Duration = Duration::from_millis(8);
/// Maximum number of steps of a session. A session with more steps is considered endless.
const MAX_STEPS: usize = 100_000;

/// Class of a command. The classes differ in the effect of a repetition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Class {
    Read,
    Write,
    Start,
    Move,
}

/// Direction of a transfer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TransferKind {
    Save,
    List,
    Load,
}

/// A controller at the remote end of a link. Tests can read its state.
pub(crate) trait Controller {
    /// Handles a datagram. Returns the answers.
    fn receive(&mut self, now: Now, datagram: &[u8]) -> Vec<Vec<u8>>;

    /// Time at which the controller sends its next datagram without a request.
    fn wake(&self) -> Option<Now> {
        None
    }

    /// Datagrams that the controller sends without a request.
    fn transmit(&mut self, _now: Now) -> Vec<Vec<u8>> {
        Vec::new()
    }

    /// Returns a request of this class.
    fn order(&mut self, class: Class) -> Request;

    /// Whether the controller has answered a read with this data.
    fn has_answered(&self, data: &[u8]) -> bool;

    /// Whether the controller can refuse with this status for another reason than being busy.
    fn may_refuse(&self, status: Status) -> bool;

    /// Total number of state-changing requests that the controller has executed. When this function is called, no
    /// datagram to the controller may be in transit.
    fn executed(&self) -> u32;

    /// Prepares a transfer of this content in this direction. Returns the file name for the request, and the content
    /// that the transfer yields.
    fn offer(&mut self, way: TransferKind, content: &[u8]) -> (&'static [u8], Vec<u8>);

    /// Removes the file of an upload, if the controller can do this.
    fn forget(&mut self);

    /// Content of the file that an upload has stored.
    fn stored(&self) -> Option<Vec<u8>>;

    /// Whether the controller can omit blocks of a file when frames are lost.
    fn skips(&self) -> bool;
}

/// Destination of a datagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum To {
    Client,
    Controller,
}

/// A datagram in transit: its arrival time, a number that keeps the order of equal times, its destination and its
/// bytes.
type Flight = Reverse<(Now, u64, To, Vec<u8>)>;

/// Result of a session.
pub(crate) struct Run<O> {
    /// How the session ended.
    pub(crate) outcome: O,
    /// Content that the session delivered.
    pub(crate) data: Vec<u8>,
    /// Every frame that the session sent.
    pub(crate) sent: Vec<Vec<u8>>,
    /// Number of refusals because the controller was busy.
    pub(crate) busy: usize,
    /// Duration from the first to the last step of the session.
    pub(crate) duration: Duration,
    /// Duration from the last progress of the session to its end. Progress is content, or a frame that differs from the
    /// previous frame in more than the id.
    pub(crate) idle: Duration,
}

/// A client, a faulty wire and a controller.
pub(crate) struct Link<C> {
    pub(crate) controller: C,
    now: Now,
    to_controller: Faults,
    to_client: Faults,
    flights: BinaryHeap<Flight>,
    launched: u64,
    /// Number of busy refusals so far.
    busy: usize,
    /// Number of client frames before the lost frame.
    lose_in: Option<usize>,
}

impl<C: Controller> Link<C> {
    pub(crate) fn new(controller: C, faults: FaultSpec) -> Self {
        let (to_controller, to_client) = Faults::pair(faults);
        Self {
            controller,
            now: Now::ZERO,
            to_controller,
            to_client,
            flights: BinaryHeap::new(),
            launched: 0,
            busy: 0,
            lose_in: None,
        }
    }

    /// Loses the client frame with this number. The next frame has number 0.
    pub(crate) fn lose_client_frame(&mut self, number: usize) {
        self.lose_in = Some(number);
    }

    /// Runs a session to its end. `feed` provides the content that the session sends.
    pub(crate) fn run<S: Session>(&mut self, session: &mut S, mut feed: impl FnMut(&mut S)) -> Run<S::Outcome> {
        let (started, busy) = (self.now, self.busy);
        let mut progress = started;
        let (mut data, mut sent) = (Vec::new(), Vec::<Vec<u8>>::new());
        for _ in 0..MAX_STEPS {
            match session.poll(self.now) {
                Step::Send(frame) => {
                    if sent.last().is_none_or(|last| !is_equal_except_id(last, &frame)) {
                        progress = self.now;
                    }
                    self.send(&frame);
                    sent.push(frame);
                }
                Step::Data(block) => {
                    assert!(!block.is_empty(), "a piece of nothing");
                    progress = self.now;
                    data.extend(block);
                }
                Step::Feed => feed(session),
                Step::Wait(until) => {
                    assert!(until > self.now, "a wait until {until:?} at {:?} would spin", self.now);
                    self.advance(until, |now, bytes| session.handle(now, bytes));
                }
                Step::Done(outcome) => {
                    let (lasted, idle) = (self.now.saturating_sub(started), self.now.saturating_sub(progress));
                    return Run { outcome, data, sent, busy: self.busy - busy, duration: lasted, idle };
                }
            }
        }
        panic!("the session has not ended after {MAX_STEPS} steps at {:?}", self.now);
    }

    /// Delivers all datagrams in transit.
    pub(crate) fn settle(&mut self) {
        while !self.flights.is_empty() {
            self.advance(Now::MAX, |_, _| {});
        }
    }

    /// Advances to the next arrival of a datagram, to the next datagram of the controller, or to `until`, whichever is
    /// first.
    fn advance(&mut self, until: Now, handle: impl FnOnce(Now, &[u8])) {
        let arrival = self.flights.peek().map_or(until, |Reverse((at, ..))| (*at).min(until));
        if let Some(at) = self.controller.wake().filter(|at| *at < arrival) {
            self.now = self.now.max(at);
            let sent = self.controller.transmit(self.now);
            return self.answer(sent);
        }
        let arrives = self.flights.peek().is_some_and(|Reverse((at, ..))| *at <= until);
        let Some(Reverse((at, _, to, bytes))) = arrives.then(|| self.flights.pop()).flatten() else {
            self.now = until;
            return;
        };
        self.now = self.now.max(at);
        match to {
            To::Client => handle(self.now, &bytes),
            To::Controller => {
                let sent = self.controller.receive(self.now, &bytes);
                self.answer(sent);
            }
        }
    }

    fn answer(&mut self, sent: Vec<Vec<u8>>) {
        for answer in sent {
            self.busy += usize::from(is_busy_refusal(&answer));
            let copies = self.to_client.pass(self.now + SERVICE_TIME, &answer);
            self.schedule(To::Client, copies);
        }
    }

    fn send(&mut self, frame: &[u8]) {
        let lost = self.lose_in == Some(0);
        self.lose_in = self.lose_in.and_then(|left| left.checked_sub(1));
        if !lost {
            let copies = self.to_controller.pass(self.now, frame);
            self.schedule(To::Controller, copies);
        }
    }

    fn schedule(&mut self, to: To, copies: Vec<(Now, Vec<u8>)>) {
        for (at, bytes) in copies {
            self.flights.push(Reverse((at, self.launched, to, bytes)));
            self.launched += 1;
        }
    }
}

/// The id is the byte at offset 11.
fn is_equal_except_id(one: &[u8], other: &[u8]) -> bool {
    one.len() == other.len() && one[..11] == other[..11] && one[12..] == other[12..]
}

/// Status and added status are at offsets 25 and 28. The codes are from DX chapter 4.
fn is_busy_refusal(frame: &[u8]) -> bool {
    frame[25] != 0 && [0xD8F1, 0xD8FA, 0xE444, 0xFFF6].contains(&u16::from_le_bytes([frame[28], frame[29]]))
}
