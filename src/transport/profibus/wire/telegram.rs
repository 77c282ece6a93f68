//! Codec for telegrams (part 4, section 4.6).

use super::{Control, Problem, WireError};
use crate::refuse_if;

const SD1: u8 = 0x10;
const SD2: u8 = 0x68;
const SD3: u8 = 0xA2;
const SD4: u8 = 0xDC;
const SC: u8 = 0xE5;
const ED: u8 = 0x16;
/// Bit in an address byte. If it is set, a service access point follows.
const EXTENDED: u8 = 0x80;
/// Number of header bytes: destination, source and function code.
const HEADER: usize = 3;
/// Number of data bytes of a fixed-length telegram.
const FIXED: usize = 8;
/// Valid values of the length field of a variable-length telegram.
const LENGTHS: std::ops::RangeInclusive<u8> = 4..=249;
/// Field name in the error that the first byte begins no telegram.
pub const START: &str = "start delimiter";
/// Field name in the error that the checksum is wrong.
pub const CHECKSUM: &str = "frame check sequence";
/// Maximum number of data bytes of a telegram with service access points.
pub const MAX_DATA: usize = 244;

/// A telegram.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Telegram {
    /// A token. The station that receives it may send requests.
    Token {
        /// New owner of the token.
        to: u8,
        /// Sender.
        from: u8,
    },
    /// Short acknowledgement: a positive answer without content.
    ShortAcknowledge,
    /// A frame with a function code.
    Frame(Frame),
}

/// A telegram with a function code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    /// Destination: 0 to 125, or 127 for all stations.
    pub to: u8,
    /// Source.
    pub from: u8,
    /// Function code.
    pub control: Control,
    /// Destination service access point.
    pub to_sap: Option<u8>,
    /// Source service access point.
    pub from_sap: Option<u8>,
    /// Data.
    pub data: Vec<u8>,
}

/// Result of decoding the start of a buffer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Parsed {
    /// A telegram and its length.
    Whole(Telegram, usize),
    /// A partial telegram and its minimum length.
    Part(usize),
}

impl Frame {
    /// Encodes the frame. The encoder uses the variable-length form also for a frame with eight data bytes.
    ///
    /// # Panics
    /// If the data is longer than [`MAX_DATA`]. Callers limit the length of the data.
    pub fn emit(&self) -> Vec<u8> {
        assert!(self.data.len() <= MAX_DATA, "data of telegrams is bounded where they are built");
        let extended = |address: u8, sap: Option<u8>| address | if sap.is_some() { EXTENDED } else { 0 };
        let mut body = vec![extended(self.to, self.to_sap), extended(self.from, self.from_sap), self.control.byte()];
        body.extend(self.to_sap);
        body.extend(self.from_sap);
        body.extend(&self.data);
        let mut bytes = Vec::with_capacity(body.len() + 6);
        if body.len() == HEADER {
            bytes.push(SD1);
        } else {
            let len = u8::try_from(body.len()).expect("data of telegrams is bounded");
            bytes.extend([SD2, len, len, SD2]);
        }
        bytes.extend(&body);
        bytes.extend([checksum(&body), ED]);
        bytes
    }
}

impl Telegram {
    /// Encodes the telegram.
    pub fn emit(&self) -> Vec<u8> {
        match self {
            Self::Token { to, from } => vec![SD4, *to, *from],
            Self::ShortAcknowledge => vec![SC],
            Self::Frame(frame) => frame.emit(),
        }
    }

    /// Decodes the telegram at the start of a buffer.
    ///
    /// # Errors
    /// The buffer does not start with a telegram.
    pub fn parse(bytes: &[u8]) -> Result<Parsed, WireError> {
        let Some(start) = bytes.first() else { return Ok(Parsed::Part(1)) };
        match *start {
            SC => Ok(Parsed::Whole(Self::ShortAcknowledge, 1)),
            SD4 => match bytes {
                [_, to, from, ..] => {
                    let token = Self::Token { to: plain_address(*to, 1)?, from: plain_address(*from, 2)? };
                    Ok(Parsed::Whole(token, 3))
                }
                _ => Ok(Parsed::Part(3)),
            },
            SD1 => frame(bytes, 1, HEADER),
            SD3 => frame(bytes, 1, HEADER + FIXED),
            SD2 => {
                let Some(&len) = bytes.get(1) else { return Ok(Parsed::Part(4)) };
                refuse_if(!LENGTHS.contains(&len), WireError::value("length", 1, len))?;
                for (at, field, expected) in [(2, "repeated length", len), (3, "repeated start", SD2)] {
                    if let Some(found) = bytes.get(at).filter(|found| **found != expected) {
                        return Err(differs(field, at, *found, expected));
                    }
                }
                frame(bytes, 4, usize::from(len))
            }
            other => Err(WireError::value(START, 0, other)),
        }
    }
}

/// Decodes a frame whose body has `len` bytes and starts at `at`.
fn frame(bytes: &[u8], at: usize, len: usize) -> Result<Parsed, WireError> {
    let whole = at + len + 2;
    let Some(&[fcs, end]) = bytes.get(at + len..whole) else { return Ok(Parsed::Part(whole)) };
    let body = &bytes[at..at + len];
    refuse_if(end != ED, differs("end delimiter", at + len + 1, end, ED))?;
    let sum = checksum(body);
    refuse_if(fcs != sum, differs(CHECKSUM, at + len, fcs, sum))?;
    let control = Control::parse(body[2], at + 2)?;
    let mut rest = HEADER;
    let mut sap = |address: u8, field: &'static str| {
        if address & EXTENDED == 0 {
            return Ok(None);
        }
        let Some(&sap) = body.get(rest) else { return Err(WireError::short(field, at + rest, 1, 0)) };
        rest += 1;
        Ok(Some(sap))
    };
    let to_sap = sap(body[0], "service access point of the receiver")?;
    let from_sap = sap(body[1], "service access point of the sender")?;
    let frame = Frame {
        to: body[0] & !EXTENDED,
        from: body[1] & !EXTENDED,
        control,
        to_sap,
        from_sap,
        data: body[rest..].to_vec(),
    };
    Ok(Parsed::Whole(Telegram::Frame(frame), whole))
}

fn plain_address(address: u8, offset: usize) -> Result<u8, WireError> {
    if address <= super::MAX_STATION { Ok(address) } else { Err(WireError::value("address", offset, address)) }
}

const fn differs(field: &'static str, offset: usize, found: u8, expected: u8) -> WireError {
    WireError { field, offset, problem: Problem::Differs { found, expected } }
}

fn checksum(body: &[u8]) -> u8 {
    body.iter().copied().fold(0, u8::wrapping_add)
}
