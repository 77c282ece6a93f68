//! Sequential programs as text: one instruction a line, labels in place of tag numbers, comments.
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
//! A file is the program of one task; its first instruction is step 1. A label makes a TAG step, and stands wherever an
//! instruction names a tag. Numbers may be short, words and keys in any case. Every instruction may begin with its step
//! number, as lists of controllers have it. Names of points, counters and timers may stand for their numbers: `PT=pick`,
//! `JMPC TAG=next parts>=5`; `MOVP pick` alone goes there in the simplest way.

mod flow;
mod instruction;
mod listing;
mod paths;
mod reader;
mod tags;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};

pub use listing::{
    Listing, NOT_IN_MANUAL, NOT_READ, Rows, Style, Unread, listing, listing_named, listing_with, not_read, tags, used,
    uses,
};
pub use paths::Known;

use super::layout::Record;
use super::table::Instruction;
pub use crate::findings::{Finding, Severity};
use crate::findings::{Findings, SourceLocation};
use crate::names::Names;

/// Most steps that the tasks have together (TO 2-4, E22).
pub const MOST_STEPS: usize = 5000;

/// A program that can be sent.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Program {
    /// In their order; the first is step 1.
    pub steps: Vec<Step>,
    /// In the order of their steps.
    pub labels: Vec<Label>,
}

/// A step of a program. All its values are in range.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// Its row in the table.
    pub instruction: &'static Instruction,
    /// Its values.
    pub record: Record,
    /// Line of the file, from 1.
    pub line: usize,
}

/// A name for a tag.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// As written where it is defined.
    pub name: String,
    /// Number of the tag, 1 to 999.
    pub tag: i32,
    /// Its TAG step, from 1.
    pub step: usize,
    /// Line of the file, from 1.
    pub line: usize,
}

/// Result of a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Checked {
    /// The program, unless a finding is an error.
    pub program: Option<Program>,
    /// What there is to say, in the order of the text.
    pub findings: Vec<Finding>,
}

impl Step {
    /// As it is sent after WSTX and its number, to the character: `MOVP a PT=001 CN=00 S V=00 POST`.
    pub fn text(&self) -> String {
        self.record.written()
    }
}

impl Checked {
    /// The findings that keep the text from being a program.
    pub fn errors(&self) -> impl Iterator<Item = &Finding> {
        self.findings.iter().filter(|finding| finding.severity == Severity::Error)
    }
}

/// Steps among others of a task.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Part {
    /// Its first step, from 1.
    pub first: usize,
    /// Tags of the steps around it; `None` if they are not known, and any may be there.
    pub tags: Option<BTreeSet<i32>>,
}

/// What a file is that is no program at all, and what takes it.
fn foreign(text: &[u8]) -> Option<(&'static str, &'static str)> {
    let first = text.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii).find(|line| !line.is_empty())?;
    let first = first.strip_prefix("\u{FEFF}".as_bytes()).unwrap_or(first).to_ascii_lowercase();
    let cells = first.split(|byte| matches!(byte, b',' | b';' | b'\t')).count();
    let names_point = first.starts_with(b"point") || first.starts_with(b"\"point");
    if names_point && cells > 1 {
        return Some(("this is a CSV file of points, not a program", "`toyo point set --from FILE` writes points"));
    }
    if first.starts_with(b"[parameters]") || first.starts_with(b"# parameters of a toyo") {
        return Some(("this is a file of parameters, not a program", "`toyo param restore FILE` writes parameters"));
    }
    None
}

/// Reads the text of a program for a task with so many steps (TO 2-4, E22).
pub fn check(text: &[u8], room: usize) -> Checked {
    check_named(text, room, None, &Names::default())
}

/// Reads a whole [`listing`], in which steps may be marked as not in the manual: those are kept as they are, and are never
/// sent.
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

/// Reads the text of a part of a program, for which there is room for so many steps.
pub fn check_part(text: &[u8], room: usize, part: &Part) -> Checked {
    check_named(text, room, Some(part), &Names::default())
}

/// Reads the text of a program, or of a part of one, in which these names may stand.
pub fn check_named(text: &[u8], room: usize, part: Option<&Part>, names: &Names) -> Checked {
    check_known(text, room, part, names, &Known::default())
}

/// The same with what is known of the controller, against which the steps are checked as well.
pub fn check_known(text: &[u8], room: usize, part: Option<&Part>, names: &Names, known: &Known) -> Checked {
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
