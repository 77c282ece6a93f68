//! Codec for the payload of cyclic frames.

use super::{Reader, WireError, Writer};

/// Data status of a running provider: primary, valid, run, no problem.
pub const RUNNING: u8 = 0x35;
/// Status bits of usable data. The first mask (primary, valid, run) must be set, and the second mask (ignore) must not
/// be set.
const USABLE: (u8, u8) = (0x15, 0x80);
/// Good provider or consumer status. Only the highest bit is checked.
pub const GOOD: u8 = 0x80;
/// Largest step of the cycle counter that counts as forward. The counter wraps around, so a larger step comes from an
/// older frame.
const FORWARD: u16 = 61_440;

/// Payload of a cyclic frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cyclic<'a> {
    /// Data and statuses of all submodules, and padding.
    pub data: &'a [u8],
    /// Cycle counter, in units of 31.25 us.
    pub counter: u16,
    /// Data status.
    pub status: u8,
    /// Transfer status. It is not 0 if a switch detected damage to the frame.
    pub transfer: u8,
}

impl<'a> Cyclic<'a> {
    /// Decodes a payload that contains `length` bytes of data.
    pub fn parse(payload: &'a [u8], length: usize) -> Result<Self, WireError> {
        let mut reader = Reader::big(payload);
        Ok(Self {
            data: reader.take(length, "data")?,
            counter: reader.u16("cycle counter")?,
            status: reader.u8("data status")?,
            transfer: reader.u8("transfer status")?,
        })
    }

    /// Encodes the payload.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.put(self.data);
        out.u16(self.counter);
        out.u8(self.status);
        out.u8(self.transfer);
        out.bytes
    }

    /// Whether the data status and the transfer status allow the use of the data.
    pub const fn is_usable(&self) -> bool {
        self.status & USABLE.0 == USABLE.0 && self.status & USABLE.1 == 0 && self.transfer == 0
    }

    /// Whether this frame is newer than the frame with the counter `last`.
    pub const fn is_after(&self, last: u16) -> bool {
        let step = self.counter.wrapping_sub(last);
        step != 0 && step <= FORWARD
    }
}

/// Returns the reason why these statuses do not allow the use of the data.
pub fn describe_status(status: u8, transfer: u8) -> &'static str {
    match status {
        _ if transfer != 0 => "a switch marked the data as damaged",
        _ if status & 0x80 != 0 => "the data is marked to be ignored",
        _ if status & 0x04 == 0 => "the data is not valid",
        _ if status & 0x10 == 0 => "the device is in the stop state",
        _ if status & 0x01 == 0 => "the device is a backup",
        _ => "the data is good",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_is_usable_only_if_running_and_valid() {
        for status in 0..=u8::MAX {
            let cyclic = Cyclic { data: &[], counter: 0, status, transfer: 0 };
            let usable = status & 1 != 0 && status & 4 != 0 && status & 0x10 != 0 && status & 0x80 == 0;
            assert_eq!(cyclic.is_usable(), usable, "{status:#x}");
            assert_eq!(describe_status(status, 0) == "the data is good", usable, "{status:#x}");
            assert!(!Cyclic { transfer: 1, ..cyclic }.is_usable());
        }
        assert!(Cyclic { data: &[], counter: 0, status: 0x15, transfer: 0 }.is_usable(), "a diagnosis is no stop");
    }

    #[test]
    fn counters_compare_across_their_wrap() {
        let after = |counter, last| Cyclic { data: &[], counter, status: 0, transfer: 0 }.is_after(last);
        assert!(after(0x200, 0) && after(0x100, 0xFF00) && after(61_440, 0));
        assert!(!after(5, 5) && !after(61_441, 0) && !after(0xFE00, 0));
    }
}
