//! Validated remote command: WI0 to WI15.

use super::codec::{self, Side, WordError};
use super::image::Words;
use super::table::parameter::Parameter;
use super::table::{Command, Row, Rule};
use super::value::{Key, Value, Values};
use crate::Risk;

/// A command with valid words.
#[derive(Debug, Clone, PartialEq)]
pub struct Order {
    row: &'static Row,
    values: Values,
    words: Words,
}

/// Builder of an order.
#[derive(Debug, Clone, PartialEq)]
pub struct Draft {
    command: Command,
    values: Values,
}

impl Command {
    /// Starts an order. Example: `Command::MovePtp.order().with(Key::Point, 19).with(Key::SpeedPercent, 50).build()`.
    pub fn order(self) -> Draft {
        Draft { command: self, values: Values::default() }
    }
}

impl Draft {
    /// Sets a field, and the flags that depend on it. Text is parsed as a value in the unit of the field.
    #[must_use]
    pub fn with(mut self, key: Key, value: impl Into<Value>) -> Self {
        self.values.set(key, value);
        self
    }

    /// Sets a field, unless the value is `None`.
    #[must_use]
    pub fn with_some(self, key: Key, value: Option<impl Into<Value>>) -> Self {
        match value {
            Some(value) => self.with(key, value),
            None => self,
        }
    }

    /// Validates the fields and encodes the words.
    pub fn build(self) -> Result<Order, WordError> {
        let row = self.command.row();
        let mut words = codec::encode(Side::Command, row.request(), &self.values, None)?;
        words[0] |= row.code;
        Order::parse(&words)
    }
}

impl Order {
    /// Decodes the words of a command. Refuses values that the manual does not allow.
    pub fn parse(words: &Words) -> Result<Self, WordError> {
        let unknown =
            || WordError::at(Side::Command, Some(0), None, format!("{:#06X} is not a remote command code", words[0]));
        let row = Row::from_word(words[0]).ok_or_else(unknown)?;
        let values = codec::decode_strictly(row.request(), words)?;
        for rule in row.rules {
            rule.check(row, &values)?;
        }
        Ok(Self { row, values, words: *words })
    }

    /// Row of the table.
    pub fn row(&self) -> &'static Row {
        self.row
    }

    /// Identifier of the command.
    pub fn command(&self) -> Command {
        self.row.command
    }

    /// Risk of the command.
    pub fn risk(&self) -> Risk {
        self.row.risk
    }

    /// Values of the fields, including defaults.
    pub fn values(&self) -> &Values {
        &self.values
    }

    /// Words WI0 to WI15 of the order.
    pub fn words(&self) -> &Words {
        &self.words
    }

    /// Whether the controller answers repeatedly until the status reset (continuous output, 4.7.4).
    pub fn is_continuous(&self) -> bool {
        self.values.int(Key::Continuous) == Some(1)
    }
}

impl Rule {
    /// Validates the values of a command.
    fn check(self, row: &Row, values: &Values) -> Result<(), WordError> {
        let int = |key| values.int(key).unwrap_or_default();
        let wrong = |key, problem: String| {
            let word = row.request().find(|field| field.key == key).map(|field| field.word);
            Err(WordError::at(Side::Command, word, Some(key), problem))
        };
        match self {
            Self::PalletSize => {
                let places = [Key::CountX, Key::CountY, Key::CountZ].map(|key| i64::from(int(key)));
                match places.iter().product::<i64>() {
                    1..=32_767 => Ok(()),
                    product => {
                        wrong(Key::CountX, format!("X times Y times Z is {product}; a pallet has 1 to 32767 positions"))
                    }
                }
            }
            Self::ParameterAxis => {
                let Some(parameter) = Parameter::from_number(int(Key::Parameter)) else { return Ok(()) };
                match (parameter.per_axis, int(Key::Axes)) {
                    (true, 0) => wrong(Key::Axes, format!("{} belongs to an axis; set the axis", parameter.name)),
                    (false, 1..) => {
                        wrong(Key::Axes, format!("{} belongs to the robot, not to an axis", parameter.name))
                    }
                    _ => Ok(()),
                }
            }
            Self::ParameterValue => {
                let Some(parameter) = Parameter::from_number(int(Key::Parameter)) else { return Ok(()) };
                let (least, most) = parameter.span;
                match int(Key::Value) {
                    value if (least..=most).contains(&value) => Ok(()),
                    value => wrong(
                        Key::Value,
                        format!(
                            "{value} is out of range for {}; allowed: {least} to {most} {}",
                            parameter.name, parameter.unit
                        )
                        .trim_end()
                        .to_owned(),
                    ),
                }
            }
        }
    }
}
