//! Choice of the broker for the next connection. The order of the list is only a preference: armctl stays at a broker
//! until it fails, then tries each of the others once, and pauses after a round without success.

use std::time::Duration;

use tokio::time::Instant;

/// First and longest backoff.
const BACKOFF_RANGE: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(60)];
/// Interval after which an ongoing failure is reported again.
const REMINDER_INTERVAL: Duration = Duration::from_secs(600);

/// Backoff between attempts to connect.
#[derive(Debug)]
pub struct Backoff {
    next: Duration,
    random: fastrand::Rng,
}

impl Backoff {
    /// Creates the backoff with a random seed.
    pub fn new(seed: u64) -> Self {
        Self { next: BACKOFF_RANGE[0], random: fastrand::Rng::with_seed(seed) }
    }

    /// Next pause: twice the last pause, up to a minute, with a random factor. Clients that lost the broker at the same
    /// time therefore do not all connect again at the same time.
    pub fn pause(&mut self) -> Duration {
        let pause = self.next.mul_f64(0.75 + self.random.f64() / 2.0);
        self.next = (self.next * 2).min(BACKOFF_RANGE[1]);
        pause
    }

    fn reset(&mut self) {
        self.next = BACKOFF_RANGE[0];
    }
}

/// What the log has said about a broker.
#[derive(Debug, Clone, Default)]
struct History {
    was_accepted: bool,
    /// Last reported failure and its time.
    last_failure: Option<(String, Instant)>,
}

/// The brokers of a run.
#[derive(Debug)]
pub struct Brokers<'a, B> {
    list: &'a [B],
    histories: Vec<History>,
    /// Number of the broker that is in use, or that is tried next.
    current: usize,
    /// Number of brokers that have failed since the last stable connection or pause.
    failed: usize,
    backoff: Backoff,
    /// Broker that has accepted this client last.
    last_accepted: Option<usize>,
}

impl<'a, B> Brokers<'a, B> {
    /// The brokers of a list that is not empty.
    pub fn new(list: &'a [B], backoff: Backoff) -> Self {
        let histories = vec![History::default(); list.len()];
        Self { list, histories, current: 0, failed: 0, backoff, last_accepted: None }
    }

    /// The broker that is in use, or that is tried next.
    pub fn current(&self) -> &'a B {
        &self.list[self.current]
    }

    /// Its number in the list.
    pub fn number(&self) -> usize {
        self.current
    }

    /// Whether there is no other broker.
    pub fn is_single(&self) -> bool {
        self.list.len() == 1
    }

    /// Whether a broker has ever accepted this client.
    pub fn was_accepted(&self) -> bool {
        self.last_accepted.is_some()
    }

    /// Whether the current broker has ever accepted this client.
    pub fn was_current_accepted(&self) -> bool {
        self.histories[self.current].was_accepted
    }

    /// Handles the acceptance of this client. Returns the broker that had accepted the client before, if there is one.
    pub fn accepted(&mut self) -> Option<usize> {
        self.histories[self.current].was_accepted = true;
        self.histories.iter_mut().for_each(|history| history.last_failure = None);
        self.last_accepted.replace(self.current)
    }

    /// Handles a stable connection: the next failure begins a new round.
    pub fn stable(&mut self) {
        self.backoff.reset();
        self.failed = 0;
    }

    /// Whether this failure of the current broker is to be reported.
    pub fn is_new_failure(&mut self, message: &str) -> bool {
        let last = &mut self.histories[self.current].last_failure;
        let is_known = last.as_ref().is_some_and(|(text, at)| text == message && at.elapsed() < REMINDER_INTERVAL);
        if !is_known {
            *last = Some((message.to_owned(), Instant::now()));
        }
        !is_known
    }

    /// Goes to the next broker. Returns the pause before its connection; `None` if this round has another broker.
    pub fn advance(&mut self) -> Option<Duration> {
        self.current = (self.current + 1) % self.list.len();
        self.failed += 1;
        if self.failed < self.list.len() {
            return None;
        }
        self.failed = 0;
        Some(self.backoff.pause())
    }
}
