//! EtherNet/IP codec: encapsulation, common packet format, CIP messages, connections, class 1 datagrams.
//!
//! Numbers are little-endian, except in socket addresses. The decoder accepts the messages of real devices and ignores
//! reserved bytes. The encoder follows the layouts of ODVA. In the comments, volume 1 is "The CIP Networks Library,
//! Common Industrial Protocol", and volume 2 is its EtherNet/IP adaptation.

use crate::bytes::Reader;
pub use crate::bytes::{Problem, WireError};

mod cip;
mod connect;
mod encapsulation;
mod identity;
mod io;
mod items;
mod path;

pub use cip::{Reply, Request, Status, service};
pub use connect::{Close, Closed, Flow, Net, Open, Opened, Refused, Triad};
pub use encapsulation::{Command, Frame, Frames, HEADER_LEN};
pub use identity::{IDENTITY_ITEM, Identity, Revision, SERVICES_ITEM, Services};
pub use io::{Cyclic, RUN};
pub use items::{Item, RrData, kind};
pub use path::{Key, Path, Segment};

/// Encodes a 16-bit length field.
///
/// # Panics
/// If the length is above 65535. Callers limit the size of messages.
fn len16(len: usize) -> [u8; 2] {
    u16::try_from(len).expect("lengths of messages are bounded where they are built").to_le_bytes()
}

/// Encodes an 8-bit length field that counts 16-bit words.
///
/// # Panics
/// If the length is above 255 words.
fn words8(len: usize) -> u8 {
    u8::try_from(len.div_ceil(2)).expect("lengths of messages are bounded where they are built")
}
