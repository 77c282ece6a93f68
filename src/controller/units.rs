//! Exact conversion between decimal text and protocol integers, and quantities whose type is their unit.
//!
//! The conversion uses no floating point: a value is sent exactly as typed, or it is rejected. The constants are the
//! resolutions of Yaskawa controllers (FS and DX 3.3.39). Other families define their own resolutions.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use super::user_input::integer;

/// A decimal unit: its symbol, and the number of decimals in the resolution of the protocol.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Unit {
    /// Symbol for display.
    pub symbol: &'static str,
    /// Digits after the decimal point. The protocol integer is the value times ten to this power.
    pub decimals: u8,
}

/// Millimetres, resolution 0.001.
pub const MILLIMETRE: Unit = Unit { symbol: "mm", decimals: 3 };
/// Degrees, resolution 0.0001.
pub const DEGREE: Unit = Unit { symbol: "deg", decimals: 4 };
/// Percent, resolution 0.01.
pub const PERCENT: Unit = Unit { symbol: "%", decimals: 2 };
/// Millimetres per second, resolution 0.1.
pub const MILLIMETRE_PER_SECOND: Unit = Unit { symbol: "mm/s", decimals: 1 };
/// Degrees per second, resolution 0.1.
pub const DEGREE_PER_SECOND: Unit = Unit { symbol: "deg/s", decimals: 1 };
/// Encoder pulses.
pub const PULSE: Unit = Unit { symbol: "pulses", decimals: 0 };

/// Declares quantities: a number of steps, with a type for its unit.
macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident $unit:ident,)*) => {$(
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
        pub struct $name(i32);

        impl $name {
            /// Symbol and resolution.
            pub const UNIT: Unit = $unit;

            /// A number of steps of the resolution.
            pub const fn from_steps(steps: i32) -> Self {
                Self(steps)
            }

            /// Number of steps of the resolution.
            pub const fn steps(self) -> i32 {
                self.0
            }

            /// The number in the unit, for calculations.
            pub fn to_f64(self) -> f64 {
                f64::from(self.0) / f64::from(10_u32.pow(Self::UNIT.decimals.into()))
            }

            /// Text with the symbol and without zeros at the end, for example `12.5 mm`.
            pub fn short(self) -> String {
                let number = Self::UNIT.show(self.0).to_string();
                let number = if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { &number };
                format!("{number} {}", Self::UNIT.symbol)
            }
        }

        impl From<i16> for $name {
            /// A whole number in the unit.
            fn from(whole: i16) -> Self {
                Self(i32::from(whole) * 10_i32.pow(Self::UNIT.decimals.into()))
            }
        }

        impl FromStr for $name {
            type Err = UnitError;

            /// Parses a decimal number without symbol, exactly.
            fn from_str(text: &str) -> Result<Self, UnitError> {
                Self::UNIT.parse(text).map(Self)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{} {}", Self::UNIT.show(self.0), Self::UNIT.symbol)
            }
        }
    )*};
}

quantities! {
    /// A length in steps of 0.001 mm.
    Millimetres MILLIMETRE,
    /// An angle in steps of 0.0001 degree.
    Degrees DEGREE,
    /// A share in steps of 0.01 %.
    Percent PERCENT,
    /// A speed in steps of 0.1 mm/s.
    MillimetresPerSecond MILLIMETRE_PER_SECOND,
    /// A speed of rotation in steps of 0.1 degree/s.
    DegreesPerSecond DEGREE_PER_SECOND,
    /// A position of an axis in encoder pulses.
    Pulses PULSE,
}

/// A text that is not a valid value of its unit.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum UnitError {
    /// Not a number: optional sign, digits, optional point with digits.
    #[error("'{text}' is not a number{}", of_unit(symbol))]
    Malformed {
        /// The text.
        text: String,
        /// Symbol of the unit.
        symbol: &'static str,
    },
    /// More decimals than the resolution.
    #[error("'{text}' has more than {decimals} digits after the point, the resolution{} here", of_unit(symbol))]
    TooFine {
        /// The text.
        text: String,
        /// Allowed decimals.
        decimals: u8,
        /// Symbol of the unit.
        symbol: &'static str,
    },
    /// The value does not fit 32 bits.
    #[error("'{text}' {symbol} is out of range; the range is {lowest} to {highest}")]
    Range {
        /// The text.
        text: String,
        /// Symbol of the unit.
        symbol: &'static str,
        /// Minimum in this unit.
        lowest: String,
        /// Maximum in this unit.
        highest: String,
    },
}

fn of_unit(symbol: &str) -> String {
    if symbol.is_empty() { String::new() } else { format!(" of {symbol}") }
}

impl Unit {
    /// Converts decimal text to the protocol integer: `"100.000"` mm is 100000.
    pub fn parse(self, text: &str) -> Result<i32, UnitError> {
        let malformed = || UnitError::Malformed { text: shorten(text), symbol: self.symbol };
        let (negative, digits) = match text.as_bytes() {
            [b'-', ..] => (true, &text[1..]),
            [b'+', ..] => (false, &text[1..]),
            _ => (false, text),
        };
        let (whole, fraction) = match digits.split_once('.') {
            Some((whole, fraction)) if !fraction.is_empty() => (whole, fraction),
            Some(_) => return Err(malformed()),
            None => (digits, ""),
        };
        if whole.is_empty() || !whole.bytes().chain(fraction.bytes()).all(|byte| byte.is_ascii_digit()) {
            return Err(malformed());
        }
        if fraction.len() > usize::from(self.decimals) {
            return Err(UnitError::TooFine { text: shorten(text), decimals: self.decimals, symbol: self.symbol });
        }
        let padding = usize::from(self.decimals) - fraction.len();
        let digits = whole.bytes().chain(fraction.bytes()).chain(std::iter::repeat_n(b'0', padding));
        // The sum saturates, so that a text of a thousand digits does not overflow. The range check below rejects a
        // saturated sum.
        let magnitude = digits.fold(0_i64, |sum, digit| sum.saturating_mul(10).saturating_add(i64::from(digit - b'0')));
        i32::try_from(if negative { -magnitude } else { magnitude }).map_err(|_| UnitError::Range {
            text: shorten(text),
            symbol: self.symbol,
            lowest: self.show(i32::MIN).to_string(),
            highest: self.show(i32::MAX).to_string(),
        })
    }

    /// Parses like [`Unit::parse`], and also accepts hexadecimal after `0x` for units without decimals, such as pulses.
    pub fn parse_steps(self, text: &str) -> Result<i32, UnitError> {
        let is_hex = text.trim_start_matches(['-', '+']).get(..2).is_some_and(|head| head.eq_ignore_ascii_case("0x"));
        let steps = integer(text).filter(|_| is_hex && self.decimals == 0);
        match steps.and_then(|steps| i32::try_from(steps).ok()) {
            Some(steps) => Ok(steps),
            None => self.parse(text),
        }
    }

    /// Formats a protocol integer with all decimals: 100000 is `100.000` in millimetres.
    pub const fn show(self, value: i32) -> Quantity {
        Quantity { unit: self, value: value as i64 }
    }

    /// Formats an unsigned word like [`Unit::show`].
    pub const fn show_unsigned(self, value: u32) -> Quantity {
        Quantity { unit: self, value: value as i64 }
    }
}

/// A protocol integer with its unit. Displays as decimal text without the symbol.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quantity {
    unit: Unit,
    value: i64,
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.value < 0 { "-" } else { "" };
        let magnitude = self.value.unsigned_abs();
        match self.unit.decimals {
            0 => write!(f, "{sign}{magnitude}"),
            decimals => {
                let scale = 10_u64.pow(u32::from(decimals));
                let width = usize::from(decimals);
                write!(f, "{sign}{}.{:0width$}", magnitude / scale, magnitude % scale)
            }
        }
    }
}

/// Limits the length of a text in an error message.
fn shorten(text: &str) -> String {
    const MAX_TEXT_LEN: usize = 40;
    if text.chars().count() <= MAX_TEXT_LEN {
        return text.to_owned();
    }
    text.chars().take(MAX_TEXT_LEN).chain("...".chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conversions_are_exact_in_both_directions() {
        assert_eq!(MILLIMETRE.parse("100.000"), Ok(100_000));
        assert_eq!(MILLIMETRE.parse("-0.001"), Ok(-1));
        assert_eq!(DEGREE.parse("180"), Ok(1_800_000));
        assert_eq!(PERCENT.parse("+50.5"), Ok(5050));
        assert_eq!(MILLIMETRE_PER_SECOND.parse("0.1"), Ok(1));
        assert_eq!(MILLIMETRE.show(-1).to_string(), "-0.001");
        assert_eq!(MILLIMETRE.show(100_000).to_string(), "100.000");
        assert_eq!(PULSE.show(i32::MIN).to_string(), "-2147483648");
        assert_eq!(MILLIMETRE.parse("-2147483.648"), Ok(i32::MIN));
    }

    #[test]
    fn quantities_convert_exactly() {
        assert_eq!(Millimetres::from(-32_768).steps(), -32_768_000);
        assert_eq!(Degrees::from(i16::MAX).to_string(), "32767.0000 deg");
        assert_eq!("0.1".parse::<MillimetresPerSecond>(), Ok(MillimetresPerSecond::from_steps(1)));
        assert_eq!((Percent::from_steps(1250).short(), Percent::from(100).short()), ("12.5 %".into(), "100 %".into()));
        assert_eq!(
            (Pulses::from(100).short(), Millimetres::from_steps(-1).short()),
            ("100 pulses".into(), "-0.001 mm".into())
        );
        assert!((Millimetres::from_steps(12_500).to_f64() - 12.5).abs() < f64::EPSILON);
    }

    #[test]
    fn rejects_values_out_of_range() {
        assert!(matches!(MILLIMETRE.parse("1.0005"), Err(UnitError::TooFine { decimals: 3, .. })));
        assert!(matches!(MILLIMETRE.parse("2147483.648"), Err(UnitError::Range { .. })));
        assert!(matches!(MILLIMETRE.parse(&"9".repeat(500)), Err(UnitError::Range { .. })));
        for junk in ["", "-", ".", "1.", ".5", "1e3", "1,5", "--1", "0x10", "1 ", "١"] {
            assert!(matches!(MILLIMETRE.parse(junk), Err(UnitError::Malformed { .. })), "{junk:?}");
        }
    }

    #[test]
    fn errors_name_the_unit_and_shorten_the_text() {
        let error = |unit: Unit, text: &str| unit.parse(text).unwrap_err().to_string();
        assert_eq!(error(MILLIMETRE, "ten"), "'ten' is not a number of mm");
        assert_eq!(error(MILLIMETRE, &"x".repeat(41)), format!("'{}...' is not a number of mm", "x".repeat(40)));
        assert_eq!(error(Unit { symbol: "", ..MILLIMETRE }, "ten"), "'ten' is not a number");
    }
}
