//! Memory map of the image on each fieldbus (chapter 1, section 1), for the programmer of the master.
//!
//! In the manual, bits 14 and 15 are missing in the bit table of compact DeviceNet. Here they are as in the full
//! tables.

use super::image::{COMMAND_WORDS, DEDICATED_WORD};
use super::signal::{Side, Signal};

/// A fieldbus and its image size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Bus {
    /// DeviceNet with I/O size "Normal".
    DeviceNet,
    /// DeviceNet with I/O size "Compact": the image has two words of bits, and no remote commands.
    DeviceNetCompact,
    /// EtherNet/IP.
    EtherNetIp,
    /// PROFIBUS.
    Profibus,
    /// PROFINET.
    Profinet,
}

impl Bus {
    /// All fieldbuses.
    pub const ALL: [Self; 5] =
        [Self::DeviceNet, Self::DeviceNetCompact, Self::EtherNetIp, Self::Profibus, Self::Profinet];

    /// Name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::DeviceNet => "devicenet",
            Self::DeviceNetCompact => "devicenet-compact",
            Self::EtherNetIp => "ethernet-ip",
            Self::Profibus => "profibus",
            Self::Profinet => "profinet",
        }
    }

    /// Whether addresses count bytes instead of words.
    pub const fn counts_bytes(self) -> bool {
        matches!(self, Self::Profibus | Self::Profinet)
    }

    /// Whether the image contains remote commands.
    pub const fn has_commands(self) -> bool {
        !matches!(self, Self::DeviceNetCompact)
    }
}

impl std::str::FromStr for Bus {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|bus| bus.name() == text).ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            format!("unknown bus '{text}'; known: {names}")
        })
    }
}

/// A row of the map.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MapRow {
    /// Direction. SI and WI are inputs of the controller, SO and WO are its outputs.
    pub side: Side,
    /// Prefix of the address: `m` or `n` if addresses count words, `Im` or `Qn` if addresses count bytes.
    pub base: &'static str,
    /// Number of words or bytes after the start address.
    pub offset: usize,
    /// The lowest bit of the row.
    pub low: u8,
    /// The highest bit of the row.
    pub high: u8,
    /// Signals of the row, for example `SI(20) to SI(27)`; empty if the bits are reserved.
    pub signal: String,
    /// Readable name.
    pub meaning: String,
    /// Whether the bits must not be used.
    pub reserved: bool,
}

impl MapRow {
    /// Address of the row as in the manual, or as a number if the start address of the master is given.
    pub fn address(&self, start: Option<u32>) -> String {
        match (start, self.offset) {
            (Some(start), offset) => {
                let prefix = self.base.trim_end_matches(['m', 'n']);
                format!("{prefix}{}", u64::from(start) + offset as u64)
            }
            (None, 0) => self.base.to_owned(),
            (None, offset) => format!("{} + {offset}", self.base),
        }
    }

    /// Bits of the row, for example `3` or `0 - 7`.
    pub fn bits(&self) -> String {
        if self.low == self.high { self.low.to_string() } else { format!("{} - {}", self.low, self.high) }
    }
}

/// The map of a fieldbus in ascending order. The outputs of the controller come first, as in the manual.
pub fn map(bus: Bus) -> Vec<MapRow> {
    [Side::Output, Side::Input].into_iter().flat_map(|side| half(bus, side)).collect()
}

fn half(bus: Bus, side: Side) -> Vec<MapRow> {
    let base = match (side, bus.counts_bytes()) {
        (Side::Output, false) => "m",
        (Side::Input, false) => "n",
        (Side::Output, true) => "Im",
        (Side::Input, true) => "Qn",
    };
    let place = |(word, low, high): (usize, u8, u8), signal: String, meaning: String| {
        let (word, low, high) = match (bus.counts_bytes(), bus.has_commands()) {
            (true, _) if high - low < 8 => (word * 2 + usize::from(low / 8), low % 8, high % 8),
            (true, _) => (word * 2, low, high),
            (false, true) => (word, low, high),
            (false, false) => (word - DEDICATED_WORD, low, high),
        };
        let reserved = signal.is_empty();
        MapRow { side, base, offset: word, low, high, signal, meaning, reserved }
    };
    let mut places = Vec::new();
    if bus.has_commands() {
        for word in 0..COMMAND_WORDS {
            let (signal, meaning) = register(side, word);
            places.push(place((word, 0, 15), signal, meaning));
        }
    }
    let mut signals = Signal::all(side).filter(|signal| !signal.is_general()).peekable();
    for bit in 0..16 {
        let (signal, meaning) = match signals.next_if(|signal| signal.bit() == bit).and_then(Signal::dedicated) {
            Some(dedicated) => (dedicated.signal.to_string(), dedicated.text.to_owned()),
            None => (String::new(), "reserved".to_owned()),
        };
        places.push(place((DEDICATED_WORD, bit, bit), signal, meaning));
    }
    let general = if side == Side::Input { "general-purpose input" } else { "general-purpose output" };
    let last = if bus.has_commands() { LAST_GENERAL } else { DEDICATED_WORD + 1 };
    let signals: Vec<Signal> = Signal::all(side).filter(|signal| signal.is_general()).collect();
    for group in signals.chunks_exact(8) {
        let [first, .., end] = group else { continue };
        if first.word() <= last {
            places.push(place((first.word(), first.bit(), end.bit()), format!("{first} to {end}"), general.to_owned()));
        }
    }
    if bus.has_commands() {
        let halves: &[(u8, u8)] = if bus.counts_bytes() { &[(0, 7), (8, 15)] } else { &[(0, 15)] };
        for (low, high) in halves {
            places.push(place((LAST_GENERAL + 1, *low, *high), String::new(), "reserved".to_owned()));
        }
    }
    places
}

/// Last word of general-purpose bits. A reserved word follows it.
const LAST_GENERAL: usize = 22;

/// Name and use of a general-purpose word.
fn register(side: Side, word: usize) -> (String, String) {
    let (name, way) = match side {
        Side::Input => ('I', "input"),
        Side::Output => ('O', "output"),
    };
    let double = if word >= 2 && word.is_multiple_of(2) { format!(", S{name}D({word})") } else { String::new() };
    let meaning = match (side, word) {
        (Side::Input, 0) => "remote command".to_owned(),
        (Side::Input, 1) => "command data".to_owned(),
        (Side::Input, _) => format!("command data, or general-purpose {way}"),
        (Side::Output, 0) => "status of the remote command".to_owned(),
        (Side::Output, 1) => "error code or response".to_owned(),
        (Side::Output, _) => format!("response, or general-purpose {way}"),
    };
    (format!("W{name}{word}, S{name}W({word}){double}"), meaning)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(bus: Bus, side: Side) -> Vec<String> {
        map(bus)
            .iter()
            .filter(|place| place.side == side)
            .map(|place| format!("{} [{}] {}", place.address(None), place.bits(), place.signal))
            .collect()
    }

    #[test]
    fn a_bus_is_found_by_its_name() {
        for bus in Bus::ALL {
            assert_eq!(bus.name().parse(), Ok(bus));
        }
        assert!("canopen".parse::<Bus>().unwrap_err().contains("known: "));
    }

    #[test]
    fn words_of_devicenet_and_ethernet_ip() {
        let rows = rows(Bus::EtherNetIp, Side::Input);
        assert_eq!(
            rows[..3],
            ["n [0 - 15] WI0, SIW(0)", "n + 1 [0 - 15] WI1, SIW(1)", "n + 2 [0 - 15] WI2, SIW(2), SID(2)"]
        );
        assert_eq!(rows[15], "n + 15 [0 - 15] WI15, SIW(15)");
        assert_eq!(rows[16..19], ["n + 16 [0] SI(00)", "n + 16 [1] SI(01)", "n + 16 [2] "]);
        assert_eq!(
            rows[30..34],
            [
                "n + 16 [14] SI(16)",
                "n + 16 [15] SI(17)",
                "n + 17 [0 - 7] SI(20) to SI(27)",
                "n + 17 [8 - 15] SI(30) to SI(37)"
            ]
        );
        assert_eq!(rows[43..], ["n + 22 [8 - 15] SI(150) to SI(157)", "n + 23 [0 - 15] "]);
        assert_eq!(map(Bus::DeviceNet), map(Bus::EtherNetIp));
    }

    #[test]
    fn bytes_of_profibus_and_profinet() {
        let rows = rows(Bus::Profinet, Side::Output);
        assert_eq!(rows[..2], ["Im [0 - 15] WO0, SOW(0)", "Im + 2 [0 - 15] WO1, SOW(1)"]);
        assert_eq!(rows[15..17], ["Im + 30 [0 - 15] WO15, SOW(15)", "Im + 32 [0] SO(00)"]);
        assert_eq!(rows[24..26], ["Im + 33 [0] SO(10)", "Im + 33 [1] SO(11)"]);
        assert_eq!(rows[32..34], ["Im + 34 [0 - 7] SO(20) to SO(27)", "Im + 35 [0 - 7] SO(30) to SO(37)"]);
        assert_eq!(rows[43..], ["Im + 45 [0 - 7] SO(150) to SO(157)", "Im + 46 [0 - 7] ", "Im + 47 [0 - 7] "]);
        assert_eq!(map(Bus::Profibus), map(Bus::Profinet));
    }

    #[test]
    fn compact_has_bits_only() {
        let rows = rows(Bus::DeviceNetCompact, Side::Input);
        assert_eq!(rows.len(), 18);
        assert_eq!(rows[0], "n [0] SI(00)");
        assert_eq!(rows[16..], ["n + 1 [0 - 7] SI(20) to SI(27)", "n + 1 [8 - 15] SI(30) to SI(37)"]);
    }

    #[test]
    fn start_addresses_are_added() {
        let places = map(Bus::EtherNetIp);
        assert_eq!(places[16].address(Some(100)), "116");
        assert_eq!(map(Bus::Profibus)[16].address(Some(u32::MAX)), "I4294967327");
    }

    #[test]
    fn every_bit_of_the_image_has_one_position() {
        for bus in Bus::ALL {
            for side in [Side::Input, Side::Output] {
                let bits: usize = map(bus)
                    .iter()
                    .filter(|place| place.side == side)
                    .map(|place| usize::from(place.high - place.low) + 1)
                    .sum();
                assert_eq!(bits, if bus.has_commands() { 24 * 16 } else { 2 * 16 }, "{}", bus.name());
            }
        }
    }
}
