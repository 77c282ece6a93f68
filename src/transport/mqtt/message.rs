//! Messages and events between client and broker, independent of the MQTT version.

use std::fmt;
use std::time::Duration;

use mqtt_protocol_core::mqtt::result_code::MqttError;
use thiserror::Error;

use super::Loss;

/// MQTT version.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    /// MQTT 3.1.1.
    V3,
    /// MQTT 5.
    V5,
}

/// A message that a client publishes.
#[derive(Clone, PartialEq, Eq)]
pub struct Message {
    /// Topic.
    pub topic: String,
    /// Payload.
    pub payload: Vec<u8>,
    /// Whether the broker keeps the message for later subscribers.
    pub retain: bool,
    /// Whether the broker acknowledges the message: `QoS` 1 if it does, `QoS` 0 if not.
    pub acknowledged: bool,
    /// Time after which the broker deletes the message; `None` if the message stays. Version 3.1.1 has no expiry.
    pub expiry: Option<Duration>,
}

impl fmt::Debug for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { topic, payload, retain, acknowledged, expiry } = self;
        let len = payload.len();
        write!(f, "{topic}: {len} bytes, retain {retain}, acknowledged {acknowledged}, expiry {expiry:?}")
    }
}

/// Last will: a message with `QoS` 1 that the broker publishes if the connection to the client is lost.
pub type Will = Message;

/// Contents of CONNECT.
#[derive(Clone)]
pub struct Hello {
    /// MQTT version.
    pub version: Version,
    /// Client identifier, unique at the broker.
    pub client_id: String,
    /// User name.
    pub user: Option<String>,
    /// Password.
    pub password: Option<Vec<u8>>,
    /// Keepalive interval.
    pub keep_alive: Duration,
    /// Last will.
    pub will: Option<Will>,
}

/// The debug output omits the password.
impl fmt::Debug for Hello {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { version, client_id, user, keep_alive, will, .. } = self;
        write!(f, "{version:?} {client_id}, user {user:?}, keep-alive {keep_alive:?}, will {will:?}")
    }
}

/// Refusal of a connection by the broker.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// MQTT version. The meaning of the code depends on it.
    pub version: Version,
    /// The return code (3.1.1, section 3.2.2.3) or reason code (5, section 3.2.2.2).
    pub code: u8,
    /// Reason text of the broker.
    pub reason: Option<String>,
    /// Name of another server that the broker recommends.
    pub server: Option<String>,
}

/// Event of a session.
#[derive(Debug)]
pub enum Event {
    /// The broker accepted the client.
    Connected,
    /// The broker refused the client.
    Refused(Refusal),
    /// The broker acknowledged the message with this number. If there is a code, the broker rejected the message with
    /// this code.
    Acknowledged(u64, Option<u8>),
    /// A subscription was accepted or refused.
    Subscribed(bool),
    /// The broker answered the ping with this number. The broker has received everything that was sent before this
    /// ping.
    Pong(u64),
    /// A message arrived.
    Message(Message),
    /// The connection is closed.
    Lost(Loss),
}

/// Error of a message that cannot be sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum SendError {
    /// The broker does not accept packets of this size.
    #[error("the broker accepts no message of this size")]
    TooLarge,
    /// The message is not valid in MQTT, for example because of its topic.
    #[error("MQTT cannot encode the message")]
    Invalid,
}

impl From<MqttError> for SendError {
    fn from(error: MqttError) -> Self {
        if error == MqttError::PacketTooLarge { Self::TooLarge } else { Self::Invalid }
    }
}
