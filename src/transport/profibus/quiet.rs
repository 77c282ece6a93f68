//! Listens before the first word: whoever speaks on a line that has a master disturbs what that master commands.

use super::Now;
use super::error::ProfibusError;
use super::wire::{Control, Piece, Stream, Telegram};

/// Characters without meaning that may be heard, as when a port is opened.
const GLITCH: usize = 2;
/// Characters of a token.
const TOKEN: usize = 3;

/// Hears whether anybody speaks.
#[derive(Debug, Default)]
pub struct Quiet {
    until: Now,
    stream: Stream,
    unreadable: usize,
    /// Who passed a token.
    tokens: Vec<u8>,
}

impl Quiet {
    /// Listens up to this moment.
    pub fn until(until: Now) -> Self {
        Self { until, ..Self::default() }
    }

    /// When it is over; `None` if never.
    pub fn due(&self) -> Option<Now> {
        Some(self.until).filter(|until| *until < Now::MAX)
    }

    /// Takes what was heard.
    ///
    /// # Errors
    /// [`ProfibusError::OtherMaster`].
    pub fn handle(&mut self, bytes: &[u8]) -> Result<(), ProfibusError> {
        self.stream.push(bytes);
        while let Some(piece) = self.stream.next_piece() {
            let (master, heard) = match piece {
                // Three bytes without a check sum: noise may look so.
                Piece::Telegram(Telegram::Token { from, .. }, _) => {
                    self.tokens.push(from);
                    continue;
                }
                Piece::Telegram(Telegram::Frame(frame), _) => match frame.control {
                    Control::Request(..) => (frame.from, "it sent a request"),
                    Control::Answer(..) => (frame.to, "it was answered by a station"),
                },
                // One byte that may be anything.
                Piece::Telegram(Telegram::ShortAcknowledge, _) | Piece::Noise(..) => {
                    self.unreadable = self.unreadable.saturating_add(1);
                    continue;
                }
            };
            return Err(ProfibusError::OtherMaster { master, heard });
        }
        Ok(())
    }

    /// Whether all was quiet, once it is over.
    ///
    /// # Errors
    /// [`ProfibusError::OtherMaster`], or [`ProfibusError::Unreadable`] where nobody can be understood.
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
