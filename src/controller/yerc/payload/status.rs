//! Controller status, two words of bits (FS and DX 3.3.3).

use super::reader::{PayloadError, Reader, push_u32s};
use crate::yerc::table::{Bit, DATA_1_BITS, DATA_2_BITS};

/// A condition of the controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum StatusBit {
    /// Step mode.
    Step,
    /// One-cycle mode.
    OneCycle,
    /// Continuous (automatic) mode.
    Continuous,
    /// A job is running.
    Running,
    /// In-guard safe operation.
    Guarded,
    /// Teach mode.
    Teach,
    /// Play mode.
    Play,
    /// Command remote.
    CommandRemote,
    /// The programming pendant applied HOLD.
    HoldPendant,
    /// An external signal applied HOLD.
    HoldExternal,
    /// A command applied HOLD.
    HoldCommand,
    /// An alarm is present.
    Alarm,
    /// An error is present.
    Error,
    /// Servo power is on.
    ServoOn,
}

use StatusBit as S;

/// All conditions, in the order of the bits.
const ALL: [StatusBit; 14] = [
    S::Step,
    S::OneCycle,
    S::Continuous,
    S::Running,
    S::Guarded,
    S::Teach,
    S::Play,
    S::CommandRemote,
    S::HoldPendant,
    S::HoldExternal,
    S::HoldCommand,
    S::Alarm,
    S::Error,
    S::ServoOn,
];

impl StatusBit {
    /// All conditions, in the order of the manual.
    pub fn all() -> impl Iterator<Item = Self> {
        ALL.into_iter()
    }

    /// Name, for example `servo on`.
    pub fn name(self) -> &'static str {
        self.row().1.set
    }

    /// The index of the status word of a condition, and the table row of its bit.
    fn row(self) -> (usize, &'static Bit) {
        let index = self as usize;
        match index.checked_sub(DATA_1_BITS.len()) {
            None => (0, &DATA_1_BITS[index]),
            Some(index) => (1, &DATA_2_BITS[index]),
        }
    }
}

/// Cycle mode, which command 0x84 sets (FS and DX 3.3.21).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum CycleMode {
    /// One step at a time.
    Step,
    /// One cycle, then stop.
    Once,
    /// Repeated cycles.
    Continuous,
}

impl CycleMode {
    /// Data word of command 0x84 for this mode.
    pub const fn word(self) -> u32 {
        match self {
            Self::Step => 1,
            Self::Once => 2,
            Self::Continuous => 3,
        }
    }
}

/// Both status words. Bits without a meaning are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct ControllerStatus {
    /// The words that the manuals call data 1 and data 2.
    pub words: [u32; 2],
}

impl ControllerStatus {
    /// Parses the data, which must have at least 8 bytes.
    pub fn parse(data: &[u8]) -> Result<Self, PayloadError> {
        let mut reader = Reader::new("controller status", data);
        Ok(Self { words: [reader.u32()?, reader.u32()?] })
    }

    /// Encodes the words in 8 bytes.
    pub fn emit(self) -> Vec<u8> {
        let mut out = Vec::with_capacity(8);
        push_u32s(&mut out, self.words);
        out
    }

    /// Whether a condition is set.
    pub fn has(self, bit: StatusBit) -> bool {
        let (word, &Bit { bit, .. }) = bit.row();
        self.words[word] >> bit & 1 == 1
    }

    /// Sets or clears a condition.
    #[must_use]
    pub fn with(mut self, bit: StatusBit, on: bool) -> Self {
        let (word, &Bit { bit, .. }) = bit.row();
        self.words[word] = self.words[word] & !(1 << bit) | u32::from(on) << bit;
        self
    }

    /// Whether a job is running.
    pub fn running(self) -> bool {
        self.has(S::Running)
    }

    /// Whether servo power is on.
    pub fn servo_on(self) -> bool {
        self.has(S::ServoOn)
    }

    /// Whether an alarm is present.
    pub fn alarm(self) -> bool {
        self.has(S::Alarm)
    }

    /// Whether an error is present.
    pub fn error(self) -> bool {
        self.has(S::Error)
    }

    /// Whether an alarm or error is present.
    pub fn faulted(self) -> bool {
        self.alarm() || self.error()
    }

    /// Whether HOLD is active from any source.
    pub fn held(self) -> bool {
        [S::HoldPendant, S::HoldExternal, S::HoldCommand].into_iter().any(|bit| self.has(bit))
    }

    /// Cycle mode, if exactly one of its three bits is set.
    pub fn cycle(self) -> Option<CycleMode> {
        match self.words[0] & 0b111 {
            0b001 => Some(CycleMode::Step),
            0b010 => Some(CycleMode::Once),
            0b100 => Some(CycleMode::Continuous),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn status_rows_are_in_bit_order() {
        for (index, bit) in StatusBit::all().enumerate() {
            assert_eq!(bit as usize, index);
            assert!(ControllerStatus::default().with(bit, true).has(bit));
        }
        assert_eq!(DATA_1_BITS[7].set, "command remote");
        assert_eq!(DATA_2_BITS[5], Bit { bit: 6, clear: "", set: "servo on" });
    }

    /// FS and DX 3.3.3 and 3.3.21.
    #[test]
    fn cycle_modes_have_a_word_and_a_status_bit() {
        let modes = [CycleMode::Step, CycleMode::Once, CycleMode::Continuous];
        assert_eq!(modes.map(CycleMode::word), [1, 2, 3]);
        let cycle = |data_1| ControllerStatus { words: [data_1, 0] }.cycle();
        assert_eq!([0b001, 0b010, 0b100].map(cycle), modes.map(Some));
        assert_eq!([0b000, 0b011, 0b111].map(cycle), [None; 3]);
    }
}
