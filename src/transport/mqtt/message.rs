//! What is said between a client and a broker, whichever MQTT they speak.

use std::fmt;
use std::time::Duration;

use mqtt_protocol_core::mqtt::result_code::MqttError;
use thiserror::Error;

use super::Loss;

/// Which MQTT.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    /// 3.1.1.
    V3,
    /// 5.
    V5,
}

/// A message.
#[derive(Clone, PartialEq, Eq)]
pub struct Message {
    /// Its topic.
    pub topic: String,
    /// What it says.
    pub payload: Vec<u8>,
    /// Whether the broker keeps it for those who come later.
    pub retain: bool,
    /// Whether the broker acknowledges it (`QoS` 1), or not (`QoS` 0).
    pub acknowledged: bool,
}

impl fmt::Debug for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { topic, payload, retain, acknowledged } = self;
        write!(f, "{topic}: {} bytes, retain {retain}, acknowledged {acknowledged}", payload.len())
    }
}

/// What a broker says for a client that is gone: a message with an acknowledgement.
pub type Will = Message;

/// What a client says of itself.
#[derive(Clone)]
pub struct Hello {
    /// Which MQTT.
    pub version: Version,
    /// Its name, unique at the broker.
    pub client_id: String,
    /// Whom the broker knows it as.
    pub user: Option<String>,
    /// That it is.
    pub password: Option<Vec<u8>>,
    /// Longest silence.
    pub keep_alive: Duration,
    /// What the broker says when it is gone.
    pub will: Option<Will>,
}

/// Without the password.
impl fmt::Debug for Hello {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { version, client_id, user, keep_alive, will, .. } = self;
        write!(f, "{version:?} {client_id}, user {user:?}, keep-alive {keep_alive:?}, will {will:?}")
    }
}

/// Why a broker does not take a client.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// Whose codes these are.
    pub version: Version,
    /// The return code (3.1.1, section 3.2.2.3) or reason code (5, section 3.2.2.2).
    pub code: u8,
    /// What it says about it.
    pub reason: Option<String>,
    /// Where to go instead.
    pub server: Option<String>,
}

/// What happened.
#[derive(Debug)]
pub enum Event {
    /// The broker took the client.
    Connected,
    /// It did not.
    Refused(Refusal),
    /// The message of this number is the broker's. Or it does not take it, and this is the code.
    Acknowledged(u64, Option<u8>),
    /// A subscription is there, or it is refused.
    Subscribed(bool),
    /// The broker answered the ping of this number: all that went before that has arrived.
    Pong(u64),
    /// A message came.
    Message(Message),
    /// The connection is at its end.
    Lost(Loss),
}

/// Why a message does not leave.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum SendError {
    /// The broker takes no packets of this size.
    #[error("the broker takes no message of this size")]
    TooLarge,
    /// It cannot be said in MQTT: a topic that is none.
    #[error("it cannot be said in MQTT")]
    Invalid,
}

impl From<MqttError> for SendError {
    fn from(error: MqttError) -> Self {
        if error == MqttError::PacketTooLarge { Self::TooLarge } else { Self::Invalid }
    }
}
