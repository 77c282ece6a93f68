//! Logical numbers of I/O signals: `#10010` is bit 0 of group 1001 (FS and DX 3.3.9).

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use super::Model;
use super::table::{Row, Span};
use crate::user_input::unsigned;

/// A signal, identified by its logical number. The last digit of this number is 0 to 7.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Signal {
    group: u16,
    bit: u8,
}

/// An invalid signal number.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum SignalError {
    /// Not a number of up to five digits.
    #[error("'{found}' is not a valid signal number, for example 10010")]
    Malformed {
        /// The invalid text.
        found: String,
    },
    /// A last digit above 7.
    #[error("signal {number} does not exist: the last digit must be from 0 to 7")]
    Digit {
        /// The number in the text.
        number: u32,
    },
}

impl Signal {
    /// A signal by its logical number.
    pub fn new(number: u32) -> Result<Self, SignalError> {
        let bit = u8::try_from(number % 10).ok().filter(|bit| *bit < 8).ok_or(SignalError::Digit { number })?;
        let malformed = |_| SignalError::Malformed { found: number.to_string() };
        Ok(Self { group: u16::try_from(number / 10).map_err(malformed)?, bit })
    }

    /// Instance of the group of eight signals that contains the signal.
    pub const fn group(self) -> u16 {
        self.group
    }

    /// Bit number in the byte of the group; 0 is the lowest bit.
    pub const fn bit(self) -> u8 {
        self.bit
    }

    /// Logical number of the signal.
    pub fn number(self) -> u32 {
        u32::from(self.group) * 10 + u32::from(self.bit)
    }

    /// Whether the signal is on. `byte` contains the eight signals of its group.
    pub const fn is_on(self, byte: u8) -> bool {
        byte >> self.bit & 1 == 1
    }

    /// Class of the signal, with name and write permission; `None` if the model does not have the signal.
    pub fn class(self, model: Model) -> Option<&'static Span> {
        io_class(model, self.group)
    }
}

/// The class of a group of eight signals.
pub fn io_class(model: Model, group: u16) -> Option<&'static Span> {
    Row::from_number(0x78)?.instances.find(model, group)
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:05}", self.number())
    }
}

impl FromStr for Signal {
    type Err = SignalError;

    fn from_str(text: &str) -> Result<Self, SignalError> {
        let digits = text.strip_prefix('#').unwrap_or(text);
        let number = unsigned(digits).filter(|number: &u32| *number < 1_000_000);
        let number = number.ok_or_else(|| SignalError::Malformed { found: text.to_owned() })?;
        Self::new(number).map_err(|error| match error {
            SignalError::Malformed { .. } => SignalError::Malformed { found: text.to_owned() },
            error @ SignalError::Digit { .. } => error,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signal_number_contains_group_bit_and_class() {
        let signal: Signal = "#29563".parse().unwrap();
        assert_eq!((signal.group(), signal.bit(), signal.to_string().as_str()), (2956, 3, "#29563"));
        assert!(signal.class(Model::Dx200).unwrap().writable);
        assert_eq!(signal.class(Model::Fs100), None);
        assert_eq!("10".parse::<Signal>().unwrap().class(Model::Fs100).unwrap().meaning, "robot user input");
        assert_eq!("0x4E2A".parse::<Signal>().unwrap().to_string(), "#20010");
        assert_eq!("9".parse::<Signal>(), Err(SignalError::Digit { number: 9 }));
        for junk in ["", "#", "-10", "1e3", "9999999", "700000"] {
            assert!(matches!(junk.parse::<Signal>(), Err(SignalError::Malformed { .. })), "{junk}");
        }
    }
}
