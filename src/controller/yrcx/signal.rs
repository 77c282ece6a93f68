//! Dedicated and general-purpose signals: the bits after the remote command (chapter 1, sections 1 and 2).
//!
//! Directions are as seen from the controller: the master sets SI and reads SO. Numbers are octal, as in the manual:
//! SI(00) to SI(07), SI(10) to SI(17), … SI(150) to SI(157).

use std::fmt;

use thiserror::Error;

use super::image::{DEDICATED_WORD, Image};
use crate::Risk;
use crate::similar_word::nearest;

/// Direction of a signal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Side {
    /// SI signals, which the master sets.
    Input,
    /// SO signals, which the controller sets.
    Output,
}

impl Side {
    /// Prefix `SI` or `SO`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Input => "SI",
            Self::Output => "SO",
        }
    }
}

/// A signal that can be used. It is never a reserved bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Signal {
    side: Side,
    index: u8,
}

/// When a dedicated signal is active.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Trigger {
    /// Active while the signal is off. In normal operation, the signal is on.
    WhileOff,
    /// Active while the signal is on.
    WhileOn,
    /// Active at the edge from off to on.
    Rise,
    /// An output that is on while its state lasts.
    State,
}

/// A signal with a fixed meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dedicated {
    /// The bit.
    pub signal: Signal,
    /// Name of the signal on the command line.
    pub name: &'static str,
    /// Name of the signal in the tables.
    pub text: &'static str,
    /// When the signal is active.
    pub trigger: Trigger,
    /// Effect of an input, or meaning of an output.
    pub effect: &'static str,
    /// Risk of switching the input on. For an output, the risk of reading it.
    pub risk: Risk,
}

/// An invalid signal.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum SignalError {
    /// The text is neither a name nor a valid number.
    #[error(
        "'{found}' is not a valid signal; use a name such as {example}, or a number from 20 to 157 with digits 0 to 7"
    )]
    Unknown {
        /// The invalid text.
        found: String,
        /// A valid name. It is similar to the text, if there is a similar name.
        example: &'static str,
    },
    /// A reserved bit.
    #[error("{side}({number:02}) is reserved", side = .side.name())]
    Reserved {
        /// Direction.
        side: Side,
        /// Octal number, as in the manual.
        number: u16,
    },
}

/// First general-purpose signal: SI(20) or SO(20).
const FIRST_GENERAL: u8 = 0o20;
/// Last general-purpose signal: SI(157) or SO(157).
const LAST: u8 = 0o157;

/// Dedicated inputs, which the master sets.
pub mod input {
    use super::{Side, Signal};

    /// Emergency stop, SI(00). It is on in normal operation.
    pub const EMERGENCY_STOP: Signal = Signal::at(Side::Input, 0o00);
    /// Servo on, SI(01).
    pub const SERVO_ON: Signal = Signal::at(Side::Input, 0o01);
    /// Stop, SI(06). It is on in normal operation.
    pub const STOP: Signal = Signal::at(Side::Input, 0o06);
    /// Sequence control, SI(10).
    pub const SEQUENCE_CONTROL: Signal = Signal::at(Side::Input, 0o10);
    /// Start of automatic operation, SI(12).
    pub const AUTO_START: Signal = Signal::at(Side::Input, 0o12);
    /// Return to origin, SI(14).
    pub const ORIGIN: Signal = Signal::at(Side::Input, 0o14);
    /// Program reset, SI(15).
    pub const PROGRAM_RESET: Signal = Signal::at(Side::Input, 0o15);
    /// Alarm reset, SI(16).
    pub const ALARM_RESET: Signal = Signal::at(Side::Input, 0o16);
    /// Return to origin of absolute axes, SI(17).
    pub const ORIGIN_ABSOLUTE: Signal = Signal::at(Side::Input, 0o17);
}

/// Dedicated outputs, which the controller sets.
pub mod output {
    use super::{Side, Signal};

    /// Emergency stop, SO(00).
    pub const EMERGENCY_STOP: Signal = Signal::at(Side::Output, 0o00);
    /// CPU OK, SO(01).
    pub const CPU_OK: Signal = Signal::at(Side::Output, 0o01);
    /// Servo on, SO(02).
    pub const SERVO_ON: Signal = Signal::at(Side::Output, 0o02);
    /// Alarm, SO(03).
    pub const ALARM: Signal = Signal::at(Side::Output, 0o03);
    /// MP ready, SO(04).
    pub const MP_READY: Signal = Signal::at(Side::Output, 0o04);
    /// Automatic mode, SO(10).
    pub const AUTO_MODE: Signal = Signal::at(Side::Output, 0o10);
    /// Return to origin complete, SO(11).
    pub const ORIGIN_COMPLETE: Signal = Signal::at(Side::Output, 0o11);
    /// Sequence program running, SO(12).
    pub const SEQUENCE_RUNNING: Signal = Signal::at(Side::Output, 0o12);
    /// Program running, SO(13).
    pub const PROGRAM_RUNNING: Signal = Signal::at(Side::Output, 0o13);
    /// Program reset, SO(14).
    pub const PROGRAM_RESET: Signal = Signal::at(Side::Output, 0o14);
    /// Warning, SO(15).
    pub const WARNING: Signal = Signal::at(Side::Output, 0o15);
}

/// All dedicated signals, inputs first.
#[rustfmt::skip] // Six lines per row would hide the table.
pub const DEDICATED: [Dedicated; 20] = [
    given(input::EMERGENCY_STOP, "emergency-stop", "emergency stop input", Trigger::WhileOff,
        "off puts the controller into emergency stop; this does not replace a hard-wired safety circuit", Risk::Write),
    given(input::SERVO_ON, "servo-on", "servo ON input", Trigger::Rise,
        "cancels the emergency stop state and switches the servos on; SI(00) must be on, and every stop must be \
         released",
        Risk::Motion),
    given(input::STOP, "stop", "stop input", Trigger::WhileOff,
        "off stops programs and jogs; the signal must be on to run", Risk::Write),
    given(input::SEQUENCE_CONTROL, "sequence-control", "sequence control input", Trigger::WhileOn,
        "runs the sequence program", Risk::Motion),
    given(input::AUTO_START, "auto-start", "auto operation start input", Trigger::Rise, "runs the robot program",
        Risk::Motion),
    given(input::ORIGIN, "origin", "return-to-origin input (incremental type axis)", Trigger::Rise,
        "returns incremental axes to origin; semi-absolute axes do an absolute search", Risk::Motion),
    given(input::PROGRAM_RESET, "program-reset", "program reset input", Trigger::Rise, "resets the robot program",
        Risk::Write),
    given(input::ALARM_RESET, "alarm-reset", "alarm reset input", Trigger::Rise,
        "resets the alarm; if the alarm stays, switch the power off and on", Risk::Write),
    given(input::ORIGIN_ABSOLUTE, "origin-absolute", "return-to-origin input (absolute type axis)", Trigger::Rise,
        "returns absolute axes to origin; if parameter DI17 is ABS/ORG, then also the incremental axes", Risk::Motion),
    says(output::EMERGENCY_STOP, "emergency-stop", "emergency stop status output",
        "the controller is in emergency stop"),
    says(output::CPU_OK, "cpu-ok", "CPU_OK status output", "the controller works"),
    says(output::SERVO_ON, "servo-on", "servo ON status output", "motor power is on"),
    says(output::ALARM, "alarm", "alarm status output", "a serious error has occurred"),
    says(output::MP_READY, "mp-ready", "MP RDY status output",
        "main power is on, and servos can be switched on; off after a serious error"),
    says(output::AUTO_MODE, "auto-mode", "AUTO mode status output", "AUTO mode is selected"),
    says(output::ORIGIN_COMPLETE, "origin-complete", "return-to-origin complete status output",
        "the robot has returned to origin"),
    says(output::SEQUENCE_RUNNING, "sequence-running", "sequence program execution status output",
        "the sequence program runs"),
    says(output::PROGRAM_RUNNING, "program-running", "robot program running output", "the robot program runs"),
    says(output::PROGRAM_RESET, "program-reset", "program reset status output",
        "the robot program is reset; off when the program starts"),
    says(output::WARNING, "warning", "warning output", "a warning is active"),
];

type Text = &'static str;

const fn given(signal: Signal, name: Text, text: Text, trigger: Trigger, effect: Text, risk: Risk) -> Dedicated {
    Dedicated { signal, name, text, trigger, effect, risk }
}

const fn says(signal: Signal, name: Text, text: Text, effect: Text) -> Dedicated {
    Dedicated { signal, name, text, trigger: Trigger::State, effect, risk: Risk::Read }
}

/// Resting image of a master: emergency stop and stop inputs on (inactive), everything else off.
pub fn resting() -> Image {
    let mut image = Image::default();
    input::EMERGENCY_STOP.set(&mut image, true);
    input::STOP.set(&mut image, true);
    image
}

impl Signal {
    const fn at(side: Side, index: u8) -> Self {
        Self { side, index }
    }

    /// The signal with this octal number, written as in the manual. For example, 157 is SI(157).
    pub fn new(side: Side, number: u16) -> Result<Self, SignalError> {
        let digits = [number / 100, number / 10 % 10, number % 10];
        let index = u8::try_from(digits[0] * 64 + digits[1] * 8 + digits[2]).ok();
        match index {
            Some(index) if digits.iter().all(|digit| *digit < 8) && index <= LAST => {
                let signal = Self { side, index };
                let usable = signal.is_general() || signal.dedicated().is_some();
                if usable { Ok(signal) } else { Err(SignalError::Reserved { side, number }) }
            }
            _ => Err(Self::unknown(side, &number.to_string())),
        }
    }

    /// Parses a name such as `servo-on`, or a number such as `20`, `SI20` or `SI(20)`.
    pub fn parse(side: Side, text: &str) -> Result<Self, SignalError> {
        if let Some(dedicated) = Self::of_side(side).find(|dedicated| dedicated.name == text) {
            return Ok(dedicated.signal);
        }
        let bare = match text.get(..2) {
            Some(prefix) if prefix.eq_ignore_ascii_case(side.name()) => &text[2..],
            _ => text,
        };
        let bare = bare.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).unwrap_or(bare);
        let number = bare.bytes().all(|byte| byte.is_ascii_digit()).then(|| bare.parse().ok()).flatten();
        Self::new(side, number.ok_or_else(|| Self::unknown(side, text))?)
    }

    /// All signals of a side, in ascending order.
    pub fn all(side: Side) -> impl Iterator<Item = Self> {
        (0..=LAST)
            .map(move |index| Self { side, index })
            .filter(|signal| signal.is_general() || signal.dedicated().is_some())
    }

    /// Direction.
    pub const fn side(self) -> Side {
        self.side
    }

    /// Number in octal digits, as in the manual.
    pub const fn number(self) -> u16 {
        let index = self.index as u16;
        index / 64 * 100 + index / 8 % 8 * 10 + index % 8
    }

    /// Word in the image, 16 to 22.
    pub const fn word(self) -> usize {
        DEDICATED_WORD + self.index as usize / 16
    }

    /// Bit in the word.
    pub const fn bit(self) -> u8 {
        self.index % 16
    }

    /// Whether the signal is a general-purpose signal, which robot programs can use freely.
    pub const fn is_general(self) -> bool {
        self.index >= FIRST_GENERAL
    }

    /// Fixed meaning; `None` for a general-purpose signal.
    pub fn dedicated(self) -> Option<&'static Dedicated> {
        DEDICATED.iter().find(|dedicated| dedicated.signal == self)
    }

    /// Name and address, for example `servo-on (SI(01))`. A general-purpose signal has only an address.
    pub fn named(self) -> String {
        self.dedicated().map_or_else(|| self.to_string(), |dedicated| format!("{} ({self})", dedicated.name))
    }

    /// Name of the signal. For a signal without a name, its address, for example `SI(20)`.
    pub fn name(self) -> String {
        self.dedicated().map_or_else(|| self.to_string(), |dedicated| dedicated.name.to_owned())
    }

    /// Risk of switching the signal. Switching it off is at most a write. The meaning of general-purpose inputs depends
    /// on the programs.
    pub fn risk(self, on: bool) -> Risk {
        match self.dedicated() {
            Some(dedicated) if on => dedicated.risk,
            _ => Risk::Write,
        }
    }

    /// Whether the signal is on in the image.
    pub fn is_on(self, image: &Image) -> bool {
        image.0[self.word()] >> self.bit() & 1 == 1
    }

    /// Switches the signal in the image.
    pub fn set(self, image: &mut Image, on: bool) {
        let mask = 1 << self.bit();
        let word = &mut image.0[self.word()];
        *word = if on { *word | mask } else { *word & !mask };
    }

    /// All dedicated signals of a side.
    pub fn of_side(side: Side) -> impl Iterator<Item = &'static Dedicated> {
        DEDICATED.iter().filter(move |dedicated| dedicated.signal.side == side)
    }

    fn unknown(side: Side, found: &str) -> SignalError {
        let usual = if side == Side::Input { "auto-start" } else { "servo-on" };
        let example = nearest(found, Self::of_side(side).map(|dedicated| dedicated.name)).unwrap_or(usual);
        SignalError::Unknown { found: found.chars().take(40).collect(), example }
    }
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}({:02})", self.side.name(), self.number())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_octal_and_count_bits() {
        let place = |number| {
            let signal = Signal::new(Side::Input, number).unwrap();
            (signal.word(), signal.bit(), signal.to_string())
        };
        // Chapter 1, section 1: n + 16 bit 14, n + 17 bits 0 and 15, n + 20 bit 0, n + 22 bit 15.
        assert_eq!(place(16), (16, 14, "SI(16)".to_owned()));
        assert_eq!(place(20), (17, 0, "SI(20)".to_owned()));
        assert_eq!(place(37), (17, 15, "SI(37)".to_owned()));
        assert_eq!(place(100), (20, 0, "SI(100)".to_owned()));
        assert_eq!(place(157), (22, 15, "SI(157)".to_owned()));
        for number in [8, 18, 80, 160, 177, 200, 1000, u16::MAX] {
            assert!(matches!(Signal::new(Side::Output, number), Err(SignalError::Unknown { .. })), "{number}");
        }
    }

    #[test]
    fn only_the_switch_on_of_a_signal_can_be_dangerous() {
        for signal in Signal::all(Side::Input) {
            let on = signal.dedicated().map_or(Risk::Write, |dedicated| dedicated.risk);
            assert_eq!((signal.risk(true), signal.risk(false)), (on, Risk::Write), "{signal}");
        }
        let dangerous = Signal::all(Side::Input).filter(|signal| signal.risk(true) == Risk::Motion);
        assert!(dangerous.count() > 3);
    }

    #[test]
    fn reserved_bits_are_no_signals() {
        let reserved = |side| {
            (0..16_u16)
                .map(|index| index / 8 * 10 + index % 8)
                .filter(|number| matches!(Signal::new(side, *number), Err(SignalError::Reserved { .. })))
                .collect::<Vec<_>>()
        };
        assert_eq!(reserved(Side::Input), [2, 3, 4, 5, 7, 11, 13]);
        assert_eq!(reserved(Side::Output), [5, 6, 7, 16, 17]);
        assert_eq!(Signal::all(Side::Input).count(), 9 + 96);
        assert_eq!(Signal::all(Side::Output).count(), 11 + 96);
    }

    #[test]
    fn texts_name_signals() {
        assert_eq!(Signal::parse(Side::Input, "stop"), Ok(input::STOP));
        assert_eq!(Signal::parse(Side::Output, "servo-on"), Ok(output::SERVO_ON));
        for text in ["150", "SO150", "so(150)", "SO(150)"] {
            assert_eq!(Signal::parse(Side::Output, text).unwrap().number(), 150, "{text}");
        }
        for junk in ["", "SI20", "stop", "-20", "2x", "99999999", "()", "é"] {
            assert!(matches!(Signal::parse(Side::Output, junk), Err(SignalError::Unknown { .. })), "{junk}");
        }
    }

    #[test]
    fn resting_image_stops_nothing() {
        let image = resting();
        assert_eq!(image.0[DEDICATED_WORD], 0b0100_0001);
        let mut changed = image;
        input::STOP.set(&mut changed, false);
        assert!(!input::STOP.is_on(&changed) && input::EMERGENCY_STOP.is_on(&changed));
    }
}
