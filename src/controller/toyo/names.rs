//! Addresses that inventory names can refer to, for example `IN2.1`, `OUT1.3` (ports of the controller itself), `CN05`,
//! `TN1` and `PT012`.

use crate::names::{Grammar, Kind};
use crate::user_input::unsigned;

/// Address notation: bits of internal ports and of ports of station 0, counters, timers and points.
pub const GRAMMAR: Grammar = Grammar { address, prefixes: &["IN", "OUT", "INT", "CN", "TN", "PT", "PN", "F"] };

/// Highest number of a port (DOUT accepts 1 to 99), and of a counter.
const LAST: u8 = 99;

const LAST_TIMER: u8 = 9;
const LAST_POINT: u16 = 999;

/// Parses an address and normalizes it.
fn address(text: &str) -> Option<(Kind, String)> {
    let at = text.find(|c: char| c.is_ascii_digit())?;
    let (letters, number) = text.split_at(at);
    let number_of = |digits: &str| unsigned::<u8>(digits).filter(|number| (1..=LAST).contains(number));
    if letters.eq_ignore_ascii_case("PT") {
        let point = unsigned::<u16>(number).filter(|point| (1..=LAST_POINT).contains(point));
        return point.map(|point| (Kind::Point, self::point(point)));
    }
    if letters.eq_ignore_ascii_case("TN") {
        return number_of(number).filter(|timer| *timer <= LAST_TIMER).map(|timer| (Kind::Timer, self::timer(timer)));
    }
    if letters.eq_ignore_ascii_case("CN") {
        return number_of(number).map(|number| (Kind::Counter, counter(number)));
    }
    let (port, bit) = number.split_once('.')?;
    let (port, bit) = (number_of(port)?, number_of(bit).filter(|bit| *bit <= 8)?);
    if letters.eq_ignore_ascii_case("IN") {
        Some((Kind::Input, input(port, bit)))
    } else if letters.eq_ignore_ascii_case("OUT") {
        Some((Kind::Output, output(port, bit)))
    } else {
        None
    }
}

/// Formats the address of an input bit, for example `IN2.1`.
pub fn input(port: u8, bit: u8) -> String {
    format!("IN{port}.{bit}")
}

/// Formats the address of an output bit, for example `OUT1.3`.
pub fn output(port: u8, bit: u8) -> String {
    format!("OUT{port}.{bit}")
}

/// Formats the address of a counter, for example `CN05`.
pub fn counter(number: u8) -> String {
    format!("CN{number:02}")
}

/// Formats the address of a timer, for example `TN1`.
pub fn timer(number: u8) -> String {
    format!("TN{number}")
}

/// Formats the address of a point, for example `PT012`.
pub fn point(row: u16) -> String {
    format!("PT{row:03}")
}

/// Instruction fields that accept a name, with their kind and address prefix.
const FIELDS: [(&str, Kind, &str); 3] =
    [("point", Kind::Point, "PT"), ("counter", Kind::Counter, "CN"), ("timer", Kind::Timer, "TN")];

/// Kind and address prefix for an instruction field; `None` if the field accepts no name.
pub fn of_field(name: &str) -> Option<(Kind, &'static str)> {
    FIELDS.iter().find(|(field, ..)| *field == name).map(|(_, kind, prefix)| (*kind, *prefix))
}

/// Returns the number in an address, for example 12 for `PT012`.
pub fn number(address: &str) -> Option<i32> {
    address.trim_start_matches(|c: char| c.is_ascii_alphabetic()).parse().ok()
}

/// The address of a number in an instruction field.
pub fn address_of(kind: Kind, number: i32) -> Option<String> {
    Some(match kind {
        Kind::Point => point(u16::try_from(number).ok()?),
        Kind::Counter => counter(u8::try_from(number).ok()?),
        Kind::Timer => timer(u8::try_from(number).ok()?),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_have_one_spelling() {
        let written = |text| (GRAMMAR.address)(text).map(|(_, address)| address);
        for (text, address) in [
            ("in2.1", "IN2.1"),
            ("OUT01.3", "OUT1.3"),
            ("cn5", "CN05"),
            ("CN05", "CN05"),
            ("tn1", "TN1"),
            ("pt12", "PT012"),
        ] {
            assert_eq!(written(text).as_deref(), Some(address), "{text}");
        }
        for text in
            ["", "1.3", "OUT1", "OUT1.9", "OUT0.1", "CN0", "CN100", "PN01.1", "TN0", "TN10", "PT0", "PT1000", "clamp"]
        {
            assert_eq!(written(text), None, "{text}");
        }
    }
}
