//! Text format of sequential programs: one instruction per line, labels instead of tag numbers, comments.
//!
//! ```text
//! # Brings parts to the tray.
//!       SPD V=5
//! next: MOVP a PT=1 CN=0 S V=0 POST
//!       JMPI TAG=next STN=0 PN1=.......1    ; while the gripper is full
//! done=20:                                  ; a label with a tag number of its own
//!       END
//! ```
//!
//! A file is the program of one task; its first instruction is step 1. A label creates a TAG step, and can replace any
//! tag number. Numbers can have fewer digits than in the protocol, and words and keys can be in upper or lower case. An
//! instruction may begin with its step number, as in listings. Names of points, counters and timers can replace their
//! numbers, for example `PT=pick` or `JMPC TAG=next parts>=5`. `MOVP pick` moves to a point with default values.

mod flow;
mod instruction;
mod listing;
mod paths;
mod reader;
mod references;
mod tags;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};

pub use listing::{
    Listing, NOT_IN_MANUAL, NOT_READ, Rows, Style, Unread, listing, listing_named, listing_with, not_read, tags, used,
    uses,
};
pub use paths::ControllerData;
pub use references::name_of;

use super::layout::Record;
use super::table::Instruction;
pub use crate::findings::{Finding, Rule, Severity};
use crate::findings::{Findings, SourceLocation};
use crate::names::Names;

/// Maximum total of steps of all tasks (TO 2-4, E22).
pub const MAX_STEPS: usize = 5000;

/// A valid program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Program {
    /// Steps in order, from step 1.
    pub steps: Vec<Step>,
    /// Labels, in the order of their steps.
    pub labels: Vec<Label>,
}

/// A step of a program, with all values in range.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// Row of the instruction table.
    pub instruction: &'static Instruction,
    /// Values of the step.
    pub record: Record,
    /// Line of the file, from 1.
    pub line: usize,
}

/// A name for a tag.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// Name as spelled in its definition.
    pub name: String,
    /// Tag number, 1 to 999.
    pub tag: i32,
    /// Number of the TAG step of the label, from 1.
    pub step: usize,
    /// Line of the file, from 1.
    pub line: usize,
}

/// Result of a check.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Checked {
    /// The program; `None` after an error.
    pub program: Option<Program>,
    /// All findings, in text order.
    pub findings: Vec<Finding>,
}

impl Step {
    /// Text of the step as the protocol has it after WSTX and the step number, for example `MOVP a PT=001 CN=00 S V=00
    /// POST`.
    pub fn text(&self) -> String {
        self.record.written()
    }
}

impl Checked {
    /// The errors among the findings.
    pub fn errors(&self) -> impl Iterator<Item = &Finding> {
        self.findings.iter().filter(|finding| finding.severity == Severity::Error)
    }
}

/// A part of the program of a task.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Part {
    /// Number of the first step, from 1.
    pub first: usize,
    /// Tags in the program outside of the part; `None` if they are unknown.
    pub tags: Option<BTreeSet<i32>>,
}

/// Detects a file of another type. Returns this type, and the command for it.
fn foreign(text: &[u8]) -> Option<(&'static str, &'static str)> {
    let first = text.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii).find(|line| !line.is_empty())?;
    let first = first.strip_prefix("\u{FEFF}".as_bytes()).unwrap_or(first).to_ascii_lowercase();
    let cells = first.split(|byte| matches!(byte, b',' | b';' | b'\t')).count();
    let is_table = first.starts_with(b"name") || first.starts_with(b"\"name");
    if is_table && cells > 1 {
        return Some((
            "this is a CSV table, not a program",
            "use `toyo point restore FILE` or `toyo param restore FILE` to write the table",
        ));
    }
    None
}

/// Parses a program for a task of `room` steps (TO 2-4, E22).
pub fn check(text: &[u8], room: usize) -> Checked {
    check_named(text, room, None, &Names::default())
}

/// Parses a whole [`listing()`]. Steps that are marked as not in the manual are kept, and are never sent.
pub fn check_kept(text: &[u8], room: usize) -> Checked {
    let mut kept = BTreeMap::new();
    let mut lines = Vec::new();
    for (index, line) in text.split(|byte| *byte == b'\n').enumerate() {
        let marked = std::str::from_utf8(line).ok().and_then(|line| line.trim_end().rsplit_once("# "));
        match marked.filter(|(_, comment)| *comment == NOT_IN_MANUAL) {
            Some((raw, _)) => {
                kept.insert(index + 1, Record::unlisted(raw));
                lines.push(&b"NOP"[..]);
            }
            None => lines.push(line),
        }
    }
    let mut checked = check(&lines.join(&b'\n'), room);
    for step in checked.program.iter_mut().flat_map(|program| &mut program.steps) {
        if let Some(record) = kept.remove(&step.line) {
            step.record = record;
        }
    }
    checked
}

/// Parses a part of a program, with room for `room` steps.
pub fn check_part(text: &[u8], room: usize, part: &Part) -> Checked {
    check_named(text, room, Some(part), &Names::default())
}

/// Parses a program or a part of a program, with these names.
pub fn check_named(text: &[u8], room: usize, part: Option<&Part>, names: &Names) -> Checked {
    check_known(text, room, part, names, &ControllerData::default())
}

/// Parses a program or a part of a program, and compares it with known data of the controller.
pub fn check_known(text: &[u8], room: usize, part: Option<&Part>, names: &Names, known: &ControllerData) -> Checked {
    let mut findings = Findings::default();
    if let Some((what, hint)) = foreign(text) {
        findings.error(SourceLocation { line: 1, column: 1 }, what, Some(hint.to_owned()));
        return Checked { program: None, findings: findings.sorted() };
    }
    let read = reader::read(text, room, part, names, &mut findings);
    let program = tags::resolve(read, part, &mut findings);
    if findings.errors() == 0 {
        flow::check(&program, part.is_some(), &mut findings);
        paths::check(&program, part.is_some(), known, &mut findings);
    }
    let program = (findings.errors() == 0).then_some(program.program);
    Checked { program, findings: findings.sorted() }
}
