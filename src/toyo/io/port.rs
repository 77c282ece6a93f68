//! Ports and the names of their signals.

use std::str::FromStr;

use crate::prelude::basics::*;
use armctl_controller::names::{Kind, Names};
use armctl_controller::toyo::names as names_of;
use armctl_frame::robot::io::{IoItem, IoKind};

use super::super::number_arguments::saturated_byte;

/// A port with its bits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Port {
    /// Name in the manual, for example `PN01`; `SY01` for the system port.
    pub name: String,
    /// Number of the port; 0 for the system port.
    pub number: u8,
    /// Bits of the port. Bit 1 is the lowest bit.
    pub byte: u8,
}

impl Port {
    fn new(number: u8, byte: u8) -> Self {
        Self { name: name(number), number, byte }
    }
}

/// Name of a port: `PN01`, `SY01`.
pub fn name(number: u8) -> String {
    if number == 0 { "SY01".to_owned() } else { format!("PN{number:02}") }
}

/// Type of ports, in the order of lists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum PortBank {
    /// Input ports (`MINP`).
    Input,
    /// Output ports (`MOUT`).
    Output,
    /// Internal ports (`MNIN`).
    Internal,
}

pub use PortBank::{Input as INPUTS, Output as OUTPUTS};

impl PortBank {
    /// All types of ports.
    pub const ALL: [Self; 3] = [Self::Input, Self::Output, Self::Internal];

    const fn command(self) -> table::Command {
        match self {
            Self::Input => table::Command::Minp,
            Self::Output => table::Command::Mout,
            Self::Internal => table::Command::Mnin,
        }
    }

    /// Noun for messages.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Input => "input",
            Self::Output => "output",
            Self::Internal => "internal",
        }
    }

    const fn prefix(self) -> &'static str {
        match self {
            Self::Input => "IN",
            Self::Output => "OUT",
            Self::Internal => "INT",
        }
    }

    /// Returns the kind of signal for reports.
    pub const fn kind(self) -> IoKind {
        match self {
            Self::Input => IoKind::Input,
            Self::Output => IoKind::Output,
            Self::Internal => IoKind::Internal,
        }
    }

    /// Returns the number of the first port of a station.
    pub const fn first(self, station: u8) -> u8 {
        if station == 0 && !matches!(self, Self::Internal) { 0 } else { 1 }
    }

    /// Last port of a station (TO 2-8). The manual also allows screen 7 of the inputs, but that screen is beyond this
    /// port (ambiguity C8).
    pub const fn last(self, station: u8) -> u8 {
        match (self, station) {
            (Self::Input, 0) => 23,
            (Self::Output, 0) => 18,
            (Self::Internal, 0) => 4,
            (Self::Input, _) => 3,
            (Self::Output, _) => 2,
            (Self::Internal, _) => 0,
        }
    }

    /// Returns the screen that contains a port. Screen 1 has ports up to 3, screen 2 has ports 4 to 7, screen 3 has
    /// ports 8 to 11, and so on. Only station 0, the controller, has more than one screen.
    pub fn screen(self, station: u8, port: u8) -> u8 {
        if station == 0 && self != Self::Internal && port > 3 { port / 4 + 1 } else { 1 }
    }

    /// Returns the screen that contains a port; `None` if the station does not have this port.
    pub fn screen_of(self, station: u8, port: u8) -> Option<u8> {
        (port <= self.last(station)).then(|| self.screen(station, port))
    }

    /// Builds the request that reads a screen.
    pub fn request(self, station: u8, screen: u8) -> Request {
        Request::of(self.command(), [Value::Number(station.into()), Value::Number(screen.into())])
    }
}

/// Ports in an answer. If a number is repeated, it means the next port, because the manual prints PN02 twice (ambiguity
/// C7).
pub fn ports_of(record: &Record) -> Vec<Port> {
    let mut ports: Vec<Port> = record.bits("sy01").map(|byte| Port::new(0, byte)).into_iter().collect();
    for (number, bits) in [("port1", "bits1"), ("port2", "bits2"), ("port3", "bits3"), ("port4", "bits4")] {
        let Some(byte) = record.bits(bits) else { break };
        let previous = ports.last().map(|port| port.number).filter(|number| *number > 0);
        let number = match saturated_byte(record, number) {
            number if Some(number) == previous => number.saturating_add(1),
            number => number,
        };
        ports.push(Port::new(number, byte));
    }
    ports
}

/// A signal: a bit of a port, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Signal {
    /// Type of the port.
    pub bank: PortBank,
    /// Number of the port; 0 for the system port.
    pub port: u8,
    /// Number of the bit, 1 to 8.
    pub bit: u8,
}

impl std::hash::Hash for PortBank {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.prefix().hash(state);
    }
}

impl Signal {
    /// Whether the bit is on. `byte` contains the bits of its port.
    pub const fn is_on(self, byte: u8) -> bool {
        byte >> (self.bit - 1) & 1 == 1
    }

    /// Report item. User-defined names apply only to station 0.
    pub fn item(self, station: u8, names: &Names) -> IoItem {
        let Self { bank, port, bit } = self;
        let kind = match bank {
            PortBank::Input => Some((Kind::Input, names_of::input(port, bit))),
            PortBank::Output => Some((Kind::Output, names_of::output(port, bit))),
            PortBank::Internal => None,
        };
        let label = kind.filter(|_| station == 0).and_then(|(kind, address)| names::label(names, kind, &address));
        let place = if station == 0 { String::new() } else { format!("station {station} ") };
        IoItem {
            name: format!("{}{port}.{bit}", bank.prefix()),
            label,
            kind: bank.kind(),
            address: format!("{place}{}.{bit}", name(port)),
            meaning: None,
        }
    }
}

/// Signals that the user typed: one signal, all signals of a port, a range, or a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SignalRange {
    /// Signals in order.
    pub signals: Vec<Signal>,
    /// Whether the user typed a name. Names apply only to station 0.
    pub is_named: bool,
}

impl FromStr for SignalRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let signals = names::parse_or_name(&[Kind::Input, Kind::Output], "IN1.1", text, addresses)?;
        Ok(Self { signals, is_named: addresses(text).is_err() })
    }
}

fn addresses(text: &str) -> Result<Vec<Signal>, String> {
    let wrong = || format!("'{text}' is not a valid signal such as IN1.3, OUT1.3, INT1.3, or a port such as IN1");
    let (bank, rest) = bank_of(text).ok_or_else(wrong)?;
    let ends = rest.split_once("..").or_else(|| rest.split_once('-'));
    let first = ends.map_or(rest, |(first, _)| first);
    let port_of = |text: &str| user_input::unsigned::<u8>(text).filter(|port| *port <= 99);
    // `IN1.3` is port 1, bit 3. The end of a range can omit the part that is equal to its beginning.
    let parse_signal = |text: &str| {
        let text = bank_of(text).filter(|(other, _)| *other == bank).map_or(text, |(_, rest)| rest);
        let (port, bit) = match text.split_once('.') {
            Some((port, bit)) => (port, Some(bit)),
            None => match first.split_once('.') {
                Some((port, _)) => (port, Some(text)),
                None => (text, None),
            },
        };
        let bit = match bit {
            None => None,
            Some(bit) => Some(
                user_input::unsigned::<u8>(bit)
                    .filter(|bit| (1..=8).contains(bit))
                    .ok_or_else(|| format!("'{bit}' is not a valid bit; a port has the bits 1 to 8"))?,
            ),
        };
        Ok::<_, String>((port_of(port).ok_or_else(wrong)?, bit))
    };
    let number = |text: &str| {
        let (port, bit) = parse_signal(text)?;
        Ok::<_, String>(u16::from(port) * 8 + u16::from(bit.unwrap_or(1)) - 1)
    };
    let (least, most) = match ends {
        None => (number(rest)?, number(rest)?),
        Some((from, to)) => (number(from)?, number(to)?),
    };
    if least > most {
        return Err(user_input::RangeError { meant: reversed(text) }.to_string());
    }
    let most = if parse_signal(first)?.1.is_some() { most } else { most + 7 };
    let signal_at =
        |at: u16| Some(Signal { bank, port: u8::try_from(at / 8).ok()?, bit: u8::try_from(at % 8 + 1).ok()? });
    Ok((least..=most).filter_map(signal_at).collect())
}

/// A range with its ends exchanged, for the message.
fn reversed(text: &str) -> String {
    let ends = text.split_once("..").or_else(|| text.split_once('-'));
    ends.map_or_else(|| text.to_owned(), |(from, to)| format!("{to}..{from}"))
}

fn bank_of(text: &str) -> Option<(PortBank, &str)> {
    let at = text.find(|c: char| !c.is_ascii_alphabetic())?;
    let (letters, rest) = text.split_at(at);
    let bank = PortBank::ALL.into_iter().find(|bank| bank.prefix().eq_ignore_ascii_case(letters))?;
    Some((bank, rest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_controller::toyo::request::Answer;

    fn names(text: &str) -> Vec<String> {
        let names = Names::default();
        addresses(text).unwrap().into_iter().map(|signal| signal.item(0, &names).name).collect()
    }

    #[test]
    fn signals_ports_and_ranges_are_parsed() {
        assert_eq!(names("IN1.3"), ["IN1.3"]);
        assert_eq!(names("out2.7..OUT3.1"), ["OUT2.7", "OUT2.8", "OUT3.1"]);
        assert_eq!(names("INT1.7..8"), ["INT1.7", "INT1.8"]);
        assert_eq!(
            (names("IN0").len(), names("IN1..3").len(), names("IN1..IN3").first().cloned()),
            (8, 24, Some("IN1.1".to_owned()))
        );
        for wrong in ["", "1.3", "IN", "IN1.9", "IN1.0", "IN100", "CN1", "IN2..IN1", "IN1.3..OUT1.4"] {
            assert!(addresses(wrong).is_err(), "{wrong}");
        }
        assert!(addresses("IN1.9").unwrap_err().contains("bits 1 to 8"));
    }

    #[test]
    fn a_port_is_read_from_its_screen() {
        let screens: Vec<(u8, u8)> =
            [0, 1, 3, 4, 7, 8, 11, 12, 19, 20, 23].map(|port| (port, INPUTS.screen(0, port))).into();
        assert_eq!(
            screens,
            [(0, 1), (1, 1), (3, 1), (4, 2), (7, 2), (8, 3), (11, 3), (12, 4), (19, 5), (20, 6), (23, 6)]
        );
    }

    #[test]
    fn a_repeated_port_number_counts_as_the_next_port() {
        let request = Request::parse("@MOUT SNO=0 GN=1").unwrap();
        // Example in TO 2-8.
        let printed = "@MOUT SNO=0 GN=1 SY01=00000001 PN01=00000010 PN02=00000100 PN02=00001000";
        let Answer::Data(record) = request.answer(printed).unwrap() else { panic!("it is data") };
        let ports: Vec<(String, u8)> = ports_of(&record).into_iter().map(|port| (port.name, port.byte)).collect();
        let expected = [("SY01", 1), ("PN01", 2), ("PN02", 4), ("PN03", 8)];
        assert_eq!(ports, expected.map(|(name, byte)| (name.to_owned(), byte)));
    }
}
