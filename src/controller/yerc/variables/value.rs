//! Values of variables.

use thiserror::Error;

use super::reference::VariableKind;
use crate::user_input::integer;
use crate::yerc::payload::{
    BasePosition, ExternalPosition, PayloadError, Position, PositionTextError, Reader, Text, TextError,
};

/// A typed value of a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// Byte (B).
    Byte(u8),
    /// Integer (I).
    Integer(i16),
    /// Double-precision integer (D).
    Double(i32),
    /// Real (R).
    Real(f32),
    /// String (S), 16-byte form.
    Short(Text<16>),
    /// String (S), 32-byte form.
    Long(Text<32>),
    /// Robot position (P).
    Position(Position),
    /// Base position (BP).
    Base(BasePosition),
    /// External axis position (EX).
    External(ExternalPosition),
}

/// Why a value is invalid.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ValueError {
    /// The number is out of range for the kind of variable.
    #[error("'{found}' is not {expected}")]
    Number {
        /// The invalid text.
        found: String,
        /// Valid values.
        expected: &'static str,
    },
    /// The string does not fit the variable.
    #[error(transparent)]
    Text(#[from] TextError),
    /// The position is invalid.
    #[error(transparent)]
    Position(#[from] PositionTextError),
}

impl Value {
    /// Parses an element of an answer. Only positions may be shorter than their full size.
    pub fn parse(kind: VariableKind, data: &[u8]) -> Result<Self, PayloadError> {
        let mut reader = Reader::new("variable", data);
        Ok(match kind {
            VariableKind::B => Self::Byte(u8::from_le_bytes(reader.array()?)),
            VariableKind::I => Self::Integer(i16::from_le_bytes(reader.array()?)),
            VariableKind::D => Self::Double(reader.i32()?),
            VariableKind::R => Self::Real(f32::from_le_bytes(reader.array()?)),
            VariableKind::S16 => Self::Short(reader.text()?),
            VariableKind::S32 => Self::Long(reader.text()?),
            VariableKind::P => Self::Position(Position::parse(data)?),
            VariableKind::Bp => Self::Base(BasePosition::parse(data)?),
            VariableKind::Ex => Self::External(ExternalPosition::parse(data)?),
        })
    }

    /// Encodes the value in the full size of the variable.
    pub fn emit(&self) -> Vec<u8> {
        match self {
            Self::Byte(value) => vec![*value],
            Self::Integer(value) => value.to_le_bytes().to_vec(),
            Self::Double(value) => value.to_le_bytes().to_vec(),
            Self::Real(value) => value.to_le_bytes().to_vec(),
            Self::Short(text) => text.emit().to_vec(),
            Self::Long(text) => text.emit().to_vec(),
            Self::Position(position) => position.emit(),
            Self::Base(position) => position.emit(),
            Self::External(position) => position.emit(),
        }
    }

    /// Kind of variable.
    pub const fn kind(&self) -> VariableKind {
        match self {
            Self::Byte(_) => VariableKind::B,
            Self::Integer(_) => VariableKind::I,
            Self::Double(_) => VariableKind::D,
            Self::Real(_) => VariableKind::R,
            Self::Short(_) => VariableKind::S16,
            Self::Long(_) => VariableKind::S32,
            Self::Position(_) => VariableKind::P,
            Self::Base(_) => VariableKind::Bp,
            Self::External(_) => VariableKind::Ex,
        }
    }

    /// Parses user input. Strings are in the encoding of the controller.
    pub fn from_text(kind: VariableKind, text: &[u8]) -> Result<Self, ValueError> {
        let shown = String::from_utf8_lossy(text);
        let number = |expected| ValueError::Number { found: shown.clone().into_owned(), expected };
        Ok(match kind {
            VariableKind::B => Self::Byte(whole(&shown).ok_or_else(|| number("a number from 0 to 255"))?),
            VariableKind::I => Self::Integer(whole(&shown).ok_or_else(|| number("a number from -32768 to 32767"))?),
            VariableKind::D => {
                Self::Double(whole(&shown).ok_or_else(|| number("a number from -2147483648 to 2147483647"))?)
            }
            VariableKind::R => {
                // Hexadecimal input is parsed as a 16-bit integer, because a real can represent every such integer
                // exactly.
                let value = shown.parse().ok().or_else(|| whole::<i16>(&shown).map(f32::from));
                let value = value.filter(|value: &f32| value.is_finite());
                Self::Real(value.ok_or_else(|| number("a number that fits 32-bit floating point"))?)
            }
            VariableKind::S16 => Self::Short(Text::new(text)?),
            VariableKind::S32 => Self::Long(Text::new(text)?),
            VariableKind::P => Self::Position(shown.parse()?),
            VariableKind::Bp => Self::Base(shown.parse()?),
            VariableKind::Ex => Self::External(shown.parse()?),
        })
    }
}

/// An integer of the type, in decimal or hexadecimal.
fn whole<T: TryFrom<i64>>(text: &str) -> Option<T> {
    integer(text).and_then(|number| T::try_from(number).ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn typed_values_are_range_checked() {
        let error = |kind, text: &str| Value::from_text(kind, text.as_bytes()).unwrap_err().to_string();
        assert_eq!(error(VariableKind::B, "256"), "'256' is not a number from 0 to 255");
        assert_eq!(error(VariableKind::I, "32768"), "'32768' is not a number from -32768 to 32767");
        assert_eq!(error(VariableKind::R, "1e39"), "'1e39' is not a number that fits 32-bit floating point");
        assert_eq!(error(VariableKind::R, "nan"), "'nan' is not a number that fits 32-bit floating point");
        assert_eq!(
            error(VariableKind::S16, "12345678901234567"),
            "the text has 17 bytes in the controller's encoding; it can have at most 16"
        );
        assert_eq!(Value::from_text(VariableKind::D, b"-5"), Ok(Value::Double(-5)));
        assert_eq!(Value::from_text(VariableKind::B, b"0xFF"), Ok(Value::Byte(255)));
        assert_eq!(Value::from_text(VariableKind::I, b"-0x10"), Ok(Value::Integer(-16)));
        assert_eq!(Value::from_text(VariableKind::D, b"0x7FFFFFFF"), Ok(Value::Double(i32::MAX)));
        assert_eq!(Value::from_text(VariableKind::R, b"0x10"), Ok(Value::Real(16.0)));
        assert_eq!(error(VariableKind::B, "0x100"), "'0x100' is not a number from 0 to 255");
        assert_eq!(error(VariableKind::I, "0xFFFF"), "'0xFFFF' is not a number from -32768 to 32767");
    }
}
