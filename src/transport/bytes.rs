//! Bounds-checked reader for the fields of fieldbus messages.

use thiserror::Error;

/// Error of a malformed message. It describes the first wrong field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("{field} at offset {offset}: {problem}")]
pub struct WireError {
    /// Name of the field.
    pub field: &'static str,
    /// Offset of the field from the start of the message, or of the part that was read.
    pub offset: usize,
    /// What is wrong with the field.
    pub problem: Problem,
}

/// What can be wrong with a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Problem {
    /// The message ends inside the field.
    #[error("needs {needed} bytes, but only {present} are present")]
    Short {
        /// Length of the field.
        needed: usize,
        /// Bytes that remain.
        present: usize,
    },
    /// Bytes follow after the last field.
    #[error("{0} more bytes follow")]
    Trailing(usize),
    /// The field has a value that is not valid.
    #[error("is {0:#04x}")]
    Value(u32),
    /// The value contradicts another part of the message.
    #[error("is {found:#04x}, not {expected:#04x}")]
    Differs {
        /// The value.
        found: u8,
        /// The value that was expected.
        expected: u8,
    },
    /// A required field is missing.
    #[error("is missing")]
    Missing,
}

impl WireError {
    pub(crate) const fn short(field: &'static str, offset: usize, needed: usize, present: usize) -> Self {
        Self { field, offset, problem: Problem::Short { needed, present } }
    }

    pub(crate) fn value(field: &'static str, offset: usize, found: impl Into<u32>) -> Self {
        Self { field, offset, problem: Problem::Value(found.into()) }
    }
}

/// Byte order of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ByteOrder {
    /// Highest byte first.
    #[default]
    Big,
    /// Lowest byte first.
    Little,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Reader<'a> {
    pub bytes: &'a [u8],
    pub at: usize,
    pub order: ByteOrder,
}

impl<'a> Reader<'a> {
    pub const fn big(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, order: ByteOrder::Big }
    }

    pub const fn little(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, order: ByteOrder::Little }
    }

    pub const fn left(&self) -> usize {
        self.bytes.len().saturating_sub(self.at)
    }

    pub const fn is_empty(&self) -> bool {
        self.left() == 0
    }

    pub fn take(&mut self, len: usize, field: &'static str) -> Result<&'a [u8], WireError> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let taken = rest.get(..len).ok_or(WireError::short(field, self.at, len, rest.len()))?;
        self.at += len;
        Ok(taken)
    }

    pub fn array<const N: usize>(&mut self, field: &'static str) -> Result<[u8; N], WireError> {
        let mut out = [0; N];
        out.copy_from_slice(self.take(N, field)?);
        Ok(out)
    }

    pub fn u8(&mut self, field: &'static str) -> Result<u8, WireError> {
        self.array(field).map(|[byte]| byte)
    }

    pub fn u16(&mut self, field: &'static str) -> Result<u16, WireError> {
        let bytes = self.array(field)?;
        Ok(if self.order == ByteOrder::Big { u16::from_be_bytes(bytes) } else { u16::from_le_bytes(bytes) })
    }

    pub fn u32(&mut self, field: &'static str) -> Result<u32, WireError> {
        let bytes = self.array(field)?;
        Ok(if self.order == ByteOrder::Big { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    }

    pub fn rest(&mut self) -> &'a [u8] {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        self.at = self.bytes.len();
        rest
    }

    /// Fails if bytes follow after `field`, which must be the last field.
    pub fn end(&self, field: &'static str) -> Result<(), WireError> {
        match self.left() {
            0 => Ok(()),
            extra => Err(WireError { field, offset: self.at, problem: Problem::Trailing(extra) }),
        }
    }

    /// Returns an error for the field that was just read. The field has `len` bytes.
    pub fn wrong(&self, field: &'static str, len: usize, found: impl Into<u32>) -> WireError {
        WireError::value(field, self.at.saturating_sub(len), found)
    }

    pub const fn missing(&self, field: &'static str) -> WireError {
        WireError { field, offset: self.at, problem: Problem::Missing }
    }
}
