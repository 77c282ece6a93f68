//! Telegrams out of a stream of characters, with noise between them.

use super::{Parsed, Telegram, WireError};

/// Most bytes that are kept: more than the longest telegram has.
const MOST_KEPT: usize = 512;

/// What comes out of a stream.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Piece {
    /// A telegram, with its bytes.
    Telegram(Telegram, Vec<u8>),
    /// A byte that begins none, and why.
    Noise(u8, WireError),
}

/// Puts telegrams together. After noise it goes on with the next byte that may begin a telegram.
#[derive(Debug, Clone, Default)]
pub struct Stream {
    bytes: Vec<u8>,
}

impl Stream {
    /// Takes what has arrived; take the pieces out before the next time.
    pub fn push(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
    }

    /// The next piece, if one is complete.
    pub fn next_piece(&mut self) -> Option<Piece> {
        if self.bytes.is_empty() {
            return None;
        }
        match Telegram::parse(&self.bytes) {
            Ok(Parsed::Whole(telegram, len)) => {
                let rest = self.bytes.split_off(len);
                Some(Piece::Telegram(telegram, std::mem::replace(&mut self.bytes, rest)))
            }
            Ok(Parsed::Part(_)) if self.bytes.len() < MOST_KEPT => None,
            Ok(Parsed::Part(needed)) => Some(self.noise(WireError::short("telegram", 0, needed, self.bytes.len()))),
            Err(error) => Some(self.noise(error)),
        }
    }

    /// How many bytes are missing of the telegram that has begun, as far as can be told; 0 when none has begun.
    pub fn missing(&self) -> usize {
        if self.bytes.is_empty() {
            return 0;
        }
        match Telegram::parse(&self.bytes) {
            Ok(Parsed::Part(needed)) => needed.saturating_sub(self.bytes.len()),
            Ok(Parsed::Whole(..)) | Err(_) => 0,
        }
    }

    /// Whether a telegram has begun.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Forgets what has begun, as after a pause: no telegram has one inside.
    pub fn clear(&mut self) {
        self.bytes.clear();
    }

    fn noise(&mut self, error: WireError) -> Piece {
        Piece::Noise(self.bytes.remove(0), error)
    }
}
