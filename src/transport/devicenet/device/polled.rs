//! Poll connection of a slave.

use std::time::Duration;

use super::super::Now;
use super::super::can::{Frame, MAX_DATA};
use super::super::wire::{Id, split};
use super::fault::inject_fault;
use super::{Application, Device};

/// Minimum time of the watchdog until the first poll.
const FIRST: Duration = Duration::from_secs(10);
/// Packet rates are rounded up to a multiple of this number of milliseconds.
const TICK: u16 = 10;

/// Connection state (attribute 1 of the connection object).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum State {
    /// The connection is allocated, but not established. The slave ignores polls.
    Configuring = 1,
    Established = 3,
    /// The watchdog of the connection expired.
    TimedOut = 4,
}

/// A complete poll.
enum Poll {
    /// The poll has no data, because the master is in idle mode.
    Idle,
    Image(Vec<u8>),
}

#[derive(Debug)]
pub(super) struct Polled {
    pub(super) state: State,
    /// Packet rate in ms; 0 switches the watchdog off.
    pub(super) rate: u16,
    until: Option<Now>,
    parts: Vec<u8>,
    /// Number of received fragments of the current image.
    count: u8,
}

impl Polled {
    pub(super) const fn new() -> Self {
        Self { state: State::Configuring, rate: 0, until: None, parts: Vec::new(), count: 0 }
    }

    pub(super) fn is_established(&self) -> bool {
        self.state == State::Established
    }

    pub(super) const fn until(&self) -> Option<Now> {
        self.until
    }

    /// Sets the packet rate. This establishes the connection. Returns the rounded packet rate.
    pub(super) fn set_rate(&mut self, now: Now, rate: u16) -> u16 {
        self.rate = rate.checked_next_multiple_of(TICK).unwrap_or(u16::MAX);
        self.state = State::Established;
        self.until = self.patience().map(|patience| now + patience.max(FIRST));
        self.rate
    }

    /// Closes the connection if its watchdog has expired. Returns whether it has just expired.
    pub(super) fn expire(&mut self, now: Now) -> bool {
        if self.until.is_none_or(|until| now < until) {
            return false;
        }
        self.until = None;
        self.state = State::TimedOut;
        true
    }

    fn patience(&self) -> Option<Duration> {
        (self.rate > 0).then(|| Duration::from_millis(self.rate.into()) * 4)
    }

    /// Handles a frame of a poll. Returns the poll if the frame completes it.
    fn take(&mut self, bytes: &[u8], size: usize) -> Option<Poll> {
        let Some((first, part)) = bytes.split_first() else {
            self.count = 0;
            return Some(Poll::Idle);
        };
        if size <= MAX_DATA {
            return (bytes.len() == size).then(|| Poll::Image(bytes.to_vec()));
        }
        let (kind, count) = (first >> 6, first & 0x3F);
        let is_next = count == self.count && self.count > 0;
        let missing = size.saturating_sub(self.parts.len());
        match kind {
            0 if count == 0 && part.len() == 7 && size > 7 => (self.parts, self.count) = (part.to_vec(), 1),
            1 if is_next && part.len() == 7 && missing > 7 => {
                self.parts.extend(part);
                self.count += 1;
            }
            2 if is_next && part.len() == missing => {
                self.parts.extend(part);
                self.count = 0;
                return Some(Poll::Image(std::mem::take(&mut self.parts)));
            }
            _ => self.count = 0,
        }
        None
    }
}

impl<A: Application> Device<A> {
    pub(super) fn polled(&mut self, now: Now, bytes: &[u8]) {
        let size = usize::from(self.setup.size);
        let Some(polled) = self.polled.as_mut().filter(|polled| polled.is_established()) else { return };
        let Some(taken) = polled.take(bytes, size) else { return };
        polled.until = polled.patience().map(|patience| now + patience);
        if let Poll::Image(image) = taken {
            self.application.image_out(now, &image);
        }
        self.application.image_in(now, &mut self.image_in);
        self.answers += 1;
        let id = Id::PollAnswer(self.setup.mac).emit();
        let frames = inject_fault(self.fault, split(&self.image_in));
        self.outbox.extend(frames.iter().filter_map(|bytes| Frame::new(id, bytes)));
    }
}
