//! Bits of words, with names.

/// A named bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bit {
    /// Position of the bit, counted from the least significant bit.
    pub bit: u8,
    /// Name of state 0; empty if the state has no name.
    pub clear: &'static str,
    /// Name of state 1.
    pub set: &'static str,
}

impl Bit {
    /// Name of the state of the bit in `value`.
    pub const fn word(&self, value: u32) -> &'static str {
        if value >> self.bit & 1 == 1 { self.set } else { self.clear }
    }
}

const fn bit(bit: u8, clear: &'static str, set: &'static str) -> Bit {
    Bit { bit, clear, set }
}

/// Bits of the form word, with their names in the text format of positions.
pub const FORM_BITS: [Bit; 8] = [
    bit(0, "front", "back"),
    bit(1, "upper", "lower"),
    bit(2, "flip", "noflip"),
    bit(3, "r-lt180", "r-ge180"),
    bit(4, "t-lt180", "t-ge180"),
    bit(5, "s-lt180", "s-ge180"),
    bit(6, "redundant-front", "redundant-back"),
    bit(7, "previous-step", "regard-form"),
];

/// Bits of the extended form word, with their names in the text format of positions.
pub const EXTENDED_FORM_BITS: [Bit; 5] = [
    bit(0, "l-lt180", "l-ge180"),
    bit(1, "u-lt180", "u-ge180"),
    bit(2, "b-lt180", "b-ge180"),
    bit(3, "e-lt180", "e-ge180"),
    bit(4, "w-lt180", "w-ge180"),
];

/// Bits of the first status word.
pub const DATA_1_BITS: [Bit; 8] = [
    bit(0, "", "step mode"),
    bit(1, "", "one-cycle mode"),
    bit(2, "", "continuous mode"),
    bit(3, "", "running"),
    bit(4, "", "in-guard safe operation"),
    bit(5, "", "teach mode"),
    bit(6, "", "play mode"),
    bit(7, "", "command remote"),
];

/// Bits of the second status word.
pub const DATA_2_BITS: [Bit; 6] = [
    bit(1, "", "hold by pendant"),
    bit(2, "", "hold by external signal"),
    bit(3, "", "hold by command"),
    bit(4, "", "alarm"),
    bit(5, "", "error"),
    bit(6, "", "servo on"),
];
