//! Characters of a line as blocks.

use crate::toyo::request::MOST;

/// Finds blocks in what comes over a line, whatever else comes with them.
#[derive(Debug, Default)]
pub struct Framer {
    text: String,
    /// Characters since the last line end that belong to no block.
    stray: u32,
    /// Why the block under way is none.
    broken: Option<&'static str>,
}

/// What a line end concludes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Framed {
    /// A block, `@` included, without line end.
    Block(String),
    /// Something that was a block once.
    Garbled {
        /// What is left of it.
        text: String,
        /// What is wrong with it.
        why: &'static str,
    },
}

impl Framer {
    /// Takes a character; returns what it concludes, and how many characters turned out to be noise.
    pub fn push(&mut self, byte: u8) -> (Option<Framed>, u32) {
        match byte {
            b'\r' | b'\n' => return (self.conclude(), 0),
            b'@' => {
                // A block begins, whatever was before.
                let noise = u32::try_from(self.text.len()).unwrap_or(u32::MAX);
                self.clear();
                self.text.push('@');
                return (None, noise);
            }
            _ if self.text.is_empty() => {
                self.stray = self.stray.saturating_add(1);
                return (None, 1);
            }
            b' '..=b'~' if self.text.len() + 2 < MOST => self.text.push(char::from(byte)),
            b' '..=b'~' => self.broken = Some("it is longer than a block may be"),
            _ => self.broken = Some("it has characters that no block has"),
        }
        (None, 0)
    }

    /// Forgets what came since the last line end.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    fn conclude(&mut self) -> Option<Framed> {
        let Self { text, stray, broken } = std::mem::take(self);
        match broken {
            Some(why) => Some(Framed::Garbled { text, why }),
            None if !text.is_empty() => Some(Framed::Block(text)),
            // Two strays may be a line end that got damaged; more were a block without its beginning.
            None if stray > 2 => Some(Framed::Garbled { text, why: "its beginning is missing" }),
            None => None,
        }
    }
}
