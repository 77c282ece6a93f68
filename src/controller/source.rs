//! Lines of a text file, and encoding errors.

use std::borrow::Cow;

use crate::findings::{Findings, SourceLocation};

const START: SourceLocation = SourceLocation { line: 1, column: 1 };

/// Splits a text into lines without their ends. Invalid UTF-8 becomes the replacement character and adds an error to
/// the findings.
pub(crate) fn lines<'t>(text: &'t [u8], findings: &mut Findings) -> Vec<Cow<'t, str>> {
    if text.starts_with(&[0xFF, 0xFE]) || text.starts_with(&[0xFE, 0xFF]) {
        findings.error(START, "the file is UTF-16", Some("save the file as UTF-8".to_owned()));
        return Vec::new();
    }
    let text = match text.strip_prefix("\u{FEFF}".as_bytes()) {
        Some(rest) => {
            findings.note(START, "the file begins with a byte order mark, which is ignored");
            rest
        }
        None => text,
    };
    let mut lines = Vec::new();
    let (mut ends_told, mut bad): (bool, Option<(SourceLocation, u8)>) = (false, None);
    let mut bad_lines = 0;
    for (index, bytes) in text.split(|byte| *byte == b'\n').enumerate() {
        let number = index + 1;
        let bytes = match bytes.strip_suffix(b"\r") {
            Some(bytes) => {
                if !ends_told {
                    findings.note(place(number, bytes), "lines end with CR LF; the CR is ignored");
                    ends_told = true;
                }
                bytes
            }
            None => bytes,
        };
        if let Some(at) = bytes.iter().position(|byte| *byte == 0) {
            let hint = "this is not a text file, or the file is UTF-16: save the file as UTF-8";
            findings.error(
                place(number, &bytes[..at]),
                "NUL character; the rest of the file is not read",
                Some(hint.to_owned()),
            );
            break;
        }
        if let Err(error) = std::str::from_utf8(bytes) {
            let (before, from) = bytes.split_at(error.valid_up_to());
            bad_lines += 1;
            bad = bad.or(Some((place(number, before), from.first().copied().unwrap_or_default())));
        }
        lines.push(String::from_utf8_lossy(bytes));
    }
    if let Some((at, byte)) = bad {
        let more = if bad_lines > 1 { format!("; {bad_lines} lines have this error") } else { String::new() };
        let hint = Some("save the file as UTF-8".to_owned());
        findings.error(at, format!("byte {byte:02X} is not UTF-8{more}"), hint);
    }
    lines
}

/// Position after the first part of a line.
fn place(line: usize, front: &[u8]) -> SourceLocation {
    SourceLocation { line, column: String::from_utf8_lossy(front).chars().count() + 1 }
}
