//! Parser of one instruction in user notation: short numbers, any case, labels instead of tag numbers.

use crate::findings::{Findings, Rule, SourceLocation};
use crate::names::{NameMatch, Names};
use crate::similar_word::nearest;
use crate::toyo::field::{Field, FieldError, Form, Value};
use crate::toyo::names;
use crate::toyo::table::instructions::INSTRUCTIONS;
use crate::toyo::table::{Instruction, Op};

/// Target of a jump.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Target {
    Number(i32),
    Label(String),
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct TagUse {
    /// Index of the tag among the values of the instruction.
    pub index: usize,
    pub target: Target,
    pub at: SourceLocation,
}

/// An instruction whose labels are not yet replaced by tag numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Draft {
    pub instruction: &'static Instruction,
    pub values: Vec<Value>,
    pub tags: Vec<TagUse>,
    /// Start of the instruction.
    pub at: SourceLocation,
}

impl Draft {
    /// Placeholder for an instruction with errors. It keeps the step count right.
    pub fn empty(at: SourceLocation) -> Self {
        Self { instruction: Op::Nop.row(), values: Vec::new(), tags: Vec::new(), at }
    }

    /// A TAG step.
    pub fn tag(target: Target, at: SourceLocation) -> Self {
        let tags = vec![TagUse { index: 0, target, at }];
        Self { instruction: Op::Tag.row(), values: vec![Value::Number(0)], tags, at }
    }
}

/// Read position in a line.
#[derive(Clone, Copy)]
pub(super) struct Cursor<'t> {
    line: &'t str,
    number: usize,
    at: usize,
}

/// Whether a field refers to a tag. Such a tag must be defined.
pub(super) fn is_tag(field: &Field) -> bool {
    matches!(field.name, "tag" | "then" | "else")
}

/// Whether a word can be a label: it begins with a letter or `_`, and continues with letters, digits, `_` and `-`.
pub(super) fn is_label(word: &str) -> bool {
    word.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && word.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-')
}

/// Parses one instruction up to the end of the code. After an error, adds the error to the findings and returns `None`.
pub(super) fn read(cursor: &mut Cursor<'_>, known: &Names, findings: &mut Findings) -> Option<Draft> {
    let errors_before = findings.errors();
    let at = cursor.place();
    let word = cursor.word();
    let Some(row) = INSTRUCTIONS.iter().find(|row| row.word.eq_ignore_ascii_case(word)) else {
        let near = nearest(word, INSTRUCTIONS.iter().map(|row| row.word));
        let message = format!("unknown instruction '{}'", excerpt(word));
        findings.error(at, message, near.map(|near| format!("did you mean {near}?")));
        return None;
    };
    if let Some(draft) = read_short(row, cursor, known, at, findings) {
        return Some(draft);
    }
    if let Some((message, hint)) = unknown_short(row, cursor.rest(), known) {
        findings.error(cursor.place(), message, Some(hint));
        return None;
    }
    let mut draft = Draft { instruction: row, values: Vec::new(), tags: Vec::new(), at };
    let mut keys = row.layout.text[row.word.len()..].split("{}");
    let form = || Some(format!("write {}", row.form()));
    cursor
        .pass_to(keys.next().unwrap_or_default(), row.layout.fields.first(), known)
        .map_err(|missing| findings.error(cursor.place(), missing, form()))
        .ok()?;
    for (index, field) in row.layout.fields.iter().enumerate() {
        let at = cursor.place();
        let text = cursor.value(field);
        if text.is_empty() {
            let label = if is_tag(field) { ", or a label" } else { "" };
            findings.error(at, format!("{} is missing: {}{label}", field.name, field.expected()), form());
            return None;
        }
        if is_tag(field) {
            match target(field, text) {
                Ok(target) => draft.tags.push(TagUse { index, target, at }),
                Err(message) => findings.error(at, message, None),
            }
            draft.values.push(Value::Number(0));
        } else {
            match named_value(field, text, known) {
                Ok(value) => draft.values.push(value),
                Err((message, hint)) => findings.error(at, message, hint),
            }
        }
        let key = keys.next().unwrap_or_default();
        let next = row.layout.fields.get(index + 1);
        cursor.pass_to(key, next, known).map_err(|missing| findings.error(cursor.place(), missing, form())).ok()?;
    }
    if !cursor.rest().is_empty() {
        findings.error(cursor.place(), format!("unexpected text '{}'", excerpt(cursor.rest())), form());
    }
    pass_fixed(&mut draft, findings);
    (findings.errors() == errors_before).then_some(draft)
}

/// Replaces POST by PASS: RSMV always passes its point, whatever the listing says (ambiguity R4).
fn pass_fixed(draft: &mut Draft, findings: &mut Findings) {
    if draft.instruction.op != Op::Rsmv {
        return;
    }
    for value in &mut draft.values {
        if *value == Value::Word("POST") {
            findings.warning(
                Rule::Unchecked,
                draft.at,
                "RSMV never stops at its position: POST has the effect of PASS",
                None,
            );
            *value = Value::Word("PASS");
        }
    }
}

/// Parses a tag number or label.
fn target(field: &Field, text: &str) -> Result<Target, String> {
    if is_label(text) {
        return Ok(Target::Label(text.to_owned()));
    }
    match field.read(text) {
        Ok(Value::Number(number)) => Ok(Target::Number(number)),
        Ok(_) | Err(FieldError::Form { .. }) => {
            Err(format!("{}: '{}' is neither a valid tag (001 to 999) nor a label", field.name, excerpt(text)))
        }
        Err(error) => Err(error.to_string()),
    }
}

/// Parses a point instruction that has only a name, for example `MOVP pick`. Defaults: absolute, no counter, the axis
/// speed of the last SPD, stop at the point.
fn read_short(
    row: &'static Instruction,
    cursor: &mut Cursor<'_>,
    known: &Names,
    at: SourceLocation,
    findings: &mut Findings,
) -> Option<Draft> {
    let point = row.layout.fields.iter().find(|field| field.name == "point")?;
    let number = by_name(point, cursor.rest(), known).ok()??;
    let values = row.layout.fields.iter().map(|field| match field.form {
        _ if field.name == point.name => Some(Value::Number(number)),
        Form::Number(number) => Some(Value::Number(number.least)),
        Form::Word(words) => words.first().map(|word| Value::Word(word.text)),
        _ => None,
    });
    let values: Vec<Value> = values.collect::<Option<_>>()?;
    let whole = row.layout.record(values.clone()).ok()?.written();
    findings.note(at, format!("{} {} is {whole}", row.word, cursor.rest()));
    Some(Draft { instruction: row, values, tags: Vec::new(), at })
}

/// Message and hint for a short form with an unknown name, for example `MOVP pikc`.
fn unknown_short(row: &Instruction, text: &str, known: &Names) -> Option<(String, String)> {
    let point = row.layout.fields.iter().find(|field| field.name == "point")?;
    let is_first = row.layout.fields.first()?.read(text).is_ok();
    (is_label(text) && !is_first).then(|| unknown_name(point, text, known)).flatten()
}

/// Number of a named point, counter or timer. `None` if no object of the field's kind has this name.
fn by_name(field: &Field, text: &str, known: &Names) -> Result<Option<i32>, String> {
    let Some((kind, _)) = names::of_field(field.name) else { return Ok(None) };
    match known.find(&[kind], text) {
        NameMatch::One(name) => Ok(names::number(&name.address)),
        NameMatch::Several(several) => {
            let addresses: Vec<&str> = several.iter().map(|name| name.address.as_str()).collect();
            Err(format!("'{}' is the name of {}; write the number", excerpt(text), addresses.join(" and of ")))
        }
        NameMatch::None => Ok(None),
    }
}

/// Parses a field value or a name. An error has a message, and a hint if one is known.
fn named_value(field: &Field, text: &str, known: &Names) -> Result<Value, (String, Option<String>)> {
    if let Some(number) = by_name(field, text, known).map_err(|message| (message, None))? {
        return Ok(Value::Number(number));
    }
    value(field, text).map_err(|error| match unknown_name(field, text, known) {
        Some((message, hint)) => (message, Some(hint)),
        None => (error.to_string(), None),
    })
}

/// Error and hint for an unknown name. `None` if the field does not accept names.
fn unknown_name(field: &Field, text: &str, known: &Names) -> Option<(String, String)> {
    let (kind, prefix) = names::of_field(field.name).filter(|_| is_label(text))?;
    let candidates = known.iter().filter(|name| name.kind == kind).map(|name| name.name.as_str());
    let hint = nearest(text, candidates).map(|near| format!("did you mean {near}?"));
    let hint = hint.unwrap_or_else(|| format!("define names in robots.toml: {} = \"{prefix}1\"", excerpt(text)));
    Some((format!("no {} has the name '{}'", kind.word(), excerpt(text)), hint))
}

fn value(field: &Field, text: &str) -> Result<Value, FieldError> {
    if let Form::Word(words) = field.form {
        let mut same = words.iter().filter(|word| word.text.trim_end().eq_ignore_ascii_case(text));
        if let (Some(word), None) = (same.next(), same.next()) {
            return Ok(Value::Word(word.text));
        }
    }
    field.read(text).map_err(|error| match error {
        FieldError::Form { name, found, form } => FieldError::Form { name, found: excerpt(&found).to_owned(), form },
        FieldError::Range { .. } | FieldError::Decimals { .. } => error,
    })
}

/// Start of a text, for a message.
pub(super) fn excerpt(text: &str) -> &str {
    text.char_indices().nth(20).map_or(text, |(end, _)| &text[..end])
}

const BLANKS: [char; 2] = [' ', '\t'];

impl<'t> Cursor<'t> {
    /// A cursor at the first character of a line. The line has no comment.
    pub fn new(line: &'t str, number: usize) -> Self {
        let mut cursor = Self { line, number, at: 0 };
        cursor.skip();
        cursor
    }

    /// The rest of the line without surrounding blanks.
    pub fn rest(&self) -> &'t str {
        self.line[self.at..].trim_matches(BLANKS)
    }

    pub fn place(&self) -> SourceLocation {
        SourceLocation { line: self.number, column: self.line[..self.at].chars().count() + 1 }
    }

    /// Takes the text before the next colon, and the colon; `None` without a colon.
    pub fn before_colon(&mut self) -> Option<&'t str> {
        let taken = self.line[self.at..].split_once(':')?.0;
        self.take(taken.len());
        self.take(1);
        Some(taken)
    }

    /// Takes a word and the blanks after it.
    pub fn word(&mut self) -> &'t str {
        self.until(&BLANKS)
    }

    /// Takes the text of a field: a comparison, eight characters of a port, or text without blanks and comparisons.
    fn value(&mut self, field: &Field) -> &'t str {
        match field.form {
            Form::Word(words) if words.iter().all(|word| word.text.starts_with(['=', '<', '>'])) => {
                let rest = &self.line[self.at..];
                let end = rest.find(|c| !matches!(c, '=' | '<' | '>')).unwrap_or(rest.len());
                self.take(end)
            }
            _ => self.until(&[' ', '\t', '=', '<', '>']),
        }
    }

    fn until(&mut self, ends: &[char]) -> &'t str {
        let rest = &self.line[self.at..];
        self.take(rest.find(ends).unwrap_or(rest.len()))
    }

    fn take(&mut self, len: usize) -> &'t str {
        let taken = &self.line[self.at..self.at + len];
        self.at += len;
        self.skip();
        taken
    }

    fn skip(&mut self) {
        let rest = &self.line[self.at..];
        self.at += rest.len() - rest.trim_start_matches(BLANKS).len();
    }

    /// Skips the words before a field. A name needs no key before it, as in `JMPC TAG=next parts>=5`.
    fn pass_to(&mut self, words: &str, field: Option<&Field>, known: &Names) -> Result<(), String> {
        if let Some(field) = field
            && let Some((_, prefix)) = names::of_field(field.name)
            && words.trim_start().starts_with(prefix)
        {
            let text = { *self }.value(field);
            if by_name(field, text, known).is_ok_and(|found| found.is_some()) {
                return Ok(());
            }
        }
        self.pass(words)
    }

    /// Skips words, in any case and with any number of blanks. Does not move if the text has other words.
    fn pass(&mut self, words: &str) -> Result<(), String> {
        let start = self.at;
        for expected in words.chars().filter(|c| *c != ' ') {
            if expected == '=' {
                self.skip();
            }
            match self.line[self.at..].chars().next() {
                Some(found) if found.eq_ignore_ascii_case(&expected) => self.at += found.len_utf8(),
                _ => return Err(self.missing(start, words)),
            }
        }
        self.skip();
        Ok(())
    }

    /// Moves the cursor back to `start`, and returns the message that `words` are missing there.
    fn missing(&mut self, start: usize, words: &str) -> String {
        self.at = start;
        let words = words.trim();
        match self.rest().split(BLANKS).next() {
            Some(found) if !found.is_empty() => format!("{words} is expected, not '{}'", excerpt(found)),
            _ => format!("{words} is missing"),
        }
    }
}
