//! PROFINET IO codec: Ethernet frames, DCP, RPC, blocks, records, cyclic data, alarms.
//!
//! Numbers are big-endian, except in the RPC header and its five NDR numbers. A field of the datagram gives the byte
//! order of these numbers. The decoder accepts the messages of real devices and ignores reserved bytes. The encoder
//! follows IEC 61158-6-10.

use std::fmt;
use std::str::FromStr;

use crate::bytes::Reader;
pub use crate::bytes::{ByteOrder, Problem, WireError};

pub mod alarm;
pub mod arp;
pub mod block;
pub mod connect;
pub mod cyclic;
pub mod dcp;
pub mod frame;
pub mod record;
pub mod rpc;
pub mod status;
#[cfg(test)]
mod tests;

/// MAC address.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Mac(pub [u8; 6]);

impl Mac {
    /// Multicast address of DCP Identify requests.
    pub const DCP_IDENTIFY: Self = Self([0x01, 0x0E, 0xCF, 0, 0, 0]);
    /// Multicast address of DCP Hello.
    pub const DCP_HELLO: Self = Self([0x01, 0x0E, 0xCF, 0, 0, 1]);

    /// Whether this is a multicast address.
    pub const fn is_group(self) -> bool {
        self.0[0] & 1 == 1
    }
}

impl fmt::Display for Mac {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, byte) in self.0.iter().enumerate() {
            write!(f, "{}{byte:02x}", if at == 0 { "" } else { ":" })?;
        }
        Ok(())
    }
}

impl fmt::Debug for Mac {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl FromStr for Mac {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("'{text}' is not a MAC address such as 02:00:00:00:00:01");
        let mut bytes = [0; 6];
        let mut parts = text.split([':', '-']);
        for byte in &mut bytes {
            let part = parts.next().filter(|part| part.len() == 2 && !part.starts_with('+')).ok_or_else(wrong)?;
            *byte = u8::from_str_radix(part, 16).map_err(|_| wrong())?;
        }
        if parts.next().is_some() { Err(wrong()) } else { Ok(Self(bytes)) }
    }
}

/// UUID, in the byte order that blocks use.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Uuid(pub [u8; 16]);

impl Uuid {
    /// The nil UUID.
    pub const NIL: Self = Self([0; 16]);

    /// Returns the UUID with the bytes of its first three fields reversed.
    fn swapped(self) -> Self {
        let mut bytes = self.0;
        bytes[..4].reverse();
        bytes[4..6].reverse();
        bytes[6..8].reverse();
        Self(bytes)
    }

    /// Creates a random UUID (version 4).
    pub fn random() -> Self {
        let mut bytes = fastrand::u128(..).to_be_bytes();
        bytes[6] = bytes[6] & 0x0F | 0x40;
        bytes[8] = bytes[8] & 0x3F | 0x80;
        Self(bytes)
    }
}

impl fmt::Display for Uuid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, byte) in self.0.iter().enumerate() {
            let dash = if matches!(at, 4 | 6 | 8 | 10) { "-" } else { "" };
            write!(f, "{dash}{byte:02x}")?;
        }
        Ok(())
    }
}

impl fmt::Debug for Uuid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl Reader<'_> {
    fn mac(&mut self, field: &'static str) -> Result<Mac, WireError> {
        self.array(field).map(Mac)
    }

    fn uuid(&mut self, field: &'static str) -> Result<Uuid, WireError> {
        let uuid = Uuid(self.array(field)?);
        Ok(if self.order == ByteOrder::Big { uuid } else { uuid.swapped() })
    }
}

#[derive(Debug, Default)]
struct Writer {
    bytes: Vec<u8>,
    order: ByteOrder,
}

impl Writer {
    fn u8(&mut self, value: u8) {
        self.bytes.push(value);
    }

    fn u16(&mut self, value: u16) {
        self.bytes.extend(if self.order == ByteOrder::Big { value.to_be_bytes() } else { value.to_le_bytes() });
    }

    fn u32(&mut self, value: u32) {
        self.bytes.extend(if self.order == ByteOrder::Big { value.to_be_bytes() } else { value.to_le_bytes() });
    }

    fn uuid(&mut self, uuid: Uuid) {
        self.bytes.extend(if self.order == ByteOrder::Big { uuid.0 } else { uuid.swapped().0 });
    }

    fn put(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    fn zeros(&mut self, count: usize) {
        self.bytes.resize(self.bytes.len() + count, 0);
    }
}

/// Encodes a 16-bit length or count.
///
/// # Panics
/// If the value is above 65535. Callers limit the size of messages.
fn count16(count: usize) -> u16 {
    u16::try_from(count).expect("lengths of messages are bounded where they are built")
}

/// Encodes a 32-bit length or count.
///
/// # Panics
/// If the value does not fit into 32 bits.
fn count32(count: usize) -> u32 {
    u32::try_from(count).expect("lengths of messages are bounded where they are built")
}

/// Decodes the text of a fixed-length field, without trailing blanks and zeros.
fn text(bytes: &[u8]) -> String {
    let text: String = String::from_utf8_lossy(bytes).chars().filter(|c| !c.is_control()).collect();
    text.trim_end_matches(' ').to_owned()
}

#[cfg(test)]
mod unit {
    use super::*;
    use crate::testing::hex;

    #[test]
    fn mac_addresses_round_trip() {
        let mac = Mac([2, 0, 0xAB, 0, 0, 1]);
        assert_eq!(mac.to_string(), "02:00:ab:00:00:01");
        for text in ["02:00:ab:00:00:01", "02-00-AB-00-00-01"] {
            assert_eq!(text.parse(), Ok(mac));
        }
        for text in ["", "02:00:ab:00:00", "02:00:ab:00:00:01:02", "2:0:ab:0:0:1", "+2:00:ab:00:00:01", "yrcx"] {
            assert!(text.parse::<Mac>().is_err(), "{text}");
        }
    }

    #[test]
    fn a_uuid_turns_its_first_three_fields_only() {
        let uuid = Uuid(hex("DEA00001 6C97 11D1 8271 00A02442DF7D").try_into().unwrap());
        assert_eq!(uuid.to_string(), "dea00001-6c97-11d1-8271-00a02442df7d");
        assert_eq!(uuid.swapped().0.to_vec(), hex("0100A0DE 976C D111 8271 00A02442DF7D"));
        assert_eq!(uuid.swapped().swapped(), uuid);
    }
}
