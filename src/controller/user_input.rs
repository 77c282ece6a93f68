//! Parser of user input, for example `0x1F`, `1..5`, `B0=7` or `on`. All families and commands use it, with the same
//! error messages.

use std::collections::HashSet;
use std::fmt::Display;
use std::hash::Hash;
use std::ops::RangeInclusive;

use thiserror::Error;

/// A range whose first end is greater than its last end.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the end of the range is before its start; did you mean {meant}?")]
pub struct RangeError {
    /// The range with its ends in the right order, for the error message.
    pub meant: String,
}

impl From<RangeError> for String {
    fn from(error: RangeError) -> Self {
        error.to_string()
    }
}

/// Parses an integer: decimal, or hexadecimal after `0x`, with an optional sign.
pub fn integer(text: &str) -> Option<i64> {
    let (is_negative, digits) = match text.as_bytes() {
        [b'-', ..] => (true, &text[1..]),
        [b'+', ..] => (false, &text[1..]),
        _ => (false, text),
    };
    let (digits, radix) = match after_0x(digits) {
        Some(digits) => (digits, 16),
        None => (digits, 10),
    };
    if digits.is_empty() || !digits.chars().all(|digit| digit.is_digit(radix)) {
        return None;
    }
    let magnitude = i64::from_str_radix(digits, radix).ok()?;
    Some(if is_negative { -magnitude } else { magnitude })
}

/// Parses an integer without a sign; `None` if it does not fit the type.
pub fn unsigned<T: TryFrom<i64>>(text: &str) -> Option<T> {
    let starts_with_digit = text.starts_with(|first: char| first.is_ascii_digit());
    integer(text).filter(|_| starts_with_digit).and_then(|number| T::try_from(number).ok())
}

/// Parses a hexadecimal code, with or without `0x`.
pub fn code<T: TryFrom<u32>>(text: &str) -> Option<T> {
    let digits = after_0x(text).unwrap_or(text);
    let is_hex = digits.bytes().all(|byte| byte.is_ascii_hexdigit());
    u32::from_str_radix(digits, 16).ok().filter(|_| is_hex).and_then(|number| T::try_from(number).ok())
}

fn after_0x(text: &str) -> Option<&str> {
    text.strip_prefix("0x").or_else(|| text.strip_prefix("0X"))
}

/// Parses one item, or a range that includes both ends. Examples: `5`, `1..5`, `1-5`, `B0..B9`, `B0-9`.
///
/// # Errors
/// If `read` fails, or if the ends are in the wrong order.
pub fn range<T: PartialOrd, E: From<RangeError>>(
    text: &str,
    read: impl Fn(&str) -> Result<T, E>,
) -> Result<RangeInclusive<T>, E> {
    let separators = ["..", "-"];
    let ends = separators.into_iter().find_map(|separator| Some((separator, text.split_once(separator)?)));
    let Some((separator, (first_text, last_text))) = ends else { return Ok(read(text)?..=read(text)?) };
    // The second end may omit the common prefix, as in `B0-9`.
    let begins = if last_text.starts_with(|first: char| first.is_ascii_digit()) { letters(first_text) } else { "" };
    let last_text = format!("{begins}{last_text}");
    let (first, last) = (read(first_text)?, read(&last_text)?);
    if first > last {
        return Err(RangeError { meant: format!("{last_text}{separator}{first_text}") }.into());
    }
    Ok(first..=last)
}

/// Parses a name that ends in a number, or a range of such names, for example `DO2` or `DO2..DO5`. A range contains
/// only names that `read` accepts.
///
/// # Errors
/// If `read` fails for the whole text, or if the ends are in the wrong order.
pub fn series<T>(text: &str, read: impl Fn(&str) -> Result<T, String>) -> Result<Vec<T>, String> {
    let wrong = match read(text) {
        Ok(one) => return Ok(vec![one]),
        Err(wrong) => wrong,
    };
    let begins = letters(text);
    let number = |name: &str| {
        let (before, digits) = name.split_at(letters(name).len());
        let is_one = before.eq_ignore_ascii_case(begins) && read(name).is_ok();
        unsigned::<u32>(digits).filter(|_| is_one).ok_or_else(|| wrong.clone())
    };
    let numbers = range(text, number)?;
    Ok(numbers.filter_map(|number| read(&format!("{begins}{number}")).ok()).collect())
}

/// The letters before the number of a name.
fn letters(name: &str) -> &str {
    &name[..name.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(name.len())]
}

/// Removes duplicates and keeps the order.
pub fn without_duplicates<T: Copy + Eq + Hash>(given: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut seen = HashSet::new();
    given.into_iter().filter(|item| seen.insert(*item)).collect()
}

/// Formats numbers and combines consecutive numbers to a range, for example `7, 2..5`.
pub fn format_ranges<T: Copy + Display + Into<i64>>(numbers: &[T], separator: &str) -> String {
    let mut format_ranges: Vec<(T, T)> = Vec::new();
    for &number in numbers {
        match format_ranges.last_mut() {
            Some((_, last)) if (*last).into() + 1 == number.into() => *last = number,
            _ => format_ranges.push((number, number)),
        }
    }
    let run = |&(first, last): &(T, T)| {
        if first.into() == last.into() { first.to_string() } else { format!("{first}{separator}{last}") }
    };
    format_ranges.iter().map(run).collect::<Vec<_>>().join(", ")
}

/// Splits a text into a name and a value, for example `B0=7`.
///
/// # Errors
/// If the `=` is missing. The message names both parts and shows the example.
pub fn split_setting<'t>(text: &'t str, name: &str, value: &str, example: &str) -> Result<(&'t str, &'t str), String> {
    text.split_once('=').ok_or_else(|| format!("write {name}, '=' and {value}, for example {example}"))
}

/// Parses the state of a signal: `on` or `1`, `off` or `0`.
///
/// # Errors
/// If the text is none of these.
pub fn state(text: &str) -> Result<bool, String> {
    match text {
        "on" | "1" => Ok(true),
        "off" | "0" => Ok(false),
        _ => Err(format!("'{text}' is not a valid state; use on or off")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parses_decimal_and_hexadecimal_integers() {
        for (text, number) in [("0", 0), ("-5", -5), ("+5", 5), ("007", 7), ("0xFf", 255), ("0X10", 16), ("-0x10", -16)]
        {
            assert_eq!(integer(text), Some(number), "{text}");
        }
        for junk in ["", "-", "0x", "x10", "1_0", "0x1g", "--1", "0x-1", " 1", "1.0", "99999999999999999999"] {
            assert_eq!(integer(junk), None, "{junk}");
        }
    }

    #[test]
    fn unsigned_numbers_and_codes_fit_their_type() {
        assert_eq!(
            [unsigned::<u8>("255"), unsigned("0xff"), unsigned("256"), unsigned("+1")],
            [Some(255), Some(255), None, None]
        );
        assert_eq!(
            [code::<u8>("28"), code("0xfF"), code("100"), code("+1"), code("")],
            [Some(0x28), Some(255), None, None, None]
        );
    }

    #[test]
    fn ranges_have_two_ends_in_their_order() {
        let read = |text: &str| unsigned::<u16>(text).ok_or_else(|| format!("not {text}"));
        assert_eq!(range("7", read), Ok(7..=7));
        assert_eq!(
            [range("1..5", read), range("1-5", read), range("0x1..0x5", read)],
            [Ok(1..=5), Ok(1..=5), Ok(1..=5)]
        );
        let wrong = |text| range(text, read).unwrap_err();
        assert_eq!(wrong("5-2"), "the end of the range is before its start; did you mean 2-5?");
        assert_eq!([wrong("1..x"), wrong("-3"), wrong("")], ["not x", "not ", "not "]);
        let named = |text: &str| {
            unsigned::<u16>(&text[1..]).filter(|_| text.starts_with('B')).ok_or_else(|| format!("not {text}"))
        };
        assert_eq!(
            [range("B0-B9", named), range("B0..9", named), range("B0-9", named)],
            [Ok(0..=9), Ok(0..=9), Ok(0..=9)]
        );
        assert_eq!(range("B5-2", named).unwrap_err(), "the end of the range is before its start; did you mean B2-B5?");
        assert_eq!(range("B0-C9", named).unwrap_err(), "not C9");
    }

    #[test]
    fn name_ranges_contain_known_names_only() {
        let known = |name: &str| {
            let is_known = ["DO7", "DO10", "DO11", "servo-on"].contains(&name);
            is_known.then(|| name.to_owned()).ok_or_else(|| format!("no {name}"))
        };
        assert_eq!(series("servo-on", known), Ok(vec!["servo-on".to_owned()]));
        for range in ["DO7..DO11", "DO7-11", "DO7-DO11"] {
            assert_eq!(series(range, known).unwrap(), ["DO7", "DO10", "DO11"], "{range}");
        }
        assert_eq!(series("servo-onn", known).unwrap_err(), "no servo-onn");
        assert_eq!(series("DO7-12", known).unwrap_err(), "no DO7-12");
        assert!(series("DO11-7", known).unwrap_err().ends_with("did you mean DO7-DO11?"));
    }

    #[test]
    fn formats_consecutive_numbers_as_ranges() {
        assert_eq!(format_ranges(&without_duplicates([7, 2, 3, 2, 4]), ".."), "7, 2..4");
        assert_eq!(format_ranges(&[1_u16, 3, 4], "-"), "1, 3-4");
        assert_eq!(format_ranges::<u16>(&[], "-"), "");
    }

    #[test]
    fn errors_of_settings_and_states_show_valid_input() {
        assert_eq!(split_setting("B0=7=8", "a variable", "a value", "B0=255"), Ok(("B0", "7=8")));
        let error = split_setting("B0", "a variable", "a value", "B0=255").unwrap_err();
        assert_eq!(error, "write a variable, '=' and a value, for example B0=255");
        assert_eq!((state("on"), state("0")), (Ok(true), Ok(false)));
        assert_eq!(state("2").unwrap_err(), "'2' is not a valid state; use on or off");
    }
}
