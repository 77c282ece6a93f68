//! How robots are told of: in topics of armctl's own ([`Plain`](super::plain::Plain)), or as a Sparkplug node
//! ([`Node`](super::sparkplug::Node)). It is handed what the poller finds and what the broker sends, and knows no
//! connection and no clock.

use super::uplink::{Message, Will};
use crate::command::fleet::poll::Event;
use crate::output::log::Level;

use super::outbox::Record;

/// What a message of the broker leads to.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Reaction {
    /// What is sent at once, before all that waits.
    pub messages: Vec<Message>,
    /// What is said of it.
    pub note: Option<(Level, String)>,
    /// Whether the connection is left, and made anew.
    pub leaves: bool,
}

/// A way to tell of robots.
pub trait Speech {
    /// The name of the client, unique at the broker.
    fn client_id(&self) -> String;
    /// A new connection is about to be made: what the broker says when it ends by itself.
    fn will(&mut self, now_ms: u64) -> Will;
    /// What the broker's messages are wanted of.
    fn topics(&self) -> Vec<String>;
    /// The connection is there: what is sent first.
    fn connected(&mut self, now_ms: u64) -> Vec<Message>;
    /// The connection is gone.
    fn lost(&mut self);
    /// The broker has sent a message.
    fn received(&mut self, message: &Message, now_ms: u64) -> Reaction;
    /// The poller has found something: what is to be told of it.
    fn found(&mut self, event: &Event, now_ms: u64) -> Vec<Record>;
    /// Whether records may be told now.
    fn is_ready(&self) -> bool;
    /// What a record is as messages; none where there is nothing to tell any more.
    fn told(&mut self, record: Record, now_ms: u64) -> Vec<Message>;
    /// What is sent last, before the connection is left in order.
    fn farewell(&mut self, now_ms: u64) -> Vec<Message>;
}
