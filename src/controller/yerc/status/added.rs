//! Table of added status codes.

use super::super::Model;
use super::super::wire::Status;
use super::{link, robot};

/// Subject of an added status: what it is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Class {
    /// The command, or the values in the command.
    Operand,
    /// Activity or mode of the controller.
    State,
    /// Servo power, positions, panel locks or coordinates.
    Servo,
    /// Jobs and positions stored in the controller.
    Job,
    /// Syntax of a loaded job or condition file.
    Syntax,
    /// Backup functions and their devices.
    Backup,
    /// Command, instance or attribute of the request.
    Address,
    /// The data of the request.
    Data,
    /// An internal error of the controller.
    System,
    /// The controller is busy.
    Busy,
    /// Files and transfer frames.
    File,
}

impl Class {
    /// Name for tables and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Operand => "command and operands",
            Self::State => "controller state",
            Self::Servo => "servo, position or panel",
            Self::Job => "job or position data",
            Self::Syntax => "job file syntax",
            Self::Backup => "backup and devices",
            Self::Address => "request addressing",
            Self::Data => "request data",
            Self::System => "system",
            Self::Busy => "busy",
            Self::File => "file and frame",
        }
    }
}

/// An added status code (FS and DX chapter 5).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AddedRow {
    /// The code, 0x1010 to 0xFFFE.
    pub code: u16,
    /// Subject.
    pub class: Class,
    /// Models whose manual contains the code; empty for the two codes from other sources (0xA100, 0xA102).
    pub models: &'static [Model],
    /// Short name.
    pub name: &'static str,
    /// What happened, and the usual causes.
    pub cause: &'static str,
    /// Remedy.
    pub remedy: &'static str,
}

pub(super) const BOTH: &[Model] = &[Model::Fs100, Model::Dx200];
pub(super) const DX200: &[Model] = &[Model::Dx200];
pub(super) const NONE: &[Model] = &[];

type Text = &'static str;

/// Creates a row; the arguments are in column order.
pub(super) const fn row(
    code: u16,
    class: Class,
    models: &'static [Model],
    name: Text,
    cause: Text,
    remedy: Text,
) -> AddedRow {
    AddedRow { code, class, models, name, cause, remedy }
}

/// The row of an added status code; `None` if the code is unknown.
pub fn added(code: u32) -> Option<&'static AddedRow> {
    let code = u16::try_from(code).ok()?;
    [robot::ROWS, link::ROWS].into_iter().find_map(|rows| {
        let index = rows.binary_search_by_key(&code, |row| row.code).ok()?;
        rows.get(index)
    })
}

/// All added status codes, in ascending order.
pub fn all_added() -> impl Iterator<Item = &'static AddedRow> {
    robot::ROWS.iter().chain(link::ROWS)
}

/// Whether an added status means that the controller is busy, so that a repeat may soon succeed (DX chapter 5: 0xD8F1,
/// 0xD8FA, 0xE444, 0xFFF6).
pub fn is_busy(code: u32) -> bool {
    added(code).is_some_and(|row| row.class == Class::Busy)
}

/// Whether a refusal means that an object does not exist: an unknown instance, or data and groups that the controller
/// does not have. The manuals do not specify the answer for a group that is not fitted.
pub fn is_absent(status: Status) -> bool {
    /// Wrong control group or base axis, wrong instance, and data or types that do not exist.
    const ABSENT: [u32; 8] = [0x3370, 0x3380, 0xA001, 0xB002, 0xB004, 0xB005, 0xB007, 0xB008];
    match (status.code, status.added) {
        (0x00, _) => false,
        (0x08 | 0x28, 0) => true,
        (_, added) => ABSENT.contains(&added),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_codes_of_the_manuals_and_two_more() {
        let printed = |model| all_added().filter(|row| row.models.contains(&model)).count();
        assert_eq!(all_added().count(), 146 + 2);
        assert_eq!(printed(Model::Dx200), 146);
        assert_eq!(printed(Model::Fs100), 105);
        let elsewhere: Vec<u16> = all_added().filter(|row| row.models.is_empty()).map(|row| row.code).collect();
        assert_eq!(elsewhere, [0xA100, 0xA102]);
    }

    #[test]
    fn ascending_without_duplicates() {
        let codes: Vec<u16> = all_added().map(|row| row.code).collect();
        assert!(codes.is_sorted_by(|a, b| a < b));
        assert!(all_added().all(|row| added(row.code.into()) == Some(row)));
    }

    #[test]
    fn every_row_has_a_short_ascii_text() {
        for row in all_added() {
            for text in [row.name, row.cause, row.remedy] {
                assert!(text.len() >= 4 && text.len() <= 260, "{:#06X}: {} bytes: {text}", row.code, text.len());
                assert!(text.bytes().all(|b| (0x20..0x7F).contains(&b)), "{:#06X}: {text}", row.code);
                assert!(!text.contains("  "), "{:#06X}: {text}", row.code);
            }
            assert!(row.cause.ends_with('.') && row.remedy.ends_with('.'), "{:#06X}", row.code);
        }
    }

    #[test]
    fn busy_or_in_another_mode_is_not_absent() {
        for added in [0xA001, 0xB008, 0xB005] {
            assert!(is_absent(Status::refused(added)), "{added:#x}");
        }
        assert!(is_absent(Status { code: 0x28, ..Status::OK }));
        for added in [0xD8FA, 0x2010, 0x2150, 0x3070, 0xC002, 0xCFFF] {
            assert!(!is_absent(Status::refused(added)), "{added:#x}");
        }
        assert!(!is_absent(Status { code: 0x1F, ..Status::OK }));
        assert!(!is_absent(Status::OK));
    }

    #[test]
    fn four_codes_are_busy() {
        let busy: Vec<u16> = all_added().filter(|row| is_busy(row.code.into())).map(|row| row.code).collect();
        assert_eq!(busy, [0xD8F1, 0xD8FA, 0xE444, 0xFFF6]);
        assert!(!is_busy(0x2010));
        assert!(!is_busy(0x0001_D8F1));
    }
}
