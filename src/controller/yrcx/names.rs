//! Addresses that inventory names can refer to, for example `SO(20)`, `SIW(2)`, `SGI5` or `DO2.1`.

use super::register::Register;
use super::signal::{Side, Signal};
use crate::names::{Grammar, Kind};
use crate::user_input::unsigned;

/// Address notation: signals and words, static variables, ports and their bits.
pub const GRAMMAR: Grammar = Grammar {
    address,
    prefixes: &["SI", "SO", "SIW", "SOW", "SID", "SOD", "SGI", "SGR", "DI", "DO", "MO", "LO", "TO"],
};

/// Kinds of ports. SI and SO are not in the list, because they are parsed as signals.
const PORTS: [&str; 5] = ["DI", "DO", "MO", "LO", "TO"];

/// Parses an address and normalizes it.
fn address(text: &str) -> Option<(Kind, String)> {
    if let Some(register) = Register::parse(text) {
        return register.ok().map(|register| (Kind::Signal, register.to_string()));
    }
    for side in [Side::Input, Side::Output] {
        // A number without SI or SO could belong to either side.
        let is_named = text.get(..2).is_some_and(|prefix| prefix.eq_ignore_ascii_case(side.name()));
        let is_dedicated = Signal::of_side(side).any(|row| row.name == text);
        if let (true, Ok(signal)) = (is_named || is_dedicated, Signal::parse(side, text)) {
            return Some((Kind::Signal, signal.to_string()));
        }
    }
    variable(text).or_else(|| port(text))
}

fn variable(text: &str) -> Option<(Kind, String)> {
    let (letters, digits) = text.split_at_checked(3)?;
    let letters = ["SGI", "SGR"].into_iter().find(|known| known.eq_ignore_ascii_case(letters))?;
    let number: u8 = unsigned(digits).filter(|number| *number <= 31)?;
    Some((Kind::Variable, format!("{letters}{number}")))
}

/// Parses a port or a bit of a port, for example `DO12`, `DO2.1` or `DO(21)`.
fn port(text: &str) -> Option<(Kind, String)> {
    let (letters, rest) = text.split_at_checked(2)?;
    let letters = PORTS.into_iter().find(|known| known.eq_ignore_ascii_case(letters))?;
    let (port, bit) = match rest.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')) {
        Some(digits) => digits.split_at_checked(digits.len().checked_sub(1)?).map(|(port, bit)| (port, Some(bit)))?,
        None => rest.split_once('.').map_or((rest, None), |(port, bit)| (port, Some(bit))),
    };
    let digit = |text: &str| unsigned::<u8>(text).filter(|_| text.bytes().all(|byte| byte.is_ascii_digit()));
    // In `DO(1)`, the port number is omitted. It is 0.
    let is_first = port.is_empty() && rest.starts_with('(');
    let port = digit(if is_first { "0" } else { port }).filter(|port| port % 10 < 8 && *port <= 27)?;
    let written = match bit {
        Some(bit) => format!("{letters}{port}.{}", digit(bit).filter(|bit| *bit < 8)?),
        None => format!("{letters}{port}"),
    };
    Some((Kind::Port, written))
}

/// The signal for a bit of port SI or SO, for example `SO(21)` for `SO2.1`.
pub fn signal_of_port(port: &str) -> Option<String> {
    let (place, bit) = port.split_once('.')?;
    let (letters, number) = place.split_at_checked(2)?;
    matches!(letters, "SI" | "SO").then(|| format!("{letters}({number}{bit})"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_have_a_canonical_form() {
        let written = |text| (GRAMMAR.address)(text).map(|(kind, address)| format!("{} {address}", kind.word()));
        for (text, address) in [
            ("SO20", "signal SO(20)"),
            ("si(157)", "signal SI(157)"),
            ("SIW2", "signal SIW(2)"),
            ("sgi5", "variable SGI5"),
            ("DO2.1", "port DO2.1"),
            ("do(21)", "port DO2.1"),
            ("DO12", "port DO12"),
            ("servo-on", "signal SI(01)"),
        ] {
            assert_eq!(written(text).as_deref(), Some(address), "{text}");
        }
        for text in ["", "20", "SO(05)", "SIW1", "SGI32", "DO8", "DO2.8", "XO1", "clamp", "DO", "SO20..27"] {
            assert_eq!(written(text), None, "{text}");
        }
        assert_eq!(signal_of_port("SO2.1").as_deref(), Some("SO(21)"));
        assert_eq!((signal_of_port("SO2"), signal_of_port("DO2.1")), (None, None));
    }
}
