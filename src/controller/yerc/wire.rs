//! Frame format: 24-byte header, 8-byte sub-header, at most 479 bytes of data (FS and DX section 3.1).
//!
//! Frames of the client (request, file data, ACK) have the request sub-header. Frames of the controller have the answer
//! sub-header. Parsing accepts what real controllers send: it ignores reserved bytes and padding bytes. Encoding
//! follows the manual.

use crate::refuse_if;
use std::ops::Range;

use thiserror::Error;

/// Offset of the data: size of header and sub-header.
pub const HEADER_LEN: usize = 32;
/// Maximum data size of a frame.
pub const MAX_DATA: usize = 479;
/// Maximum size of a datagram.
pub const MAX_FRAME: usize = HEADER_LEN + MAX_DATA;
/// Bit in the block number that marks the last frame of an answer or transfer.
pub const LAST_BLOCK: u32 = 0x8000_0000;
/// Bit that is set in the service number of an answer.
pub const ANSWER_BIT: u8 = 0x80;

const IDENTIFIER: &[u8; 4] = b"YERC";
const RESERVE_1: u8 = 0x03;
const RESERVE_2: [u8; 8] = [0x39; 8];

/// Byte ranges of a frame.
mod field {
    use super::Range;

    pub(super) const IDENTIFIER: Range<usize> = 0..4;
    pub(super) const HEADER_SIZE: Range<usize> = 4..6;
    pub(super) const DATA_SIZE: Range<usize> = 6..8;
    pub(super) const RESERVE_1: usize = 8;
    pub(super) const DIVISION: usize = 9;
    pub(super) const ACK: usize = 10;
    pub(super) const ID: usize = 11;
    pub(super) const BLOCK: Range<usize> = 12..16;
    pub(super) const RESERVE_2: Range<usize> = 16..24;

    // Sub-header of client frames.
    pub(super) const COMMAND: Range<usize> = 24..26;
    pub(super) const INSTANCE: Range<usize> = 26..28;
    pub(super) const ATTRIBUTE: usize = 28;
    pub(super) const SERVICE: usize = 29;

    // Sub-header of controller frames.
    pub(super) const ANSWER_SERVICE: usize = 24;
    pub(super) const STATUS: usize = 25;
    pub(super) const ADDED_SIZE: usize = 26;
    pub(super) const ADDED: Range<usize> = 28..32;
}

/// Server of a frame. Each server has its own UDP port.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Division {
    /// Robot control, UDP 10040.
    Robot,
    /// File control, UDP 10041.
    File,
}

impl Division {
    const fn byte(self) -> u8 {
        match self {
            Self::Robot => 1,
            Self::File => 2,
        }
    }
}

/// Why a datagram is invalid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum WireError {
    /// The datagram is too short for header and sub-header.
    #[error("{0} bytes are too short: a frame has at least {HEADER_LEN}")]
    Truncated(usize),
    /// The datagram is longer than any valid frame.
    #[error("{0} bytes are too long: a frame has at most {MAX_FRAME}")]
    Oversized(usize),
    /// The identifier is not YERC.
    #[error("identifier at offset 0 is {0:02x?}, not \"YERC\"")]
    Identifier([u8; 4]),
    /// The header size is not 0x20.
    #[error("header size at offset 4 is {0:#06x}, not 0x0020")]
    HeaderSize(u16),
    /// The size field does not match the size of the data.
    #[error("data size at offset 6 is {stated}, but {present} bytes follow the header")]
    DataSize {
        /// Size in the header.
        stated: usize,
        /// Actual size.
        present: usize,
    },
    /// The division is neither robot (1) nor file (2).
    #[error("processing division at offset 9 is {0}, neither 1 (robot) nor 2 (file)")]
    Division(u8),
    /// The ACK flag is neither 0 nor 1.
    #[error("ACK at offset 10 is {0}, neither 0 nor 1")]
    Ack(u8),
}

/// Common part of both sub-headers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Header {
    division: Division,
    ack: bool,
    id: u8,
    block: u32,
}

impl Header {
    fn parse(bytes: &[u8]) -> Result<(Self, &[u8]), WireError> {
        let len = bytes.len();
        refuse_if(len < HEADER_LEN, WireError::Truncated(len))?;
        refuse_if(len > MAX_FRAME, WireError::Oversized(len))?;
        let found = array(bytes, field::IDENTIFIER);
        refuse_if(&found != IDENTIFIER, WireError::Identifier(found))?;
        let found = u16::from_le_bytes(array(bytes, field::HEADER_SIZE));
        refuse_if(usize::from(found) != HEADER_LEN, WireError::HeaderSize(found))?;
        let data = &bytes[HEADER_LEN..];
        let stated = usize::from(u16::from_le_bytes(array(bytes, field::DATA_SIZE)));
        refuse_if(stated != data.len(), WireError::DataSize { stated, present: data.len() })?;
        let division = match bytes[field::DIVISION] {
            1 => Division::Robot,
            2 => Division::File,
            found => return Err(WireError::Division(found)),
        };
        let ack = match bytes[field::ACK] {
            0 => false,
            1 => true,
            found => return Err(WireError::Ack(found)),
        };
        let block = u32::from_le_bytes(array(bytes, field::BLOCK));
        Ok((Self { division, ack, id: bytes[field::ID], block }, data))
    }

    /// Encodes a frame with an empty sub-header.
    fn emit(self, data: &[u8]) -> Vec<u8> {
        let mut frame = vec![0; HEADER_LEN + data.len()];
        frame[field::IDENTIFIER].copy_from_slice(IDENTIFIER);
        frame[field::HEADER_SIZE].copy_from_slice(&le16(HEADER_LEN));
        frame[field::DATA_SIZE].copy_from_slice(&le16(data.len()));
        frame[field::RESERVE_1] = RESERVE_1;
        frame[field::DIVISION] = self.division.byte();
        frame[field::ACK] = u8::from(self.ack);
        frame[field::ID] = self.id;
        frame[field::BLOCK].copy_from_slice(&self.block.to_le_bytes());
        frame[field::RESERVE_2].copy_from_slice(&RESERVE_2);
        frame[HEADER_LEN..].copy_from_slice(data);
        frame
    }
}

/// A client frame: request, file data block or ACK.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RequestFrame<'a> {
    /// Robot or file server.
    pub division: Division,
    /// `false` for a request, `true` for data blocks and ACKs of a transfer.
    pub ack: bool,
    /// Request id, copied into the answer.
    pub id: u8,
    /// Block number within a transfer; 0 for a request.
    pub block: u32,
    /// Command number; 0 for files.
    pub command: u16,
    /// Instance of the command.
    pub instance: u16,
    /// Attribute: a field of the instance.
    pub attribute: u8,
    /// Service.
    pub service: u8,
    /// Data of the frame, at most [`MAX_DATA`] bytes.
    pub data: &'a [u8],
}

impl<'a> RequestFrame<'a> {
    /// Parses a client datagram.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, WireError> {
        let (Header { division, ack, id, block }, data) = Header::parse(bytes)?;
        Ok(Self {
            division,
            ack,
            id,
            block,
            command: u16::from_le_bytes(array(bytes, field::COMMAND)),
            instance: u16::from_le_bytes(array(bytes, field::INSTANCE)),
            attribute: bytes[field::ATTRIBUTE],
            service: bytes[field::SERVICE],
            data,
        })
    }

    /// Encodes the datagram. With more data than [`MAX_DATA`], no controller accepts it.
    pub fn emit(&self) -> Vec<u8> {
        let Self { division, ack, id, block, .. } = *self;
        let mut frame = Header { division, ack, id, block }.emit(self.data);
        frame[field::COMMAND].copy_from_slice(&self.command.to_le_bytes());
        frame[field::INSTANCE].copy_from_slice(&self.instance.to_le_bytes());
        frame[field::ATTRIBUTE] = self.attribute;
        frame[field::SERVICE] = self.service;
        frame
    }
}

/// Result code of an answer: status, and an optional added status.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Status {
    /// Status code: 0x00 is success, 0x1F refers to the added status (DX chapter 4).
    pub code: u8,
    /// Size of the added status in 16-bit words, 0 to 2.
    pub added_size: u8,
    /// Added status; 0 if `added_size` is 0.
    pub added: u32,
}

impl Status {
    /// Success without an added status.
    pub const OK: Self = Self { code: 0, added_size: 0, added: 0 };

    /// A refusal with a 16-bit added status, as controllers send it (status 0x1F, size 1).
    pub const fn refused(added: u16) -> Self {
        Self { code: 0x1F, added_size: 1, added: added as u32 }
    }

    /// Whether the controller carried out the request. With this status, an added status may still report that the
    /// object of the request did not exist (DX: E29C, E2A7 with status 0).
    pub const fn is_ok(self) -> bool {
        self.code == 0
    }
}

/// A controller frame: answer, file data block or ACK.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AnswerFrame<'a> {
    /// Robot or file server.
    pub division: Division,
    /// ACK flag; `true` in all controller frames.
    pub ack: bool,
    /// Request id, copied from the client frame.
    pub id: u8,
    /// Block number within a transfer. [`LAST_BLOCK`] in a single answer.
    pub block: u32,
    /// Service of the request plus [`ANSWER_BIT`].
    pub service: u8,
    /// Result code.
    pub status: Status,
    /// Data of the frame, at most [`MAX_DATA`] bytes.
    pub data: &'a [u8],
}

impl<'a> AnswerFrame<'a> {
    /// Parses a controller datagram.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, WireError> {
        let (Header { division, ack, id, block }, data) = Header::parse(bytes)?;
        let added_size = bytes[field::ADDED_SIZE];
        let added = u32::from_le_bytes(array(bytes, field::ADDED));
        let added = match added_size {
            0 => 0,
            1 => added & 0xFFFF,
            _ => added,
        };
        Ok(Self {
            division,
            ack,
            id,
            block,
            service: bytes[field::ANSWER_SERVICE],
            status: Status { code: bytes[field::STATUS], added_size, added },
            data,
        })
    }

    /// Encodes the datagram. With more data than [`MAX_DATA`], no client accepts it.
    pub fn emit(&self) -> Vec<u8> {
        let Self { division, ack, id, block, .. } = *self;
        let mut frame = Header { division, ack, id, block }.emit(self.data);
        frame[field::ANSWER_SERVICE] = self.service;
        frame[field::STATUS] = self.status.code;
        frame[field::ADDED_SIZE] = self.status.added_size;
        let added = match self.status.added_size {
            0 => 0,
            1 => self.status.added & 0xFFFF,
            _ => self.status.added,
        };
        frame[field::ADDED].copy_from_slice(&added.to_le_bytes());
        frame
    }
}

/// The bytes of a range. The length of the range must be `N`.
fn array<const N: usize>(bytes: &[u8], range: Range<usize>) -> [u8; N] {
    let mut out = [0; N];
    out.copy_from_slice(&bytes[range]);
    out
}

/// Encodes a size. The size of a valid frame is at most 511.
fn le16(size: usize) -> [u8; 2] {
    u16::try_from(size).unwrap_or(u16::MAX).to_le_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::hex;

    #[test]
    fn status_request_of_section_3_2_1() {
        let frame = RequestFrame {
            division: Division::Robot,
            ack: false,
            id: 0,
            block: 0,
            command: 0x72,
            instance: 1,
            attribute: 0,
            service: 0x01,
            data: &[],
        };
        let bytes = hex("5945524320000000030100000000000039393939393939397200010000010000");
        assert_eq!(frame.emit(), bytes);
        assert_eq!(RequestFrame::parse(&bytes), Ok(frame));
    }

    #[test]
    fn refusal_with_one_added_word() {
        let bytes = hex("59455243200000000301012a000000803939393939393939901f010000210000");
        let answer = AnswerFrame::parse(&bytes).unwrap();
        assert_eq!(answer.status, Status::refused(0x2100));
        assert_eq!(answer.emit(), bytes);
    }

    #[test]
    fn error_contains_the_length_of_a_short_datagram() {
        assert_eq!(AnswerFrame::parse(&[0; 31]), Err(WireError::Truncated(31)));
    }
}
