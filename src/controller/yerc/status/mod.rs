//! Meanings and remedies of status and added status codes (DX chapters 4 and 5, FS chapter 5).
//!
//! Names, causes and remedies are worded independently of the manuals. An uncertain meaning is marked "hint".

use std::borrow::Cow;

use thiserror::Error;

use crate::user_input;

use super::Model;
use super::wire::Status;

mod added;
mod link;
mod robot;

pub use added::{AddedRow, Class, added, all_added, is_absent, is_busy};

/// A status code. Only the DX200 manual has a list (chapter 4); an FS100 probably uses the same codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StatusRow {
    /// The code.
    pub code: u8,
    /// Models whose manual contains the code.
    pub models: &'static [Model],
    /// Short name.
    pub name: &'static str,
    /// What happened.
    pub cause: &'static str,
    /// Remedy.
    pub remedy: &'static str,
}

/// Rows in ascending order of the code. Columns: code, models, name, cause, remedy.
#[rustfmt::skip] // Seven lines per row would hide the table.
static STATUSES: [StatusRow; 5] = [
    row(0x00, added::BOTH, "done", "The controller carried out the request.", "Nothing to do."),
    row(0x08, added::DX200, "command not defined", "The controller does not support this command number.",
        "Check the model (fs100 or dx200) and the software version (`armctl yerc info`): some commands need newer \
         software, and some exist on only one model."),
    row(0x09, added::DX200, "element (attribute) number is invalid", "The command has no such field.",
        "With `armctl yerc raw`, compare --attribute with the command's list or try 0; otherwise check the model."),
    row(0x1F, added::DX200, "refused, see the added status",
        "The controller refused; the added status gives the reason.",
        "Look up the added status: `armctl explain yerc CODE`. Without an added status, read the display of the \
         pendant and `armctl yerc alarm list`."),
    row(0x28, added::DX200, "array (instance) number does not exist",
        "The address does not exist: a number above the last variable, signal, group or task, or number plus count \
         above the end (not certain).",
        "Check the number against this controller's ranges and the set model."),
];

type Text = &'static str;

const fn row(code: u8, models: &'static [Model], name: Text, cause: Text, remedy: Text) -> StatusRow {
    StatusRow { code, models, name, cause, remedy }
}

/// The row of a status code; `None` if the code is unknown.
pub fn status(code: u8) -> Option<&'static StatusRow> {
    STATUSES.iter().find(|row| row.code == code)
}

/// All status codes, in ascending order.
pub fn all_statuses() -> impl Iterator<Item = &'static StatusRow> {
    STATUSES.iter()
}

/// Description of a code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Explanation {
    /// Text of the more specific code, in hexadecimal. For example, `0x2060` is an added status, and `0x28` is a status
    /// without an added status.
    pub code_text: String,
    /// Class of the code; `None` for status codes and for unknown codes.
    pub class: Option<Class>,
    /// Models whose manual contains the code.
    pub models: &'static [Model],
    /// Whether the tables contain the code.
    pub known: bool,
    /// Short name.
    pub name: Cow<'static, str>,
    /// What happened.
    pub cause: Cow<'static, str>,
    /// Remedy.
    pub remedy: Cow<'static, str>,
}

/// Describes the result code of an answer. Unknown codes also have a description.
///
/// An added status is more specific than its status, even than status 0 (DX 3.1: 0xE29C and 0xE2A7 come with status 0).
/// Codes in the manual have 16 bits. If an added status has two words, only the lower word is looked up, because the
/// manual does not define the upper word (DX 3.1).
pub fn explain(result: Status) -> Explanation {
    if result.added_size == 0 || result.added == 0 {
        return status(result.code).map_or_else(|| unknown_status(result.code), of_status);
    }
    let Some(row) = added(result.added & 0xFFFF) else {
        return unknown_added(result.added);
    };
    Explanation { code_text: added_text(result.added), ..of_added(row) }
}

/// An invalid code.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "'{text}' is not a valid code: status codes have one or two hexadecimal digits, added status codes have four, for \
     example 0x2060"
)]
pub struct NoCode {
    /// The invalid text.
    pub text: String,
}

/// Looks up a code in user notation, for example `2060`, `0x2060`, `e29c`, `1F` or `0x1f`. Codes are hexadecimal, with
/// or without prefix. The result is never empty. It has two entries only if a short code is in both tables.
pub fn lookup(text: &str) -> Result<Vec<Explanation>, NoCode> {
    let trimmed = text.trim();
    let code: u32 = user_input::code(trimmed).ok_or_else(|| NoCode { text: text.to_owned() })?;

    let short = u8::try_from(code).ok();
    let mut found: Vec<Explanation> = short.and_then(status).map(of_status).into_iter().collect();
    found.extend(added(code).map(of_added));
    if found.is_empty() {
        let mut unknown = short.map_or_else(|| unknown_added(code), unknown_status);
        if let Some(row) = trimmed.parse().ok().and_then(added) {
            let hint = format!(" If {trimmed} is a decimal number, the code is 0x{:04X}: {}.", row.code, row.name);
            unknown.remedy.to_mut().push_str(&hint);
        }
        found.push(unknown);
    }
    Ok(found)
}

fn of_status(row: &'static StatusRow) -> Explanation {
    Explanation {
        code_text: status_text(row.code),
        class: None,
        models: row.models,
        known: true,
        name: row.name.into(),
        cause: row.cause.into(),
        remedy: row.remedy.into(),
    }
}

fn of_added(row: &'static AddedRow) -> Explanation {
    Explanation {
        code_text: added_text(row.code.into()),
        class: Some(row.class),
        models: row.models,
        known: true,
        name: row.name.into(),
        cause: row.cause.into(),
        remedy: row.remedy.into(),
    }
}

fn unknown_status(code: u8) -> Explanation {
    Explanation {
        code_text: status_text(code),
        class: None,
        models: added::NONE,
        known: false,
        name: "unknown status code".into(),
        cause: "No source lists this status. Any status other than 0x00 means that the request was not carried out as \
                requested."
            .into(),
        remedy:
            "Look for a message on the pendant and in `armctl yerc alarm list`. If the status comes again, record the \
             exchange with --trace."
                .into(),
    }
}

fn unknown_added(code: u32) -> Explanation {
    Explanation {
        code_text: added_text(code),
        class: None,
        models: added::NONE,
        known: false,
        name: "unknown added status code".into(),
        cause: "No source lists this added status; a newer controller or an option may have more codes.".into(),
        remedy: "Look for a message on the pendant. An alarm number is not an added status: `armctl yerc alarm list` \
                 shows its text."
            .into(),
    }
}

fn status_text(code: u8) -> String {
    format!("0x{code:02X}")
}

/// Added status as text, for example `0xB005`.
pub fn added_text(code: u32) -> String {
    format!("0x{code:04X}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Vec<String> {
        lookup(text).unwrap().into_iter().map(|found| format!("{} {}", found.code_text, found.name)).collect()
    }

    #[test]
    fn five_status_codes_ascending() {
        let codes: Vec<u8> = all_statuses().map(|row| row.code).collect();
        assert_eq!(codes, [0x00, 0x08, 0x09, 0x1F, 0x28]);
        for row in all_statuses() {
            assert_eq!(status(row.code), Some(row));
            for text in [row.name, row.cause, row.remedy] {
                assert!(text.len() >= 4 && text.is_ascii() && !text.contains("  "), "{:#04X}: {text}", row.code);
            }
        }
    }

    #[test]
    fn added_status_describes_a_refusal() {
        let found = explain(Status::refused(0x2060));
        assert_eq!((found.code_text.as_str(), found.class), ("0x2060", Some(Class::State)));
        assert!(found.remedy.contains("alarm reset"), "{}", found.remedy);
    }

    #[test]
    fn command_remote_names_the_switch() {
        let found = explain(Status::refused(0x2100));
        assert!(found.remedy.contains("#82015 CMD REMOTE SEL"), "{}", found.remedy);
    }

    #[test]
    fn added_status_is_used_with_success() {
        let result = Status { code: 0, added_size: 1, added: 0xE29C };
        assert_eq!(explain(result).code_text, "0xE29C");
        assert_eq!(explain(Status::OK).code_text, "0x00");
    }

    #[test]
    fn finds_a_two_word_code_by_its_lower_word() {
        let found = explain(Status { code: 0x1F, added_size: 2, added: 0x0001_2070 });
        assert!(found.known);
        assert_eq!((found.code_text.as_str(), found.name.as_ref()), ("0x12070", "servo power is off"));
    }

    #[test]
    fn unlisted_codes_are_unknown() {
        for result in [Status { code: 0x77, added_size: 0, added: 0 }, Status::refused(0x1234)] {
            let found = explain(result);
            assert!(!found.known && found.name.starts_with("unknown"), "{found:?}");
            assert!(!found.cause.is_empty() && !found.remedy.is_empty());
        }
        assert_eq!(explain(Status { code: 0x77, added_size: 0, added: 0 }).code_text, "0x77");
    }

    #[test]
    fn typed_codes() {
        for text in ["2060", "0x2060", "0X2060", " 2060 "] {
            assert_eq!(names(text), ["0x2060 an error or alarm is active"], "{text}");
        }
        for text in ["1f", "1F", "0x1F", "0x1f"] {
            assert_eq!(names(text), ["0x1F refused, see the added status"], "{text}");
        }
        assert_eq!(names("0"), ["0x00 done"]);
        assert_eq!(names("e29c"), ["0xE29C requested file does not exist or is empty"]);
        assert_eq!(names("4315"), ["0x4315 unknown added status code"]);
        assert_eq!(names("77"), ["0x77 unknown status code"]);
    }

    #[test]
    fn recognizes_a_decimal_code_by_mistake() {
        let found = lookup("8288").unwrap();
        assert!(found[0].remedy.contains("0x2060"), "{}", found[0].remedy);
    }

    #[test]
    fn rejects_texts_without_a_code() {
        for text in ["", "0x", "hello", "+2060", "-1", "123456789", "20 60", "０ｘ２"] {
            assert_eq!(lookup(text), Err(NoCode { text: text.to_owned() }), "{text}");
        }
    }
}
