//! Reader and writer of the data part.

use thiserror::Error;

use super::text::Text;

/// Why the data of an answer is invalid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum PayloadError {
    /// The data has too few bytes.
    #[error("{what}: {found} data bytes, at least {needed} expected")]
    Short {
        /// Name of the payload.
        what: &'static str,
        /// Required bytes.
        needed: usize,
        /// Received bytes.
        found: usize,
    },
    /// The number of elements in the answer is not the requested number.
    #[error("{what}: received {answered} elements, requested {asked}")]
    Count {
        /// Name of the payload.
        what: &'static str,
        /// Requested elements.
        asked: u32,
        /// Elements in the answer.
        answered: u32,
    },
}

/// Sequential reader of a payload.
pub(in crate::yerc) struct Reader<'a> {
    what: &'static str,
    whole: usize,
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    /// A reader of `data`. `what` is the name of the payload in error messages.
    pub(in crate::yerc) fn new(what: &'static str, data: &'a [u8]) -> Self {
        Self { what, whole: data.len(), rest: data }
    }

    pub(in crate::yerc) fn bytes(&mut self, size: usize) -> Result<&'a [u8], PayloadError> {
        let Some((head, tail)) = self.rest.split_at_checked(size) else {
            let needed = (self.whole - self.rest.len()).saturating_add(size);
            return Err(PayloadError::Short { what: self.what, needed, found: self.whole });
        };
        self.rest = tail;
        Ok(head)
    }

    pub(in crate::yerc) fn array<const N: usize>(&mut self) -> Result<[u8; N], PayloadError> {
        let mut out = [0; N];
        out.copy_from_slice(self.bytes(N)?);
        Ok(out)
    }

    pub(in crate::yerc) fn u32(&mut self) -> Result<u32, PayloadError> {
        self.array().map(u32::from_le_bytes)
    }

    pub(in crate::yerc) fn i32(&mut self) -> Result<i32, PayloadError> {
        self.array().map(i32::from_le_bytes)
    }

    pub(in crate::yerc) fn words<const N: usize>(&mut self) -> Result<[i32; N], PayloadError> {
        let mut out = [0; N];
        for word in &mut out {
            *word = self.i32()?;
        }
        Ok(out)
    }

    pub(in crate::yerc) fn text<const N: usize>(&mut self) -> Result<Text<N>, PayloadError> {
        self.bytes(N).map(Text::cut)
    }

    /// Remaining bytes of the payload.
    pub(in crate::yerc) fn rest(self) -> &'a [u8] {
        self.rest
    }
}

/// Appends words, little-endian.
pub(super) fn push_words(out: &mut Vec<u8>, words: impl IntoIterator<Item = i32>) {
    for word in words {
        out.extend_from_slice(&word.to_le_bytes());
    }
}

/// Appends unsigned words, little-endian.
pub(super) fn push_u32s(out: &mut Vec<u8>, words: impl IntoIterator<Item = u32>) {
    for word in words {
        out.extend_from_slice(&word.to_le_bytes());
    }
}
