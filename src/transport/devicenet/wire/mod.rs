//! The bytes of DeviceNet: identifiers, explicit messages, fragments, the duplicate MAC check.
//!
//! Little-endian. The layouts are those of the ODVA's volume 3 ("DeviceNet Adaptation of CIP"), as tshark's dissector and
//! two codecs that others wrote read them.

mod duplicate;
mod explicit;
mod fragment;
mod id;
mod io;

pub use self::duplicate::DuplicateCheck;
pub use self::explicit::{Answer, Format, Header, Request, class, connection, general, owner, service};
pub use self::fragment::{Fragment, Kind};
pub use self::id::{Id, Mac};
pub use self::io::{Assembler, Piece, split};
