//! `toyo io`: ports of eight bits, on the controller itself (station 0) and on its slave stations (1 to 4).
//!
//! The manual does not say which character of a port is which bit. Bit 8 stands first and bit 1 last: the comments of
//! its sample 3-1 call `.......1` output bit 1 (ambiguity C9).

mod read;
mod set;

pub(super) use read::{Bank, INPUTS, OUTPUTS, ports_of};

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::commands;
use crate::command::frame::names;
use crate::command::frame::watch::Watch;
use crate::controller::names::{Kind, Names};
use crate::controller::toyo::field::Mask;
use crate::controller::toyo::names as names_of;

commands! {
    /// What can be done with ports.
    pub enum Io {
        /// Input ports
        In(read::In),
        /// Output ports
        Out(read::Out),
        /// Internal ports
        Internal(read::Internal),
        /// Set outputs: 1.3=on, or 1=.......1 for the bits of a whole port
        Set(set::Set),
        /// Print each change of the inputs and outputs
        Watch(Watch<read::Both>),
        /// Switch one of the direct outputs F1 to F4
        Direct(set::Direct),
    }
}

/// A port and the state of its bits.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub(super) struct Port {
    /// As the manual names it: `PN01`, `SY01` for the system port.
    pub(super) name: String,
    /// Null for the system port.
    port: Option<u8>,
    /// As the controller sends it: bit 8 first, bit 1 last.
    raw: String,
    /// Bit 1 first, bit 8 last.
    bits: [bool; 8],
    /// Numbers of the bits that are on.
    on: Vec<u8>,
    /// What people call the bits, bit 1 first; null where one has no name.
    labels: [Option<String>; 8],
}

impl Port {
    /// Its bits as a number.
    pub(super) fn byte(&self) -> u8 {
        self.on.iter().fold(0, |byte, number| byte | 1 << (number - 1))
    }

    fn new(port: Option<u8>, byte: u8) -> Self {
        let name = port.map_or_else(|| "SY01".to_owned(), name);
        let bits = [0, 1, 2, 3, 4, 5, 6, 7].map(|bit| byte >> bit & 1 == 1);
        Self { name, port, raw: Mask::all(byte).to_string(), bits, on: numbers(byte), labels: Default::default() }
    }

    /// With the names of its bits, where it is a port of the controller itself.
    fn labelled(mut self, names: &Names, bits: Bits, station: u8) -> Self {
        if let Some(port) = self.port.filter(|_| station == 0) {
            self.labels =
                [1, 2, 3, 4, 5, 6, 7, 8].map(|bit| names::label(names, bits.kind, &(bits.address)(port, bit)));
        }
        self
    }

    /// The names of its bits in a line: `1 clamp, 3 lamp`.
    fn label(&self) -> Option<String> {
        label_of(&self.labels)
    }
}

/// Which names the bits of a port have.
#[derive(Debug, Clone, Copy)]
struct Bits {
    kind: Kind,
    address: fn(u8, u8) -> String,
}

const INPUT_BITS: Bits = Bits { kind: Kind::Input, address: names_of::input };
const OUTPUT_BITS: Bits = Bits { kind: Kind::Output, address: names_of::output };

/// The names of bits, bit 1 first, in a line.
fn label_of(labels: &[Option<String>; 8]) -> Option<String> {
    let told = (1..).zip(labels).filter_map(|(bit, label)| Some(format!("{bit} {}", label.as_ref()?)));
    let told = told.collect::<Vec<String>>().join(", ");
    (!told.is_empty()).then_some(told)
}

/// `PN01`.
fn name(port: u8) -> String {
    format!("PN{port:02}")
}

/// The bits of a byte that are set, as the manual counts them: from 1.
fn numbers(byte: u8) -> Vec<u8> {
    (1..=8).filter(|bit| byte >> (bit - 1) & 1 == 1).collect()
}

/// Numbers with blanks between; a dash for none.
fn listed(numbers: &[u8]) -> String {
    if numbers.is_empty() {
        return "-".to_owned();
    }
    numbers.iter().map(u8::to_string).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bit_1_is_the_last_character() {
        let port = Port::new(Some(1), 0b0000_0101);
        assert_eq!((port.name.as_str(), port.raw.as_str(), &port.on[..]), ("PN01", "00000101", &[1, 3][..]));
        assert!(port.bits[0] && !port.bits[1] && port.bits[2]);
        assert_eq!(Port::new(None, 0).name, "SY01");
        assert_eq!((listed(&[]), listed(&[1, 8])), ("-".to_owned(), "1 8".to_owned()));
    }
}
