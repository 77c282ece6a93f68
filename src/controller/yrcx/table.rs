//! Table of remote commands: codes, words, ranges, answers and risks (chapter 2, sections 3 and 4).
//!
//! The table is the single source for encoding, decoding, descriptions and the simulator. If tables and detail pages of
//! the manual contradict each other, detail pages and examples have priority.

mod field;
mod layouts;
pub mod parameter;
mod rows;

pub use field::{COMMON_LINES, Charset, Field, Form, Presence, Show, When};
pub use rows::{Command, ROWS};

use super::value::Key;
use crate::Risk;

/// Code of the status reset in WI0. It also means that there is no command.
pub const STATUS_RESET: u16 = 0x0000;

/// Duration class of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DurationClass {
    /// The command ends at once. A start of a program ends when the controller accepts it (chapter 2, 1.2).
    Quick,
    /// The command ends when servos or motor power have switched.
    Power,
    /// The command ends when the motion ends, without a time limit.
    Motion,
    /// The command runs until the stop input goes off (4.2.6).
    Jog,
}

/// Constraint on several fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Rule {
    /// The product of X, Y and Z positions is at most 32767 (4.3.3).
    PalletSize,
    /// A parameter of an axis needs one axis; a parameter of the robot needs none (4.4.2).
    ParameterAxis,
    /// The value is within the range of the parameter (4.4.2).
    ParameterValue,
}

/// A remote command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Identifier.
    pub command: Command,
    /// Bits 11 to 0 of WI0.
    pub code: u16,
    /// Name for programs, for example `move-ptp`.
    pub id: &'static str,
    /// Readable name.
    pub name: &'static str,
    /// Section of the manual, in chapter 2.
    pub section: &'static str,
    /// Risk of the command.
    pub risk: Risk,
    /// Duration class.
    pub pace: DurationClass,
    /// Fields of the command words WI.
    pub request: &'static [&'static [Field]],
    /// Fields of the answer words WO after a normal end.
    pub answer: &'static [&'static [Field]],
    /// Constraints on several fields.
    pub rules: &'static [Rule],
}

/// Fields of a layout, in the order of its parts.
pub type Fields = std::iter::Flatten<std::iter::Copied<std::slice::Iter<'static, &'static [Field]>>>;

impl Row {
    /// The row for the code in WI0. The robot number in WI0 is ignored if the command has a robot.
    pub fn from_word(wi0: u16) -> Option<&'static Self> {
        let row = ROWS.iter().find(|row| row.code == wi0 & 0x0FFF)?;
        (wi0 & 0xF000 == 0 || row.has_robot()).then_some(row)
    }

    /// The row with this name.
    pub fn named(id: &str) -> Option<&'static Self> {
        ROWS.iter().find(|row| row.id == id)
    }

    /// Category 1 to 7; 0 for the status reset.
    pub const fn category(&self) -> u16 {
        if self.code == STATUS_RESET { 0 } else { (self.code >> 8) + 1 }
    }

    /// Fields of the command.
    pub fn request(&self) -> Fields {
        self.request.iter().copied().flatten()
    }

    /// Fields of the answer.
    pub fn answer(&self) -> Fields {
        self.answer.iter().copied().flatten()
    }

    /// Whether bits 15 to 12 of WI0 contain a robot number.
    pub fn has_robot(&self) -> bool {
        self.request().any(|field| field.key == Key::Robot)
    }

    /// Whether the controller accepts the command while the programming box has control. It then accepts only commands
    /// that read data (chapter 2, 3). The read command of program execution (4.6.4) is missing in the list of the
    /// manual, so it is not accepted.
    pub const fn enabled_under_programming_box(&self) -> bool {
        matches!(self.risk, Risk::Read) && !matches!(self.command, Command::ProgramShow)
    }

    /// Whether the command continues to its old target if it is sent again after a stop. A setting of the controller
    /// can change this (4.2.2, 4.2.4).
    pub const fn keeps_target(&self) -> bool {
        matches!(
            self.command,
            Command::MoveiPtp
                | Command::MoveiLinear
                | Command::MoveiMm
                | Command::MoveiPulse
                | Command::DriveiPoint
                | Command::DriveiMm
                | Command::DriveiPulse
        )
    }

    /// Code in the notation of the manual, for example `0xR001`.
    pub fn code_text(&self) -> String {
        if self.has_robot() { format!("0xR{:03X}", self.code) } else { format!("0x{:04X}", self.code) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_111_commands_with_one_row_each() {
        assert_eq!(ROWS.len(), 111);
        for (at, row) in ROWS.iter().enumerate() {
            assert!(ROWS[..at].iter().all(|other| other.code < row.code && other.id != row.id), "{}", row.id);
            assert_eq!(row.command.row().code, row.code);
            assert_eq!(Row::from_word(row.code).unwrap().id, row.id);
            assert_eq!(Row::named(row.id).unwrap().code, row.code);
        }
        let counts = [0, 1, 2, 3, 4, 5, 6, 7].map(|n| ROWS.iter().filter(|row| row.category() == n).count());
        assert_eq!(counts, [1, 48, 10, 20, 3, 7, 19, 3]);
    }

    #[test]
    fn only_commands_with_a_robot_field_have_a_robot() {
        assert!(Row::from_word(0x4001).is_some());
        assert!(Row::from_word(0x1042).is_none(), "motor power is that of the whole system");
        assert!(Row::from_word(0x1111).is_none(), "the layout of 4.3.5 has a robot, all else has not");
        assert!(Row::from_word(0x4516).is_some(), "4.7.18 has a robot, the tables have not");
        assert!(Row::from_word(0x0999).is_none());
    }

    #[test]
    fn reads_are_the_references() {
        for row in ROWS.iter().filter(|row| row.command != Command::StatusReset) {
            assert_eq!(row.risk == Risk::Read, row.name.starts_with("read "), "{}", row.id);
        }
    }

    #[test]
    fn fields_stay_in_the_words_and_do_not_overlap() {
        for row in ROWS {
            for layout in [row.request().collect::<Vec<_>>(), row.answer().collect()] {
                let mut taken: Vec<(usize, u16, Option<When>)> = Vec::new();
                for field in layout {
                    assert!(field.word + field.size() <= 16, "{} {}", row.id, field.key);
                    for word in field.word..field.word + field.size() {
                        let free = taken.iter().all(|(other, mask, when)| {
                            *other != word || mask & field.mask() == 0 || (*when != field.when && when.is_some())
                        });
                        assert!(free, "{} {}", row.id, field.key);
                        taken.push((word, field.mask(), field.when));
                    }
                }
            }
        }
    }
}
