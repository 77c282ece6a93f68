//! A block or a part of one: fixed words with fields between them.

use std::ops::Range;

use thiserror::Error;

use super::field::{Field, FieldError, Form, Mask, Value};

/// Text with fields in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// As the manual prints it, with `{}` in the place of each field.
    pub text: &'static str,
    /// The fields, in their order.
    pub fields: &'static [Field],
}

/// Values in the places of a layout.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Record {
    layout: Layout,
    values: Vec<Value>,
}

/// Why a text does not fit a layout, and where.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{what} at column {}", at + 1)]
pub struct LayoutError {
    /// Bytes before the place.
    pub at: usize,
    /// What is wrong there.
    pub what: LayoutProblem,
}

/// What is wrong in one place of a text.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum LayoutProblem {
    /// Other words than expected.
    #[error("'{expected}' is expected")]
    Words {
        /// What should stand there.
        expected: &'static str,
    },
    /// No value of the field.
    #[error(transparent)]
    Field(#[from] FieldError),
    /// More than there should be.
    #[error("'{}' is too much", found.escape_debug())]
    Rest {
        /// What is left.
        found: String,
    },
    /// What came from a controller and is kept as it came; it is never sent.
    #[error("'{}' is not in the manual, and is not written", found.escape_debug())]
    Unlisted {
        /// As it came.
        found: String,
    },
    /// Not as many values as fields.
    #[error("{found} values for {expected} fields")]
    Count {
        /// Fields.
        expected: usize,
        /// Values.
        found: usize,
    },
}

/// What a controller holds and the manual does not list, such as the instruction of a newer version: kept as it came.
pub const UNLISTED: Layout =
    Layout::new("{}", &[Field::new("unlisted", Form::Text, "what the manual does not list, as it came")]);

impl Layout {
    /// Only words.
    pub const fn words(text: &'static str) -> Self {
        Self { text, fields: &[] }
    }

    /// Words and fields.
    pub const fn new(text: &'static str, fields: &'static [Field]) -> Self {
        Self { text, fields }
    }

    /// The text with values in it, each in its form and range.
    pub fn emit(&self, values: &[Value]) -> Result<String, LayoutProblem> {
        if values.len() != self.fields.len() {
            return Err(LayoutProblem::Count { expected: self.fields.len(), found: values.len() });
        }
        if let (true, [Value::Text(found)]) = (*self == UNLISTED, values) {
            return Err(LayoutProblem::Unlisted { found: found.clone() });
        }
        self.join(|index, field| Ok(field.emit(&values[index])?))
    }

    /// The text with the values in it that are known, each in its form and range; `?` stands for the others.
    pub fn sketch(&self, values: &[Option<Value>]) -> Result<String, LayoutProblem> {
        if values.len() != self.fields.len() {
            return Err(LayoutProblem::Count { expected: self.fields.len(), found: values.len() });
        }
        self.join(|index, field| match &values[index] {
            Some(value) => Ok(field.emit(value)?),
            None => Ok("?".to_owned()),
        })
    }

    /// The values in a text. Outer blanks, and more blanks than needed between items, do not matter (ambiguity A7).
    pub fn parse(&self, text: &str) -> Result<Record, LayoutError> {
        let mut values = Vec::with_capacity(self.fields.len());
        self.scan(text, |_, value, _| values.push(value))?;
        Ok(Record { layout: *self, values })
    }

    /// As [`Layout::parse`], but a value that is not in its form is kept as it came, as [`Value::Text`], which is never
    /// sent. Words and the places of the values must be right.
    pub fn parse_kept(&self, text: &str) -> Result<Record, LayoutError> {
        let mut values = Vec::with_capacity(self.fields.len());
        self.walk(text, true, |_, value, _| values.push(value))?;
        Ok(Record { layout: *self, values })
    }

    /// Hands over every value in a text with its field and the bytes it takes, up to the first that does not fit.
    pub fn scan(&self, text: &str, found: impl FnMut(&'static Field, Value, Range<usize>)) -> Result<(), LayoutError> {
        self.walk(text, false, found)
    }

    fn walk(
        &self,
        text: &str,
        keeps: bool,
        mut found: impl FnMut(&'static Field, Value, Range<usize>),
    ) -> Result<(), LayoutError> {
        let mut rest = text.trim_start_matches(' ');
        let at = |rest: &str| text.len() - rest.len();
        let mut words = self.text.split("{}");
        let mut fields = self.fields.iter();
        loop {
            let expected = words.next().unwrap_or_default();
            rest = pass(expected, rest)
                .map_err(|rest| LayoutError { at: at(rest), what: LayoutProblem::Words { expected } })?;
            let Some(field) = fields.next() else { break };
            let mut taken = field.take(rest);
            if keeps {
                let (next, is_last) = (words.clone().next().unwrap_or_default(), fields.len() == 0);
                let fits = |left| pass(next, left).is_ok_and(|left| !is_last || left.trim_end_matches(' ').is_empty());
                if !taken.as_ref().is_ok_and(|(_, left)| fits(left)) {
                    taken = kept(rest, next, is_last).map_or(taken, Ok);
                }
            }
            let (value, left) = taken.map_err(|error| LayoutError { at: at(rest), what: error.into() })?;
            found(field, value, at(rest)..at(left));
            rest = left;
        }
        match rest.trim_end_matches(' ') {
            "" => Ok(()),
            found => Err(LayoutError { at: at(rest), what: LayoutProblem::Rest { found: found.to_owned() } }),
        }
    }

    /// Values for the fields, which may be out of range: what a controller holds.
    pub fn record(&self, values: Vec<Value>) -> Result<Record, LayoutProblem> {
        if values.len() == self.fields.len() {
            Ok(Record { layout: *self, values })
        } else {
            Err(LayoutProblem::Count { expected: self.fields.len(), found: values.len() })
        }
    }

    /// Words and fields joined, each field as `write` has it.
    fn join(
        &self,
        mut write: impl FnMut(usize, &Field) -> Result<String, LayoutProblem>,
    ) -> Result<String, LayoutProblem> {
        let mut text = String::with_capacity(self.text.len() + 8 * self.fields.len());
        for (index, words) in self.text.split("{}").enumerate() {
            text.push_str(words);
            if let Some(field) = self.fields.get(index) {
                text.push_str(&write(index, field)?);
            }
        }
        Ok(text)
    }
}

/// A value that is not in its form: all up to the words that follow it.
fn kept<'t>(text: &'t str, next: &str, is_last: bool) -> Option<(Value, &'t str)> {
    let end = match next {
        "" if is_last => text.len(),
        "" => return None,
        next => text.find(next)?,
    };
    let (own, rest) = text.split_at(end);
    let own = own.trim_matches(' ');
    (!own.is_empty()).then(|| (Value::Text(own.to_owned()), rest))
}

/// What follows the expected words; a blank stands for one or more. On failure, the place where they differ.
fn pass<'t>(words: &str, mut text: &'t str) -> Result<&'t str, &'t str> {
    for expected in words.chars() {
        let rest = text.strip_prefix(expected).ok_or(text)?;
        text = if expected == ' ' { rest.trim_start_matches(' ') } else { rest };
    }
    Ok(text)
}

impl Record {
    /// Its layout.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Its values, in the order of the fields.
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

    /// A text that is kept as it came.
    pub fn unlisted(text: &str) -> Self {
        Self { layout: UNLISTED, values: vec![Value::Text(text.trim_matches(' ').to_owned())] }
    }

    /// The same with another value in a field; without such a field, the same.
    #[must_use]
    pub fn with(mut self, name: &str, value: Value) -> Self {
        if let Some(index) = self.layout.fields.iter().position(|field| field.name == name) {
            self.values[index] = value;
        }
        self
    }

    /// Whether all of it is in the manual's form.
    pub fn is_listed(&self) -> bool {
        self.layout != UNLISTED && self.pairs().all(|(field, value)| field.is_listed(value))
    }

    /// A number, in units of its last decimal; `None` if there is no such number.
    pub fn number(&self, name: &str) -> Option<i32> {
        if let Value::Number(number) = self.value(name)? { Some(*number) } else { None }
    }

    /// A word as on the line.
    pub fn word(&self, name: &str) -> Option<&'static str> {
        if let Value::Word(word) = self.value(name)? { Some(word) } else { None }
    }

    /// A byte of two hexadecimal digits.
    pub fn byte(&self, name: &str) -> Option<u8> {
        if let Value::Byte(byte) = self.value(name)? { Some(*byte) } else { None }
    }

    /// The bits of a port.
    pub fn bits(&self, name: &str) -> Option<u8> {
        if let Value::Bits(bits) = self.value(name)? { Some(*bits) } else { None }
    }

    /// Conditions or orders for a port.
    pub fn mask(&self, name: &str) -> Option<Mask> {
        if let Value::Mask(mask) = self.value(name)? { Some(*mask) } else { None }
    }

    /// A text without form.
    pub fn text(&self, name: &str) -> Option<&str> {
        if let Value::Text(text) = self.value(name)? { Some(text) } else { None }
    }

    /// As it is sent: every value in form and range.
    pub fn emit(&self) -> Result<String, LayoutProblem> {
        self.layout.emit(&self.values)
    }

    /// In form, whatever the ranges: what a controller answers.
    pub fn written(&self) -> String {
        let write = |index: usize, field: &Field| Ok(field.written(&self.values[index]));
        self.layout.join(write).unwrap_or_default()
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
    fn what_is_sent_is_what_is_printed() {
        let values = [Value::Number(1), Value::Number(0)];
        assert_eq!(TWO.emit(&values).unwrap(), "MCNT CN01=0000");
        assert_eq!(TWO.parse("MCNT CN01=0000").unwrap().values(), values);
        assert_eq!(TWO.emit(&values[..1]), Err(LayoutProblem::Count { expected: 2, found: 1 }));
    }

    #[test]
    fn blanks_do_not_matter() {
        assert_eq!(TWO.parse("  MCNT   CN01=0012  ").unwrap().written(), "MCNT CN01=0012");
    }

    #[test]
    fn a_value_that_is_not_in_its_form_is_kept_and_never_sent() {
        let kept = |text: &str| TWO.parse_kept(text).map(|record| (record.written(), record.is_listed()));
        assert_eq!(kept("MCNT CN01=0000"), Ok(("MCNT CN01=0000".into(), true)));
        assert_eq!(kept("MCNT CN1=00012"), Ok(("MCNT CN1=00012".into(), false)));
        assert_eq!(kept("MCNT CN01=1 2"), Ok(("MCNT CN01=1 2".into(), false)));
        assert!(kept("MCNT CM01=0000").is_err() && kept("MCNT CN01").is_err() && kept("MCNT CN01=").is_err());
        assert!(TWO.parse_kept("MCNT CN01=00012").unwrap().emit().is_err());
        let foreign = Record::unlisted("FOO X=1 ");
        assert_eq!((foreign.written().as_str(), foreign.is_listed()), ("FOO X=1", false));
        assert_eq!(foreign.emit().unwrap_err().to_string(), "'FOO X=1' is not in the manual, and is not written");
    }

    #[test]
    fn the_place_of_a_mistake_is_told() {
        let error = |text| TWO.parse(text).unwrap_err().to_string();
        assert_eq!(error("MCNT XN01=0000"), "'MCNT CN' is expected at column 6");
        assert_eq!(error("MCNT CN01=x"), "count: 'x' is not a number, 0 to 9999 at column 11");
        assert_eq!(error("MCNT CN01=0000 R"), "' R' is too much at column 15");
        assert_eq!(error(""), "'MCNT CN' is expected at column 1");
    }
}
