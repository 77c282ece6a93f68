//! Line parser of a program: step numbers, labels, instructions, comments.

use super::instruction::{Cursor, Draft, TagUse, Target, excerpt, is_label, read as read_instruction};
use super::listing::NOT_READ;
use super::{MAX_STEPS, Part};
use crate::findings::{Findings, Rule, SourceLocation};
use crate::names::Names;
use crate::source;
use crate::toyo::table::Op;

/// Parsed lines of a file.
#[derive(Debug, Default)]
pub(super) struct ParsedLines {
    pub steps: Vec<Draft>,
    pub labels: Vec<LabelDefinition>,
}

/// Definition of a label.
#[derive(Debug)]
pub(super) struct LabelDefinition {
    pub name: String,
    /// Tag number that the text assigns to the label, as in `done=20:`.
    pub tag: Option<i32>,
    /// Index of the TAG step of the label, from 0.
    pub step: usize,
    pub at: SourceLocation,
}

/// Parses the lines of a task or of a part, with room for `room` steps.
pub(super) fn read(
    text: &[u8],
    room: usize,
    part: Option<&Part>,
    names: &Names,
    findings: &mut Findings,
) -> ParsedLines {
    let room = room.min(MAX_STEPS);
    let lines = source::lines(text, findings);
    let start = part.map_or(1, |part| part.first);
    let mut reader = Reader { read: ParsedLines::default(), start, first: None, names, findings };
    for (index, line) in lines.iter().enumerate() {
        if reader.findings.is_full() {
            break;
        }
        let before = reader.read.steps.len();
        reader.line(line, index + 1);
        let after = reader.read.steps.len();
        if before <= room && room < after {
            let at = reader.read.steps[room].at;
            let message =
                format!("step {} does not fit: the task can have at most {} steps", start + room, start + room - 1);
            reader.findings.error(
                at,
                message,
                Some("the machine parameter E22 (task-steps) sets this number".to_owned()),
            );
        }
        // The parser stops here, because not even a task with all steps has this step.
        if after > MAX_STEPS {
            break;
        }
    }
    if reader.read.steps.is_empty() && reader.findings.errors() == 0 {
        reader.findings.error(SourceLocation { line: 1, column: 1 }, "the file contains no instruction", None);
    }
    reader.read
}

struct Reader<'f> {
    read: ParsedLines,
    /// Number of the first step.
    start: usize,
    /// Number of the first step in the file.
    first: Option<usize>,
    /// Names of points, counters and timers.
    names: &'f Names,
    findings: &'f mut Findings,
}

impl Reader<'_> {
    fn line(&mut self, line: &str, number: usize) {
        let code = line.find(['#', ';']).map_or(line, |end| &line[..end]);
        let mut cursor = Cursor::new(code, number);
        if cursor.rest().is_empty() {
            return;
        }
        if !self.is_clean(code, number) {
            return self.read.steps.push(Draft::empty(cursor.place()));
        }
        let steps = self.read.steps.len();
        if cursor.rest().starts_with(|c: char| c.is_ascii_digit()) {
            self.step_number(&mut cursor);
        }
        if cursor.rest().starts_with(NOT_READ) {
            let hint = "read the program again, because the program is different without this step";
            self.findings.error(cursor.place(), "this step was not read from the controller", Some(hint.to_owned()));
            return self.read.steps.push(Draft::empty(cursor.place()));
        }
        while self.read.steps.len() <= MAX_STEPS && !self.findings.is_full() {
            let at = cursor.place();
            let Some(text) = cursor.before_colon() else { break };
            self.label(text, at);
        }
        if cursor.rest().is_empty() {
            if steps == self.read.steps.len() {
                self.findings.error(cursor.place(), "an instruction is missing after the step number", None);
            }
            return;
        }
        let at = cursor.place();
        let draft = read_instruction(&mut cursor, self.names, self.findings).unwrap_or_else(|| Draft::empty(at));
        if let (Op::Tag, [TagUse { target: Target::Label(name), .. }]) = (draft.instruction.op, &draft.tags[..]) {
            self.read.labels.push(LabelDefinition { name: name.clone(), tag: None, step: self.read.steps.len(), at });
        }
        self.read.steps.push(draft);
    }

    /// Whether the code has only valid characters. A file that is not UTF-8 was already reported.
    fn is_clean(&mut self, code: &str, line: usize) -> bool {
        let Some((column, wrong)) = code.chars().enumerate().find(|(_, c)| is_wrong(*c)) else { return true };
        if wrong != char::REPLACEMENT_CHARACTER {
            let hint = narrow(wrong).map(|narrow| format!("this is a wide character: write '{narrow}'"));
            let message = format!("character '{}' is not allowed here", wrong.escape_default());
            self.findings.error(SourceLocation { line, column: column + 1 }, message, hint);
        }
        false
    }

    /// Reads a step number. Step numbers must be consecutive, but can start at any number.
    fn step_number(&mut self, cursor: &mut Cursor<'_>) {
        let at = cursor.place();
        let text = cursor.word();
        let steps = self.read.steps.len();
        // No program has as many steps as this type can count.
        let Ok(number) = text.parse::<u16>().map(usize::from) else {
            self.findings.error(at, format!("'{}' is not a valid step number", excerpt(text)), None);
            return;
        };
        let is_first = self.first.is_none();
        let first = *self.first.get_or_insert(number.saturating_sub(steps));
        let expected = first + steps;
        if number != expected {
            let message = format!("step number {number} must be {expected:04}: step numbers increase by one");
            self.findings.error(at, message, Some("instructions need no step numbers".to_owned()));
            // The following step numbers are compared with this step number.
            self.first = Some(number.saturating_sub(steps));
        } else if is_first && first != self.start {
            let start = self.start;
            let message = format!(
                "the step numbers of the file begin with {first}, but its first instruction becomes step {start}"
            );
            self.findings.warning(Rule::Unchecked, at, message, None);
        }
    }

    /// Parses a label before a colon, for example `name` or `name = 010`.
    fn label(&mut self, text: &str, at: SourceLocation) {
        let (name, tag) = match text.split_once('=') {
            Some((name, tag)) => (name.trim(), Some(tag.trim())),
            None => (text.trim(), None),
        };
        let step = self.read.steps.len();
        if !is_label(name) {
            let message = format!("'{}' is not a valid label", excerpt(name));
            let hint = "a label begins with a letter, and contains letters, digits, _ and -";
            self.findings.error(at, message, Some(hint.to_owned()));
            return;
        }
        let number = tag.map(|tag| tag.parse().ok().filter(|tag| (1..=999).contains(tag)));
        if number == Some(None) {
            let message = format!("the tag of label {name} must be a number from 1 to 999");
            self.findings.error(at, message, None);
        }
        self.read.labels.push(LabelDefinition { name: name.to_owned(), tag: number.flatten(), step, at });
        self.read.steps.push(Draft::tag(Target::Label(name.to_owned()), at));
    }
}

/// Whether a character is a control character, invalid UTF-8, or the full-width form of an ASCII character.
fn is_wrong(c: char) -> bool {
    (c.is_control() && c != '\t') || c == char::REPLACEMENT_CHARACTER || narrow(c).is_some()
}

/// Returns the ASCII form of a full-width character. Japanese keyboards produce full-width characters.
fn narrow(c: char) -> Option<char> {
    match c {
        '\u{3000}' => Some(' '),
        '\u{FF01}'..='\u{FF5E}' => char::from_u32(u32::from(c) - 0xFEE0),
        _ => None,
    }
}
