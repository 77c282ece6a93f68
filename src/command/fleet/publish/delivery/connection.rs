//! State of the connection to a broker, and its next step.

use std::collections::{HashMap, VecDeque};
use std::time::Duration;

use futures_util::future::LocalBoxFuture;
use tokio::task::coop::consume_budget;
use tokio::time::{Instant, sleep_until};

use super::super::outbox::Ticket;
use super::super::uplink::{Event, Loss};
use super::{Broker, Uplink as _};

/// Minimum interval of pings that confirm messages without acknowledgement.
const PING_INTERVAL: Duration = Duration::from_millis(500);
/// Time limit for an acknowledgement, while the broker answers pings.
const ACKNOWLEDGE_TIMEOUT: Duration = Duration::from_secs(30);
/// Lifetime of a connection after which the backoff starts again.
const STABLE_AFTER: Duration = Duration::from_secs(10);

/// An open connection with its messages in transit.
pub struct Open<U> {
    pub uplink: U,
    pub is_accepted: bool,
    /// Messages with acknowledgement, by number.
    pub acknowledged: HashMap<u64, Option<Ticket>>,
    /// Records without acknowledgement that no ping has confirmed yet.
    pub unconfirmed: VecDeque<Ticket>,
    /// Number of the current ping, and the records that it will confirm.
    pub pending_ping: Option<(u64, Vec<Ticket>)>,
    /// Topics whose retained messages the broker was asked for, and the time at which the question ends.
    pub question: Option<(Vec<String>, Instant)>,
    since: Instant,
    pub last_ping: Instant,
    /// Time of the last acknowledgement, or the last time at which no message was in transit.
    pub progress: Instant,
}

impl<U> Open<U> {
    /// A connection that the broker has not accepted yet.
    pub fn new(uplink: U) -> Self {
        let now = Instant::now();
        Self {
            uplink,
            is_accepted: false,
            acknowledged: HashMap::new(),
            unconfirmed: VecDeque::new(),
            pending_ping: None,
            question: None,
            since: now,
            last_ping: now,
            progress: now,
        }
    }

    /// Records progress. Returns whether the connection counts as stable.
    pub fn note_progress(&mut self) -> bool {
        self.progress = Instant::now();
        self.progress - self.since >= STABLE_AFTER
    }

    /// Whether no message is in transit.
    pub fn is_idle(&self) -> bool {
        self.acknowledged.is_empty() && self.unconfirmed.is_empty() && self.pending_ping.is_none()
    }
}

/// State of the connection.
pub enum ConnectionState<'a, B: Broker> {
    Waiting(Instant),
    Opening(LocalBoxFuture<'a, Result<B::Uplink, Loss>>),
    Open(Open<B::Uplink>),
    /// The connection closes. The next attempt to connect follows at this time, but not before the end.
    Closing(LocalBoxFuture<'a, ()>, Instant),
}

/// Next step of the connection.
pub enum Step<U> {
    Connect,
    Opened(Result<U, Loss>),
    Closed(Instant),
    Event(Event),
    Stuck,
    Ping,
    Answered,
}

/// Waits for the next step of the connection. Cancel safe.
pub async fn step<B: Broker>(line: &mut ConnectionState<'_, B>) -> Step<B::Uplink> {
    match line {
        ConnectionState::Waiting(until) => {
            sleep_until(*until).await;
            Step::Connect
        }
        ConnectionState::Opening(opened) => Step::Opened(opened.await),
        ConnectionState::Closing(closed, next) => {
            closed.await;
            Step::Closed(*next)
        }
        ConnectionState::Open(open) => {
            let stuck = open.progress + ACKNOWLEDGE_TIMEOUT;
            let (wants_ping, is_idle) = (!open.unconfirmed.is_empty() && open.pending_ping.is_none(), open.is_idle());
            let ping = open.last_ping + PING_INTERVAL;
            let answered = open.question.as_ref().map(|(_, until)| *until);
            tokio::select! {
                biased;
                event = async {
                    // A broker with endless events must not block other tasks.
                    consume_budget().await;
                    open.uplink.next().await
                } => Step::Event(event),
                () = sleep_until(ping), if wants_ping => Step::Ping,
                () = sleep_until(stuck), if !is_idle => Step::Stuck,
                () = sleep_until(answered.unwrap_or(stuck)), if answered.is_some() => Step::Answered,
            }
        }
    }
}
