//! Cyclic data: what a frame carries behind its id.

use super::{Reader, WireError, Writer};

/// Data status of one that runs: primary, valid, run, no problem.
pub const RUNNING: u8 = 0x35;
/// Bits that inputs must have to be used: primary, valid, run; and the one that they must not have: ignore.
const USABLE: (u8, u8) = (0x15, 0x80);
/// A provider's or a consumer's status that says good; only the highest bit counts.
pub const GOOD: u8 = 0x80;
/// Counts of the cycle counter that are a step forward, rather than an old frame.
const FORWARD: u16 = 61_440;

/// Cyclic data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cyclic<'a> {
    /// The data of all submodules, their statuses, and filling.
    pub data: &'a [u8],
    /// In units of 31.25 us.
    pub counter: u16,
    /// What the provider says of all of it.
    pub status: u8,
    /// 0 unless a switch found the frame damaged.
    pub transfer: u8,
}

impl<'a> Cyclic<'a> {
    /// Reads what a frame carries; its data has the length that the connection agreed on.
    ///
    /// # Errors
    /// When there is less.
    pub fn parse(payload: &'a [u8], length: usize) -> Result<Self, WireError> {
        let mut reader = Reader::big(payload);
        Ok(Self {
            data: reader.take(length, "data")?,
            counter: reader.u16("cycle counter")?,
            status: reader.u8("data status")?,
            transfer: reader.u8("transfer status")?,
        })
    }

    /// The bytes.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.put(self.data);
        out.u16(self.counter);
        out.u8(self.status);
        out.u8(self.transfer);
        out.bytes
    }

    /// Whether the data may be used, as far as the whole of it goes.
    pub const fn is_usable(&self) -> bool {
        self.status & USABLE.0 == USABLE.0 && self.status & USABLE.1 == 0 && self.transfer == 0
    }

    /// Whether it was sent after the one that counted `last`.
    pub const fn is_after(&self, last: u16) -> bool {
        let step = self.counter.wrapping_sub(last);
        step != 0 && step <= FORWARD
    }
}

/// What is missing of a data status for its data to be used, in words.
pub fn describe_status(status: u8, transfer: u8) -> &'static str {
    match status {
        _ if transfer != 0 => "a switch marked it as damaged",
        _ if status & 0x80 != 0 => "it is marked to be ignored",
        _ if status & 0x04 == 0 => "its data is not valid",
        _ if status & 0x10 == 0 => "the device is in stop",
        _ if status & 0x01 == 0 => "the device is a backup",
        _ => "it is good",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_runs_and_is_valid_is_usable() {
        for status in 0..=u8::MAX {
            let cyclic = Cyclic { data: &[], counter: 0, status, transfer: 0 };
            let usable = status & 1 != 0 && status & 4 != 0 && status & 0x10 != 0 && status & 0x80 == 0;
            assert_eq!(cyclic.is_usable(), usable, "{status:#x}");
            assert_eq!(describe_status(status, 0) == "it is good", usable, "{status:#x}");
            assert!(!Cyclic { transfer: 1, ..cyclic }.is_usable());
        }
        assert!(Cyclic { data: &[], counter: 0, status: 0x15, transfer: 0 }.is_usable(), "a diagnosis is no stop");
    }

    #[test]
    fn counters_go_forward_over_their_end() {
        let after = |counter, last| Cyclic { data: &[], counter, status: 0, transfer: 0 }.is_after(last);
        assert!(after(0x200, 0) && after(0x100, 0xFF00) && after(61_440, 0));
        assert!(!after(5, 5) && !after(61_441, 0) && !after(0xFE00, 0));
    }
}
