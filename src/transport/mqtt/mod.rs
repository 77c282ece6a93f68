//! MQTT 3.1.1 and 5, as a client: messages out, acknowledged; messages in, bounded; nothing known of what they say.
//!
//! | file | holds |
//! |---|---|
//! | `message` | what is said, whichever MQTT they speak |
//! | `session` | the protocol between CONNECT and DISCONNECT: time and bytes in, bytes and events out |
//! | `client` | moves what the session wants moved, over TCP or TLS |
//! | `tls` | whom to trust, who one is, and what is wrong with a certificate |

mod client;
mod message;
mod session;
mod tls;

use thiserror::Error;

pub use self::client::{Client, Endpoint};
pub use self::message::{Event, Hello, Message, Refusal, SendError, Version, Will};
pub use self::session::{LARGEST, Session};
pub use self::tls::{Identity, Tls, TlsError, Trust};
use super::tcp::ConnectError;

/// Packets, bytes and seconds: what a broker may send in a time, besides answers to what is sent to it.
const FLOOD: (u32, u32, u64) = (1000, 4 << 20, 10);

/// Why there is no connection to a broker, or none any more.
#[derive(Debug, Error)]
pub enum Loss {
    /// It is not reached.
    #[error("{0}")]
    Connect(#[from] ConnectError),
    /// It cannot be trusted, or does not trust this client.
    #[error("{0}")]
    Tls(TlsError),
    /// It took the connection, and does not answer.
    #[error("it takes the connection and does not answer")]
    Unanswered,
    /// It stopped answering.
    #[error("it does not answer any more")]
    Silent,
    /// It closed the connection.
    #[error("it closed the connection")]
    Closed,
    /// It closed the connection, and said why.
    #[error("it closed the connection: {}", goodbye(*code, reason.as_deref()))]
    Goodbye {
        /// The reason code of MQTT 5.
        code: u8,
        /// What it says.
        reason: Option<String>,
    },
    /// What it says is not MQTT, or makes no sense.
    #[error("what it says is not MQTT ({0})")]
    Garbage(String),
    /// It breaks the rules of MQTT.
    #[error("it breaks the MQTT protocol: {0}")]
    Protocol(&'static str),
    /// It sends more than a client can want.
    #[error("it sends too much: more than {} packets or {} bytes in {} s that answer nothing", FLOOD.0, FLOOD.1, FLOOD.2)]
    Flood,
    /// It does not take what is sent to it.
    #[error("it does not read what is sent to it")]
    Unread,
    /// It sends a message that nobody here wants to hold.
    #[error("it sends a packet of more than {LARGEST} bytes")]
    TooLarge,
    /// The line.
    #[error("{0}")]
    Io(String),
}

impl Loss {
    /// Another client with the same name took the place of this one.
    pub fn is_takeover(&self) -> bool {
        matches!(self, Self::Goodbye { code: 0x8e, .. })
    }
}

/// What a reason code of a DISCONNECT means (MQTT 5, section 3.14.2.1), with what the broker adds.
fn goodbye(code: u8, reason: Option<&str>) -> String {
    const CODES: [(u8, &str); 16] = [
        (0x81, "malformed packet"),
        (0x82, "protocol error"),
        (0x87, "not authorized"),
        (0x89, "it is busy"),
        (0x8b, "it shuts down"),
        (0x8d, "keep-alive timeout"),
        (0x8e, "another client has taken over this name"),
        (0x90, "invalid topic"),
        (0x93, "receive maximum exceeded"),
        (0x95, "packet too large"),
        (0x96, "message rate too high"),
        (0x97, "quota exceeded"),
        (0x98, "administrative action"),
        (0x9a, "it keeps no retained messages"),
        (0x9c, "use another server"),
        (0x9d, "it has moved"),
    ];
    let name = CODES.iter().find(|(known, _)| *known == code).map_or("unspecified", |(_, name)| name);
    match reason {
        Some(reason) => format!("{name} (0x{code:02X}): {reason}"),
        None => format!("{name} (0x{code:02X})"),
    }
}
