//! Check for other traffic before the first telegram. On a line with a master, our telegrams would disturb its control
//! of the slaves.

use super::Now;
use super::error::ProfibusError;
use super::wire::{Control, Piece, Stream, Telegram};

/// Number of noise characters that are tolerated, for example when a port is opened.
const GLITCH: usize = 2;
/// Length of a token.
const TOKEN: usize = 3;

/// The check.
#[derive(Debug, Default)]
pub struct Quiet {
    until: Now,
    stream: Stream,
    unreadable: usize,
    /// Senders of tokens.
    tokens: Vec<u8>,
}

impl Quiet {
    /// Listens until this time.
    pub fn until(until: Now) -> Self {
        Self { until, ..Self::default() }
    }

    /// End of the check; `None` if it never ends.
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
                // Three bytes without a checksum: noise can look the same.
                Piece::Telegram(Telegram::Token { from, .. }, _) => {
                    self.tokens.push(from);
                    continue;
                }
                Piece::Telegram(Telegram::Frame(frame), _) => match frame.control {
                    Control::Request(..) => (frame.from, "it sent a request"),
                    Control::Answer(..) => (frame.to, "a station answered it"),
                },
                // One byte, which can be noise.
                Piece::Telegram(Telegram::ShortAcknowledge, _) | Piece::Noise(..) => {
                    self.unreadable = self.unreadable.saturating_add(1);
                    continue;
                }
            };
            return Err(ProfibusError::OtherMaster { master, heard });
        }
        Ok(())
    }

    /// Result of the check, once it is complete.
    ///
    /// # Errors
    /// [`ProfibusError::OtherMaster`], or [`ProfibusError::Unreadable`] if only noise was received.
    pub fn poll(&mut self, now: Now) -> Option<Result<(), ProfibusError>> {
        if now < self.until {
            return None;
        }
        Some(if self.unreadable > GLITCH + TOKEN * self.tokens.len() {
            Err(ProfibusError::Unreadable { bytes: self.unreadable })
        } else if let Some(&master) = self.tokens.first() {
            Err(ProfibusError::OtherMaster { master, heard: "it passed the token" })
        } else {
            Ok(())
        })
    }
}
