//! Codec for connectionless RPC (DCE 1.1, version 4) on UDP port 34964. It includes the NDR header before the blocks.

use super::{ByteOrder, Reader, Uuid, WireError, Writer, count16, count32};
use crate::refuse_if;

/// UDP port of both controller and device.
pub const PORT: u16 = 34964;
/// Length of the RPC header.
pub const HEADER_LEN: usize = 80;
/// Length of the five NDR numbers in bytes.
const NDR_LEN: usize = 20;
/// Buffer size for an answer. It is large enough for all calls.
pub const ANSWER_BUFFER_SIZE: u32 = 4096;
/// Maximum size of a reassembled answer in bytes.
pub const MAX_ANSWER_LEN: usize = 65_536;

/// Packet type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Kind(pub u8);

impl Kind {
    /// A call.
    pub const REQUEST: Self = Self(0);
    /// Request for the state of a call in progress.
    pub const PING: Self = Self(1);
    /// Answer to a call.
    pub const RESPONSE: Self = Self(2);
    /// The call failed.
    pub const FAULT: Self = Self(3);
    /// The call is in progress.
    pub const WORKING: Self = Self(4);
    /// The call is unknown.
    pub const NO_CALL: Self = Self(5);
    /// The call is rejected.
    pub const REJECT: Self = Self(6);
    /// Acknowledgement of a response.
    pub const ACK: Self = Self(7);
    /// Acknowledgement of a fragment.
    pub const FRAGMENT_ACK: Self = Self(9);
}

/// Flags of the header.
pub mod flag {
    /// The datagram is the last fragment.
    pub const LAST_FRAGMENT: u8 = 0x02;
    /// The datagram is a fragment.
    pub const FRAGMENT: u8 = 0x04;
    /// The receiver must not acknowledge the fragment.
    pub const NO_ACK: u8 = 0x08;
    /// The call can be repeated without harm.
    pub const IDEMPOTENT: u8 = 0x20;
}

/// Operation numbers.
pub mod operation {
    /// Open a connection.
    pub const CONNECT: u16 = 0;
    /// Close a connection.
    pub const RELEASE: u16 = 1;
    /// Read a record.
    pub const READ: u16 = 2;
    /// Write records.
    pub const WRITE: u16 = 3;
    /// Call PrmEnd or ApplicationReady.
    pub const CONTROL: u16 = 4;
    /// Read a record without a connection.
    pub const READ_IMPLICIT: u16 = 5;
}

/// Interface UUID of devices.
pub const DEVICE: Uuid = Uuid([0xDE, 0xA0, 0, 1, 0x6C, 0x97, 0x11, 0xD1, 0x82, 0x71, 0, 0xA0, 0x24, 0x42, 0xDF, 0x7D]);
/// Interface UUID of controllers.
pub const CONTROLLER: Uuid =
    Uuid([0xDE, 0xA0, 0, 2, 0x6C, 0x97, 0x11, 0xD1, 0x82, 0x71, 0, 0xA0, 0x24, 0x42, 0xDF, 0x7D]);

/// Returns the object UUID of a station.
pub fn object(instance: u16, device: u16, vendor: u16) -> Uuid {
    let [i0, i1] = instance.to_be_bytes();
    let [d0, d1] = device.to_be_bytes();
    let [v0, v1] = vendor.to_be_bytes();
    Uuid([0xDE, 0xA0, 0, 0, 0x6C, 0x97, 0x11, 0xD1, 0x82, 0x71, i0, i1, d0, d1, v0, v1])
}

/// RPC header.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Header {
    /// Packet type.
    pub kind: Kind,
    /// Flags; see [`flag`].
    pub flags: u8,
    /// Byte order of the header and the NDR numbers.
    pub order: ByteOrder,
    /// Object UUID of the device.
    pub object: Uuid,
    /// Interface UUID.
    pub interface: Uuid,
    /// Activity UUID, unique for each client.
    pub activity: Uuid,
    /// Boot time of the server; 0 if unknown.
    pub boot: u32,
    /// Sequence number of the call in the activity.
    pub sequence: u32,
    /// Operation number; see [`operation`].
    pub operation: u16,
    /// Fragment number.
    pub fragment: u16,
}

/// An RPC datagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Datagram<'a> {
    /// RPC header.
    pub header: Header,
    /// NDR numbers and blocks, or a fragment of these bytes.
    pub body: &'a [u8],
}

impl<'a> Datagram<'a> {
    /// Decodes a datagram.
    ///
    /// # Errors
    /// The datagram is not RPC version 4, or is too short.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, WireError> {
        let mut reader = Reader::big(bytes);
        let version = reader.u8("RPC version")?;
        refuse_if(version != 4, reader.wrong("RPC version", 1, version))?;
        let kind = Kind(reader.u8("packet type")? & 0x1F);
        let flags = reader.u8("flags")?;
        reader.u8("flags 2")?;
        let order = match reader.u8("data representation")? >> 4 {
            0 => ByteOrder::Big,
            1 => ByteOrder::Little,
            other => return Err(reader.wrong("data representation", 1, other)),
        };
        reader.take(3, "data representation")?;
        reader.order = order;
        let object = reader.uuid("object")?;
        let interface = reader.uuid("interface")?;
        let activity = reader.uuid("activity")?;
        let boot = reader.u32("server boot time")?;
        reader.u32("interface version")?;
        let sequence = reader.u32("sequence number")?;
        let operation = reader.u16("operation")?;
        reader.u32("hints")?;
        let length = reader.u16("fragment length")?;
        let fragment = reader.u16("fragment number")?;
        reader.u16("authentication")?;
        let body = reader.take(usize::from(length), "fragment")?;
        let header = Header { kind, flags, order, object, interface, activity, boot, sequence, operation, fragment };
        Ok(Self { header, body })
    }

    /// Encodes the datagram.
    pub fn emit(&self) -> Vec<u8> {
        let header = &self.header;
        let mut out = Writer { bytes: Vec::with_capacity(HEADER_LEN + self.body.len()), order: header.order };
        let representation = if header.order == ByteOrder::Big { 0x00 } else { 0x10 };
        out.put(&[4, header.kind.0, header.flags, 0, representation, 0, 0, 0]);
        out.uuid(header.object);
        out.uuid(header.interface);
        out.uuid(header.activity);
        out.u32(header.boot);
        out.u32(1);
        out.u32(header.sequence);
        out.u16(header.operation);
        out.u32(0xFFFF_FFFF);
        out.u16(count16(self.body.len()));
        out.u16(header.fragment);
        out.put(&[0; 2]);
        out.put(self.body);
        out.bytes
    }
}

impl Header {
    /// Returns the header of the answer to this call.
    #[must_use]
    pub const fn answer(&self) -> Self {
        Self { kind: Kind::RESPONSE, flags: flag::NO_ACK | flag::LAST_FRAGMENT, fragment: 0, ..*self }
    }

    /// Whether the datagram is a fragment.
    pub const fn is_fragment(&self) -> bool {
        self.flags & flag::FRAGMENT != 0
    }
}

/// Content of a call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Call<'a> {
    /// Buffer size for the blocks of the answer.
    pub room: u32,
    /// The blocks.
    pub blocks: &'a [u8],
}

impl<'a> Call<'a> {
    /// Decodes a call.
    pub fn parse(body: &'a [u8], order: ByteOrder) -> Result<Self, WireError> {
        let (room, blocks) = read_ndr(body, order)?;
        Ok(Self { room, blocks })
    }

    /// Encodes the call.
    pub fn emit(&self, order: ByteOrder) -> Vec<u8> {
        write_ndr(self.room, self.room, self.blocks, order)
    }
}

/// Content of an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reply<'a> {
    /// Status; 0 is success. See [`super::status`].
    pub status: u32,
    /// Size of the buffer for the answer, copied from the call.
    pub room: u32,
    /// The blocks.
    pub blocks: &'a [u8],
}

impl<'a> Reply<'a> {
    /// Decodes an answer.
    pub fn parse(body: &'a [u8], order: ByteOrder) -> Result<Self, WireError> {
        let mut reader = Reader::big(body);
        reader.order = order;
        let status = reader.u32("PNIOStatus")?;
        // In a refusal, the bytes after the status may be missing.
        if status != 0 && body.len() < NDR_LEN {
            return Ok(Self { status, room: 0, blocks: &[] });
        }
        let mut room = Reader { at: 8, ..reader };
        let room = room.u32("MaximumCount")?;
        let (_, blocks) = read_ndr(body, order)?;
        Ok(Self { status, room, blocks })
    }

    /// Encodes the answer.
    pub fn emit(&self, order: ByteOrder) -> Vec<u8> {
        write_ndr(self.status, self.room, self.blocks, order)
    }
}

fn read_ndr(body: &[u8], order: ByteOrder) -> Result<(u32, &[u8]), WireError> {
    let mut reader = Reader::big(body);
    reader.order = order;
    let first = reader.u32("ArgsMaximum")?;
    let length = reader.u32("ArgsLength")?;
    reader.u32("MaximumCount")?;
    let offset = reader.u32("Offset")?;
    refuse_if(offset != 0, reader.wrong("Offset", 4, offset))?;
    reader.u32("ActualCount")?;
    let blocks = reader.take(usize::try_from(length).unwrap_or(usize::MAX), "blocks")?;
    Ok((first, blocks))
}

fn write_ndr(first: u32, room: u32, blocks: &[u8], order: ByteOrder) -> Vec<u8> {
    let mut out = Writer { bytes: Vec::with_capacity(NDR_LEN + blocks.len()), order };
    let length = count32(blocks.len());
    for number in [first, length, room, 0, length] {
        out.u32(number);
    }
    out.put(blocks);
    out.bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::hex;

    fn header(order: ByteOrder) -> Header {
        Header {
            kind: Kind::REQUEST,
            flags: flag::IDEMPOTENT,
            order,
            object: object(1, 1, 0xFFFF),
            interface: DEVICE,
            activity: Uuid(hex("AAAAAAAA BBBB CCCC DDDD EEEEEEEEEEEE").try_into().unwrap()),
            boot: 0,
            sequence: 0,
            operation: operation::CONNECT,
            fragment: 0,
        }
    }

    const BLOCKS: [u8; 394] = [7; 394];

    /// The header of Connect and its NDR numbers are from the worked example in the notes.
    #[test]
    fn headers_in_both_orders_are_as_printed() {
        let big = hex(concat!(
            "04 00 20 00 000000 00 DEA00000 6C97 11D1 8271 0001 0001 FFFF DEA00001 6C97 11D1 8271 00A02442DF7D",
            "AAAAAAAA BBBB CCCC DDDD EEEEEEEEEEEE 00000000 00000001 00000000 0000 FFFF FFFF 019E 0000 00 00",
            "00001000 0000018A 00001000 00000000 0000018A",
        ));
        let little = hex(concat!(
            "04 00 20 00 100000 00 0000A0DE 976C D111 8271 0001 0001 FFFF 0100A0DE 976C D111 8271 00A02442DF7D",
            "AAAAAAAA BBBB CCCC DDDD EEEEEEEEEEEE 00000000 01000000 00000000 0000 FFFF FFFF 9E01 0000 00 00",
            "00100000 8A010000 00100000 00000000 8A010000",
        ));
        for (order, start) in [(ByteOrder::Big, big), (ByteOrder::Little, little)] {
            let body = Call { room: ANSWER_BUFFER_SIZE, blocks: &BLOCKS }.emit(order);
            let datagram = Datagram { header: header(order), body: &body };
            let bytes = [start, BLOCKS.to_vec()].concat();
            assert_eq!(datagram.emit(), bytes);
            let read = Datagram::parse(&bytes).unwrap();
            assert_eq!(read, datagram);
            assert_eq!(Call::parse(read.body, order), Ok(Call { room: ANSWER_BUFFER_SIZE, blocks: &BLOCKS }));
        }
    }

    /// The answer is from the worked example in the notes.
    #[test]
    fn answers_begin_with_their_status() {
        let body = Reply { status: 0, room: ANSWER_BUFFER_SIZE, blocks: &BLOCKS[..0x56] }.emit(ByteOrder::Big);
        assert_eq!(body[..20].to_vec(), hex("00000000 00000056 00001000 00000000 00000056"));
        let refusal = hex("DB810209");
        let read = Reply::parse(&refusal, ByteOrder::Big).unwrap();
        assert_eq!((read.status, read.blocks), (0xDB81_0209, &[][..]));
        assert_eq!(Reply::parse(&hex("00000000"), ByteOrder::Big).unwrap_err().field, "MaximumCount");
        let longer = hex("00000000 00000056 00001000 00000000 00000056 00");
        assert_eq!(Reply::parse(&longer, ByteOrder::Big).unwrap_err().field, "blocks");
    }
}
