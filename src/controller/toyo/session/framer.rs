//! Framer: splits received characters into blocks.

use crate::toyo::request::MAX_BLOCK_LEN;

/// Framer: finds the blocks in a stream of characters.
#[derive(Debug, Default)]
pub struct Framer {
    text: String,
    /// Characters outside of blocks since the last line end.
    stray: u32,
    /// Why the current block is invalid.
    broken: Option<&'static str>,
}

/// Result of a line end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Framed {
    /// A block with `@`, without line end.
    Block(String),
    /// A damaged block.
    Garbled {
        /// Text of the block.
        text: String,
        /// The damage.
        why: &'static str,
    },
}

impl Framer {
    /// Processes a character. Returns a completed block, and the number of noise characters.
    pub fn push(&mut self, byte: u8) -> (Option<Framed>, u32) {
        match byte {
            b'\r' | b'\n' => return (self.conclude(), 0),
            b'@' => {
                // `@` always begins a new block.
                let noise = u32::try_from(self.text.len()).unwrap_or(u32::MAX);
                self.clear();
                self.text.push('@');
                return (None, noise);
            }
            _ if self.text.is_empty() => {
                self.stray = self.stray.saturating_add(1);
                return (None, 1);
            }
            b' '..=b'~' if self.text.len() + 2 < MAX_BLOCK_LEN => self.text.push(char::from(byte)),
            b' '..=b'~' => self.broken = Some("it is too long for a block"),
            _ => self.broken = Some("it contains characters that are not possible in a block"),
        }
        (None, 0)
    }

    /// Discards the characters since the last line end.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    fn conclude(&mut self) -> Option<Framed> {
        let Self { text, stray, broken } = std::mem::take(self);
        match broken {
            Some(why) => Some(Framed::Garbled { text, why }),
            None if !text.is_empty() => Some(Framed::Block(text)),
            // Two stray characters may be a damaged line end. More than two are a block without its start.
            None if stray > 2 => Some(Framed::Garbled { text, why: "its beginning is missing" }),
            None => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn framed(text: &str) -> Option<Framed> {
        let mut framer = Framer::default();
        text.bytes().find_map(|byte| framer.push(byte).0)
    }

    #[test]
    fn a_block_is_as_long_as_the_longest_one_at_most() {
        // The length of a block includes its line end, CR LF.
        let longest = format!("@{}", "A".repeat(MAX_BLOCK_LEN - 3));
        assert_eq!(framed(&format!("{longest}\r")), Some(Framed::Block(longest.clone())));
        let why = "it is too long for a block";
        assert_eq!(framed(&format!("{longest}A\r")), Some(Framed::Garbled { text: longest, why }));
    }
}
