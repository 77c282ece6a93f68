//! Command words. They are parsed with the table, but checked independently of the client, and more strictly than real
//! controllers are known to do.

use super::alarms::{AlarmSource, Fault, UNKNOWN_COMMAND};
use crate::refuse_if;
use crate::yrcx::answer::Status;
use crate::yrcx::image::{COMMAND_WORDS, Words};
use crate::yrcx::table::parameter::Parameter;
use crate::yrcx::table::{Charset, Command, Field, Form, Row, Show};
use crate::yrcx::value::{Key, Value, Values};

/// Maximum number of robots.
pub(super) const ROBOTS: usize = 4;

/// A valid command.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Request {
    pub(super) row: &'static Row,
    pub(super) words: Words,
    values: Values,
}

impl Request {
    /// Decodes WI0 to WI15.
    pub(super) fn read(words: &Words) -> Result<Self, Fault> {
        let row = Row::from_word(words[0]).ok_or_else(|| {
            Fault::new(UNKNOWN_COMMAND, AlarmSource::Slot, format!("WI0: {:#06X} is not a valid command", words[0]))
        })?;
        let mut values = Values::default();
        let mut used: Words = [0; COMMAND_WORDS];
        for field in row.request().filter(|field| counts(field, |key| raw(row, key, words))) {
            let value = read(field, words).map_err(|why| wrong(field, &why))?;
            for word in used.iter_mut().skip(field.word).take(field.size()) {
                *word |= field.mask();
            }
            values.set(field.key, value);
        }
        let stray = words.iter().zip(&used).enumerate().skip(1).find(|(_, (word, used))| **word & !**used != 0);
        if let Some((at, (word, used))) = stray {
            return Err(Fault::of_words(format!("WI{at}: bits {:#06X} must be 0", word & !used)));
        }
        let request = Self { row, words: *words, values };
        request.check()?;
        Ok(request)
    }

    /// Integer of a field; 0 if the field is not in use.
    pub(super) fn int(&self, key: Key) -> i32 {
        self.values.int(key).unwrap_or_default()
    }

    /// Integer of a field that is used as an index. The layout limits the integer to valid indexes.
    pub(super) fn index(&self, key: Key) -> usize {
        usize::try_from(self.int(key)).unwrap_or_default()
    }

    /// Integer of a field; `None` if the field is not in use.
    pub(super) fn maybe(&self, key: Key) -> Option<i32> {
        self.values.int(key)
    }

    pub(super) fn text(&self, key: Key) -> &str {
        self.values.text(key).unwrap_or_default()
    }

    /// Value for a variable: an integer or a real number.
    pub(super) fn value(&self) -> Option<&Value> {
        self.values.value(Key::Value)
    }

    pub(super) fn axes(&self) -> [i32; 4] {
        Key::AXES.map(|key| self.int(key))
    }

    /// Index of the robot, from 0. A command without a robot applies to the first robot.
    pub(super) fn robot(&self) -> usize {
        self.index(Key::Robot).saturating_sub(1)
    }

    /// Words of an end status or of continuous output, with `values` at their positions in the table.
    pub(super) fn reply(&self, status: Status, values: &Values) -> Words {
        let mut words = [0; COMMAND_WORDS];
        let look = |key| values.int(key).or_else(|| self.values.int(key)).unwrap_or_default();
        for field in self.row.answer().filter(|field| counts(field, look)) {
            // The answer repeats fields of the command.
            if let Some(value) = values.value(field.key).or_else(|| self.values.value(field.key)) {
                field.write(&mut words, value).expect("the answer of the simulator fits its field");
            }
        }
        words[0] = status.word();
        words
    }

    /// Checks constraints on several fields.
    fn check(&self) -> Result<(), Fault> {
        match self.row.command {
            Command::PalletSet => {
                let places: i64 =
                    [Key::CountX, Key::CountY, Key::CountZ].map(|key| i64::from(self.int(key))).iter().product();
                if (1..=32_767).contains(&places) {
                    return Ok(());
                }
                Err(Fault::of_words(format!("a pallet cannot have {places} positions")))
            }
            Command::ParamSet | Command::ParamGet => {
                let parameter = Parameter::from_number(self.int(Key::Parameter));
                let parameter = parameter.ok_or_else(|| Fault::of_words("WI2: no such parameter"))?;
                if parameter.per_axis != (self.int(Key::Axes) != 0) {
                    return Err(Fault::of_words(format!("WI3: {} is not possible with this axis", parameter.name)));
                }
                let (least, most) = parameter.span;
                if self.row.command == Command::ParamSet && !(least..=most).contains(&self.int(Key::Value)) {
                    return Err(Fault::of_words(format!("WI4: {} is out of range", parameter.name)));
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }
}

/// Value of another field of the command. The condition of a field depends on this value.
fn raw(row: &Row, key: Key, words: &Words) -> i32 {
    let field = row.request().find(|field| field.key == key);
    match field.map(|field| field.read(words)) {
        Some(Value::Int(number)) => number,
        _ => 0,
    }
}

/// Whether a field is in use, according to its condition.
fn counts(field: &Field, look: impl Fn(Key) -> i32) -> bool {
    field.when.is_none_or(|when| (when.least..=when.most).contains(&look(when.key)))
}

fn wrong(field: &Field, why: &str) -> Fault {
    Fault::of_words(format!("WI{} {}: {why}", field.word, field.key))
}

/// Decodes a field. Accepts only values that the manual allows.
fn read(field: &Field, words: &Words) -> Result<Value, String> {
    if let Form::Text(charset) = field.form {
        return text(charset, &words[field.word..field.word + field.size()]).map(Value::Text);
    }
    let value = field.read(words);
    match value {
        Value::Int(number) => number_is_allowed(field, number)?,
        Value::Real(number) if !number.is_finite() => return Err(format!("{number} is not a number")),
        Value::Real(_) | Value::Text(_) => {}
    }
    Ok(value)
}

fn number_is_allowed(field: &Field, number: i32) -> Result<(), String> {
    if !field.spans.is_empty() && field.spans.iter().all(|&(least, most)| number < least || number > most) {
        return Err(format!("{number} is out of range"));
    }
    let Form::Bits { show, .. } = field.form else { return Ok(()) };
    let fine = match show {
        Show::Choice(choices) => choices.iter().any(|&(code, _)| i32::from(code) == number),
        Show::Set { least, most } => (least..=most).contains(&number.count_ones()),
        Show::Fixed(fixed) => i32::from(fixed) == number,
        // Digits that are not decimal decode as a number above 99.
        Show::Digits => number < 100,
        Show::Number(_) | Show::Version | Show::Revision | Show::FpgaVersion | Show::Variable | Show::Line => true,
    };
    if fine { Ok(()) } else { Err(format!("{number} is not defined here")) }
}

/// Decodes a text. After the text, only padding is allowed.
fn text(charset: Charset, words: &[u16]) -> Result<String, String> {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    let (used, rest) = bytes.split_at(end);
    refuse_if(rest.iter().any(|byte| *byte != 0), "characters after the end".to_owned())?;
    let allowed = |byte: &u8| match charset {
        Charset::Comment => (0x20..=0x7E).contains(byte),
        Charset::Program => byte.is_ascii_uppercase() || byte.is_ascii_digit() || *byte == b'_',
    };
    let length = used.iter().rposition(|byte| *byte != b' ').map_or(0, |last| last + 1);
    let used = &used[..length];
    refuse_if(!used.iter().all(allowed), "a character that is not allowed".to_owned())?;
    refuse_if(used.is_empty() && charset == Charset::Program, "no name".to_owned())?;
    Ok(used.iter().copied().map(char::from).collect())
}
