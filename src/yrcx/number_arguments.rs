//! Numbers of points, variables and tasks on a command line, in the ranges of the protocol's fields.

use armctl_controller::user_input;
use armctl_controller::yrcx::table::{Command, Field};
use armctl_controller::yrcx::value::{Key, Value};

/// One number or a range of numbers: `5`, `0..29`, `SGI0..SGI5`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Numbers(Vec<i32>);

impl Numbers {
    /// Parses a number or a range for a field of a command; each number must be valid for the field.
    pub fn parse(command: Command, key: Key, text: &str) -> Result<Self, String> {
        let field = field(command, key)?;
        let numbers: Vec<i32> = user_input::range(text, |end| number(field, end))?.collect();
        numbers.iter().try_for_each(|number| field.accept(&Value::Int(*number)))?;
        Ok(Self(numbers))
    }

    /// All numbers, without duplicates, in the order typed.
    pub fn of(given: &[Self]) -> Vec<i32> {
        user_input::without_duplicates(given.iter().flat_map(|numbers| &numbers.0).copied())
    }
}

/// One name that ends in a number, or a range of such names: `DO2`, `SO20..SO27`, `SI20-27`.
#[derive(Debug, Clone)]
pub struct Series<T>(Vec<T>);

impl<T: Clone + Send + Sync + 'static> Series<T> {
    /// Parser for a series; `read` parses one name.
    pub fn reader(
        read: impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static,
    ) -> impl Fn(&str) -> Result<Self, String> + Clone + Send + Sync + 'static {
        move |text| user_input::series(text, &read).map(Self)
    }

    /// All items of several series.
    pub fn all(given: &[Self]) -> impl Iterator<Item = &T> {
        given.iter().flat_map(|series| &series.0)
    }
}

/// Parses a single number for a field of a command.
pub fn single(command: Command, key: Key, text: &str) -> Result<i32, String> {
    number(field(command, key)?, text)
}

/// Formats a number in the notation of the field, for example `SGI5`.
pub fn named(command: Command, key: Key, number: i32) -> String {
    field(command, key).map_or_else(|_| number.to_string(), |field| field.show(&Value::Int(number)))
}

/// Formats numbers in the order given, and consecutive numbers as a range, for example `5..9`.
pub fn runs(numbers: &[i32]) -> String {
    user_input::format_ranges(numbers, "..")
}

fn field(command: Command, key: Key) -> Result<&'static Field, String> {
    command.row().request().find(|field| field.key == key).ok_or_else(|| format!("{} has no {key}", command.row().id))
}

fn number(field: &Field, text: &str) -> Result<i32, String> {
    let text = text.trim();
    // The field reads names of variables only in capitals, so try capitals too.
    let parsed = field.parse(text).or_else(|error| field.parse(&text.to_ascii_uppercase()).map_err(|_| error));
    match parsed? {
        Value::Int(number) => field.accept(&Value::Int(number)).map(|()| number),
        Value::Real(_) | Value::Text(_) => Err(format!("'{text}' is not a whole number")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_ranges() {
        let points = |text| Numbers::parse(Command::PointGet, Key::Point, text);
        let given = [points("7").unwrap(), points("2..4").unwrap(), points("3-5").unwrap()];
        assert_eq!(Numbers::of(&given), [7, 2, 3, 4, 5]);
        assert_eq!(runs(&Numbers::of(&given)), "7, 2..5");
        assert_eq!(Numbers::of(&[points("P7").unwrap(), points("p19..P21").unwrap()]), [7, 19, 20, 21]);
        assert_eq!(points("Pick").unwrap_err(), "'Pick' is not a whole number");
        assert_eq!(Numbers::of(&[points("0..29999").unwrap()]).len(), 30_000);
        assert_eq!(points("0..30000").unwrap_err(), "30000 is out of range; allowed: 0 to 29999");
        assert_eq!(points("5..2").unwrap_err(), "the end of the range is before its start; did you mean 2..5?");
        assert!(points("").is_err() && points("-3").is_err() && points("x").is_err() && points("1..").is_err());
    }

    #[test]
    fn variables_have_names() {
        let variables = |text| Numbers::parse(Command::VarGet, Key::Variable, text);
        assert_eq!(Numbers::of(&[variables("sgi30..SGI31").unwrap(), variables("SGR0").unwrap()]), [30, 31, 256]);
        assert!(variables("SGI30..SGR1").unwrap_err().contains("SGI0 to SGI31, SGR0 to SGR31"));
        assert_eq!(named(Command::VarGet, Key::Variable, 257), "SGR1");
    }
}
