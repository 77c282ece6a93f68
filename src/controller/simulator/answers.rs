//! Response delay, and random busy refusals of a controller.

use std::collections::VecDeque;
use std::time::Duration;

use crate::Now;

/// Queue of delayed answers. A full queue drops the oldest answer, because a client may send without end.
#[derive(Debug, Clone)]
pub(crate) struct DelayedAnswers<T> {
    delay: Duration,
    capacity: usize,
    waiting: VecDeque<(Now, T)>,
}

impl<T> DelayedAnswers<T> {
    /// An empty queue for at most `most` answers.
    pub(crate) fn new(delay: Duration, capacity: usize) -> Self {
        Self { delay, capacity, waiting: VecDeque::new() }
    }

    pub(crate) fn push(&mut self, now: Now, answer: T) {
        if self.waiting.len() >= self.capacity {
            self.waiting.pop_front();
        }
        self.waiting.push_back((now.saturating_add(self.delay), answer));
    }

    /// Takes the next answer that is due at `now`.
    pub(crate) fn take(&mut self, now: Now) -> Option<T> {
        self.due().filter(|due| *due <= now)?;
        self.waiting.pop_front().map(|(_, answer)| answer)
    }

    /// Time of the next answer.
    pub(crate) fn due(&self) -> Option<Now> {
        self.waiting.front().map(|(due, _)| *due)
    }

    pub(crate) fn clear(&mut self) {
        self.waiting.clear();
    }
}

/// Random busy refusals of a share of the requests. The same seed gives the same sequence.
#[derive(Debug, Clone)]
pub(crate) struct Busy {
    share: f64,
    random: fastrand::Rng,
}

impl Busy {
    /// Share from 0.0 to 1.0.
    pub(crate) fn new(share: f64, seed: u64) -> Self {
        Self { share, random: fastrand::Rng::with_seed(seed) }
    }

    /// Changes the share, from 0.0 to 1.0.
    pub(crate) fn set_share(&mut self, share: f64) {
        self.share = share.clamp(0.0, 1.0);
    }

    /// Whether the controller refuses the next request.
    pub(crate) fn refuses(&mut self) -> bool {
        self.share > 0.0 && self.random.f64() < self.share
    }
}
