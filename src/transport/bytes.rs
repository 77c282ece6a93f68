//! Reads the messages of fieldbuses field by field.

use thiserror::Error;

/// Bytes that are no such message, with the field that says so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("{field} at offset {offset}: {problem}")]
pub struct WireError {
    /// The field.
    pub field: &'static str,
    /// Where it begins, from the start of the message or the part of it that was read.
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
    #[error("is {found:#04x}")]
    Value {
        /// The value.
        found: u32,
    },
    /// Another value than the rest of the message asks for.
    #[error("is {found:#04x}, not {expected:#04x}")]
    Differs {
        /// The value.
        found: u8,
        /// The value that fits.
        expected: u8,
    },
    /// Something that must be there is not.
    #[error("is missing")]
    Missing,
}

impl WireError {
    pub(crate) const fn short(field: &'static str, offset: usize, needed: usize, present: usize) -> Self {
        Self { field, offset, problem: Problem::Short { needed, present } }
    }

    pub(crate) fn value(field: &'static str, offset: usize, found: impl Into<u32>) -> Self {
        Self { field, offset, problem: Problem::Value { found: found.into() } }
    }
}

/// The order of bytes in numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ByteOrder {
    /// The highest first.
    #[default]
    Big,
    /// The lowest first.
    Little,
}

/// Reads a message field by field.
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

    /// Nothing may follow `field`.
    pub fn end(&self, field: &'static str) -> Result<(), WireError> {
        match self.left() {
            0 => Ok(()),
            extra => Err(WireError { field, offset: self.at, problem: Problem::Trailing { extra } }),
        }
    }

    /// The error of a field of `len` bytes that was just read.
    pub fn wrong(&self, field: &'static str, len: usize, found: impl Into<u32>) -> WireError {
        WireError::value(field, self.at.saturating_sub(len), found)
    }

    pub const fn missing(&self, field: &'static str) -> WireError {
        WireError { field, offset: self.at, problem: Problem::Missing }
    }
}
