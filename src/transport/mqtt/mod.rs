//! MQTT client for versions 3.1.1 and 5. It sends acknowledged messages, and limits the size and number of received
//! messages. This module does not interpret payloads.
//!
//! | file | contents |
//! |---|---|
//! | `message` | messages and events, independent of the version |
//! | `session` | the protocol between CONNECT and DISCONNECT: time and bytes in, bytes and events out |
//! | `packets` | CONNECT, and properties of MQTT 5 |
//! | `client` | driver over TCP or TLS |
//! | `tls` | trust, client certificates, explanation of certificate errors |

mod client;
mod message;
mod packets;
mod session;
mod tls;

use thiserror::Error;

pub use self::client::{Client, Endpoint};
pub use self::message::{Event, Hello, Message, Refusal, SendError, Version, Will};
pub use self::session::{MAX_PACKET_SIZE, Session};
pub use self::tls::{Identity, Tls, TlsError, Trust};
use super::tcp::ConnectError;

/// Flood limit: maximum number of packets and of bytes, and the number of seconds in which they are counted. Answers to
/// packets of this client do not count.
const FLOOD: (u32, u32, u64) = (1000, 4 << 20, 10);

/// Reason why there is no connection to the broker.
#[derive(Debug, Error)]
pub enum Loss {
    /// The TCP connection could not be opened.
    #[error("{0}")]
    Connect(#[from] ConnectError),
    /// The certificate check failed at the client or at the broker.
    #[error("{0}")]
    Tls(TlsError),
    /// The broker accepted the connection but did not answer.
    #[error("the broker accepts the connection, but does not answer")]
    Unanswered,
    /// The broker stopped answering pings.
    #[error("the broker does not answer any longer")]
    Silent,
    /// The broker closed the connection.
    #[error("the broker closed the connection")]
    Closed,
    /// The broker closed the connection with a reason.
    #[error("the broker closed the connection: {}", goodbye(*code, reason.as_deref()))]
    Goodbye {
        /// MQTT 5 reason code.
        code: u8,
        /// Reason text.
        reason: Option<String>,
    },
    /// The received bytes are not MQTT, or not valid.
    #[error("the broker does not send MQTT ({0})")]
    Garbage(String),
    /// The broker violated the MQTT protocol.
    #[error("the broker does not follow the MQTT protocol: {0}")]
    Protocol(&'static str),
    /// The broker sends too much data. See the flood limit.
    #[error("the broker sends too much: more than {} packets or {} bytes in {} s without a request", FLOOD.0, FLOOD.1, FLOOD.2)]
    Flood,
    /// The broker does not read the bytes that are sent to it.
    #[error("the broker does not read the sent data")]
    Unread,
    /// The broker sent a packet that is larger than the limit.
    #[error("the broker sends a packet that is longer than {MAX_PACKET_SIZE} bytes")]
    TooLarge,
    /// Error of the connection.
    #[error("{0}")]
    Io(String),
}

impl Loss {
    /// Whether another client with the same client identifier took over the connection.
    pub fn is_takeover(&self) -> bool {
        matches!(self, Self::Goodbye { code: 0x8e, .. })
    }
}

/// Text of a DISCONNECT reason code (MQTT 5, section 3.14.2.1), with the reason of the broker.
fn goodbye(code: u8, reason: Option<&str>) -> String {
    const CODES: [(u8, &str); 16] = [
        (0x81, "malformed packet"),
        (0x82, "protocol error"),
        (0x87, "not authorized"),
        (0x89, "the broker is busy"),
        (0x8b, "the broker is shutting down"),
        (0x8d, "keep-alive timeout"),
        (0x8e, "another client connected with the same name"),
        (0x90, "invalid topic"),
        (0x93, "receive maximum exceeded"),
        (0x95, "packet too large"),
        (0x96, "message rate too high"),
        (0x97, "quota exceeded"),
        (0x98, "administrative action"),
        (0x9a, "the broker stores no retained messages"),
        (0x9c, "use another server"),
        (0x9d, "the broker has a new address"),
    ];
    let name = CODES.iter().find(|(known, _)| *known == code).map_or("unspecified", |(_, name)| name);
    match reason {
        Some(reason) => format!("{name} (0x{code:02X}): {reason}"),
        None => format!("{name} (0x{code:02X})"),
    }
}
