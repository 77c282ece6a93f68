//! DeviceNet codec: identifiers, explicit messages, fragments, duplicate MAC check.
//!
//! Numbers are little-endian. The layouts follow ODVA volume 3 ("DeviceNet Adaptation of CIP"). They were taken from
//! Wireshark's dissector and from two codecs of other authors.

mod duplicate;
mod explicit;
mod fragment;
mod id;
mod io;

pub use self::duplicate::DuplicateCheck;
pub use self::explicit::{Answer, Format, Header, Request, class, connection, general, owner, service};
pub use self::fragment::{Fragment, Kind};
pub use self::id::{Id, Mac};
pub use self::io::{Assembler, AssemblyResult, split};
