//! Addresses that a name of the inventory can stand for: `IN2.1`, `OUT1.3` on the controller itself, `CN05`.

use crate::names::{Grammar, Kind};
use crate::typed::unsigned;

/// Bits of ports of station 0, and counters.
pub const GRAMMAR: Grammar = Grammar { address, prefixes: &["IN", "OUT", "INT", "CN", "PN", "F"] };

/// The last port of a kind that may be there (DOUT takes 1 to 99), and the last counter.
const LAST: u8 = 99;

/// An address as typed, and as it is written.
fn address(text: &str) -> Option<(Kind, String)> {
    let at = text.find(|c: char| c.is_ascii_digit())?;
    let (letters, number) = text.split_at(at);
    let number_of = |digits: &str| unsigned::<u8>(digits).filter(|number| (1..=LAST).contains(number));
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

/// `IN2.1`.
pub fn input(port: u8, bit: u8) -> String {
    format!("IN{port}.{bit}")
}

/// `OUT1.3`.
pub fn output(port: u8, bit: u8) -> String {
    format!("OUT{port}.{bit}")
}

/// `CN05`.
pub fn counter(number: u8) -> String {
    format!("CN{number:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_written_one_way() {
        let written = |text| (GRAMMAR.address)(text).map(|(_, address)| address);
        for (text, address) in [("in2.1", "IN2.1"), ("OUT01.3", "OUT1.3"), ("cn5", "CN05"), ("CN05", "CN05")] {
            assert_eq!(written(text).as_deref(), Some(address), "{text}");
        }
        for text in ["", "1.3", "OUT1", "OUT1.9", "OUT0.1", "CN0", "CN100", "PN01.1", "clamp"] {
            assert_eq!(written(text), None, "{text}");
        }
    }
}
