//! Pump from poller to broker: puts data into the outbox, and sends it while the broker is connected. After a loss it
//! connects again with a growing backoff.

use std::collections::{HashMap, VecDeque};
use std::future::{Future, pending};
use std::pin::pin;
use std::time::Duration;

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;
use jiff::Timestamp;
use tokio::task::coop::consume_budget;
use tokio::time::{Instant, sleep_until, timeout_at};

use super::broker::Url;
use super::outbox::{Outbox, Ticket};
use super::speech::{Reaction, Speech};
use super::uplink::{Event, Loss, Message, Refusal, SendError, Will};
use super::words;
use crate::command::fleet::poll::Event as Found;
use crate::command::fleet::service::END;
use crate::failure::{Failure, Kind, plain};
use crate::output::log::Level;
use crate::settings::duration;

/// Limits of messages in transit: with and without acknowledgement.
const WINDOW: usize = 64;
const UNCONFIRMED: usize = 1000;
/// Limit of unsent bytes on the connection.
const LINE: usize = 256 * 1024;
/// Minimum interval of pings that confirm messages without acknowledgement.
const PING: Duration = Duration::from_millis(500);
/// Time limit for an acknowledgement, while the broker answers pings.
const ACKNOWLEDGE: Duration = Duration::from_secs(30);
/// First and longest backoff.
const PAUSES: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(60)];
/// Lifetime of a connection after which the backoff starts again.
const STEADY: Duration = Duration::from_secs(10);
/// Time limits at the end: for queued records, and for the acknowledgement of the last message. DISCONNECT gets the
/// rest.
const DELIVER: Duration = Duration::from_millis(500);
const FAREWELL: Duration = Duration::from_millis(700);
/// Interval after which an ongoing failure is reported again.
const REMIND: Duration = Duration::from_secs(600);

/// Opens connections to a broker.
pub trait Broker {
    /// Connection type.
    type Uplink: Uplink;
    /// Connects and sends CONNECT. The first event is the broker's answer.
    async fn open(&self, client_id: String, will: Will) -> Result<Self::Uplink, Loss>;
}

/// A connection to a broker.
pub trait Uplink {
    /// Waits for the next event. Cancel safe.
    async fn next(&mut self) -> Event;
    /// Sends a message. Returns the number of its acknowledgement, if it gets one.
    fn publish(&mut self, message: &Message) -> Result<Option<u64>, SendError>;
    /// Subscribes to topics.
    fn subscribe(&mut self, topics: &[String]) -> Result<(), SendError>;
    /// Sends a ping, and returns its number.
    fn ping(&mut self) -> u64;
    /// How many more unacknowledged messages the broker accepts, if it has set a limit.
    fn room(&self) -> Option<u16>;
    /// Number of unsent bytes.
    fn unsent(&mut self) -> usize;
    /// Disconnects.
    async fn close(self);
}

/// Backoff between attempts to connect.
#[derive(Debug)]
pub struct Pauses {
    next: Duration,
    random: fastrand::Rng,
}

impl Pauses {
    /// Creates the backoff with a random seed.
    pub fn new(seed: u64) -> Self {
        Self { next: PAUSES[0], random: fastrand::Rng::with_seed(seed) }
    }

    /// Next pause: twice the last one, up to a minute, with a random factor. So clients that lost a broker together do
    /// not return together.
    pub fn pause(&mut self) -> Duration {
        let pause = self.next.mul_f64(0.75 + self.random.f64() / 2.0);
        self.next = (self.next * 2).min(PAUSES[1]);
        pause
    }

    fn reset(&mut self) {
        self.next = PAUSES[0];
    }
}

/// Receiver of broker events.
pub trait Listener {
    /// A message for the log.
    fn say(&self, level: Level, text: &str);
    /// The broker accepted this client, or is gone.
    fn reached(&self, is_there: bool);
}

/// Counters of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Records that have arrived.
    pub published: u64,
    /// Records that the broker rejected.
    pub refused: u64,
    /// Records dropped because the queue was full.
    pub dropped: u64,
    /// Connections after the first one.
    pub reconnects: u64,
    /// Records left for the next process, or lost.
    pub undelivered: u64,
}

/// An open connection with its messages in transit.
struct Open<U> {
    uplink: U,
    is_accepted: bool,
    /// Messages with acknowledgement, by number.
    acknowledged: HashMap<u64, Option<Ticket>>,
    /// Records without acknowledgement that no ping has confirmed yet.
    unconfirmed: VecDeque<Ticket>,
    /// Number of the current ping, and the records that it will confirm.
    pinged: Option<(u64, Vec<Ticket>)>,
    since: Instant,
    last_ping: Instant,
    /// Time of the last acknowledgement, or when nothing was in transit.
    progress: Instant,
}

impl<U> Open<U> {
    fn new(uplink: U) -> Self {
        let now = Instant::now();
        Self {
            uplink,
            is_accepted: false,
            acknowledged: HashMap::new(),
            unconfirmed: VecDeque::new(),
            pinged: None,
            since: now,
            last_ping: now,
            progress: now,
        }
    }

    /// Notes progress. Returns whether the connection counts as stable.
    fn progressed(&mut self) -> bool {
        self.progress = Instant::now();
        self.progress - self.since >= STEADY
    }

    fn is_idle(&self) -> bool {
        self.acknowledged.is_empty() && self.unconfirmed.is_empty() && self.pinged.is_none()
    }
}

/// State of the connection.
enum Line<'a, B: Broker> {
    Waiting(Instant),
    Opening(LocalBoxFuture<'a, Result<B::Uplink, Loss>>),
    Open(Open<B::Uplink>),
}

/// Next step of the connection.
enum Step<U> {
    Try,
    Opened(Result<U, Loss>),
    Happened(Event),
    Stuck,
    Ping,
}

/// The pump.
pub struct Pump<'a, B: Broker> {
    broker: &'a B,
    url: &'a Url,
    speech: Box<dyn Speech>,
    outbox: Outbox,
    listener: &'a dyn Listener,
    line: Line<'a, B>,
    pauses: Pauses,
    counts: Counts,
    /// Whether the broker has ever accepted this client, and the time of the last loss.
    was_accepted: bool,
    gone_since: Option<Instant>,
    /// Last reported failure and its time.
    said: Option<(String, Instant)>,
    /// Whether a missing broker ends the run.
    ends_without_broker: bool,
    /// Number of messages that the broker rejected.
    forbidden: u32,
}

impl<'a, B: Broker + 'a> Pump<'a, B> {
    /// Creates a pump.
    pub fn new(
        (broker, url): (&'a B, &'a Url),
        speech: Box<dyn Speech>,
        outbox: Outbox,
        (listener, pauses): (&'a dyn Listener, Pauses),
        ends_without_broker: bool,
    ) -> Self {
        Self {
            broker,
            url,
            speech,
            outbox,
            listener,
            line: Line::Waiting(Instant::now()),
            pauses,
            counts: Counts::default(),
            was_accepted: false,
            gone_since: None,
            said: None,
            ends_without_broker,
            forbidden: 0,
        }
    }

    /// Runs until it is stopped, or until `found` has ended and everything has arrived. Call [`end`](Self::end) next.
    ///
    /// # Errors
    /// A bounded run without a broker, or the broker refuses this client.
    pub async fn run(
        &mut self,
        mut found: impl AsyncFnMut() -> Option<Found>,
        stop: impl Future<Output = ()>,
    ) -> Result<(), Failure> {
        let mut stop = pin!(stop);
        let mut has_more = true;
        loop {
            if !has_more && self.outbox.is_empty() && self.is_idle() {
                return Ok(());
            }
            let found = async { if has_more { found().await } else { pending().await } };
            tokio::select! {
                biased;
                () = &mut stop => return Ok(()),
                next = step(&mut self.line) => self.go(next)?,
                event = found => match event {
                    None => has_more = false,
                    Some(event) => self.take(&event),
                },
            }
            self.fill();
        }
    }

    fn is_idle(&self) -> bool {
        matches!(&self.line, Line::Open(open) if open.is_accepted && open.is_idle())
    }

    /// Handles an event of the poller.
    fn take(&mut self, event: &Found) {
        for record in self.speech.found(event, now_ms()) {
            self.outbox.push(record);
        }
        if let Some(error) = self.outbox.take_trouble() {
            let why = plain(&error);
            self.listener.say(
                Level::Error,
                &format!("cannot write messages to disk ({why}): messages that do not fit into memory are dropped"),
            );
        }
        // Without a connection, each drop would be reported. The sum is reported with the next connection.
        if matches!(self.line, Line::Open(_)) {
            self.say_dropped();
        }
    }

    fn say_dropped(&mut self) {
        let dropped = self.outbox.take_dropped();
        self.counts.dropped += dropped.for_room + dropped.damaged;
        if dropped.for_room > 0 {
            let what = if dropped.for_room == 1 { "message was" } else { "messages were" };
            self.listener.say(
                Level::Warning,
                &format!("{} {what} dropped, the oldest first: the buffer was full", dropped.for_room),
            );
        }
        if dropped.damaged > 0 {
            self.listener.say(Level::Error, "a part of the buffer on disk was damaged and is lost");
        }
    }

    /// Handles a step of the connection.
    fn go(&mut self, step: Step<B::Uplink>) -> Result<(), Failure> {
        match step {
            Step::Try => {
                let (id, will) = (self.speech.client_id(), self.speech.will(now_ms()));
                self.line = Line::Opening(self.broker.open(id, will).boxed_local());
                Ok(())
            }
            Step::Opened(Ok(uplink)) => {
                self.line = Line::Open(Open::new(uplink));
                Ok(())
            }
            Step::Opened(Err(loss)) | Step::Happened(Event::Lost(loss)) => self.lost(&loss),
            Step::Stuck => self.lost(&Loss::Silent),
            Step::Ping => {
                if let Line::Open(open) = &mut self.line {
                    let tickets = std::mem::take(&mut open.unconfirmed).into();
                    open.last_ping = Instant::now();
                    open.pinged = Some((open.uplink.ping(), tickets));
                }
                Ok(())
            }
            Step::Happened(Event::Connected) => {
                self.connected();
                Ok(())
            }
            Step::Happened(Event::Refused(refusal)) => self.refused(&refusal),
            Step::Happened(Event::Acknowledged(id, code)) => {
                self.acknowledged(id, code);
                Ok(())
            }
            Step::Happened(Event::Pong(number)) => {
                self.confirmed(number);
                Ok(())
            }
            Step::Happened(Event::Subscribed(is_allowed)) => {
                if !is_allowed {
                    self.listener.say(
                        Level::Warning,
                        "the broker refuses the subscription: rebirth commands and the state of the primary host do \
                         not arrive",
                    );
                }
                Ok(())
            }
            Step::Happened(Event::Message(message)) => {
                let reaction = self.speech.received(&message, now_ms());
                self.react(reaction);
                Ok(())
            }
        }
    }

    fn connected(&mut self) {
        let Line::Open(open) = &mut self.line else { return };
        open.is_accepted = true;
        self.listener.reached(true);
        let again = std::mem::replace(&mut self.was_accepted, true);
        self.said = None;
        let (waiting, on_disk) = self.outbox.waiting();
        let messages = if waiting == 1 { "message" } else { "messages" };
        let buffered = match (waiting, on_disk) {
            (0, 0) => String::new(),
            // The first polls run while it connects, so some records always wait.
            (_, 0) if !again => String::new(),
            (waiting, 0) => format!("; {waiting} {messages} in the buffer"),
            (0, bytes) => format!("; {} KiB in the buffer on disk", bytes.div_ceil(1024)),
            (waiting, bytes) => {
                format!("; {waiting} {messages} in the buffer, and {} KiB on disk", bytes.div_ceil(1024))
            }
        };
        match self.gone_since.take().filter(|_| again) {
            Some(since) => {
                self.counts.reconnects += 1;
                let secs = duration::display(Duration::from_secs(since.elapsed().as_secs()));
                self.listener.say(Level::Notice, &format!("connected to {} again after {secs}{buffered}", self.url));
            }
            None => self.listener.say(Level::Notice, &format!("connected to {}{buffered}", self.url)),
        }
        self.say_dropped();
        let topics = self.speech.topics();
        if let (false, Line::Open(open)) = (topics.is_empty(), &mut self.line)
            && open.uplink.subscribe(&topics).is_err()
        {
            self.listener.say(Level::Warning, "cannot send the subscription to the broker");
        }
        let messages = self.speech.connected(now_ms());
        self.send(None, &messages);
    }

    fn react(&mut self, reaction: Reaction) {
        if let Some((level, note)) = reaction.note {
            self.listener.say(level, &note);
        }
        self.send(None, &reaction.messages);
        if reaction.leaves {
            // The next connection has a new last will.
            self.leave();
            self.line = Line::Waiting(Instant::now() + PAUSES[0]);
        }
    }

    /// The connection has ended. Records that have not arrived stay in the queue.
    fn leave(&mut self) {
        self.listener.reached(false);
        self.outbox.lost();
        self.speech.lost();
        self.gone_since = self.gone_since.or_else(|| self.was_accepted.then(Instant::now));
    }

    fn lost(&mut self, loss: &Loss) -> Result<(), Failure> {
        self.leave();
        self.fail(words::loss(self.url, loss))
    }

    fn refused(&mut self, refusal: &Refusal) -> Result<(), Failure> {
        self.leave();
        self.fail(words::refusal(self.url, refusal))
    }

    /// Waits before the next attempt, for any failure: even a refusal or a certificate error can be over a minute
    /// later. Only a bounded run gives up.
    fn fail(&mut self, failure: Failure) -> Result<(), Failure> {
        if self.ends_without_broker {
            self.line = Line::Waiting(Instant::now());
            return Err(failure);
        }
        let pause = self.pauses.pause();
        self.line = Line::Waiting(Instant::now() + pause);
        let is_known = self.said.as_ref().is_some_and(|(said, at)| *said == failure.message && at.elapsed() < REMIND);
        // If it worked before, the settings are probably right, unless the broker reports an error in them.
        let is_setting = failure.kind == Kind::Usage || !self.was_accepted;
        let hint = failure.hint.filter(|_| is_setting).map(|hint| format!(" ({hint})")).unwrap_or_default();
        let level = if is_known { Level::Detail } else { Level::Warning };
        let again = format!("{}.{}s", pause.as_secs(), pause.subsec_millis() / 100);
        self.listener.say(level, &format!("{}{hint}; next try in {again}, then repeatedly", failure.message));
        if !is_known {
            self.said = Some((failure.message, Instant::now()));
        }
        Ok(())
    }

    fn acknowledged(&mut self, id: u64, code: Option<u8>) {
        let Line::Open(open) = &mut self.line else { return };
        let Some(ticket) = open.acknowledged.remove(&id) else { return };
        if open.progressed() {
            self.pauses.reset();
        }
        if let Some(code) = code {
            self.refuse(&format!("the broker refused a message (0x{code:02X}): check the publish rights of this user"));
        }
        if let Some(ticket) = ticket {
            self.counts.published += u64::from(code.is_none());
            self.counts.refused += u64::from(code.is_some());
            self.outbox.done(ticket);
        }
    }

    /// Reports the first rejection as a warning, and later ones at `-v`.
    fn refuse(&mut self, why: &str) {
        self.listener.say(if self.forbidden > 0 { Level::Detail } else { Level::Warning }, why);
        self.forbidden = self.forbidden.saturating_add(1);
    }

    fn confirmed(&mut self, number: u64) {
        let Line::Open(open) = &mut self.line else { return };
        if let Some((_, tickets)) = open.pinged.take_if(|(ping, _)| *ping <= number) {
            if open.progressed() {
                self.pauses.reset();
            }
            for ticket in tickets {
                self.counts.published += 1;
                self.outbox.done(ticket);
            }
        }
    }

    /// Sends records up to the limits.
    fn fill(&mut self) {
        loop {
            let Line::Open(open) = &mut self.line else { return };
            let has_room = open.is_accepted
                && self.speech.is_ready()
                && open.acknowledged.len() < WINDOW
                && open.unconfirmed.len() < UNCONFIRMED
                && open.uplink.room().is_none_or(|room| room > 0)
                && open.uplink.unsent() < LINE;
            if !has_room {
                return;
            }
            let Some((ticket, record)) = self.outbox.take_next() else { return };
            let messages = self.speech.told(record, now_ms());
            self.send(Some(ticket), &messages);
        }
    }

    /// Sends the messages of a record, or messages without a record.
    fn send(&mut self, ticket: Option<Ticket>, messages: &[Message]) {
        let Line::Open(open) = &mut self.line else { return };
        if open.is_idle() {
            open.progress = Instant::now();
        }
        let mut is_confirmed_by_ping = false;
        let mut is_under_way = false;
        let mut failed = None;
        for message in messages {
            match open.uplink.publish(message) {
                Ok(Some(id)) => {
                    is_under_way = true;
                    open.acknowledged.insert(id, ticket);
                }
                Ok(None) => is_confirmed_by_ping = true,
                Err(error) => failed = Some(format!("{}: {error}", message.topic)),
            }
        }
        if let Some(ticket) = ticket {
            if is_confirmed_by_ping {
                open.unconfirmed.push_back(ticket);
            } else if !is_under_way {
                // No message of it could be sent, so it is removed.
                self.outbox.done(ticket);
                self.counts.refused += u64::from(failed.is_some());
            }
        }
        if let Some(why) = failed {
            self.refuse(&why);
        }
    }

    /// Ends the run: sends queued records within a time limit, then a last message, and leaves the rest for the next
    /// process. It always takes less than [`END`]. After a failure it reports less.
    pub async fn end(mut self, has_failed: bool) -> Counts {
        let now = Instant::now();
        let told = async {
            while let Line::Open(_) = &self.line {
                if self.outbox.is_empty() && self.is_idle() || !self.speech.is_ready() {
                    break;
                }
                let next = step(&mut self.line).await;
                if self.go(next).is_err() {
                    break;
                }
                self.fill();
            }
        };
        let _in_time = timeout_at(now + DELIVER, told).await;
        if matches!(&self.line, Line::Open(open) if open.is_accepted) {
            let messages = self.speech.farewell(now_ms());
            self.send(None, &messages);
            let heard = async {
                while matches!(&self.line, Line::Open(open) if open.acknowledged.values().any(Option::is_none)) {
                    let next = step(&mut self.line).await;
                    if self.go(next).is_err() {
                        break;
                    }
                }
            };
            let _in_time = timeout_at(now + FAREWELL, heard).await;
        }
        if let Line::Open(open) = std::mem::replace(&mut self.line, Line::Waiting(Instant::now())) {
            let _in_time = timeout_at(now + END, open.uplink.close()).await;
        }
        self.say_dropped();
        let has_left = !self.outbox.is_empty();
        let outbox = std::mem::replace(&mut self.outbox, Outbox::new(0, None));
        let (nowhere, trouble) = outbox.park();
        self.counts.undelivered = nowhere;
        if let Some(error) = trouble {
            self.listener.say(Level::Error, &format!("cannot store the buffer: {}", plain(&error)));
        }
        let or_detail = |level| if has_failed { Level::Detail } else { level };
        if nowhere > 0 {
            let what = if nowhere == 1 { "message was" } else { "messages were" };
            let text = format!("{nowhere} {what} not delivered: the buffer on disk is full or off");
            self.listener.say(or_detail(Level::Warning), &text);
        } else if has_left {
            self.listener.say(or_detail(Level::Notice), "undelivered messages are stored on disk for the next start");
        }
        self.counts
    }
}

/// Waits for the next step of the connection. Cancel safe.
async fn step<B: Broker>(line: &mut Line<'_, B>) -> Step<B::Uplink> {
    match line {
        Line::Waiting(until) => {
            sleep_until(*until).await;
            Step::Try
        }
        Line::Opening(opened) => Step::Opened(opened.await),
        Line::Open(open) => {
            let stuck = open.progress + ACKNOWLEDGE;
            let (wants_ping, is_idle) = (!open.unconfirmed.is_empty() && open.pinged.is_none(), open.is_idle());
            let ping = open.last_ping + PING;
            tokio::select! {
                biased;
                event = async {
                    // A broker with endless events must not block other tasks.
                    consume_budget().await;
                    open.uplink.next().await
                } => Step::Happened(event),
                () = sleep_until(ping), if wants_ping => Step::Ping,
                () = sleep_until(stuck), if !is_idle => Step::Stuck,
            }
        }
    }
}

fn now_ms() -> u64 {
    u64::try_from(Timestamp::now().as_millisecond()).unwrap_or_default()
}
