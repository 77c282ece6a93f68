//! Codec for CIP requests and replies (volume 1, 2-4).

use std::fmt;

use super::{Path, Reader, WireError, words8};

/// Service codes.
pub mod service {
    /// Get_Attributes_All.
    pub const ATTRIBUTES_ALL: u8 = 0x01;
    /// Get_Attribute_Single.
    pub const ATTRIBUTE_SINGLE: u8 = 0x0E;
    /// Set_Attribute_Single.
    pub const SET_ATTRIBUTE_SINGLE: u8 = 0x10;
    /// ForwardClose.
    pub const FORWARD_CLOSE: u8 = 0x4E;
    /// ForwardOpen, for connections of up to 511 bytes in each direction.
    pub const FORWARD_OPEN: u8 = 0x54;
    /// LargeForwardOpen, for connections of up to 65,535 bytes in each direction.
    pub const LARGE_FORWARD_OPEN: u8 = 0x5B;
    /// Bit that is set in the service code of a reply.
    pub const REPLY: u8 = 0x80;
}

/// A request to an object.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Request<'a> {
    /// Service code; see [`service`].
    pub service: u8,
    /// Path of the object.
    pub path: Path,
    /// Service data.
    pub data: &'a [u8],
}

impl<'a> Request<'a> {
    /// Decodes a request.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, WireError> {
        let mut reader = Reader::little(bytes);
        let service = reader.u8("service")?;
        let words = reader.u8("words of the path")?;
        let path = Path::parse(reader.take(usize::from(words) * 2, "path")?)
            .map_err(|error| WireError { offset: error.offset + 2, ..error })?;
        Ok(Self { service, path, data: reader.rest() })
    }

    /// Encodes the request.
    pub fn emit(&self) -> Vec<u8> {
        let path = self.path.emit();
        let mut out = vec![self.service, words8(path.len())];
        out.extend(path);
        out.extend(self.data);
        out
    }
}

/// CIP status.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct Status {
    /// General status; 0 is success.
    pub general: u8,
    /// Extended status words. In most cases there are none.
    pub extended: Vec<u16>,
}

impl Status {
    /// Success.
    pub const OK: Self = Self { general: 0, extended: Vec::new() };

    /// Creates a general status without extended words.
    pub const fn general(general: u8) -> Self {
        Self { general, extended: Vec::new() }
    }

    /// Creates an extended status of the connection manager (general status 1). `more` contains the words after the
    /// extended status.
    pub fn connection(extended: u16, more: &[u16]) -> Self {
        Self { general: 1, extended: [&[extended], more].concat() }
    }

    /// Whether the request succeeded.
    pub const fn is_ok(&self) -> bool {
        self.general == 0
    }
}

impl fmt::Display for Status {
    /// Formats the status, for example "0x01/0x0109 54": the general status, the extended status, and the further words
    /// in decimal.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:#04x}", self.general)?;
        if let Some((code, more)) = self.extended.split_first() {
            write!(f, "/{code:#06x}")?;
            more.iter().try_for_each(|word| write!(f, " {word}"))?;
        }
        Ok(())
    }
}

/// Reply to a request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reply<'a> {
    /// Service code of the request.
    pub service: u8,
    /// CIP status.
    pub status: Status,
    /// Response data. If the object refuses, details of the refusal.
    pub data: &'a [u8],
}

impl<'a> Reply<'a> {
    /// Decodes a reply.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, WireError> {
        let mut reader = Reader::little(bytes);
        let service = reader.u8("reply service")?;
        if service & service::REPLY == 0 {
            return Err(reader.wrong("reply service", 1, service));
        }
        reader.u8("reserved")?;
        let general = reader.u8("general status")?;
        let words = reader.u8("words of extended status")?;
        let extended = reader.take(usize::from(words) * 2, "extended status")?;
        let extended = extended.chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect();
        Ok(Self { service: service & !service::REPLY, status: Status { general, extended }, data: reader.rest() })
    }

    /// Encodes the reply.
    pub fn emit(&self) -> Vec<u8> {
        let extended = &self.status.extended;
        let mut out = vec![self.service | service::REPLY, 0, self.status.general, words8(extended.len() * 2)];
        out.extend(extended.iter().flat_map(|word| word.to_le_bytes()));
        out.extend(self.data);
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::hex;

    #[test]
    fn a_read_of_an_attribute() {
        let request = Request { service: service::ATTRIBUTE_SINGLE, path: Path::attribute(4, 100, 3), data: &[] };
        let bytes = hex("0E 03 20 04 24 64 30 03");
        assert_eq!(request.emit(), bytes);
        assert_eq!(Request::parse(&bytes), Ok(request));
    }

    /// A failed ForwardClose of a ControlLogix (cpppo, enip_test.py, `fwd_clo_reply_just_sts`).
    #[test]
    fn a_refusal_with_an_extended_status() {
        let bytes = hex("CE 00 01 01 00 01");
        let reply = Reply::parse(&bytes).unwrap();
        assert_eq!(reply, Reply { service: 0x4E, status: Status::connection(0x0100, &[]), data: &[] });
        assert_eq!(reply.emit(), bytes);
        assert_eq!(reply.status.to_string(), "0x01/0x0100");
    }

    #[test]
    fn errors_count_from_the_start_of_the_message() {
        let error = Request::parse(&hex("0E 02 20 04 FF 00")).unwrap_err();
        assert_eq!((error.field, error.offset), ("path segment", 4));
        assert_eq!(Reply::parse(&hex("0E 00 00 00")).unwrap_err().field, "reply service");
    }
}
