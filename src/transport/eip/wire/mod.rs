//! The bytes of EtherNet/IP: encapsulation, common packet format, CIP messages, connections, cyclic datagrams.
//!
//! Little-endian but for socket addresses. Parsing takes what devices send (reserved bytes are not looked at); emitting
//! writes what the ODVA's layouts say. Volume 1 below is "The CIP Networks Library, Common Industrial Protocol", volume
//! 2 its EtherNet/IP adaptation.

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

/// A length as the two bytes of its field.
///
/// # Panics
/// Above 65535; whoever builds messages bounds what goes into them.
fn len16(len: usize) -> [u8; 2] {
    u16::try_from(len).expect("lengths of messages are bounded where they are built").to_le_bytes()
}

/// A length in 16-bit words as its byte; likewise.
fn words8(len: usize) -> u8 {
    u8::try_from(len.div_ceil(2)).expect("lengths of messages are bounded where they are built")
}
