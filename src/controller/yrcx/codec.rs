//! Codec between values and words. It uses the layouts of the table.

use std::collections::BTreeSet;
use std::fmt;

use thiserror::Error;

use super::alarm::{Alarm, INPUT_FORMAT};
use super::image::Words;
use super::table::{Field, Form, Presence, Show, When};
use super::value::{Key, Value, Values};

/// Direction of the words: a command, or the answer to a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Side {
    /// WI words: from the master to the controller.
    Command,
    /// WO words: from the controller to the master.
    Answer,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Command => "WI",
            Self::Answer => "WO",
        })
    }
}

/// Why values cannot be encoded or words cannot be decoded.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{place}{problem}")]
pub struct WordError {
    /// Location of the error, as far as it is known.
    pub place: FieldLocation,
    /// The problem.
    pub problem: String,
    /// The alarm that a controller raises for this error, if the manual specifies one (4.2.1).
    pub alarm: Option<Alarm>,
}

/// Location of an error.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldLocation {
    /// Command words (WI) or answer words (WO).
    pub side: Side,
    /// Word 0 to 15; `None` for a value without a word.
    pub word: Option<usize>,
    /// The field; `None` for words without a field.
    pub key: Option<Key>,
}

impl fmt::Display for FieldLocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.word, self.key) {
            (Some(word), Some(key)) => write!(f, "{}{word} {key}: ", self.side),
            (Some(word), None) => write!(f, "{}{word}: ", self.side),
            (None, Some(key)) => write!(f, "{key}: "),
            (None, None) => Ok(()),
        }
    }
}

impl WordError {
    pub(super) fn of_field(side: Side, field: &Field, problem: impl Into<String>) -> Self {
        Self::at(side, Some(field.word), Some(field.key), problem)
    }

    pub(super) fn at(side: Side, word: Option<usize>, key: Option<Key>, problem: impl Into<String>) -> Self {
        Self { place: FieldLocation { side, word, key }, problem: problem.into(), alarm: None }
    }
}

/// Fields of a layout, in their order.
pub(super) trait Layout: Iterator<Item = &'static Field> + Clone {}

impl<I: Iterator<Item = &'static Field> + Clone> Layout for I {}

/// Encodes values. If an answer depends on values of its command, `context` contains the values of the command. Word 0
/// gets only the values of its fields, and no code or status.
pub(super) fn encode(
    side: Side,
    layout: impl Layout,
    given: &Values,
    context: Option<&Values>,
) -> Result<Words, WordError> {
    let mut words = [0; 16];
    let state = implied(side, layout.clone(), given, context)?;
    let look = look_in(&state, context);
    let mut used = BTreeSet::new();
    for field in layout.clone().filter(|field| counts(field, &look)) {
        let value = match (state.value(field.key), field.form) {
            (Some(value), _) => value.clone(),
            (None, Form::Bits { show: Show::Fixed(fixed), .. }) => Value::from(fixed),
            (None, _) if may_be_missing(field, &look) => continue,
            (None, _) => return Err(WordError::of_field(side, field, format!("missing; {}", field.allowed()))),
        };
        field.accept(&value).and_then(|()| field.write(&mut words, &value)).map_err(|problem| {
            let error = WordError::of_field(side, field, problem);
            // This error means that the values request a position output in both units at once. It is the only error
            // for which the manual specifies an alarm (4.2.1).
            WordError { alarm: (field.key == Key::Report).then_some(INPUT_FORMAT), ..error }
        })?;
        used.insert(field.key);
    }
    match given.iter().find(|(key, _)| !used.contains(key)) {
        Some((key, _)) => Err(misplaced(side, layout, key)),
        None => Ok(words),
    }
}

/// Converts texts to values, and adds the flags that the given values imply. A field whose condition is not met is
/// ignored.
fn implied(side: Side, layout: impl Layout, given: &Values, context: Option<&Values>) -> Result<Values, WordError> {
    let mut state = Values::default();
    // Two passes, because the condition of a field may depend on a later field.
    for _ in 0..2 {
        for field in layout.clone() {
            let Some(value) = given.value(field.key) else { continue };
            if field.when.is_some_and(|when| !when.sets && !holds(when, look_in(&state, context)(when.key))) {
                continue;
            }
            let value = match value {
                Value::Text(text) => field.parse(text).map_err(|problem| WordError::of_field(side, field, problem))?,
                other => other.clone(),
            };
            state.set(field.key, value);
        }
    }
    for field in layout.filter(|field| given.value(field.key).is_some()) {
        let Some(When { key, least, sets: true, .. }) = field.when else { continue };
        match state.int(key) {
            Some(other) if other != least => {
                let problem =
                    format!("is not possible with {key} = {other}, which is set or follows from another field");
                return Err(WordError::of_field(side, field, problem));
            }
            _ => state.set(key, least),
        }
    }
    Ok(state)
}

/// Looks up the number of a key in the values, then in the values of the command. A missing number is 0.
fn look_in(values: &Values, context: Option<&Values>) -> impl Fn(Key) -> i32 {
    move |key| values.int(key).or_else(|| context?.int(key)).unwrap_or_default()
}

fn holds(when: When, value: i32) -> bool {
    (when.least..=when.most).contains(&value)
}

/// Whether a field is in use. This depends on the value of another field.
fn counts(field: &Field, look: impl Fn(Key) -> i32) -> bool {
    field.when.is_none_or(|when| holds(when, look(when.key)))
}

/// Whether a field may be missing. The words of a missing field are 0.
fn may_be_missing(field: &Field, look: impl Fn(Key) -> i32) -> bool {
    match field.need {
        Presence::Required => false,
        Presence::Optional => true,
        Presence::OfAxis(axis) => look(Key::AxisFlag) == 1 && look(Key::Axes) >> (axis - 1) & 1 == 0,
    }
}

fn misplaced(side: Side, mut layout: impl Layout, key: Key) -> WordError {
    let problem = match layout.find(|field| field.key == key).and_then(|field| field.when) {
        Some(when) => format!("is not possible with this {}", when.key),
        None => "this command has no such field".to_owned(),
    };
    WordError::at(side, None, Some(key), problem)
}

/// The fields that `words` use, with their values. The words can have any content.
pub(super) fn read<'a>(
    layout: impl Layout + 'a,
    words: &'a Words,
    context: Option<&'a Values>,
) -> impl Iterator<Item = (&'static Field, Value)> + 'a {
    let flags = layout.clone();
    let look = move |key| {
        let own = flags.clone().find(|field| field.key == key).map(|field| field.read(words));
        match own {
            Some(Value::Int(number)) => number,
            _ => context.and_then(|context| context.int(key)).unwrap_or_default(),
        }
    };
    layout.filter(move |field| counts(field, &look)).map(|field| (field, field.read(words)))
}

/// Bits in words 1 to 15 that no field uses. Each item is a word number and a mask.
pub(super) fn strays(
    layout: impl Layout,
    words: &Words,
    context: Option<&Values>,
) -> impl Iterator<Item = (usize, u16)> {
    let mut left = *words;
    left[0] = 0;
    for (field, _) in read(layout, words, context) {
        for word in left.iter_mut().skip(field.word).take(field.size()) {
            *word &= !field.mask();
        }
    }
    left.into_iter().enumerate().filter(|(_, bits)| *bits != 0)
}

/// Decodes a command. Accepts only values that the manual allows.
pub(super) fn decode_strictly(layout: impl Layout, words: &Words) -> Result<Values, WordError> {
    let side = Side::Command;
    let mut values = Values::default();
    for (field, value) in read(layout.clone(), words, None) {
        field.accept(&value).map_err(|problem| {
            let alarm = (field.key == Key::Report).then_some(INPUT_FORMAT);
            WordError { alarm, ..WordError::of_field(side, field, problem) }
        })?;
        values.set(field.key, value);
    }
    match strays(layout, words, None).next() {
        Some((word, bits)) => {
            Err(WordError::at(side, Some(word), None, format!("bits {bits:#06x} must be 0 here, but are set")))
        }
        None => Ok(values),
    }
}
