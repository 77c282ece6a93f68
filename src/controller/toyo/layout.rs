//! Layout of a block, or of a part of a block: fixed words with fields between them.

use std::ops::Range;

use thiserror::Error;

use super::field::{Field, FieldError, Form, Mask, Value};
use crate::units::Millimetres;

/// A text with fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Template of the manual, with `{}` for each field.
    pub text: &'static str,
    /// Fields, in order.
    pub fields: &'static [Field],
}

/// Values of a layout.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Record {
    layout: Layout,
    values: Vec<Value>,
}

/// Why a text does not fit a layout, and where.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{what} at column {}", at + 1)]
pub struct LayoutError {
    /// Byte offset.
    pub at: usize,
    /// The problem.
    pub what: LayoutProblem,
}

/// Problem at one position of a text.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum LayoutProblem {
    /// The text has other words than the expected ones.
    #[error("'{expected}' is expected")]
    Words {
        /// Expected words.
        expected: &'static str,
    },
    /// Not a valid value of the field.
    #[error(transparent)]
    Field(#[from] FieldError),
    /// Text is left after the end of the layout.
    #[error("unexpected text '{}'", found.escape_debug())]
    Rest {
        /// The rest.
        found: String,
    },
    /// A value that was kept as received. armctl never sends such a value.
    #[error("'{}' is not in the manual; armctl does not write it", found.escape_debug())]
    Unlisted {
        /// The received text.
        found: String,
    },
    /// Wrong number of values.
    #[error("{found} values, but {expected} fields")]
    Count {
        /// Number of fields.
        expected: usize,
        /// Number of values.
        found: usize,
    },
}

/// Layout of received content that is not in the manual, such as an instruction of a newer version. The content is kept
/// as received.
pub const UNLISTED: Layout =
    Layout::new("{}", &[Field::new("unlisted", Form::Text, "a value that is not in the manual, as received")]);

impl Layout {
    /// Words only.
    pub const fn words(text: &'static str) -> Self {
        Self { text, fields: &[] }
    }

    /// Words and fields.
    pub const fn new(text: &'static str, fields: &'static [Field]) -> Self {
        Self { text, fields }
    }

    /// Formats values. Each value must be in format and in range.
    pub fn emit(&self, values: &[Value]) -> Result<String, LayoutProblem> {
        if values.len() != self.fields.len() {
            return Err(LayoutProblem::Count { expected: self.fields.len(), found: values.len() });
        }
        if let (true, [Value::Text(found)]) = (*self == UNLISTED, values) {
            return Err(LayoutProblem::Unlisted { found: found.clone() });
        }
        self.join(values, |field, value| Ok(field.emit(value)?))
    }

    /// Formats the known values, and writes `?` for the others. Each known value must be in format and in range.
    pub fn sketch(&self, values: &[Option<Value>]) -> Result<String, LayoutProblem> {
        if values.len() != self.fields.len() {
            return Err(LayoutProblem::Count { expected: self.fields.len(), found: values.len() });
        }
        self.join(values, |field, value| match value {
            Some(value) => Ok(field.emit(value)?),
            None => Ok("?".to_owned()),
        })
    }

    /// Parses the values of a text. Surrounding blanks and additional blanks do not matter (ambiguity A7).
    pub fn parse(&self, text: &str) -> Result<Record, LayoutError> {
        let mut values = Vec::with_capacity(self.fields.len());
        self.scan(text, |_, value, _| values.push(value))?;
        Ok(Record { layout: *self, values })
    }

    /// Parses like [`Layout::parse`], but keeps a value that is not in its format as [`Value::Text`], which is never
    /// sent. The words and positions must be right.
    pub fn parse_kept(&self, text: &str) -> Result<Record, LayoutError> {
        let mut values = Vec::with_capacity(self.fields.len());
        self.walk(text, true, |_, value, _| values.push(value))?;
        Ok(Record { layout: *self, values })
    }

    /// Calls `found` for each value with its field and byte range, up to the first value that does not fit.
    pub fn scan(&self, text: &str, found: impl FnMut(&'static Field, Value, Range<usize>)) -> Result<(), LayoutError> {
        self.walk(text, false, found)
    }

    fn walk(
        &self,
        text: &str,
        keeps_unlisted: bool,
        mut found: impl FnMut(&'static Field, Value, Range<usize>),
    ) -> Result<(), LayoutError> {
        let mut rest = text.trim_start_matches(' ');
        let at = |rest: &str| text.len() - rest.len();
        let mut words = self.text.split("{}");
        let mut fields = self.fields.iter();
        loop {
            let expected = words.next().unwrap_or_default();
            rest = skip_words(expected, rest)
                .map_err(|rest| LayoutError { at: at(rest), what: LayoutProblem::Words { expected } })?;
            let Some(field) = fields.next() else { break };
            let mut parsed = field.take(rest);
            if keeps_unlisted {
                let (next, is_last) = (words.clone().next().unwrap_or_default(), fields.len() == 0);
                let fits = |rest_after| {
                    skip_words(next, rest_after)
                        .is_ok_and(|rest_after| !is_last || rest_after.trim_end_matches(' ').is_empty())
                };
                if !parsed.as_ref().is_ok_and(|(_, rest_after)| fits(rest_after)) {
                    parsed = take_unlisted(rest, next, is_last).map_or(parsed, Ok);
                }
            }
            let (value, rest_after) = parsed.map_err(|error| LayoutError { at: at(rest), what: error.into() })?;
            found(field, value, at(rest)..at(rest_after));
            rest = rest_after;
        }
        match rest.trim_end_matches(' ') {
            "" => Ok(()),
            found => Err(LayoutError { at: at(rest), what: LayoutProblem::Rest { found: found.to_owned() } }),
        }
    }

    /// A record of values that may be out of range, such as content of a controller.
    pub fn record(&self, values: Vec<Value>) -> Result<Record, LayoutProblem> {
        if values.len() == self.fields.len() {
            Ok(Record { layout: *self, values })
        } else {
            Err(LayoutProblem::Count { expected: self.fields.len(), found: values.len() })
        }
    }

    /// A record of values whose number may also be wrong. [`Record::emit`] then fails.
    pub(super) fn unchecked(&self, values: Vec<Value>) -> Record {
        Record { layout: *self, values }
    }

    /// Joins words and fields; `write` formats the value of a field.
    fn join<V>(
        &self,
        values: &[V],
        mut write: impl FnMut(&Field, &V) -> Result<String, LayoutProblem>,
    ) -> Result<String, LayoutProblem> {
        let mut text = String::with_capacity(self.text.len() + 8 * self.fields.len());
        let mut fields = self.fields.iter().zip(values);
        for words in self.text.split("{}") {
            text.push_str(words);
            if let Some((field, value)) = fields.next() {
                text.push_str(&write(field, value)?);
            }
        }
        Ok(text)
    }
}

/// Takes a value that is not in its format: all text before the next words.
fn take_unlisted<'t>(text: &'t str, next: &str, is_last: bool) -> Option<(Value, &'t str)> {
    let end = match next {
        "" if is_last => text.len(),
        "" => return None,
        next => text.find(next)?,
    };
    let (own, rest) = text.split_at(end);
    let own = own.trim_matches(' ');
    (!own.is_empty()).then(|| (Value::Text(own.to_owned()), rest))
}

/// Skips the expected words. A blank in `words` matches one or more blanks. If the text differs, the error is the text
/// from the first difference on.
fn skip_words<'t>(words: &str, mut text: &'t str) -> Result<&'t str, &'t str> {
    for expected in words.chars() {
        let rest = text.strip_prefix(expected).ok_or(text)?;
        text = if expected == ' ' { rest.trim_start_matches(' ') } else { rest };
    }
    Ok(text)
}

impl Record {
    /// Layout of the record.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Values in field order.
    pub fn values(&self) -> &[Value] {
        &self.values
    }

    /// Fields with their values.
    pub fn pairs(&self) -> impl Iterator<Item = (&'static Field, &Value)> {
        self.layout.fields.iter().zip(&self.values)
    }

    /// The value of a field by its name.
    pub fn value(&self, name: &str) -> Option<&Value> {
        self.pairs().find(|(field, _)| field.name == name).map(|(_, value)| value)
    }

    /// A text that is kept as received.
    pub fn unlisted(text: &str) -> Self {
        Self { layout: UNLISTED, values: vec![Value::Text(text.trim_matches(' ').to_owned())] }
    }

    /// Replaces the value of a field. Has no effect if the layout does not have this field.
    #[must_use]
    pub fn with(mut self, name: &str, value: Value) -> Self {
        let mut fields = self.layout.fields.iter().zip(&mut self.values);
        if let Some((_, own)) = fields.find(|(field, _)| field.name == name) {
            *own = value;
        }
        self
    }

    /// Whether all values are in the formats of the manual.
    pub fn is_listed(&self) -> bool {
        self.layout != UNLISTED && self.pairs().all(|(field, value)| field.is_listed(value))
    }

    /// Value of a number field by name, in units of its last decimal.
    pub fn number(&self, name: &str) -> Option<i32> {
        if let Value::Number(number) = self.value(name)? { Some(*number) } else { None }
    }

    /// Value of a number field in millimetres by name, for example `x` of a position.
    pub fn millimetres(&self, name: &str) -> Option<Millimetres> {
        let (field, value) = self.pairs().find(|(field, _)| field.name == name)?;
        let (Form::Number(number), Value::Number(units)) = (field.form, value) else { return None };
        let steps_per_mm = 10_i32.pow(Millimetres::UNIT.decimals.into());
        let steps = units.checked_mul(steps_per_mm.checked_div(number.scale())?)?;
        (steps_per_mm % number.scale() == 0).then_some(Millimetres::from_steps(steps))
    }

    /// Value of a word field by name, as the protocol spells it.
    pub fn word(&self, name: &str) -> Option<&'static str> {
        if let Value::Word(word) = self.value(name)? { Some(word) } else { None }
    }

    /// Value of a hexadecimal field by name.
    pub fn byte(&self, name: &str) -> Option<u8> {
        if let Value::Byte(byte) = self.value(name)? { Some(*byte) } else { None }
    }

    /// Value of a port field by name, as eight bits.
    pub fn bits(&self, name: &str) -> Option<u8> {
        if let Value::Bits(bits) = self.value(name)? { Some(*bits) } else { None }
    }

    /// Conditions or actions for a port, from the field with this name.
    pub fn mask(&self, name: &str) -> Option<Mask> {
        if let Value::Mask(mask) = self.value(name)? { Some(*mask) } else { None }
    }

    /// Value of a text field by name.
    pub fn text(&self, name: &str) -> Option<&str> {
        if let Value::Text(text) = self.value(name)? { Some(text) } else { None }
    }

    /// Formats the record for sending: every value must be in range.
    pub fn emit(&self) -> Result<String, LayoutProblem> {
        self.layout.emit(&self.values)
    }

    /// Formats the record without a range check, for answers of a controller.
    pub fn written(&self) -> String {
        self.layout.join(&self.values, |field, value| Ok(field.written(value))).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::toyo::field::{Form, Number};

    const TWO: Layout = Layout::new(
        "MCNT CN{}={}",
        &[
            Field::new("counter", Form::Number(Number::digits(2, 1, 99)), "counter"),
            Field::new("count", Form::Number(Number::digits(4, 0, 9999)), "count"),
        ],
    );

    #[test]
    fn emitted_text_equals_the_manual() {
        let values = [Value::Number(1), Value::Number(0)];
        assert_eq!(TWO.emit(&values).unwrap(), "MCNT CN01=0000");
        assert_eq!(TWO.parse("MCNT CN01=0000").unwrap().values(), values);
        assert_eq!(TWO.emit(&values[..1]), Err(LayoutProblem::Count { expected: 2, found: 1 }));
    }

    #[test]
    fn additional_blanks_are_accepted() {
        assert_eq!(TWO.parse("  MCNT   CN01=0012  ").unwrap().written(), "MCNT CN01=0012");
    }

    #[test]
    fn a_value_outside_its_format_is_kept_and_never_sent() {
        let take_unlisted = |text: &str| TWO.parse_kept(text).map(|record| (record.written(), record.is_listed()));
        assert_eq!(take_unlisted("MCNT CN01=0000"), Ok(("MCNT CN01=0000".into(), true)));
        assert_eq!(take_unlisted("MCNT CN1=00012"), Ok(("MCNT CN1=00012".into(), false)));
        assert_eq!(take_unlisted("MCNT CN01=1 2"), Ok(("MCNT CN01=1 2".into(), false)));
        assert!(
            take_unlisted("MCNT CM01=0000").is_err()
                && take_unlisted("MCNT CN01").is_err()
                && take_unlisted("MCNT CN01=").is_err()
        );
        assert!(TWO.parse_kept("MCNT CN01=00012").unwrap().emit().is_err());
        let foreign = Record::unlisted("FOO X=1 ");
        assert_eq!((foreign.written().as_str(), foreign.is_listed()), ("FOO X=1", false));
        assert_eq!(foreign.emit().unwrap_err().to_string(), "'FOO X=1' is not in the manual; armctl does not write it");
    }

    #[test]
    fn an_error_has_the_column_of_the_difference() {
        let error = |text| TWO.parse(text).unwrap_err().to_string();
        assert_eq!(error("MCNT XN01=0000"), "'MCNT CN' is expected at column 6");
        assert_eq!(error("MCNT CN01=x"), "count: 'x' is not a number, 0 to 9999 at column 11");
        assert_eq!(error("MCNT CN01=0000 R"), "unexpected text ' R' at column 15");
        assert_eq!(error(""), "'MCNT CN' is expected at column 1");
    }
}
