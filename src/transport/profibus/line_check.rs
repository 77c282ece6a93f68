//! Check for other traffic before the first telegram. If another master is on the line, telegrams of this master would
//! disturb its control of the slaves.

use super::Now;
use super::error::ProfibusError;
use super::wire::{Control, Piece, Stream, Telegram};

/// Number of noise characters that are accepted. For example, opening a port can cause noise.
const MAX_NOISE: usize = 2;
/// Length of a token in bytes.
const TOKEN: usize = 3;

/// Check for other traffic on a line.
#[derive(Debug, Default)]
pub struct LineCheck {
    until: Now,
    stream: Stream,
    unreadable: usize,
    /// Addresses that sent a token.
    tokens: Vec<u8>,
}

impl LineCheck {
    /// Creates a check that listens until `until`.
    pub fn until(until: Now) -> Self {
        Self { until, ..Self::default() }
    }

    /// Time at which the check ends; `None` if it never ends.
    pub fn due(&self) -> Option<Now> {
        Some(self.until).filter(|until| *until < Now::MAX)
    }

    /// Handles received bytes.
    ///
    /// # Errors
    /// [`ProfibusError::OtherMaster`].
    pub fn handle(&mut self, bytes: &[u8]) -> Result<(), ProfibusError> {
        self.stream.push(bytes);
        while let Some(piece) = self.stream.next_piece() {
            let (master, heard) = match piece {
                // A token has three bytes and no checksum, so noise can look like a token. One token alone is therefore
                // no proof of another master.
                Piece::Telegram(Telegram::Token { from, .. }, _) => {
                    self.tokens.push(from);
                    continue;
                }
                Piece::Telegram(Telegram::Frame(frame), _) => match frame.control {
                    Control::Request(..) => (frame.from, "it sent a request"),
                    Control::Answer(..) => (frame.to, "a station answered it"),
                },
                // A short acknowledgement is a single byte, so it can also be noise.
                Piece::Telegram(Telegram::ShortAcknowledge, _) | Piece::Noise(..) => {
                    self.unreadable = self.unreadable.saturating_add(1);
                    continue;
                }
            };
            return Err(ProfibusError::OtherMaster { master, heard });
        }
        Ok(())
    }

    /// Result of the check; `None` until the check is complete.
    ///
    /// # Errors
    /// [`ProfibusError::OtherMaster`] if another master was received, [`ProfibusError::Unreadable`] if only noise was
    /// received.
    pub fn poll(&mut self, now: Now) -> Option<Result<(), ProfibusError>> {
        if now < self.until {
            return None;
        }
        Some(if self.unreadable > MAX_NOISE + TOKEN * self.tokens.len() {
            Err(ProfibusError::Unreadable(self.unreadable))
        } else if let Some(&master) = self.tokens.first() {
            Err(ProfibusError::OtherMaster { master, heard: "it passed the token" })
        } else {
            Ok(())
        })
    }
}
