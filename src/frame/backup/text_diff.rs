//! Line comparison of texts, as in `diff -u`.

use std::time::Instant;

use similar::{Algorithm, ChangeTag, capture_diff_slices_deadline, group_diff_ops};

use crate::prelude::basics::*;
use armctl_controller::text::Encoding;

/// Maximum file size for a line comparison; larger files are compared only by bytes.
pub const MAX_TEXT: usize = 4 << 20;
/// Number of context lines.
const CONTEXT_LINES: usize = 3;
/// Time limit for a minimal diff; after it, a longer but correct diff is accepted.
const DIFF_TIMEOUT: Duration = Duration::from_secs(2);

/// A hunk of changes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Hunk {
    /// First line in the old file, starting with 1; 0 if there is none.
    pub old_start: usize,
    /// Number of lines in the old file.
    pub old_lines: usize,
    /// First line in the new file, starting with 1; 0 if there is none.
    pub new_start: usize,
    /// Number of lines in the new file.
    pub new_lines: usize,
    /// Lines of both files.
    pub lines: Vec<DiffLine>,
}

/// A line of either file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct DiffLine {
    /// File or files that contain the line.
    pub change: Change,
    /// Text without the line ending.
    pub text: String,
    /// Line ending.
    pub ending: Ending,
}

/// File or files that contain a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// Both.
    Same,
    /// Only the old file.
    Removed,
    /// Only the new file.
    Added,
}

/// Line ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// CR LF.
    CrLf,
    /// LF without CR.
    Lf,
    /// End of file without a line ending.
    None,
}

/// Line differences.
#[derive(Debug)]
pub struct TextDifference {
    /// Hunks of changes.
    pub hunks: Vec<Hunk>,
    /// Whether only line endings differ.
    pub only_line_endings: bool,
}

impl TextDifference {
    /// Compares two texts; `None` if one of them is not text.
    pub fn of(encoding: Encoding, old: &[u8], new: &[u8]) -> Option<Self> {
        let is_text = |bytes: &[u8]| bytes.len() <= MAX_TEXT && !bytes.contains(&0);
        if !is_text(old) || !is_text(new) {
            return None;
        }
        let (old, new) = (lines(old), lines(new));
        let only_line_endings =
            old.len() == new.len() && old.iter().zip(&new).all(|(a, b)| with_line_ending(a).0 == with_line_ending(b).0);
        let ops = capture_diff_slices_deadline(Algorithm::Myers, &old, &new, Instant::now().checked_add(DIFF_TIMEOUT));
        let line = |change: &similar::Change<&[u8]>| {
            let (text, ending) = with_line_ending(change.value());
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
        Some(Self { hunks: group_diff_ops(ops, CONTEXT_LINES).into_iter().map(hunk).collect(), only_line_endings })
    }
}

/// Unified diff with the names of both files. CR LF is the normal line ending of controllers, so only other endings
/// are shown, and a bare LF only next to lines with CR LF.
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

/// Lines with their endings.
fn lines(bytes: &[u8]) -> Vec<&[u8]> {
    bytes.split_inclusive(|byte| *byte == b'\n').collect()
}

fn with_line_ending(line: &[u8]) -> (&[u8], Ending) {
    match line.strip_suffix(b"\n") {
        None => (line, Ending::None),
        Some(text) => match text.strip_suffix(b"\r") {
            Some(text) => (text, Ending::CrLf),
            None => (text, Ending::Lf),
        },
    }
}
