//! Poll cycle: exchanges one image in each direction at a fixed rate without drift.

use std::time::Duration;

use crate::devicenet::Now;
use crate::devicenet::can::Frame;
use crate::devicenet::wire::{Assembler, AssemblyResult, Id, Mac, split};

use super::view::Statistics;

/// After this multiple of the packet rate without an answer, the slave counts as lost. After the same time without a
/// poll, the slave closes the connection.
pub(super) const WATCHDOG: u32 = 4;
/// Maximum number of abandoned polls whose answers may still arrive.
const MAX_ABANDONED_POLLS: u8 = 2;

/// Poll cycle of one generation.
#[derive(Debug)]
pub(super) struct Polling {
    slave: Mac,
    cycle: Duration,
    rate: Duration,
    due: Now,
    /// Time at which the last poll was sent, if it has no answer yet.
    poll_sent_at: Option<Now>,
    /// Duration of the last exchange, from the poll to the last frame of the answer.
    round_trip: Duration,
    /// Number of abandoned polls whose answers may still arrive. The answer to an abandoned poll does not confirm a
    /// later poll.
    abandoned_polls: u8,
    /// Number of the change that the last poll contained.
    sent_change: u64,
    assembler: Assembler,
    last_answer_at: Now,
}

/// Effect of a frame of the slave.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum PollResult {
    /// The frame completes no image.
    Nothing,
    /// The frame completes an image. The number is that of the change that the slave has accepted. It is present only
    /// if the image certainly answers the last poll.
    Image(Vec<u8>, Option<u64>),
}

impl Polling {
    pub(super) fn new(now: Now, slave: Mac, size: usize, cycle: Duration, rate: Duration) -> Self {
        Self {
            slave,
            cycle,
            rate,
            due: now,
            poll_sent_at: None,
            round_trip: rate / 4,
            abandoned_polls: 0,
            sent_change: 0,
            assembler: Assembler::new(size),
            last_answer_at: now,
        }
    }

    /// Time without an answer after which the slave counts as lost.
    pub(super) fn patience(&self) -> Duration {
        self.rate * WATCHDOG
    }

    /// Time when the slave counts as lost.
    pub(super) fn until(&self) -> Now {
        self.last_answer_at + self.patience()
    }

    /// Time of the next poll.
    pub(super) fn next(&self) -> Now {
        // If a poll was not answered, the next poll waits for two round trips, but not longer than the packet rate.
        // Otherwise a slow adapter would get polls faster than it can send them.
        let given_up =
            self.poll_sent_at.map(|poll_sent_at| poll_sent_at + self.cycle.max(self.round_trip * 2).min(self.rate));
        given_up.map_or(self.due, |given_up| self.due.max(given_up))
    }

    /// Returns the frames of a poll with this image. The result is empty if no poll is due.
    pub(super) fn poll(&mut self, now: Now, image: &[u8], change: u64, counted: &mut Statistics) -> Vec<Frame> {
        if now < self.next() {
            return Vec::new();
        }
        if self.poll_sent_at.is_some() {
            counted.missed += 1;
            self.abandoned_polls = (self.abandoned_polls + 1).min(MAX_ABANDONED_POLLS);
        }
        // A new assembler starts here, so that fragments of an older answer are not combined with fragments of the next
        // answer.
        self.assembler = Assembler::new(image.len());
        self.poll_sent_at = Some(now);
        self.sent_change = change;
        counted.sent += 1;
        self.due += self.cycle;
        while self.due <= now {
            self.due += self.cycle;
            counted.skipped += 1;
        }
        let id = Id::Poll(self.slave).emit();
        split(image).iter().filter_map(|bytes| Frame::new(id, bytes)).collect()
    }

    /// Handles a frame of an answer of the slave.
    pub(super) fn handle_frame(&mut self, now: Now, bytes: &[u8], counted: &mut Statistics) -> PollResult {
        match self.assembler.take(bytes) {
            AssemblyResult::Part => PollResult::Nothing,
            AssemblyResult::Idle | AssemblyResult::Wrong => {
                counted.wrong += 1;
                PollResult::Nothing
            }
            AssemblyResult::Whole(image) => {
                // No poll is waiting for an answer. So the image is a duplicate, or the answer to an abandoned poll,
                // and may be older than the last image.
                let Some(poll_sent_at) = self.poll_sent_at.take() else {
                    counted.late += 1;
                    return PollResult::Nothing;
                };
                counted.received += 1;
                self.last_answer_at = now;
                self.round_trip = now.saturating_sub(poll_sent_at);
                let is_sure = self.abandoned_polls == 0;
                self.abandoned_polls = self.abandoned_polls.saturating_sub(1);
                PollResult::Image(image, is_sure.then_some(self.sent_change))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    fn polling() -> (Polling, Statistics) {
        (Polling::new(Now::ZERO, Mac::new(5).unwrap(), 4, MS * 20, MS * 100), Statistics::default())
    }

    #[test]
    fn polls_keep_their_interval() {
        let (mut polling, mut counted) = polling();
        for at in [0, 20, 41, 60, 85, 100] {
            let now = MS * at;
            assert_eq!(polling.poll(now, &[0; 4], 1, &mut counted).len(), 1, "{at}");
            assert!(polling.poll(now, &[0; 4], 1, &mut counted).is_empty());
            assert!(matches!(polling.handle_frame(now + MS, &[0; 4], &mut counted), PollResult::Image(..)));
        }
        assert_eq!((counted.sent, counted.received, counted.skipped), (6, 6, 0));
        // After a pause, the polls continue in their old schedule. Polls that were missed are not sent later.
        assert_eq!(polling.poll(MS * 190, &[0; 4], 1, &mut counted).len(), 1);
        assert_eq!((polling.due, counted.skipped), (MS * 200, 3));
    }

    /// An answer that may belong to an older poll does not confirm the newest poll.
    #[test]
    fn late_answer_does_not_confirm_a_poll() {
        let (mut polling, mut counted) = polling();
        polling.poll(Now::ZERO, &[0; 4], 1, &mut counted);
        let again = polling.next();
        assert!(again >= MS * 20);
        polling.poll(again, &[1; 4], 2, &mut counted);
        assert_eq!(polling.handle_frame(again + MS, &[7; 4], &mut counted), PollResult::Image(vec![7; 4], None));
        // The answer to the newest poll looks like a duplicate of the late answer, so it is ignored.
        assert_eq!(polling.handle_frame(again + MS, &[8; 4], &mut counted), PollResult::Nothing);
        let next = polling.next();
        polling.poll(next, &[1; 4], 2, &mut counted);
        assert_eq!(polling.handle_frame(next + MS, &[8; 4], &mut counted), PollResult::Image(vec![8; 4], Some(2)));
        assert_eq!((counted.missed, counted.late), (1, 1));
    }

    #[test]
    fn slow_adapter_delays_polls() {
        let (mut polling, mut counted) = polling();
        polling.poll(Now::ZERO, &[0; 4], 1, &mut counted);
        polling.handle_frame(MS * 30, &[0; 4], &mut counted);
        assert_eq!(polling.next(), MS * 20, "overdue");
        polling.poll(MS * 30, &[0; 4], 1, &mut counted);
        assert_eq!(polling.next(), MS * 90, "twice the round trip of 30 ms");
        assert_eq!(polling.until(), MS * 430);
    }
}
