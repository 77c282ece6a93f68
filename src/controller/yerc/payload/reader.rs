//! Reading and writing the data part.

use thiserror::Error;

use super::text::Text;

/// Answer data that does not hold what the command answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum PayloadError {
    /// Fewer bytes than the least that makes sense.
    #[error("{what}: {found} data bytes, at least {needed} expected")]
    Short {
        /// The payload.
        what: &'static str,
        /// Bytes needed.
        needed: usize,
        /// Bytes there.
        found: usize,
    },
    /// The count in front of the elements is not the one asked for.
    #[error("{what}: {answered} elements answered, {asked} asked for")]
    Count {
        /// The payload.
        what: &'static str,
        /// Elements requested.
        asked: u32,
        /// Elements announced.
        answered: u32,
    },
}

/// Reads a payload front to back.
pub(in crate::yerc) struct Reader<'a> {
    what: &'static str,
    whole: usize,
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    /// A reader over `data`, whose errors speak of `what`.
    pub(in crate::yerc) fn new(what: &'static str, data: &'a [u8]) -> Self {
        Self { what, whole: data.len(), rest: data }
    }

    /// The next `size` bytes.
    pub(in crate::yerc) fn bytes(&mut self, size: usize) -> Result<&'a [u8], PayloadError> {
        let Some((head, tail)) = self.rest.split_at_checked(size) else {
            let needed = (self.whole - self.rest.len()).saturating_add(size);
            return Err(PayloadError::Short { what: self.what, needed, found: self.whole });
        };
        self.rest = tail;
        Ok(head)
    }

    /// The next bytes as an array.
    pub(in crate::yerc) fn array<const N: usize>(&mut self) -> Result<[u8; N], PayloadError> {
        let mut out = [0; N];
        out.copy_from_slice(self.bytes(N)?);
        Ok(out)
    }

    /// The next word.
    pub(in crate::yerc) fn u32(&mut self) -> Result<u32, PayloadError> {
        self.array().map(u32::from_le_bytes)
    }

    /// The next signed word.
    pub(in crate::yerc) fn i32(&mut self) -> Result<i32, PayloadError> {
        self.array().map(i32::from_le_bytes)
    }

    /// Several signed words.
    pub(in crate::yerc) fn words<const N: usize>(&mut self) -> Result<[i32; N], PayloadError> {
        let mut out = [0; N];
        for word in &mut out {
            *word = self.i32()?;
        }
        Ok(out)
    }

    /// A text field of `N` bytes.
    pub(in crate::yerc) fn text<const N: usize>(&mut self) -> Result<Text<N>, PayloadError> {
        self.bytes(N).map(Text::cut)
    }

    /// What has not been read.
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
