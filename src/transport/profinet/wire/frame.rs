//! Codec for PROFINET Ethernet frames, with and without VLAN tag, and their frame ids.

use super::{Mac, Reader, WireError, Writer};

/// EtherType of PROFINET.
pub const ETHER_TYPE: u16 = 0x8892;
/// EtherType of a VLAN tag.
const TAGGED: u16 = 0x8100;
/// VLAN tag: priority 6, VLAN 0, for cyclic data and high-priority alarms.
pub const TAG_HIGH: u16 = 0xC000;
/// VLAN tag: priority 5, VLAN 0, for low-priority alarms.
pub const TAG_LOW: u16 = 0xA000;
/// Minimum length of a frame in bytes, without tag and checksum.
const MIN_LEN: usize = 60;

/// Frame ids.
pub mod id {
    use std::ops::RangeInclusive;

    /// Unicast cyclic data, RT class 1 (property value 2).
    pub const RT_CLASS_1: RangeInclusive<u16> = 0x8000..=0xBBFF;
    /// Unicast cyclic data of older devices (property value 1).
    pub const RT_CLASS_1_LEGACY: RangeInclusive<u16> = 0xC000..=0xF7FF;
    /// High-priority alarm.
    pub const ALARM_HIGH: u16 = 0xFC01;
    /// Low-priority alarm.
    pub const ALARM_LOW: u16 = 0xFE01;
    /// DCP Hello.
    pub const DCP_HELLO: u16 = 0xFEFC;
    /// DCP Get and Set, and their answers.
    pub const DCP_GET_SET: u16 = 0xFEFD;
    /// DCP Identify request.
    pub const DCP_IDENTIFY: u16 = 0xFEFE;
    /// DCP Identify answer.
    pub const DCP_IDENTIFIED: u16 = 0xFEFF;
}

/// A PROFINET Ethernet frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frame<'a> {
    /// Destination.
    pub destination: Mac,
    /// Source.
    pub source: Mac,
    /// VLAN tag; `None` if the frame has none. A network driver may also have removed the tag.
    pub tag: Option<u16>,
    /// Frame id.
    pub id: u16,
    /// Payload, which may end with padding.
    pub payload: &'a [u8],
}

impl<'a> Frame<'a> {
    /// Decodes a frame.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, WireError> {
        let mut reader = Reader::big(bytes);
        let destination = reader.mac("destination")?;
        let source = reader.mac("source")?;
        let mut kind = reader.u16("type")?;
        let mut tag = None;
        if kind == TAGGED {
            tag = Some(reader.u16("tag")?);
            kind = reader.u16("type")?;
        }
        if kind != ETHER_TYPE {
            return Err(reader.wrong("type", 2, kind));
        }
        let id = reader.u16("FrameID")?;
        Ok(Self { destination, source, tag, id, payload: reader.rest() })
    }

    /// Encodes the frame, padded to the minimum length.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.put(&self.destination.0);
        out.put(&self.source.0);
        if let Some(tag) = self.tag {
            out.u16(TAGGED);
            out.u16(tag);
        }
        out.u16(ETHER_TYPE);
        out.u16(self.id);
        out.put(self.payload);
        let shortest = if self.tag.is_some() { MIN_LEN + 4 } else { MIN_LEN };
        out.zeros(shortest.saturating_sub(out.bytes.len()));
        out.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::super::Problem;
    use super::*;
    use crate::testing::hex;

    #[test]
    fn frames_round_trip_with_and_without_a_vlan_tag() {
        let frame =
            Frame { destination: Mac([2; 6]), source: Mac([4; 6]), tag: Some(TAG_HIGH), id: 0x8001, payload: &[7; 3] };
        let bytes = frame.emit();
        assert_eq!(bytes[..23].to_vec(), hex("020202020202 040404040404 8100 C000 8892 8001 070707"));
        assert_eq!(bytes.len(), 64);
        let read = Frame::parse(&bytes).unwrap();
        assert_eq!((read.tag, read.id, read.payload[..3].to_vec()), (Some(0xC000), 0x8001, vec![7; 3]));
        let plain = Frame { tag: None, ..frame }.emit();
        assert_eq!((plain.len(), Frame::parse(&plain).unwrap().tag), (60, None));
    }

    #[test]
    fn other_frames_are_named() {
        let error = Frame::parse(&hex("020202020202 040404040404 0800 4500")).unwrap_err();
        assert_eq!((error.field, error.offset, error.problem), ("type", 12, Problem::Value(0x800)));
    }
}
