//! The bytes of EtherNet/IP: encapsulation, common packet format, CIP messages, connections, cyclic datagrams.
//!
//! Little-endian but for socket addresses. Parsing takes what devices send (reserved bytes are not looked at); emitting
//! writes what the ODVA's layouts say. Volume 1 below is "The CIP Networks Library, Common Industrial Protocol", volume
//! 2 its EtherNet/IP adaptation.

use thiserror::Error;

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

/// Bytes that are no such message, with the field that says so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("{field} at offset {offset}: {problem}")]
pub struct WireError {
    /// The field.
    pub field: &'static str,
    /// Where it begins, from the start of the message it belongs to.
    pub offset: usize,
    /// What is wrong with it.
    pub problem: Problem,
}

/// What can be wrong with a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Problem {
    /// The message ends before it does.
    #[error("needs {needed} bytes, {present} are there")]
    Short {
        /// Its length.
        needed: usize,
        /// What is left of the message.
        present: usize,
    },
    /// The message goes on after it.
    #[error("{extra} more bytes follow")]
    Trailing {
        /// Bytes too many.
        extra: usize,
    },
    /// A value that it cannot have.
    #[error("is {found:#x}")]
    Value {
        /// The value.
        found: u32,
    },
}

/// Reads a message field by field.
#[derive(Debug, Clone, Copy)]
struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    const fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    fn take(&mut self, len: usize, field: &'static str) -> Result<&'a [u8], WireError> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let Some(taken) = rest.get(..len) else {
            let problem = Problem::Short { needed: len, present: rest.len() };
            return Err(WireError { field, offset: self.at, problem });
        };
        self.at += len;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self, field: &'static str) -> Result<[u8; N], WireError> {
        let mut out = [0; N];
        out.copy_from_slice(self.take(N, field)?);
        Ok(out)
    }

    fn u8(&mut self, field: &'static str) -> Result<u8, WireError> {
        self.array(field).map(u8::from_le_bytes)
    }

    fn u16(&mut self, field: &'static str) -> Result<u16, WireError> {
        self.array(field).map(u16::from_le_bytes)
    }

    fn u32(&mut self, field: &'static str) -> Result<u32, WireError> {
        self.array(field).map(u32::from_le_bytes)
    }

    fn rest(&mut self) -> &'a [u8] {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        self.at = self.bytes.len();
        rest
    }

    const fn is_empty(&self) -> bool {
        self.at >= self.bytes.len()
    }

    /// Nothing may follow `field`.
    fn end(&self, field: &'static str) -> Result<(), WireError> {
        let extra = self.bytes.len().saturating_sub(self.at);
        if extra == 0 {
            return Ok(());
        }
        Err(WireError { field, offset: self.at, problem: Problem::Trailing { extra } })
    }

    /// The error of a field of `len` bytes that was just read.
    fn wrong(&self, field: &'static str, len: usize, found: impl Into<u32>) -> WireError {
        let problem = Problem::Value { found: found.into() };
        WireError { field, offset: self.at.saturating_sub(len), problem }
    }
}

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

#[cfg(test)]
fn hex(text: &str) -> Vec<u8> {
    let digits: Vec<u8> = text.bytes().filter(|byte| !byte.is_ascii_whitespace()).collect();
    let byte = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap();
    digits.chunks(2).map(byte).collect()
}
