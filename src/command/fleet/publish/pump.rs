//! Between poller and broker: takes what is found into the outbox, and tells it while the broker is there. A connection that
//! is lost is made again, after a pause that grows.

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

/// Messages that are on their way at a time: with an acknowledgement, and without.
const WINDOW: usize = 64;
const UNCONFIRMED: usize = 1000;
/// Bytes that wait for the line before no more are added.
const LINE: usize = 256 * 1024;
/// The least time between two pings that ask whether all has arrived.
const PING: Duration = Duration::from_millis(500);
/// How long a broker has to acknowledge, while it answers pings.
const ACKNOWLEDGE: Duration = Duration::from_secs(30);
/// The pause after a failure: the first one, and the longest.
const PAUSES: [Duration; 2] = [Duration::from_secs(1), Duration::from_secs(60)];
/// How long a connection holds before the pauses begin anew: one that is lost at once is no success.
const STEADY: Duration = Duration::from_secs(10);
/// Time of the end for what waits, and for the acknowledgement of the farewell. What is left of it is for the goodbye.
const DELIVER: Duration = Duration::from_millis(500);
const FAREWELL: Duration = Duration::from_millis(700);
/// How often a failure that goes on is said again, at the least.
const REMIND: Duration = Duration::from_secs(600);

/// What opens connections to a broker.
pub trait Broker {
    /// A connection.
    type Uplink: Uplink;
    /// Connects, and says hello; whether the broker takes the client is the first event.
    async fn open(&self, client_id: String, will: Will) -> Result<Self::Uplink, Loss>;
}

/// A connection to a broker.
pub trait Uplink {
    /// What happens next; may be dropped.
    async fn next(&mut self) -> Event;
    /// Sends a message; the number of its acknowledgement, if it gets one.
    fn publish(&mut self, message: &Message) -> Result<Option<u64>, SendError>;
    /// Wants messages.
    fn subscribe(&mut self, topics: &[String]) -> Result<(), SendError>;
    /// Asks whether all has arrived; the number of the ping.
    fn ping(&mut self) -> u64;
    /// Acknowledged messages that the broker takes, if it has said so.
    fn room(&self) -> Option<u16>;
    /// Bytes that the line has not taken.
    fn unsent(&mut self) -> usize;
    /// Says goodbye.
    async fn close(self);
}

/// The pauses between attempts.
#[derive(Debug)]
pub struct Pauses {
    next: Duration,
    random: fastrand::Rng,
}

impl Pauses {
    /// Which they are, by a seed.
    pub fn new(seed: u64) -> Self {
        Self { next: PAUSES[0], random: fastrand::Rng::with_seed(seed) }
    }

    /// The next one: twice as long as the last, up to a minute, and a bit off, so that those who lost a broker at the same
    /// moment do not come back at the same moment.
    pub fn pause(&mut self) -> Duration {
        let pause = self.next.mul_f64(0.75 + self.random.f64() / 2.0);
        self.next = (self.next * 2).min(PAUSES[1]);
        pause
    }

    fn reset(&mut self) {
        self.next = PAUSES[0];
    }
}

/// Who is told what happens with the broker.
pub trait Listener {
    /// Something happened.
    fn say(&self, level: Level, text: &str);
    /// The broker has taken this client, or is gone.
    fn reached(&self, is_there: bool);
}

/// What came of it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Records that have arrived.
    pub published: u64,
    /// Records that the broker does not want.
    pub refused: u64,
    /// Records that had no room.
    pub dropped: u64,
    /// Connections after the first one.
    pub reconnects: u64,
    /// Records that were left to the next process, or to nobody.
    pub undelivered: u64,
}

/// An open connection, and what is on its way over it.
struct Open<U> {
    uplink: U,
    is_accepted: bool,
    /// Acknowledged messages, by their numbers.
    acknowledged: HashMap<u64, Option<Ticket>>,
    /// Records whose messages have no acknowledgement and were not confirmed by a ping.
    unconfirmed: VecDeque<Ticket>,
    /// Those that a ping under way will confirm.
    pinged: Option<(u64, Vec<Ticket>)>,
    since: Instant,
    last_ping: Instant,
    /// When something was acknowledged last, or nothing was on its way.
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

    /// Notes that something has arrived; whether the connection has held for some time.
    fn progressed(&mut self) -> bool {
        self.progress = Instant::now();
        self.progress - self.since >= STEADY
    }

    fn is_idle(&self) -> bool {
        self.acknowledged.is_empty() && self.unconfirmed.is_empty() && self.pinged.is_none()
    }
}

/// Where the connection is.
enum Line<'a, B: Broker> {
    Waiting(Instant),
    Opening(LocalBoxFuture<'a, Result<B::Uplink, Loss>>),
    Open(Open<B::Uplink>),
}

/// What comes next of the connection.
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
    /// Whether the broker has ever taken the client; since when it is gone.
    was_accepted: bool,
    gone_since: Option<Instant>,
    /// What was said last of the broker, and when.
    said: Option<(String, Instant)>,
    /// Whether a broker that is not there ends it.
    ends_without_broker: bool,
    /// Messages that the broker refused.
    forbidden: u32,
}

impl<'a, B: Broker + 'a> Pump<'a, B> {
    /// Between this broker and this way to tell.
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

    /// Goes on until it is stopped, or `found` has nothing more and all of it has arrived. [`end`](Self::end) comes next.
    ///
    /// # Errors
    /// There is no broker, or it refuses this client, and the run is a bounded one.
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

    /// Takes what the poller has found.
    fn take(&mut self, event: &Found) {
        for record in self.speech.found(event, now_ms()) {
            self.outbox.push(record);
        }
        if let Some(error) = self.outbox.take_trouble() {
            let why = plain(&error);
            self.listener
                .say(Level::Error, &format!("the disk takes no messages ({why}): what memory cannot hold is dropped"));
        }
        // While nobody listens, each one would be said: the sum comes with the connection.
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
                &format!("{} {what} dropped, the oldest first: the buffer had no room", dropped.for_room),
            );
        }
        if dropped.damaged > 0 {
            self.listener.say(Level::Error, "a part of the buffer on disk was damaged, and is lost");
        }
    }

    /// Does what follows from a step of the connection.
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
                        "the broker does not allow to subscribe: no host can ask for births, or be waited for",
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
            // The first looks are done while it is connected to.
            (_, 0) if !again => String::new(),
            (waiting, 0) => format!("; {waiting} {messages} waited for it"),
            (0, bytes) => format!("; {} KiB on disk waited for it", bytes.div_ceil(1024)),
            (waiting, bytes) => {
                format!("; {waiting} {messages} and {} KiB on disk waited for it", bytes.div_ceil(1024))
            }
        };
        match self.gone_since.take().filter(|_| again) {
            Some(since) => {
                self.counts.reconnects += 1;
                let secs = duration::display(Duration::from_secs(since.elapsed().as_secs()));
                self.listener.say(Level::Notice, &format!("{} is back after {secs}{buffered}", self.url));
            }
            None => self.listener.say(Level::Notice, &format!("connected to {}{buffered}", self.url)),
        }
        self.say_dropped();
        let topics = self.speech.topics();
        if let (false, Line::Open(open)) = (topics.is_empty(), &mut self.line)
            && open.uplink.subscribe(&topics).is_err()
        {
            self.listener.say(Level::Warning, "the broker cannot be told which messages are wanted");
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
            // The next connection has a will of its own.
            self.leave();
            self.line = Line::Waiting(Instant::now() + PAUSES[0]);
        }
    }

    /// The connection is over: what has not arrived waits.
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

    /// Waits before the next attempt, whatever the reason: it was given by another machine, or depends on the clock, and
    /// both may be right a minute later. Only a bounded run gives up.
    fn fail(&mut self, failure: Failure) -> Result<(), Failure> {
        if self.ends_without_broker {
            self.line = Line::Waiting(Instant::now());
            return Err(failure);
        }
        let pause = self.pauses.pause();
        self.line = Line::Waiting(Instant::now() + pause);
        let is_known = self.said.as_ref().is_some_and(|(said, at)| *said == failure.message && at.elapsed() < REMIND);
        // Where it worked before, a setting is wrong only if the broker says so.
        let is_setting = failure.kind == Kind::Usage || !self.was_accepted;
        let hint = failure.hint.filter(|_| is_setting).map(|hint| format!(" ({hint})")).unwrap_or_default();
        let level = if is_known { Level::Detail } else { Level::Warning };
        let again = format!("{}.{}s", pause.as_secs(), pause.subsec_millis() / 100);
        self.listener.say(level, &format!("{}{hint}; trying again in {again}, and so on", failure.message));
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
            self.refuse(&format!("the broker refuses a message (0x{code:02X}): check what this user may publish"));
        }
        if let Some(ticket) = ticket {
            self.counts.published += u64::from(code.is_none());
            self.counts.refused += u64::from(code.is_some());
            self.outbox.done(ticket);
        }
    }

    /// Says it the first time, and then at `-v`.
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

    /// Sends as much as may be on its way.
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

    /// Sends the messages of a record, or those that are of none.
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
                // Nothing of it left: it would never leave.
                self.outbox.done(ticket);
                self.counts.refused += u64::from(failed.is_some());
            }
        }
        if let Some(why) = failed {
            self.refuse(&why);
        }
    }

    /// Tells what waits, if that is soon done, says farewell, and leaves the rest for the next process, of which it says
    /// little where a failure says more. It takes less than [`END`], whatever the broker does.
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
            self.listener.say(Level::Error, &format!("the buffer could not be kept: {}", plain(&error)));
        }
        let or_detail = |level| if has_failed { Level::Detail } else { level };
        if nowhere > 0 {
            let what = if nowhere == 1 { "message was" } else { "messages were" };
            let text = format!("{nowhere} {what} not delivered: no disk has room for what waits");
            self.listener.say(or_detail(Level::Warning), &text);
        } else if has_left {
            self.listener.say(or_detail(Level::Notice), "what was not delivered is kept on disk, for the next start");
        }
        self.counts
    }
}

/// Waits for the next step of the connection; may be dropped.
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
                    // A broker that always has something to say leaves others their turn.
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
