//! Trait for a message format: plain topics ([`PlainFormat`](super::plain_format::PlainFormat)), or a Sparkplug node
//! ([`Node`](super::sparkplug::Node)). Its input is poller events and broker messages. It has no connection and no
//! clock.

use std::time::Duration;

use super::uplink::{Message, Will};
use crate::command::fleet::poll::Event;
use armctl_frame::output::log::Level;

use super::outbox::Record;

/// Reaction to a message of the broker.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Reaction {
    /// Messages to send at once, before the queue.
    pub messages: Vec<Message>,
    /// Text for the log.
    pub note: Option<(Level, String)>,
    /// Whether to close the connection and open a new connection.
    pub reconnects: bool,
    /// Whether to close the connection and try the next broker of the list, if there is one.
    pub tries_next: bool,
    /// Time after which to call [`MessageFormat::delayed_messages`], because these messages may not be sent yet.
    pub delay: Option<Duration>,
}

/// A message format.
pub trait MessageFormat {
    /// Client identifier, unique at the broker.
    fn client_id(&self) -> String;
    /// Sets the broker of the next connection, by its number in the list.
    fn set_broker(&mut self, broker: usize);
    /// Last will of a new connection.
    fn will(&mut self, now_ms: u64) -> Will;
    /// Topics to subscribe to.
    fn topics(&self) -> Vec<String>;
    /// First messages of a new connection.
    fn first_messages(&mut self, now_ms: u64) -> Vec<Message>;
    /// Handles the loss of the connection.
    fn connection_lost(&mut self);
    /// Handles a message of the broker.
    fn handle_message(&mut self, message: &Message, now_ms: u64) -> Reaction;
    /// Messages to send after the delay of a [`Reaction`]; empty if there are none any more.
    fn delayed_messages(&mut self, _now_ms: u64) -> Vec<Message> {
        Vec::new()
    }
    /// Converts a poller event to records.
    fn convert_event(&mut self, event: &Event, now_ms: u64) -> Vec<Record>;
    /// Topics whose retained messages are needed next; empty if there are none. The connection asks for them with a
    /// subscription that lasts until [`end_question`](Self::end_question).
    fn next_question(&mut self) -> Vec<String> {
        Vec::new()
    }
    /// Ends the question: all retained messages have arrived, or there was no question. Returns further records.
    fn end_question(&mut self, _now_ms: u64) -> Vec<Record> {
        Vec::new()
    }
    /// Handles the acknowledgement of a record.
    fn handle_arrival(&mut self, _record: &Record) {}
    /// A warning for the log.
    fn take_note(&mut self) -> Option<String> {
        None
    }
    /// Whether records can be sent now.
    fn is_ready(&self) -> bool;
    /// Converts a record to messages; empty if the record is out of date.
    fn convert_record(&mut self, record: Record, now_ms: u64) -> Vec<Message>;
    /// Last messages before a normal close.
    fn final_messages(&mut self, now_ms: u64) -> Vec<Message>;
}
