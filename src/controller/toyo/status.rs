//! The five status pages (TO 2-2, STAS).

/// Status of a controller. Pages are numbered as in `STAS SNO=`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Status {
    /// Page 0: error, execution, origin.
    pub state: u8,
    /// Page 1: error code, 0 for none.
    pub error: u8,
    /// Page 2: modes, pendant, host.
    pub mode: u8,
    /// Page 3: servo, slave, card.
    pub equipment: u8,
    /// Page 4: inputs that affect a program.
    pub inputs: u8,
}

/// A bit of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bit {
    /// Page, 0 to 4.
    pub page: u8,
    /// Bit, 0 to 7.
    pub bit: u8,
    /// Name in snake case.
    pub name: &'static str,
    /// Description.
    pub about: &'static str,
    /// Whether the bit is active low.
    pub is_low: bool,
}

/// Program type: bits 1 and 0 of page 2.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ProgramKind {
    /// Sequential mode.
    Sequential,
    /// Palletizing mode.
    Palletizing,
    /// External point designation mode.
    ExternalPoint,
    /// Easy mode.
    Easy,
}

/// Run mode: bits 3 and 2 of page 2.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RunMode {
    /// Continuous execution.
    Automatic,
    /// Single-step execution.
    Step,
    /// Program editing.
    Program,
}

macro_rules! bits {
    ($($(#[$doc:meta])* $name:ident $page:literal / $bit:literal $low:literal $about:literal;)*) => {
        impl Status {
            $(
                $(#[$doc])*
                pub const fn $name(self) -> bool {
                    (self.page($page) >> $bit & 1 == 1) != $low
                }
            )*
        }

        /// All single bits with a meaning.
        pub const BITS: &[Bit] = &[
            $(Bit { page: $page, bit: $bit, name: stringify!($name), about: $about, is_low: $low },)*
        ];
    };
}

bits! {
    /// An error is present; page 1 has its code.
    has_error 0 / 0 false "error";
    /// A command or program runs.
    executing 0 / 1 false "in execution";
    /// A program is paused.
    paused 0 / 2 false "paused";
    /// The axes return to the origin.
    homing 0 / 3 false "in return to origin";
    /// Return to origin is complete: the axis positions are valid.
    homed 0 / 4 false "return to origin complete";
    /// Positioning is complete.
    in_position 0 / 5 false "positioning complete";
    /// Parameter 2 was changed: nothing runs before a power cycle.
    needs_power_cycle 0 / 7 false "parameter 2 changed";
    /// Single movement mode.
    single_movement 2 / 4 false "single movement mode";
    /// The teach pendant has control.
    pendant_on 2 / 6 false "teach pendant ON";
    /// The host has control.
    host_on 2 / 7 false "host ON";
    /// Servo power is on.
    servo_on 3 / 0 false "servo ON";
    /// A slave station is not ready (active low).
    slave_not_ready 3 / 4 true "slave not ready";
    /// A memory card is inserted.
    card_inserted 3 / 5 false "card inserted";
    /// The card is being read.
    card_reading 3 / 6 false "reading card";
    /// The card is being written.
    card_writing 3 / 7 false "writing to card";
    /// The escape input is on.
    escape_input 4 / 0 false "escape input ON";
    /// The continuous start input is on.
    continuous_input 4 / 1 false "continuous input ON";
    /// A program waits for an input.
    waits_for_input 4 / 2 false "waits for input";
    /// The pause input is on.
    pause_input 4 / 3 false "pause input ON";
    /// The ready output is on.
    ready_output 4 / 4 false "ready output";
}

impl Status {
    /// A page by its number; 0 if the page does not exist.
    pub const fn page(self, page: u8) -> u8 {
        match page {
            0 => self.state,
            1 => self.error,
            2 => self.mode,
            3 => self.equipment,
            4 => self.inputs,
            _ => 0,
        }
    }

    /// Replaces a page. Has no effect if the page does not exist.
    #[must_use]
    pub const fn with(mut self, page: u8, byte: u8) -> Self {
        match page {
            0 => self.state = byte,
            1 => self.error = byte,
            2 => self.mode = byte,
            3 => self.equipment = byte,
            4 => self.inputs = byte,
            _ => {}
        }
        self
    }

    /// Program type (bit order: ambiguity R27).
    pub const fn program_kind(self) -> ProgramKind {
        match self.mode & 0b11 {
            0b00 => ProgramKind::Sequential,
            0b01 => ProgramKind::Palletizing,
            0b10 => ProgramKind::ExternalPoint,
            _ => ProgramKind::Easy,
        }
    }

    /// Run mode, or `None` for the bit combination that is not in the manual.
    pub const fn run_mode(self) -> Option<RunMode> {
        match self.mode >> 2 & 0b11 {
            0b00 => Some(RunMode::Automatic),
            0b01 => Some(RunMode::Step),
            0b10 => Some(RunMode::Program),
            _ => None,
        }
    }
}

impl ProgramKind {
    /// The two bits of the program type.
    pub const fn bits(self) -> u8 {
        self as u8
    }

    /// Name in snake case.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sequential => "sequential",
            Self::Palletizing => "palletizing",
            Self::ExternalPoint => "external_point",
            Self::Easy => "easy",
        }
    }
}

impl RunMode {
    /// The two bits of the run mode, not shifted.
    pub const fn bits(self) -> u8 {
        self as u8
    }

    /// Name in snake case.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Automatic => "automatic",
            Self::Step => "step",
            Self::Program => "program",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_of_the_manual_is_decoded() {
        // TO 2-2: 22H is "in execution" and "positioning complete". TO 3-1 step 11: 30H after a return to origin.
        let status = Status::default().with(0, 0x22);
        assert!(status.executing() && status.in_position() && !status.homed());
        let status = Status::default().with(0, 0x30);
        assert!(!status.executing() && status.in_position() && status.homed());
    }

    #[test]
    fn modes_are_two_bits_each() {
        let status = Status::default().with(2, 0b1000_1011);
        assert_eq!((status.program_kind(), status.run_mode()), (ProgramKind::Easy, Some(RunMode::Program)));
        assert!(status.host_on() && !status.pendant_on());
        assert_eq!(Status::default().with(2, 0b1100).run_mode(), None);
    }

    #[test]
    fn a_missing_slave_is_a_cleared_bit() {
        assert!(Status::default().slave_not_ready());
        assert!(!Status::default().with(3, 0x10).slave_not_ready());
    }

    #[test]
    fn each_page_and_mode_has_its_own_bits() {
        let status = (0..5).fold(Status::default(), |status, page| status.with(page, 0x10 + page)).with(5, 0xFF);
        assert_eq!([0, 1, 2, 3, 4, 5].map(|page| status.page(page)), [0x10, 0x11, 0x12, 0x13, 0x14, 0]);
        // Ambiguity R27: the order of the bits.
        let kinds = [ProgramKind::Sequential, ProgramKind::Palletizing, ProgramKind::ExternalPoint, ProgramKind::Easy];
        let modes = [RunMode::Automatic, RunMode::Step, RunMode::Program];
        for (bits, kind) in (0..).zip(kinds) {
            assert_eq!((kind.bits(), Status::default().with(2, bits).program_kind()), (bits, kind));
        }
        for (bits, mode) in (0..).zip(modes) {
            assert_eq!((mode.bits(), Status::default().with(2, bits << 2).run_mode()), (bits, Some(mode)));
        }
    }
}
