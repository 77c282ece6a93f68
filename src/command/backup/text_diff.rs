//! Texts compared by lines, as `diff -u` shows them.

use std::time::{Duration, Instant};

use schemars::JsonSchema;
use serde::Serialize;
use similar::{Algorithm, ChangeTag, capture_diff_slices_deadline, group_diff_ops};

use crate::controller::text::Encoding;
use crate::output::view::{Cell, Tone};

/// Larger files are compared byte by byte only.
pub const MOST_TEXT: usize = 4 << 20;
/// Unchanged lines around a change.
const AROUND: usize = 3;
/// After this, a correct but longer diff does.
const PATIENCE: Duration = Duration::from_secs(2);

/// A stretch of changes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Hunk {
    /// First line in the old file, from 1; 0 if there is none.
    pub old_start: usize,
    /// How many of its lines.
    pub old_lines: usize,
    /// First line in the new file, from 1; 0 if there is none.
    pub new_start: usize,
    /// How many of its lines.
    pub new_lines: usize,
    /// Those of both.
    pub lines: Vec<DiffLine>,
}

/// A line of either file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct DiffLine {
    /// Which file has it.
    pub change: Change,
    /// Without what ends it.
    pub text: String,
    /// What ends it.
    pub ending: Ending,
}

/// Which file has a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// Both.
    Same,
    /// The old one alone.
    Removed,
    /// The new one alone.
    Added,
}

/// How a line ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// CR LF.
    CrLf,
    /// LF alone.
    Lf,
    /// The file ends without one.
    None,
}

/// A difference in lines.
#[derive(Debug)]
pub struct TextDifference {
    /// Stretches of changes.
    pub hunks: Vec<Hunk>,
    /// Whether nothing but ends of lines differs.
    pub only_line_endings: bool,
}

impl TextDifference {
    /// `None` if one of the two is no text.
    pub fn of(encoding: Encoding, old: &[u8], new: &[u8]) -> Option<Self> {
        let is_text = |bytes: &[u8]| bytes.len() <= MOST_TEXT && !bytes.contains(&0);
        if !is_text(old) || !is_text(new) {
            return None;
        }
        let (old, new) = (lines(old), lines(new));
        let only_line_endings = old.len() == new.len() && old.iter().zip(&new).all(|(a, b)| ended(a).0 == ended(b).0);
        let ops = capture_diff_slices_deadline(Algorithm::Myers, &old, &new, Instant::now().checked_add(PATIENCE));
        let line = |change: &similar::Change<&[u8]>| {
            let (text, ending) = ended(change.value());
            let change = match change.tag() {
                ChangeTag::Equal => Change::Same,
                ChangeTag::Delete => Change::Removed,
                ChangeTag::Insert => Change::Added,
            };
            DiffLine { change, text: encoding.decode(text), ending }
        };
        let hunk = |group: Vec<similar::DiffOp>| {
            let lines: Vec<DiffLine> =
                group.iter().flat_map(|op| op.iter_changes(&old, &new)).map(|change| line(&change)).collect();
            let count = |without: Change| lines.iter().filter(|line| line.change != without).count();
            let (old_lines, new_lines) = (count(Change::Added), count(Change::Removed));
            let start = |range: Option<std::ops::Range<usize>>, lines: usize| {
                range.map_or(0, |range| range.start + usize::from(lines > 0))
            };
            Hunk {
                old_start: start(group.first().map(similar::DiffOp::old_range), old_lines),
                old_lines,
                new_start: start(group.first().map(similar::DiffOp::new_range), new_lines),
                new_lines,
                lines,
            }
        };
        Some(Self { hunks: group_diff_ops(ops, AROUND).into_iter().map(hunk).collect(), only_line_endings })
    }
}

/// The unified form under the names of the two. A CR LF is what lines of a controller end in, so only other ends are shown,
/// and a bare LF only beside lines that have CR LF.
pub fn unified(old: &str, new: &str, hunks: &[Hunk]) -> Vec<Cell> {
    let mut shown =
        vec![Cell::from(format!("--- {old}")).tone(Tone::Bad), Cell::from(format!("+++ {new}")).tone(Tone::Good)];
    let marks_lf = hunks.iter().flat_map(|hunk| &hunk.lines).any(|line| line.ending == Ending::CrLf);
    for hunk in hunks {
        let Hunk { old_start, old_lines, new_start, new_lines, lines } = hunk;
        let head = format!("@@ -{old_start},{old_lines} +{new_start},{new_lines} @@");
        shown.push(Cell::from(head).tone(Tone::Warning));
        for DiffLine { change, text, ending } in lines {
            let (sign, tone) = match change {
                Change::Same => (' ', Tone::Plain),
                Change::Removed => ('-', Tone::Bad),
                Change::Added => ('+', Tone::Good),
            };
            let mark = if *ending == Ending::Lf && marks_lf { " [LF]" } else { "" };
            shown.push(Cell::from(format!("{sign}{text}{mark}")).tone(tone));
            if *ending == Ending::None {
                shown.push("\\ no line ending".into());
            }
        }
    }
    shown
}

/// Lines with what ends them.
fn lines(bytes: &[u8]) -> Vec<&[u8]> {
    bytes.split_inclusive(|byte| *byte == b'\n').collect()
}

fn ended(line: &[u8]) -> (&[u8], Ending) {
    match line.strip_suffix(b"\n") {
        None => (line, Ending::None),
        Some(text) => match text.strip_suffix(b"\r") {
            Some(text) => (text, Ending::CrLf),
            None => (text, Ending::Lf),
        },
    }
}
