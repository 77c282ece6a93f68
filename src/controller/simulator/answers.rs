//! Answers between controller and client: how long they take, and which requests a busy controller refuses.

use std::collections::VecDeque;
use std::time::Duration;

use crate::Now;

/// Answers that wait to be fetched. The oldest give way to a client that sends without end.
#[derive(Debug, Clone)]
pub(crate) struct Answers<T> {
    delay: Duration,
    most: usize,
    waiting: VecDeque<(Now, T)>,
}

impl<T> Answers<T> {
    /// No answers yet; each takes `delay`, and at most so many wait.
    pub(crate) fn new(delay: Duration, most: usize) -> Self {
        Self { delay, most, waiting: VecDeque::new() }
    }

    /// Sends an answer on its way.
    pub(crate) fn push(&mut self, now: Now, answer: T) {
        if self.waiting.len() >= self.most {
            self.waiting.pop_front();
        }
        self.waiting.push_back((now.saturating_add(self.delay), answer));
    }

    /// The next answer that is there at `now`.
    pub(crate) fn take(&mut self, now: Now) -> Option<T> {
        self.due().filter(|due| *due <= now)?;
        self.waiting.pop_front().map(|(_, answer)| answer)
    }

    /// When the next answer is there.
    pub(crate) fn due(&self) -> Option<Now> {
        self.waiting.front().map(|(due, _)| *due)
    }

    /// Loses all of them.
    pub(crate) fn clear(&mut self) {
        self.waiting.clear();
    }
}

/// A controller that refuses a share of the requests as busy, by a seed.
#[derive(Debug, Clone)]
pub(crate) struct Busy {
    share: f64,
    random: fastrand::Rng,
}

impl Busy {
    /// Refuses this share, 0.0 to 1.0.
    pub(crate) fn new(share: f64, seed: u64) -> Self {
        Self { share, random: fastrand::Rng::with_seed(seed) }
    }

    /// Whether the next request is refused.
    pub(crate) fn refuses(&mut self) -> bool {
        self.share > 0.0 && self.random.f64() < self.share
    }
}
