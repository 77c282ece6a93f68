//! Bit rates and their bus parameters (EN 50170, volume 2, part 8, table of bus parameters).

use std::time::Duration;

use super::super::line::Pace;

/// Bits per character: 1 start bit, 8 data bits, 1 even parity bit, 1 stop bit.
pub const CHARACTER: u32 = 11;
/// Idle bits before a request (TSYN).
pub const SYNC: u32 = 33;
/// Idle bits between an answer and the next request (TID1).
pub const IDLE: u32 = 37;

/// A bit rate with its bus parameters in bit times.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rate {
    /// Name in URLs, for example `500k`.
    pub name: &'static str,
    /// Bits per second.
    pub baud: u32,
    /// Longest delay of an answer (max TSDR).
    pub max_tsdr: u32,
    /// Time limit for the start of an answer (slot time, TSL).
    pub slot: u32,
    /// Minimum slot time with an adapter, in ms. It is longer than the slot time of the bus, because drivers and
    /// converters delay characters.
    pub adapter_ms: u64,
    /// Default time between two data exchanges, in ms.
    pub cycle_ms: u64,
}

const fn rate(name: &'static str, baud: u32, max_tsdr: u32, slot: u32, adapter_ms: u64, cycle_ms: u64) -> Rate {
    Rate { name, baud, max_tsdr, slot, adapter_ms, cycle_ms }
}

/// Bit rates that PC adapters support. The bus has three more bit rates, up to 12 Mbit/s.
pub const RATES: [Rate; 7] = [
    rate("9.6k", 9_600, 60, 100, 60, 200),
    rate("19.2k", 19_200, 60, 100, 30, 100),
    rate("45.45k", 45_450, 400, 640, 10, 50),
    rate("93.75k", 93_750, 60, 100, 10, 50),
    rate("187.5k", 187_500, 60, 100, 10, 20),
    rate("500k", 500_000, 100, 200, 10, 20),
    rate("1.5M", 1_500_000, 150, 300, 10, 20),
];

impl Rate {
    /// Finds a rate by bits per second.
    pub fn from_baud(baud: u32) -> Option<Self> {
        RATES.into_iter().find(|rate| rate.baud == baud)
    }

    /// Finds a rate by name, for example `500k` or `1.5M`.
    pub fn from_name(name: &str) -> Option<Self> {
        RATES.into_iter().find(|rate| rate.name == name)
    }

    /// Speed of a line with this bit rate, in characters per time.
    pub fn pace(self) -> Pace {
        Pace::new(self.baud, CHARACTER)
    }

    /// Duration of this number of bits.
    pub fn bits(self, bits: u32) -> Duration {
        Duration::from_nanos((u64::from(bits) * 1_000_000_000).div_ceil(u64::from(self.baud.max(1))))
    }

    /// Longest duration of a data exchange: the pause before it, the request, the delay of the answer, and the answer.
    pub fn exchange(self, output: usize, input: usize) -> Duration {
        // Number of bytes of a frame without data: start, lengths, addresses, function code, checksum, end.
        const FRAME: usize = 9;
        self.pace().time(output + input + 2 * FRAME) + self.bits(IDLE + self.max_tsdr)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bit_rates_have_names() {
        for rate in RATES {
            assert_eq!(Rate::from_name(rate.name), Some(rate));
            assert_eq!(Rate::from_baud(rate.baud), Some(rate));
        }
        assert_eq!(Rate::from_baud(12_000_000), None);
    }

    #[test]
    fn exchanges_of_48_bytes_take_as_long_as_the_table_says() {
        for (name, least, most) in
            [("9.6k", 135_000, 141_500), ("93.75k", 13_800, 14_500), ("500k", 2_600, 2_820), ("1.5M", 860, 970)]
        {
            let time = Rate::from_name(name).unwrap().exchange(48, 48).as_micros();
            assert!((least..=most).contains(&time), "{name}: {time} us");
        }
    }
}
