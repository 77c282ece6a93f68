//! Pump from poller to broker: puts data into the outbox, and sends it while a broker is connected. After a loss it
//! connects to the next broker, and pauses with a growing backoff after each round.

mod connection;
mod failover;
mod storage;

use std::future::{Future, pending, ready};
use std::io;
use std::pin::pin;

use jiff::Timestamp;
use tokio::task::JoinHandle;
use tokio::time::{Instant, sleep_until, timeout, timeout_at};

use self::connection::{ConnectionState, Open, Step, step};
pub use self::failover::Backoff;
use self::failover::Brokers;
use super::broker::Url;
use super::error_text;
use super::message_format::{MessageFormat, Reaction};
use super::outbox::{Outbox, Ticket};
use super::uplink::{Event, Loss, Message, Refusal, SendError, Will};
use crate::command::fleet::poll::Event as Found;
use crate::command::fleet::service::END_TIMEOUT;
use armctl_frame::failure::plain;
use armctl_frame::output::log::Level;
use armctl_frame::prelude::*;

/// Limits of messages in transit: `WINDOW` of messages with acknowledgement, `UNCONFIRMED_WINDOW` of messages without
/// acknowledgement.
const WINDOW: usize = 64;
const UNCONFIRMED_WINDOW: usize = 1000;
/// Limit of unsent bytes on the connection.
const UNSENT_LIMIT: usize = 256 * 1024;
/// Time limits at the end: `DELIVERY_TIMEOUT` for queued records, `FINAL_TIMEOUT` until the last message is
/// acknowledged. DISCONNECT gets the rest of [`END_TIMEOUT`].
const DELIVERY_TIMEOUT: Duration = Duration::from_millis(500);
const FINAL_TIMEOUT: Duration = Duration::from_millis(700);
/// Time for the answers to a question: the broker sends retained messages directly after it has accepted a subscription.
const ANSWER_TIME: Duration = Duration::from_secs(2);
/// Time limit for the end of a connection before the next one.
const CLOSE_TIMEOUT: Duration = Duration::from_secs(1);
/// Pause before the next connection to a broker that is the only one.
const RECONNECT_PAUSE: Duration = Duration::from_secs(1);
/// Time for the state of a primary host to arrive, if there is another broker.
const HOST_TIMEOUT: Duration = Duration::from_secs(30);

/// Opens connections to a broker.
pub trait Broker {
    /// Connection type.
    type Uplink: Uplink;
    /// URL for messages.
    fn url(&self) -> &Url;
    /// Connects and sends CONNECT. The first event is the broker's answer.
    async fn open(&self, client_id: String, will: Will) -> Result<Self::Uplink, Loss>;
}

/// A connection to a broker.
pub trait Uplink {
    /// Waits for the next event. Cancel safe.
    async fn next(&mut self) -> Event;
    /// Sends a message. Returns the number of the acknowledgement, if the broker acknowledges this message.
    fn publish(&mut self, message: &Message) -> Result<Option<u64>, SendError>;
    /// Subscribes to topics.
    fn subscribe(&mut self, topics: &[String]) -> Result<(), SendError>;
    /// Ends the subscription to topics.
    fn unsubscribe(&mut self, topics: &[String]) -> Result<(), SendError>;
    /// Sends a ping, and returns its number.
    fn ping(&mut self) -> u64;
    /// How many more unacknowledged messages the broker accepts, if it has set a limit.
    fn room(&self) -> Option<u16>;
    /// Number of unsent bytes.
    fn unsent(&mut self) -> usize;
    /// Disconnects.
    async fn close(self);
}

/// Receiver of broker events.
pub trait Listener {
    /// A message for the log.
    fn log(&self, level: Level, text: &str);
    /// Records which broker is in use, and whether it has accepted this client.
    fn set_broker(&self, url: &Url, is_connected: bool);
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

/// The pump.
pub struct Delivery<'a, B: Broker> {
    brokers: Brokers<'a, B>,
    format: Box<dyn MessageFormat>,
    outbox: Outbox,
    listener: &'a dyn Listener,
    connection: ConnectionState<'a, B>,
    began: Instant,
    counts: Counts,
    /// Time of the last loss.
    lost_since: Option<Instant>,
    /// Whether a missing broker ends the run.
    ends_without_broker: bool,
    /// Number of messages that the broker rejected.
    rejected: u32,
    /// Time of the next flush of the buffer on disk; `None` without such a buffer.
    next_flush: Option<Instant>,
    flushing: Option<JoinHandle<io::Result<()>>>,
    /// Time of the delayed messages of the format.
    delayed_until: Option<Instant>,
}

impl<'a, B: Broker + 'a> Delivery<'a, B> {
    /// Creates a pump. It uses one of the brokers at a time.
    pub fn new(
        brokers: &'a [B],
        format: Box<dyn MessageFormat>,
        outbox: Outbox,
        (listener, backoff): (&'a dyn Listener, Backoff),
        ends_without_broker: bool,
    ) -> Self {
        let next_flush = outbox.sync_interval().map(|interval| Instant::now() + interval);
        Self {
            brokers: Brokers::new(brokers, backoff),
            format,
            outbox,
            listener,
            connection: ConnectionState::Waiting(Instant::now()),
            began: Instant::now(),
            counts: Counts::default(),
            lost_since: None,
            ends_without_broker,
            rejected: 0,
            next_flush,
            flushing: None,
            delayed_until: None,
        }
    }

    /// Runs until it is stopped, or until `found` has ended and everything has arrived. Call [`end`](Self::end) next.
    ///
    /// # Errors
    /// If a run with a limit (`--count`) finds no broker, or if the broker refuses this client.
    pub async fn run(
        &mut self,
        mut found: impl AsyncFnMut() -> Option<Found>,
        stop: impl Future<Output = ()>,
    ) -> Result<()> {
        let mut stop = pin!(stop);
        let mut has_more = true;
        loop {
            if !has_more && self.outbox.is_empty() && self.is_idle() && !self.has_question() {
                return Ok(());
            }
            let flush_at = self.next_flush.filter(|_| self.flushing.is_none());
            let flushing = &mut self.flushing;
            let next_event = async { if has_more { found().await } else { pending().await } };
            let delayed_until = self.delayed_until;
            tokio::select! {
                biased;
                () = &mut stop => return Ok(()),
                () = at(flush_at) => self.flush(),
                flushed = async { match flushing { Some(flush) => flush.await, None => pending().await } } => {
                    self.flushing = None;
                    if let Ok(Err(error)) = flushed {
                        self.outbox.note_disk_error(error);
                        self.report_disk_error();
                    }
                }
                () = at(delayed_until) => {
                    self.delayed_until = None;
                    self.handle_delay();
                }
                next = step(&mut self.connection) => self.handle_step(next)?,
                event = next_event => match event {
                    None => has_more = false,
                    Some(event) => self.handle_event(&event),
                },
            }
            self.fill();
        }
    }

    fn is_idle(&self) -> bool {
        matches!(&self.connection, ConnectionState::Open(open) if open.is_accepted && open.is_idle())
    }

    fn has_question(&self) -> bool {
        matches!(&self.connection, ConnectionState::Open(open) if open.question.is_some())
    }

    /// Asks the broker for retained messages that the format needs. If the broker refuses, the format gets no answer.
    fn ask(&mut self) {
        let ConnectionState::Open(open) = &mut self.connection else { return };
        while open.is_accepted && open.question.is_none() {
            let topics = self.format.next_question();
            if !topics.is_empty() {
                let _asked = open.uplink.subscribe(&topics);
                open.question = Some((topics, Instant::now() + ANSWER_TIME));
                return;
            }
            let records = self.format.end_question(now_ms());
            if records.is_empty() {
                return;
            }
            self.outbox.extend(records);
        }
    }

    /// Handles an event of the poller.
    fn handle_event(&mut self, event: &Found) {
        if !self.outbox.is_away() && self.is_stalled() {
            self.outbox.set_away(true);
        }
        let records = self.format.convert_event(event, now_ms());
        self.outbox.extend(records);
        self.report_disk_error();
        if let Some(note) = self.format.take_note() {
            self.listener.log(Level::Warning, &note);
        }
        self.ask();
        // Without a connection, each drop would be reported. The sum is reported with the next connection.
        if matches!(self.connection, ConnectionState::Open(_)) {
            self.report_dropped();
        }
    }

    /// Handles a step of the connection.
    fn handle_step(&mut self, step: Step<B::Uplink>) -> Result<()> {
        match step {
            Step::Connect => {
                let broker = self.brokers.current();
                self.listener.set_broker(broker.url(), false);
                self.format.set_broker(self.brokers.number());
                let (id, will) = (self.format.client_id(), self.format.will(now_ms()));
                self.connection = ConnectionState::Opening(broker.open(id, will).boxed_local());
                Ok(())
            }
            Step::Closed(next) => {
                self.connection = ConnectionState::Waiting(next);
                Ok(())
            }
            Step::Opened(Ok(uplink)) => {
                self.connection = ConnectionState::Open(Open::new(uplink));
                Ok(())
            }
            Step::Opened(Err(loss)) | Step::Event(Event::Lost(loss)) => self.handle_loss(&loss),
            Step::Stuck => self.handle_loss(&Loss::Silent),
            Step::Ping => {
                if let ConnectionState::Open(open) = &mut self.connection {
                    let tickets = std::mem::take(&mut open.unconfirmed).into();
                    open.last_ping = Instant::now();
                    open.pending_ping = Some((open.uplink.ping(), tickets));
                }
                Ok(())
            }
            Step::Event(Event::Connected) => {
                self.handle_connected();
                Ok(())
            }
            Step::Event(Event::Refused(refusal)) => self.handle_refusal(&refusal),
            Step::Event(Event::Acknowledged(id, code)) => {
                self.handle_acknowledgement(id, code);
                Ok(())
            }
            Step::Event(Event::Pong(number)) => {
                self.handle_pong(number);
                Ok(())
            }
            Step::Answered => {
                if let ConnectionState::Open(open) = &mut self.connection
                    && let Some((topics, _)) = open.question.take()
                {
                    // If this fails, the broker sends messages that the format ignores.
                    let _ended = open.uplink.unsubscribe(&topics);
                }
                let records = self.format.end_question(now_ms());
                self.outbox.extend(records);
                self.ask();
                Ok(())
            }
            Step::Event(Event::Subscribed(is_allowed)) => {
                if !is_allowed && !self.format.topics().is_empty() {
                    self.listener.log(
                        Level::Warning,
                        "the broker refuses the subscription: rebirth commands and the state of the primary host do \
                         not arrive",
                    );
                }
                Ok(())
            }
            Step::Event(Event::Message(message)) => {
                let reaction = self.format.handle_message(&message, now_ms());
                self.react(reaction);
                Ok(())
            }
        }
    }

    fn handle_connected(&mut self) {
        let ConnectionState::Open(open) = &mut self.connection else { return };
        open.is_accepted = true;
        let url = self.brokers.current().url();
        self.listener.set_broker(url, true);
        let last = self.brokers.accepted();
        let again = last.is_some();
        let (waiting, on_disk) = self.outbox.waiting();
        let messages = if waiting == 1 { "message" } else { "messages" };
        let buffered = match (waiting, on_disk) {
            (0, 0) => String::new(),
            // The first polls run while the client connects, so some records always wait.
            (_, 0) if !again => String::new(),
            (waiting, 0) => format!("; {waiting} {messages} in the buffer"),
            (0, bytes) => format!("; {} KiB in the buffer on disk", bytes.div_ceil(1024)),
            (waiting, bytes) => {
                format!("; {waiting} {messages} in the buffer, and {} KiB on disk", bytes.div_ceil(1024))
            }
        };
        match self.lost_since.take().filter(|_| again) {
            Some(since) => {
                self.counts.reconnects += 1;
                let secs = duration::display(Duration::from_secs(since.elapsed().as_secs()));
                let again = if last == Some(self.brokers.number()) { " again" } else { "" };
                self.listener.log(Level::Notice, &format!("connected to {url}{again} after {secs}{buffered}"));
            }
            None => self.listener.log(Level::Notice, &format!("connected to {url}{buffered}")),
        }
        self.report_dropped();
        let topics = self.format.topics();
        if let (false, ConnectionState::Open(open)) = (topics.is_empty(), &mut self.connection)
            && open.uplink.subscribe(&topics).is_err()
        {
            self.listener.log(Level::Warning, "cannot send the subscription to the broker");
        }
        let messages = self.format.first_messages(now_ms());
        self.send(None, &messages);
        if !self.format.is_ready() && !self.brokers.is_single() {
            self.delayed_until = Some(Instant::now() + HOST_TIMEOUT);
        }
        self.ask();
    }

    /// Sends the delayed messages of the format. If the format is still not ready, no primary host has sent its state.
    fn handle_delay(&mut self) {
        let messages = self.format.delayed_messages(now_ms());
        self.send(None, &messages);
        if !self.format.is_ready() {
            let secs = HOST_TIMEOUT.as_secs();
            self.listener.log(Level::Notice, &format!("no primary host has sent its state within {secs}s"));
            self.close_and_continue();
        }
    }

    fn react(&mut self, reaction: Reaction) {
        if let Some((level, note)) = reaction.note {
            self.listener.log(level, &note);
        }
        self.send(None, &reaction.messages);
        if let Some(delay) = reaction.delay {
            self.delayed_until = Some(Instant::now() + delay);
        }
        if reaction.reconnects || (reaction.tries_next && !self.brokers.is_single()) {
            self.close_and_continue();
        }
    }

    /// Ends the connection with DISCONNECT, and then connects to the next broker, or to the only broker again. The new
    /// connection has a new last will.
    fn close_and_continue(&mut self) {
        self.leave();
        let pause = if self.brokers.is_single() { Some(RECONNECT_PAUSE) } else { self.brokers.advance() };
        let next = Instant::now() + pause.unwrap_or_default();
        let closed = std::mem::replace(&mut self.connection, ConnectionState::Waiting(next));
        if let ConnectionState::Open(open) = closed {
            let closed = timeout(CLOSE_TIMEOUT, open.uplink.close()).map(|_in_time| ());
            self.connection = ConnectionState::Closing(closed.boxed_local(), next);
        }
        if !self.brokers.is_single() {
            self.listener
                .log(Level::Notice, &format!("next broker: {}{}", self.brokers.current().url(), within(pause)));
        }
    }

    /// Handles the end of the connection. Records that have not arrived stay in the queue.
    fn leave(&mut self) {
        self.listener.set_broker(self.brokers.current().url(), false);
        self.outbox.requeue();
        self.outbox.set_away(true);
        self.delayed_until = None;
        self.format.connection_lost();
        self.lost_since = self.lost_since.or_else(|| self.brokers.was_accepted().then(Instant::now));
    }

    fn handle_loss(&mut self, loss: &Loss) -> Result<()> {
        self.leave();
        self.fail(error_text::loss(self.brokers.current().url(), loss))
    }

    fn handle_refusal(&mut self, refusal: &Refusal) -> Result<()> {
        self.leave();
        self.fail(error_text::refusal(self.brokers.current().url(), refusal))
    }

    /// Continues with the next broker. After a round, waits before the next attempt: even the cause of a refusal or of a
    /// certificate error can be gone a minute later. Only a run with a limit (`--count`) gives up.
    fn fail(&mut self, failure: Failure) -> Result<()> {
        // If the connection worked before, the settings are probably right, unless the broker reports an error in them.
        let is_setting = failure.kind == Kind::Usage || !self.brokers.was_current_accepted();
        let level = if self.brokers.is_new_failure(&failure.message) { Level::Warning } else { Level::Detail };
        let pause = self.brokers.advance();
        self.connection = ConnectionState::Waiting(Instant::now() + pause.unwrap_or_default());
        if self.ends_without_broker && pause.is_some() {
            return Err(failure);
        }
        let hint = failure.hint.filter(|_| is_setting).map(|hint| format!(" ({hint})")).unwrap_or_default();
        let next = match pause {
            None => format!("next broker: {}", self.brokers.current().url()),
            Some(_) => format!("next try{}, then repeatedly", within(pause)),
        };
        self.listener.log(level, &format!("{}{hint}; {next}", failure.message));
        Ok(())
    }

    fn handle_acknowledgement(&mut self, id: u64, code: Option<u8>) {
        let ConnectionState::Open(open) = &mut self.connection else { return };
        let Some(ticket) = open.acknowledged.remove(&id) else { return };
        if open.note_progress() {
            self.brokers.stable();
        }
        if let Some(code) = code {
            self.refuse(&format!("the broker refused a message (0x{code:02X}): check the publish rights of this user"));
        }
        if let Some(ticket) = ticket {
            self.counts.published += u64::from(code.is_none());
            self.counts.refused += u64::from(code.is_some());
            if let (Some(record), None) = (self.outbox.acknowledge(ticket), code) {
                self.format.handle_arrival(&record);
            }
        }
    }

    /// Reports the first rejection as a warning, and later ones at `-v`.
    fn refuse(&mut self, why: &str) {
        self.listener.log(if self.rejected > 0 { Level::Detail } else { Level::Warning }, why);
        self.rejected = self.rejected.saturating_add(1);
    }

    fn handle_pong(&mut self, number: u64) {
        let ConnectionState::Open(open) = &mut self.connection else { return };
        if let Some((_, tickets)) = open.pending_ping.take_if(|(ping, _)| *ping <= number) {
            if open.note_progress() {
                self.brokers.stable();
            }
            for ticket in tickets {
                self.counts.published += 1;
                self.outbox.acknowledge(ticket);
            }
        }
    }

    /// Sends records up to the limits.
    fn fill(&mut self) {
        if self.is_flowing() {
            self.outbox.set_away(false);
        }
        loop {
            let ConnectionState::Open(open) = &mut self.connection else { return };
            let has_room = open.is_accepted
                && self.format.is_ready()
                && open.acknowledged.len() < WINDOW
                && open.unconfirmed.len() < UNCONFIRMED_WINDOW
                && open.uplink.room().is_none_or(|room| room > 0)
                && open.uplink.unsent() < UNSENT_LIMIT;
            if !has_room {
                return;
            }
            let Some((ticket, record)) = self.outbox.take_next() else { return };
            let messages = self.format.convert_record(record, now_ms());
            self.send(Some(ticket), &messages);
        }
    }

    /// Sends the messages of a record, or messages without a record.
    fn send(&mut self, ticket: Option<Ticket>, messages: &[Message]) {
        let ConnectionState::Open(open) = &mut self.connection else { return };
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
                // No message of the record could be sent, so the record is removed.
                self.outbox.acknowledge(ticket);
                self.counts.refused += u64::from(failed.is_some());
            }
        }
        if let Some(why) = failed {
            self.refuse(&why);
        }
    }

    /// Ends the run: sends queued records within a time limit, then a last message, and leaves the rest for the next
    /// process. The end always takes less than [`END_TIMEOUT`]. After a failure (`has_failed`), the messages about the
    /// rest are details.
    pub async fn end(mut self, has_failed: bool) -> Counts {
        let now = Instant::now();
        let told = async {
            while let ConnectionState::Open(_) = &self.connection {
                if self.outbox.is_empty() && self.is_idle() || !self.format.is_ready() {
                    break;
                }
                let next = step(&mut self.connection).await;
                if self.handle_step(next).is_err() {
                    break;
                }
                self.fill();
            }
        };
        let _in_time = timeout_at(now + DELIVERY_TIMEOUT, told).await;
        if matches!(&self.connection, ConnectionState::Open(open) if open.is_accepted) {
            let messages = self.format.final_messages(now_ms());
            self.send(None, &messages);
            let heard = async {
                while matches!(&self.connection, ConnectionState::Open(open) if open.acknowledged.values().any(Option::is_none))
                {
                    let next = step(&mut self.connection).await;
                    if self.handle_step(next).is_err() {
                        break;
                    }
                }
            };
            let _in_time = timeout_at(now + FINAL_TIMEOUT, heard).await;
        }
        let closed = match std::mem::replace(&mut self.connection, ConnectionState::Waiting(now)) {
            ConnectionState::Open(open) => open.uplink.close().boxed_local(),
            ConnectionState::Closing(closed, _) => closed,
            ConnectionState::Waiting(_) | ConnectionState::Opening(_) => ready(()).boxed_local(),
        };
        let _in_time = timeout_at(now + END_TIMEOUT, closed).await;
        self.report_dropped();
        let has_left = !self.outbox.is_empty();
        let outbox = std::mem::replace(&mut self.outbox, Outbox::new(0, None));
        let (nowhere, trouble) = outbox.save_all();
        self.counts.undelivered = nowhere;
        if let Some(error) = trouble {
            self.listener.log(Level::Error, &format!("cannot store the buffer: {}", plain(&error)));
        }
        let or_detail = |level| if has_failed { Level::Detail } else { level };
        if nowhere > 0 {
            let what = if nowhere == 1 { "message was" } else { "messages were" };
            let text = format!("{nowhere} {what} not delivered: the buffer on disk is full or off");
            self.listener.log(or_detail(Level::Warning), &text);
        } else if has_left {
            self.listener.log(or_detail(Level::Notice), "undelivered messages are stored on disk for the next start");
        }
        self.counts
    }
}

/// Text of a pause: ` in 1.2s`.
fn within(pause: Option<Duration>) -> String {
    pause.map(|pause| format!(" in {}.{}s", pause.as_secs(), pause.subsec_millis() / 100)).unwrap_or_default()
}

/// Waits until this time; for ever without a time.
async fn at(time: Option<Instant>) {
    match time {
        Some(time) => sleep_until(time).await,
        None => pending().await,
    }
}

fn now_ms() -> u64 {
    u64::try_from(Timestamp::now().as_millisecond()).unwrap_or_default()
}
