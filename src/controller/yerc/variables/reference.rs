//! Kinds and names of variables.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use crate::user_input::{self, RangeError, unsigned};
use crate::yerc::Model;
use crate::yerc::table::{Plural, Row};

/// Kind of variable. S variables have 16 bytes on FS100 and 32 on DX200. On a DX200, both string forms can be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum VariableKind {
    /// Byte.
    B,
    /// Integer, 16 bits.
    I,
    /// Double-precision integer, 32 bits.
    D,
    /// Real.
    R,
    /// String, 16-byte form.
    S16,
    /// String, 32-byte form (DX200).
    S32,
    /// Robot position.
    P,
    /// Base position.
    Bp,
    /// External axis position.
    Ex,
}

/// Kind, letters, command for one variable, command for several variables.
const KINDS: [(VariableKind, &str, u16, u16); 9] = [
    (VariableKind::B, "B", 0x7A, 0x302),
    (VariableKind::I, "I", 0x7B, 0x303),
    (VariableKind::D, "D", 0x7C, 0x304),
    (VariableKind::R, "R", 0x7D, 0x305),
    (VariableKind::S16, "S", 0x7E, 0x306),
    (VariableKind::S32, "S", 0x8C, 0x30C),
    (VariableKind::P, "P", 0x7F, 0x307),
    (VariableKind::Bp, "BP", 0x80, 0x308),
    (VariableKind::Ex, "EX", 0x81, 0x309),
];

impl VariableKind {
    /// All kinds, in the order of the manual.
    pub fn all() -> impl Iterator<Item = Self> {
        KINDS.iter().map(|row| row.0)
    }

    /// Letters of the kind, for example `BP`. Both string forms have the letter `S`.
    pub fn letters(self) -> &'static str {
        KINDS[self as usize].1
    }

    /// Command for one variable.
    pub fn command(self) -> u16 {
        KINDS[self as usize].2
    }

    /// Command for several variables.
    pub fn plural_command(self) -> u16 {
        KINDS[self as usize].3
    }

    /// Size in bytes.
    pub fn size(self) -> usize {
        self.row().size()
    }

    /// Limits of the plural command.
    #[expect(clippy::missing_panics_doc, reason = "a property of the table, checked by a test")]
    pub fn plural(self) -> Plural {
        Row::from_number(self.plural_command()).and_then(|row| row.plural).expect("every variable has a plural command")
    }

    /// Last number in the factory state: 99, or 127 for positions.
    #[expect(clippy::missing_panics_doc, reason = "a property of the table, checked by a test")]
    pub fn last_standard(self) -> u16 {
        let spans = self.row().instances.dx200;
        spans.iter().find(|span| !span.extended).map(|span| span.last).expect("every variable has standard numbers")
    }

    /// Whether the kind is P, BP or EX.
    pub const fn is_position(self) -> bool {
        matches!(self, Self::P | Self::Bp | Self::Ex)
    }

    /// The string form for a model: 32 bytes if the model has it, unless `short` requests 16 bytes.
    #[must_use]
    pub const fn string_form(self, model: Model, short: bool) -> Self {
        match self {
            Self::S16 | Self::S32 if model.has_long_strings() && !short => Self::S32,
            Self::S16 | Self::S32 => Self::S16,
            _ => self,
        }
    }

    fn row(self) -> &'static Row {
        Row::from_number(self.command()).expect("every variable has a command")
    }
}

/// A variable, identified by kind and number. The text form is, for example, `B0`, `P12` or `EX3`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Reference {
    /// Kind of variable.
    pub kind: VariableKind,
    /// Number, from 0.
    pub number: u16,
}

/// An invalid variable reference.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ReferenceError {
    /// Unknown letters.
    #[error("'{0}' is not a variable; use B, I, D, R, S, P, BP or EX with a number, for example B0 or B0..B99")]
    Kind(String),
    /// The number is missing, or is above 65535.
    #[error("'{0}' needs a number from 0 to 65535")]
    Number(String),
    /// The ends of a range have different kinds.
    #[error("'{0}' is not a valid range; both ends must have the same type, and the lower end must be first")]
    Range(String),
    /// The ends of a range are in the wrong order.
    #[error(transparent)]
    Backwards(#[from] RangeError),
}

impl Reference {
    /// Creates a reference.
    pub const fn new(kind: VariableKind, number: u16) -> Self {
        Self { kind, number }
    }
}

impl fmt::Display for Reference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.kind.letters(), self.number)
    }
}

impl FromStr for Reference {
    type Err = ReferenceError;

    /// The letter `S` means the 32-byte form; see [`VariableKind::string_form`].
    fn from_str(text: &str) -> Result<Self, ReferenceError> {
        let digits = text.find(|c: char| c.is_ascii_digit()).unwrap_or(text.len());
        let (letters, number) = text.split_at(digits);
        let kind = KINDS
            .iter()
            .rev()
            .find(|row| row.1.eq_ignore_ascii_case(letters))
            .map(|row| row.0)
            .ok_or_else(|| ReferenceError::Kind(text.to_owned()))?;
        Ok(Self { kind, number: parse_number(number, text)? })
    }
}

/// Parses `B0`, `B0..B99` or `B0..99`. A range includes both ends.
pub fn parse_references(text: &str) -> Result<Vec<Reference>, ReferenceError> {
    let first: Reference = text.split(['.', '-']).next().unwrap_or_default().parse()?;
    let numbers = user_input::range(text, |end| {
        let end: Reference = end.parse()?;
        let same_kind = Some(end.number).filter(|_| end.kind == first.kind);
        same_kind.ok_or_else(|| ReferenceError::Range(text.to_owned()))
    })?;
    Ok(numbers.map(|number| Reference::new(first.kind, number)).collect())
}

/// Parses `5` or `5..20`, for registers and I/O groups. A range includes both ends.
pub fn parse_numbers(text: &str) -> Result<Vec<u16>, ReferenceError> {
    user_input::range(text, |end| parse_number(end, text)).map(Iterator::collect)
}

fn parse_number(digits: &str, whole: &str) -> Result<u16, ReferenceError> {
    unsigned(digits).ok_or_else(|| ReferenceError::Number(whole.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_in_row_order() {
        for (index, kind) in VariableKind::all().enumerate() {
            assert_eq!(kind as usize, index);
            assert_eq!(kind.row().size(), Row::from_number(kind.plural_command()).unwrap().size());
        }
        assert_eq!(VariableKind::P.last_standard(), 127);
        assert_eq!(VariableKind::S16.last_standard(), 99);
        assert_eq!(VariableKind::S32.string_form(Model::Fs100, false), VariableKind::S16);
        assert_eq!(VariableKind::S16.string_form(Model::Dx200, false), VariableKind::S32);
    }

    #[test]
    fn references_and_ranges() {
        assert_eq!("bp7".parse(), Ok(Reference::new(VariableKind::Bp, 7)));
        assert_eq!(Reference::new(VariableKind::Ex, 3).to_string(), "EX3");
        assert_eq!(parse_references("B0..B99").unwrap().len(), 100);
        assert_eq!(parse_references("I1..20").unwrap().len(), 20);
        assert_eq!(parse_references("D5").unwrap(), [Reference::new(VariableKind::D, 5)]);
        for junk in ["", "B", "X1", "B-1", "B65536", "B0..", "B1..B0", "B0..I5", "B0...B5", "5", "B1x", "..B1"] {
            assert!(parse_references(junk).is_err(), "{junk}");
        }
        assert_eq!(parse_numbers("5..7"), Ok(vec![5, 6, 7]));
        assert_eq!(parse_numbers("0x0E..0x10"), Ok(vec![14, 15, 16]));
        assert_eq!("B0x10".parse(), Ok(Reference::new(VariableKind::B, 16)));
        assert_eq!(parse_references("B0xA..0xC").unwrap().len(), 3);
    }
}
