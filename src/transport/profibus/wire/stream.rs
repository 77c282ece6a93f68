//! Splitter that divides a character stream into telegrams and noise.

use super::{Parsed, Telegram, WireError};

/// Size limit of the buffer. It is larger than the longest telegram.
const MAX_BUFFER_LEN: usize = 512;

/// A piece of the stream.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Piece {
    /// A telegram, with its bytes.
    Telegram(Telegram, Vec<u8>),
    /// A byte with which no telegram begins, and the reason.
    Noise(u8, WireError),
}

/// Splitter of a character stream. After noise, the splitter continues at the next byte with which a telegram can
/// begin.
#[derive(Debug, Clone, Default)]
pub struct Stream {
    bytes: Vec<u8>,
}

impl Stream {
    /// Adds received bytes. Before the next call, the caller must take out all pieces.
    pub fn push(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
    }

    /// Returns the next complete piece.
    pub fn next_piece(&mut self) -> Option<Piece> {
        if self.bytes.is_empty() {
            return None;
        }
        match Telegram::parse(&self.bytes) {
            Ok(Parsed::Whole(telegram, len)) => {
                let rest = self.bytes.split_off(len);
                Some(Piece::Telegram(telegram, std::mem::replace(&mut self.bytes, rest)))
            }
            Ok(Parsed::Part(_)) if self.bytes.len() < MAX_BUFFER_LEN => None,
            Ok(Parsed::Part(needed)) => Some(self.noise(WireError::short("telegram", 0, needed, self.bytes.len()))),
            Err(error) => Some(self.noise(error)),
        }
    }

    /// Number of bytes that the current telegram still needs, if known; 0 if no telegram has begun.
    pub fn missing(&self) -> usize {
        if self.bytes.is_empty() {
            return 0;
        }
        match Telegram::parse(&self.bytes) {
            Ok(Parsed::Part(needed)) => needed.saturating_sub(self.bytes.len()),
            Ok(Parsed::Whole(..)) | Err(_) => 0,
        }
    }

    /// Whether no telegram has begun.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Drops a partial telegram, for example after a pause. A telegram contains no pauses, so it cannot continue.
    pub fn clear(&mut self) {
        self.bytes.clear();
    }

    fn noise(&mut self, error: WireError) -> Piece {
        Piece::Noise(self.bytes.remove(0), error)
    }
}
