//! Numbers on a command line within the ranges of protocol fields, and reads of several values.

use super::link::Link;
use super::refusal;
use crate::prelude::basics::*;
use armctl_controller::names::Kind as NameKind;
use armctl_controller::toyo::field::{Field, Form};
use armctl_controller::toyo::names as names_of;

/// A number or a range: `5`, `1-5`, `1..5`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Numbers(Vec<i32>);

impl Numbers {
    /// Parses a number or a range; each number must be valid for the field.
    pub fn parse(field: &Field, text: &str) -> Result<Self, String> {
        Ok(Self(user_input::range(text, |end| number(field, end))?.collect()))
    }

    /// All numbers that the user typed, in order and without duplicates; all numbers of the field if the user typed
    /// none.
    pub fn of(typed_numbers: &[Self], field: &Field) -> Vec<i32> {
        if typed_numbers.is_empty() {
            return match field.form {
                Form::Number(number) => (number.least..=number.most).collect(),
                _ => Vec::new(),
            };
        }
        user_input::without_duplicates(typed_numbers.iter().flat_map(|numbers| &numbers.0).copied())
    }
}

/// Parses a number within the range of the field. A decimal number becomes an integer in units of its last digit.
pub fn number(field: &Field, text: &str) -> Result<i32, String> {
    match field.read(text) {
        Ok(Value::Number(number)) => Ok(number),
        Ok(_) => Err(format!("{} is not a number", field.name)),
        Err(error) => Err(error.to_string()),
    }
}

/// Parses a number, an address such as `TN1`, or a name that the user assigned.
pub fn named<T>(kind: NameKind, text: &str, parse: impl Fn(&str) -> Result<T, String>) -> Result<T, String> {
    let any = names_of::address_of(kind, 1).unwrap_or_default();
    names::parse_or_name(&[kind], &any, text, |text| {
        let prefix = any.trim_end_matches(|c: char| c.is_ascii_digit());
        let front = text.get(..prefix.len()).filter(|front| front.eq_ignore_ascii_case(prefix));
        parse(if front.is_some() { &text[prefix.len()..] } else { text })
    })
}

/// Number in an answer as a byte. A larger number becomes 255.
pub fn saturated_byte(record: &Record, name: &str) -> u8 {
    u8::try_from(record.number(name).unwrap_or(0)).unwrap_or(u8::MAX)
}

/// Reads several values in order. The first refusal or failure ends the work. A dry run records all requests.
pub async fn ask_all(link: &mut Link, screen: &Screen, what: &str, requests: &[Request]) -> Result<Vec<Record>> {
    link.plan_all(requests)?;
    let mut progress = (requests.len() > 1).then(|| screen.items_progress(what, requests.len() as u64));
    let mut answers = Vec::with_capacity(requests.len());
    for request in requests {
        answers.push(link.ask(request).await?);
        if let Some(progress) = &mut progress {
            progress.advance(1);
        }
    }
    Ok(answers)
}

/// Reads a value back after a command. A dry run records the request.
pub async fn read_back(link: &mut Link, order: &Request, read: &Request) -> Result<Record> {
    link.ask(read).await.map_err(|failure| {
        let message = format!(
            "the controller accepted {}, but the value could not be read back: {}",
            order.text(),
            failure.message
        );
        Failure::new(Kind::OutcomeUnknown, message).hint(refusal::verification_hint(order.command()))
    })
}

/// Failure: the value that was read back differs.
pub fn read_back_mismatch(order: &Request, value: &str) -> Failure {
    Failure::new(Kind::ConditionNotMet, format!("the controller accepted {}, but {value}", order.text()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_controller::toyo::table::Command;

    fn field() -> &'static Field {
        &Command::Mcnt.row().requests[0].fields[0]
    }

    #[test]
    fn numbers_and_ranges_are_parsed_without_repetition() {
        let parse = |text| Numbers::parse(field(), text);
        let typed_numbers = [parse("7").unwrap(), parse("2-4").unwrap(), parse("3..5").unwrap()];
        assert_eq!(Numbers::of(&typed_numbers, field()), [7, 2, 3, 4, 5]);
        assert_eq!(Numbers::of(&[], field()).len(), 99);
        assert_eq!(parse("100").unwrap_err(), "counter: 100 is out of range (a number, 1 to 99)");
        assert_eq!(parse("5-2").unwrap_err(), "the end of the range is before its start; did you mean 2-5?");
        assert!(parse("0-3").is_err() && parse("x").is_err() && parse("").is_err() && parse("-3").is_err());
    }
}
