//! Value of a variable in reports.

use super::position::PositionData;
use crate::prelude::*;
use armctl_controller::text::hex;
use armctl_controller::yerc::variables::Value;

/// The value of a variable.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Data {
    /// Value of a B, I or D variable.
    Integer(i32),
    /// Value of an R variable, with the fewest digits that convert back to the same value.
    Real(f64),
    /// Value of an S variable; also of an R variable that is not a number: `NaN`, `inf`, `-inf`.
    Text(String),
    /// Value of a P, BP or EX variable.
    Position(Box<PositionData>),
}

impl Data {
    /// Value for reports, and its bytes in hexadecimal if the value cannot be converted back to these bytes.
    pub fn of(value: &Value, encoding: Encoding) -> (Self, Option<String>) {
        let text = |bytes: &[u8]| {
            let name = encoding.name(bytes);
            (Self::Text(name.text), name.hex)
        };
        match value {
            Value::Byte(value) => (Self::Integer((*value).into()), None),
            Value::Integer(value) => (Self::Integer((*value).into()), None),
            Value::Double(value) => (Self::Integer(*value), None),
            Value::Real(value) => match shortest(*value) {
                Some(value) => (Self::Real(value), None),
                None => (Self::Text(value.to_string()), Some(hex(&value.to_le_bytes()))),
            },
            Value::Short(value) => text(value.as_bytes()),
            Value::Long(value) => text(value.as_bytes()),
            Value::Position(_) | Value::Base(_) | Value::External(_) => {
                let position = PositionData::of(value).map(Box::new);
                (position.map_or(Self::Text(String::new()), Self::Position), None)
            }
        }
    }

    /// Whether the value is a number.
    pub const fn is_number(&self) -> bool {
        matches!(self, Self::Integer(_) | Self::Real(_))
    }

    /// Whether the value is 0 or an empty text. A controller has such a value in a variable that was never written.
    pub fn is_blank(&self) -> bool {
        match self {
            Self::Integer(number) => *number == 0,
            Self::Real(number) => *number == 0.0,
            Self::Text(text) => text.is_empty(),
            Self::Position(_) => false,
        }
    }
}

impl fmt::Display for Data {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Integer(value) => value.fmt(f),
            // The text has a decimal point or an exponent, so that it is recognized as a real.
            Self::Real(value) => write!(f, "{value:?}"),
            Self::Text(text) => f.write_str(text),
            Self::Position(position) => f.write_str(position.text()),
        }
    }
}

/// 64-bit number with the same digits as the 32-bit number; `None` if it is not a number.
fn shortest(value: f32) -> Option<f64> {
    if value.is_finite() { format!("{value:?}").parse().ok() } else { None }
}
