//! Fields of a block, with their exact formats.
//!
//! Every field has a fixed width (templates in TO 2-4 to 2-8). Lines have no checksum: the width is the only protection
//! against lost or doubled characters. For this reason, a received value must have exactly this width, but it may be
//! out of range. User input may be shorter.

use std::borrow::Cow;
use std::fmt;

use thiserror::Error;

/// A field of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// Name in snake case, for example `ax1`, `x` or `station`.
    pub name: &'static str,
    /// Format.
    pub form: Form,
    /// Description.
    pub about: &'static str,
    /// Unit of a number, for example `mm`, `mm/s`, `s` or `%`. Empty if there is no unit.
    pub unit: &'static str,
    /// Whether the controller may send asterisks instead (TO 2-8, error history).
    pub starred: bool,
}

/// Format of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Decimal digits with leading zeros.
    Number(Number),
    /// Two hexadecimal digits.
    Hex,
    /// One of these words. If several match, the longest is used.
    Word(&'static [Word]),
    /// Eight digits `0` or `1`, bit 8 first (ambiguity C9).
    Bits,
    /// Eight characters `0`, `1` or `.`, bit 8 first. A condition ignores a bit with a dot; an action does not change
    /// it.
    Mask,
    /// Text without blanks.
    Token,
    /// The rest of the block, without surrounding blanks.
    Text,
}

/// Number format. A value is an integer that counts units of the last decimal: 1234 means 12.34.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Number {
    /// Whether a sign is always written.
    pub signed: bool,
    /// Digits before the decimal point.
    pub whole: u8,
    /// Digits after the decimal point. With 0 digits, there is no point.
    pub decimals: u8,
    /// Number of additional decimals that the parser accepts and keeps (ambiguity R8).
    pub spare: u8,
    /// Minimum of a value that armctl sends.
    pub least: i32,
    /// Maximum of a value that armctl sends.
    pub most: i32,
}

/// A word and its meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Word {
    /// Text in the protocol.
    pub text: &'static str,
    /// Meaning; equal to `text` if the text is clear by itself.
    pub about: &'static str,
}

/// A value, independent of a format.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Value {
    /// A number, in units of the last decimal.
    Number(i32),
    /// A byte, sent as two hexadecimal digits.
    Byte(u8),
    /// A word, as the protocol spells it.
    Word(&'static str),
    /// Eight bits; bit 1 of the manual is the least significant.
    Bits(u8),
    /// Eight bits of which a condition or action uses only some.
    Mask(Mask),
    /// Text of a field without a fixed form. Also a received value that is not in the form of its field.
    Text(String),
    /// Asterisks instead of a value.
    Stars,
}

/// Conditions or actions for eight bits. Bit 1 of the manual is the least significant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Mask {
    /// Bits that the condition or action uses, as a mask.
    pub care: u8,
    /// States of these bits. The other bits are 0.
    pub bits: u8,
}

/// Why a text or value does not fit a field.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum FieldError {
    /// Wrong format.
    #[error("{name}: '{}' is not {form}", found.escape_debug())]
    Form {
        /// Name of the field.
        name: &'static str,
        /// Found text.
        found: String,
        /// Expected format.
        form: String,
    },
    /// More decimals than the protocol has.
    #[error("{name}: {found} {} ({form})", decimals(*most))]
    Decimals {
        /// Name of the field.
        name: &'static str,
        /// Found text.
        found: String,
        /// Maximum number of decimals.
        most: u8,
        /// Expected format.
        form: String,
    },
    /// Number out of range.
    #[error("{name}: {found} is out of range ({form})")]
    Range {
        /// Name of the field.
        name: &'static str,
        /// The number.
        found: String,
        /// Expected range.
        form: String,
    },
}

/// Message about too many decimals.
fn decimals(most: u8) -> String {
    match most {
        0 => "is not a whole number".to_owned(),
        1 => "has too many decimals: at most 1 decimal".to_owned(),
        most => format!("has too many decimals: at most {most} decimals"),
    }
}

impl Number {
    /// An integer with this number of digits.
    pub const fn digits(whole: u8, least: i32, most: i32) -> Self {
        Self { signed: false, whole, decimals: 0, spare: 0, least, most }
    }

    /// A number with decimals; the range counts the last decimal.
    pub const fn fixed(whole: u8, decimals: u8, least: i32, most: i32) -> Self {
        Self { signed: false, whole, decimals, spare: 0, least, most }
    }

    /// A number with decimals and a mandatory sign.
    pub const fn signed(whole: u8, decimals: u8, least: i32, most: i32) -> Self {
        Self { signed: true, whole, decimals, spare: 0, least, most }
    }

    /// Adds decimals that the controller may send but armctl does not send. The values and the range count units of the
    /// last additional decimal.
    #[must_use]
    pub const fn with_spare(self, spare: u8) -> Self {
        Self { spare, ..self }
    }

    /// Number of value units in the number 1, for example 100 with two decimals.
    pub const fn scale(self) -> i32 {
        10_i32.pow(self.decimals as u32 + self.spare as u32)
    }

    /// Width in the protocol.
    const fn width(self) -> usize {
        let sign = self.signed as usize;
        let fraction = if self.decimals == 0 { 0 } else { 1 + self.decimals as usize };
        sign + self.whole as usize + fraction
    }

    /// Whether sign, digits and point are in their places.
    fn has_shape(self, text: &str) -> bool {
        let fits = |whole: u8, decimals: u8| {
            let point = usize::from(self.signed) + usize::from(whole);
            text.bytes().enumerate().all(|(at, byte)| match at {
                0 if self.signed => matches!(byte, b'+' | b'-'),
                _ if at == point && decimals > 0 => byte == b'.',
                _ => byte.is_ascii_digit(),
            })
        };
        fits(self.whole, self.decimals)
            || self.spare > 0 && fits(self.whole.saturating_sub(self.spare), self.decimals + self.spare)
    }

    /// Smallest difference of two values that can be sent, in value units.
    const fn step(self) -> i32 {
        10_i32.pow(self.spare as u32)
    }

    /// Formats a value without padding, for example `-12.34`.
    pub fn plain(self, value: i32) -> String {
        let sign = if value < 0 { "-" } else { "" };
        format!("{sign}{}", self.unsigned(value, 0))
    }

    /// Formats a value in full width. The text of a value that is too large is wider.
    fn emit(self, value: i32) -> String {
        let sign = match (self.signed, value < 0) {
            (_, true) => "-",
            (true, false) => "+",
            (false, false) => "",
        };
        format!("{sign}{}", self.unsigned(value, self.whole))
    }

    /// Digits, padded to `whole` before the point. If the value needs the spare decimals, they replace leading digits,
    /// so the width stays the same.
    fn unsigned(self, value: i32, whole: u8) -> String {
        let (scale, step) = (self.scale().unsigned_abs(), self.step().unsigned_abs());
        let digits = value.unsigned_abs();
        let (integer, fraction) = (digits / scale, digits % scale);
        let (whole, decimals, fraction) = if fraction % step == 0 {
            (whole, self.decimals, fraction / step)
        } else {
            (whole.saturating_sub(self.spare), self.decimals + self.spare, fraction)
        };
        let (whole, decimals) = (usize::from(whole), usize::from(decimals));
        if decimals == 0 { format!("{integer:0whole$}") } else { format!("{integer:0whole$}.{fraction:0decimals$}") }
    }

    /// Parses digits with an optional sign and point. Decimals beyond the format must be zeros, so that nothing is
    /// rounded.
    fn parse(self, text: &str) -> Option<i32> {
        let (sign, digits) = match text.as_bytes().first()? {
            b'-' => (-1, &text[1..]),
            b'+' => (1, &text[1..]),
            _ => (1, text),
        };
        let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
        let is_digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
        if (whole.is_empty() && fraction.is_empty()) || !is_digits(whole) || !is_digits(fraction) {
            return None;
        }
        let decimals = usize::from(self.decimals + self.spare);
        let (kept, beyond) = fraction.split_at(decimals.min(fraction.len()));
        if beyond.bytes().any(|digit| digit != b'0') {
            return None;
        }
        let units: i64 = format!("{whole}{kept:0<decimals$}").parse().ok()?;
        i32::try_from(sign * units).ok()
    }

    /// Range as text, for example `-8000.00 to 8000.00`.
    fn range(self) -> String {
        if self.least == self.most {
            format!("only {}", self.plain(self.least))
        } else {
            format!("{} to {}", self.plain(self.least), self.plain(self.most))
        }
    }
}

impl Mask {
    /// A mask that uses all eight bits.
    pub const fn all(bits: u8) -> Self {
        Self { care: 0xFF, bits }
    }

    /// Whether the bits of a port meet the condition.
    pub const fn matches(self, port: u8) -> bool {
        port & self.care == self.bits
    }

    /// The bits of a port after the action.
    pub const fn applied(self, port: u8) -> u8 {
        port & !self.care | self.bits
    }

    fn parse(text: &str, may_skip: bool) -> Option<Self> {
        let mut mask = Self::default();
        let mut count = 0;
        for c in text.chars() {
            let (care, bit) = match c {
                '0' => (1, 0),
                '1' => (1, 1),
                '.' if may_skip => (0, 0),
                _ => return None,
            };
            mask = Self { care: mask.care << 1 | care, bits: mask.bits << 1 | bit };
            count += 1;
        }
        (count == 8).then_some(mask)
    }
}

impl fmt::Display for Mask {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (0..8).rev().try_for_each(|bit| {
            f.write_str(match (self.care >> bit & 1, self.bits >> bit & 1) {
                (0, _) => ".",
                (_, 0) => "0",
                _ => "1",
            })
        })
    }
}

impl Field {
    /// A field without unit.
    pub const fn new(name: &'static str, form: Form, about: &'static str) -> Self {
        Self { name, form, about, unit: "", starred: false }
    }

    /// Sets the unit.
    #[must_use]
    pub const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// Accepts asterisks.
    #[must_use]
    pub const fn starred(self) -> Self {
        Self { starred: true, ..self }
    }

    /// Sets the name.
    #[must_use]
    pub const fn named(self, name: &'static str) -> Self {
        Self { name, ..self }
    }

    /// Formats a value for sending. The value must be in range.
    pub fn emit(&self, value: &Value) -> Result<String, FieldError> {
        match (self.form, value) {
            (Form::Number(number), Value::Number(units)) => {
                if (number.least..=number.most).contains(units) && units % number.step() == 0 {
                    Ok(number.emit(*units))
                } else {
                    Err(self.out_of_range(number.plain(*units)))
                }
            }
            (Form::Word(words), Value::Word(text)) if words.iter().any(|word| word.text == *text) => {
                Ok((*text).to_owned())
            }
            (Form::Hex, Value::Byte(_)) | (Form::Bits, Value::Bits(_)) | (Form::Mask, Value::Mask(_)) => {
                Ok(self.written(value))
            }
            (Form::Token | Form::Text, Value::Text(text)) if text.bytes().all(|byte| (0x20..0x7F).contains(&byte)) => {
                Ok(text.clone())
            }
            (_, Value::Stars) if self.starred => Ok(self.written(value)),
            _ => Err(self.misfit(&self.written(value))),
        }
    }

    /// Formats a value that may be out of range, such as a received value.
    pub fn written(&self, value: &Value) -> String {
        match (value, self.form) {
            (Value::Number(units), Form::Number(number)) => number.emit(*units),
            (Value::Number(units), _) => units.to_string(),
            (Value::Byte(byte), _) => format!("{byte:02X}"),
            (Value::Word(text), _) => (*text).to_owned(),
            (Value::Bits(bits), _) => Mask::all(*bits).to_string(),
            (Value::Mask(mask), _) => mask.to_string(),
            (Value::Text(text), _) => text.clone(),
            (Value::Stars, Form::Number(number)) => "*".repeat(number.whole.into()),
            (Value::Stars, _) => "**".to_owned(),
        }
    }

    /// Parses a value in full width at the start of a text. Returns the value and the rest of the text.
    pub fn take<'t>(&self, text: &'t str) -> Result<(Value, &'t str), FieldError> {
        let misfit = || self.misfit(excerpt(text));
        let len = match self.form {
            Form::Number(number) => number.width(),
            Form::Hex => 2,
            Form::Word(words) => {
                let fitting = words
                    .iter()
                    .map(|word| word.text.len())
                    .filter(|len| words.iter().any(|word| word.text.len() == *len && text.starts_with(word.text)));
                fitting.max().ok_or_else(misfit)?
            }
            Form::Bits | Form::Mask => 8,
            Form::Token => text.find(' ').unwrap_or(text.len()),
            Form::Text => text.len(),
        };
        let (own, rest) = text.split_at_checked(len).ok_or_else(misfit)?;
        let value = self.value(own).ok_or_else(misfit)?;
        match (self.form, &value) {
            (Form::Number(number), Value::Number(_)) if !number.has_shape(own) => Err(misfit()),
            _ => Ok((value, rest)),
        }
    }

    /// Parses user input, which must be in format and in range.
    pub fn read(&self, text: &str) -> Result<Value, FieldError> {
        let value = self.value(text).ok_or_else(|| self.too_fine(text).unwrap_or_else(|| self.misfit(text)))?;
        if let (Form::Number(number), Value::Number(units)) = (self.form, &value)
            && units % number.step() != 0
        {
            return Err(self.too_fine(text).unwrap_or_else(|| self.misfit(text)));
        }
        self.check(&value)?;
        Ok(value)
    }

    /// Checks that a value can be sent.
    pub fn check(&self, value: &Value) -> Result<(), FieldError> {
        self.emit(value).map(|_| ())
    }

    /// Whether a value is in the format of the field. A received value in another format is kept as text.
    pub fn is_listed(&self, value: &Value) -> bool {
        !matches!(value, Value::Text(_)) || matches!(self.form, Form::Token | Form::Text)
    }

    /// Description of valid values, for example `a number 0000 to 9999` or `J or E`.
    pub fn expected(&self) -> String {
        match self.form {
            Form::Number(number) if self.unit.is_empty() => format!("a number, {}", number.range()),
            Form::Number(number) => format!("a number, {} {}", number.range(), self.unit),
            Form::Hex => "two hexadecimal digits".to_owned(),
            Form::Word(words) => {
                let texts: Vec<&str> = words.iter().map(|word| word.text.trim_end()).collect();
                match texts.split_last() {
                    Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
                    _ => texts.concat(),
                }
            }
            Form::Bits => "eight digits, each 0 or 1".to_owned(),
            Form::Mask => "eight characters, each 0, 1 or .".to_owned(),
            Form::Token => "one word".to_owned(),
            Form::Text => "a text".to_owned(),
        }
    }

    /// Readable value, for example `12.5 mm` or `absolute`.
    pub fn meaning<'v>(&self, value: &'v Value) -> Cow<'v, str> {
        match (value, self.form) {
            (Value::Number(units), Form::Number(number)) => {
                let plain = number.plain(*units);
                Cow::Owned(if self.unit.is_empty() { plain } else { format!("{plain} {}", self.unit) })
            }
            (Value::Word(text), Form::Word(words)) => {
                let word = words.iter().find(|word| word.text == *text);
                Cow::Borrowed(word.map_or(*text, |word| word.about))
            }
            (Value::Text(text), _) => Cow::Borrowed(text),
            _ => Cow::Owned(self.written(value)),
        }
    }

    fn value(&self, text: &str) -> Option<Value> {
        if self.starred && !text.is_empty() && text.bytes().all(|byte| byte == b'*') {
            return Some(Value::Stars);
        }
        match self.form {
            Form::Number(number) => number.parse(text).map(Value::Number),
            Form::Hex if text.len() == 2 => u8::from_str_radix(text, 16).ok().map(Value::Byte),
            Form::Hex => None,
            Form::Word(words) => {
                let found = words.iter().find(|word| word.text.trim_end() == text.trim_end());
                found.map(|word| Value::Word(word.text))
            }
            Form::Bits => Mask::parse(text, false).map(|mask| Value::Bits(mask.bits)),
            Form::Mask => Mask::parse(text, true).map(Value::Mask),
            Form::Token if text.is_empty() || text.contains(' ') => None,
            Form::Token | Form::Text => Some(Value::Text(text.trim().to_owned())),
        }
    }

    /// Error for too many decimals; `None` if the text is not a number.
    fn too_fine(&self, text: &str) -> Option<FieldError> {
        let Form::Number(number) = self.form else { return None };
        let is_number = text.parse::<f64>().is_ok_and(f64::is_finite) && !text.contains(['e', 'E']);
        (is_number && text.contains('.')).then(|| FieldError::Decimals {
            name: self.name,
            found: text.to_owned(),
            most: number.decimals,
            form: self.expected(),
        })
    }

    fn misfit(&self, found: &str) -> FieldError {
        FieldError::Form { name: self.name, found: found.to_owned(), form: self.expected() }
    }

    fn out_of_range(&self, found: String) -> FieldError {
        FieldError::Range { name: self.name, found, form: self.expected() }
    }
}

/// Start of a text, for an error.
fn excerpt(text: &str) -> &str {
    let end = text.char_indices().nth(16).map_or(text.len(), |(at, _)| at);
    let front = &text[..end];
    front.split_inclusive(' ').next().map_or(front, str::trim_end)
}

#[cfg(test)]
mod tests {
    use super::*;

    const X: Field = Field::new("x", Form::Number(Number::signed(4, 2, -800_000, 800_000)), "X").unit("mm");
    const STEP: Field = Field::new("step", Form::Number(Number::digits(4, 1, 5000)), "step");
    const COMPARE: Field = Field::new(
        "compare",
        Form::Word(&[
            Word { text: "= ", about: "equal" },
            Word { text: "< ", about: "less" },
            Word { text: "<=", about: "at most" },
        ]),
        "comparison",
    );
    const PORT: Field = Field::new("data", Form::Mask, "port");

    #[test]
    fn numbers_are_sent_in_full_width() {
        assert_eq!(X.emit(&Value::Number(10_000)).unwrap(), "+0100.00");
        assert_eq!(X.emit(&Value::Number(-5)).unwrap(), "-0000.05");
        assert_eq!(STEP.emit(&Value::Number(7)).unwrap(), "0007");
        assert_eq!(
            X.emit(&Value::Number(800_001)).unwrap_err().to_string(),
            "x: 8000.01 is out of range (a number, -8000.00 to 8000.00 mm)"
        );
    }

    #[test]
    fn received_numbers_must_have_full_width() {
        let take = |text| X.take(text).map(|(value, rest)| (value, rest.to_owned()));
        assert_eq!(take("+0100.00 Y"), Ok((Value::Number(10_000), " Y".into())));
        assert_eq!(take("+9999.99"), Ok((Value::Number(999_999), String::new())));
        for damaged in ["+010.00", "+0100.0", "0100.00 ", "+01000.0", "+01.0.00", "", "+"] {
            assert!(take(damaged).is_err(), "{damaged}");
        }
        // A doubled digit shifts the rest of the text, so the rest does not fit the format.
        assert_eq!(take("+01100.00 Y"), Err(X.take("+01100.00 Y").unwrap_err()));
    }

    #[test]
    fn typed_numbers_can_have_any_width() {
        assert_eq!(X.read("-1.5").unwrap(), Value::Number(-150));
        assert_eq!(X.read("100").unwrap(), Value::Number(10_000));
        assert_eq!(X.read("0.100").unwrap(), Value::Number(10));
        assert_eq!(
            X.read("0.001").unwrap_err().to_string(),
            "x: 0.001 has too many decimals: at most 2 decimals (a number, -8000.00 to 8000.00 mm)",
            "nothing is rounded away"
        );
        assert_eq!(STEP.read("1.5").unwrap_err().to_string(), "step: 1.5 is not a whole number (a number, 1 to 5000)");
        assert_eq!(STEP.read("7.0").unwrap(), Value::Number(7));
        assert!(X.read("99999999999").is_err());
    }

    #[test]
    fn an_additional_decimal_is_kept_where_the_manual_is_ambiguous() {
        let number = Number::signed(3, 2, -99_990, 99_990).with_spare(1);
        let offset = Field::new("ax1", Form::Number(number), "offset");
        let (value, _) = offset.take("+12.345").unwrap();
        assert_eq!(value, Value::Number(12_345));
        assert_eq!(offset.written(&value), "+12.345");
        assert!(offset.emit(&value).is_err());
        assert_eq!(offset.emit(&offset.take("-001.50").unwrap().0).unwrap(), "-001.50");
        assert!(offset.take("+0.1234").is_err());
    }

    #[test]
    fn comparisons_are_two_characters_wide() {
        assert_eq!(COMPARE.take("= 0000").unwrap(), (Value::Word("= "), "0000"));
        assert!(COMPARE.take("=0000").is_err());
        assert_eq!(COMPARE.take("<=0000").unwrap(), (Value::Word("<="), "0000"));
        assert!(COMPARE.take("!").is_err());
    }

    #[test]
    fn a_mask_leaves_bits_unchanged() {
        let (value, rest) = PORT.take(".......1 AND").unwrap();
        assert_eq!((value.clone(), rest), (Value::Mask(Mask { care: 1, bits: 1 }), " AND"));
        assert_eq!(PORT.emit(&value).unwrap(), ".......1");
        let mask = Mask::parse("10.10.10", true).unwrap();
        assert_eq!(mask.applied(0b0111_1111), 0b1011_0110);
        assert!(mask.matches(0b1001_0010) && !mask.matches(0));
        assert!(PORT.take("10").is_err());
    }

    #[test]
    fn typed_values_must_be_in_range() {
        assert!(STEP.read("5000").is_ok());
        assert!(matches!(STEP.read("5001"), Err(FieldError::Range { .. })));
        assert!(matches!(STEP.read("x"), Err(FieldError::Form { .. })));
        assert!(matches!(X.read("1.005"), Err(FieldError::Decimals { .. })));
        assert!(matches!(X.read("1.0e1"), Err(FieldError::Form { .. })));
        assert!(matches!(X.read("999999999999"), Err(FieldError::Form { .. })));
        assert_eq!(COMPARE.read("<").unwrap(), Value::Word("< "));
    }
}
