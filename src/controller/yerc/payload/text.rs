//! Text fields: bytes in the encoding of the pendant, padded with NUL.

use std::fmt;

use thiserror::Error;

/// A text of at most `N` bytes without NUL, in the encoding of the pendant.
#[derive(Clone, PartialEq, Eq, Hash, Default)]
pub struct Text<const N: usize>(Vec<u8>);

/// Why bytes do not fit a text field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum TextError {
    /// Longer than the field.
    #[error("the text has {len} bytes in the controller's encoding; it can have at most {most}")]
    TooLong {
        /// Length in bytes.
        len: usize,
        /// Size of the field in bytes.
        most: usize,
    },
    /// The bytes contain a NUL, which would end the text early.
    #[error("the text contains a NUL byte at position {at}")]
    Nul {
        /// Offset of the first NUL.
        at: usize,
    },
}

impl<const N: usize> Text<N> {
    /// Creates a text from bytes that must fit the field.
    pub fn new(bytes: &[u8]) -> Result<Self, TextError> {
        if bytes.len() > N {
            return Err(TextError::TooLong { len: bytes.len(), most: N });
        }
        match bytes.iter().position(|&byte| byte == 0) {
            Some(at) => Err(TextError::Nul { at }),
            None => Ok(Self(bytes.to_vec())),
        }
    }

    /// Parses a field. The text ends at the first NUL, or at the end of the field.
    pub fn cut(field: &[u8]) -> Self {
        let field = &field[..field.len().min(N)];
        let end = field.iter().position(|&byte| byte == 0).unwrap_or(field.len());
        Self(field[..end].to_vec())
    }

    /// Bytes without padding.
    pub fn as_bytes(&self) -> &[u8] {
        &self.0
    }

    /// Whether the text is empty.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The field of `N` bytes, padded with NUL.
    pub fn emit(&self) -> [u8; N] {
        let mut field = [0; N];
        field[..self.0.len()].copy_from_slice(&self.0);
        field
    }
}

impl<const N: usize> fmt::Debug for Text<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\"{}\"", self.0.escape_ascii())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_ends_at_the_first_nul_and_is_padded() {
        assert_eq!(Text::<8>::cut(b"AB\0CD\0\0\0").as_bytes(), b"AB");
        assert_eq!(Text::<4>::cut(b"ABCD").as_bytes(), b"ABCD");
        assert_eq!(Text::<4>::new(b"AB").unwrap().emit(), *b"AB\0\0");
        assert_eq!(Text::<2>::new(b"ABC"), Err(TextError::TooLong { len: 3, most: 2 }));
        assert_eq!(Text::<4>::new(b"A\0B"), Err(TextError::Nul { at: 1 }));
    }
}
