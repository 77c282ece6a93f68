//! Decoder of a protocol line into described fields. It uses the tables and never fails: a damaged line is decoded up
//! to the damage.

use std::ops::Range;

use schemars::JsonSchema;
use serde::Serialize;

use super::errors;
use super::field::{Field, FieldError, Form, Value};
use super::layout::{Layout, LayoutError};
use super::request::{BlockError, Request};
use super::status::{BITS, Status};
use super::table::{Command, Instruction, Pallet, Parameter, Row};

/// A decoded line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Description {
    /// One-line summary.
    pub title: String,
    /// Section of the manual if the command is known, for example `TO 2-2`.
    pub section: Option<String>,
    /// Command and values, in their order.
    pub fields: Vec<FieldNote>,
    /// The problem of the line, if any.
    pub problem: Option<String>,
}

/// A part of a line.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[schemars(rename = "FieldRow")]
pub struct FieldNote {
    /// Column of the first character, from 1.
    pub column: usize,
    /// Number of characters.
    pub width: usize,
    /// Name of the part.
    pub name: &'static str,
    /// Text of the part in the line.
    pub raw: String,
    /// Meaning of the text.
    pub meaning: String,
    /// Description of the field.
    pub about: &'static str,
}

/// Sender of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sender {
    /// The host: commands.
    Host,
    /// The controller: answers.
    Controller,
}

impl Sender {
    /// Guesses the sender of a line: the host or the controller, depending on whose form fits a longer part of the
    /// line. TYPE has the same form on both sides and counts as a request.
    pub fn guess(line: &str) -> Self {
        let text = line.trim_end_matches(['\r', '\n']);
        if matches!(text.trim_end_matches(' '), "@OK" | "@NG") {
            return Self::Controller;
        }
        let Some((_, row)) = command_of(text) else { return Self::Host };
        let reach = |sender: Self| {
            let ends = forms(row, sender).iter().map(|form| Notes::new(text).block(row, form, sender));
            ends.map(|end| end.map_or_else(|(at, _)| at, |()| usize::MAX)).max().unwrap_or_default()
        };
        // An answer to MERP differs from the request only in its trailing blanks (ambiguity C5).
        let padded = row.command == Command::Merp && text.ends_with(' ');
        if padded || reach(Self::Controller) > reach(Self::Host) { Self::Controller } else { Self::Host }
    }
}

/// Decodes a line, with or without line end. `request` is the request that an answer belongs to, if it is known: `@OK`
/// and `@NG` do not contain their request.
pub fn describe(line: &str, sender: Sender, request: Option<&Request>) -> Description {
    let text = line.trim_end_matches(['\r', '\n']);
    let request = request.filter(|_| sender == Sender::Controller);
    if sender == Sender::Controller
        && let Some((what, about)) = verdict(text)
    {
        return describe_verdict(text, what, about, request);
    }
    let mut notes = Notes::new(text);
    let row = command_of(text).map(|(_, row)| row);
    if let Some(row) = row {
        notes = describe_block(text, row, sender);
    }
    // Only an error of the block as a whole is reported here. If an error has a position in the line, the notes already
    // contain it.
    let damage = match Request::parse(text) {
        Err(BlockError::Layout(_) | BlockError::Values(_) | BlockError::Unknown { .. } | BlockError::Other { .. }) => {
            None
        }
        Err(error) => Some(error.to_string()),
        Ok(_) => None,
    };
    let other = match request.map(|request| request.answer(text)) {
        Some(Err(error @ BlockError::Other { .. })) => Some(error.to_string()),
        _ => None,
    };
    let what = if sender == Sender::Host { "request" } else { "answer" };
    let title = match row {
        Some(row) => format!("{what}: {}, {}", row.word, row.about),
        None => format!("{what}, unknown"),
    };
    Description { title, section: row.map(citation), fields: notes.fields, problem: damage.or(other).or(notes.problem) }
}

/// One-line summary of a line, for traces.
pub fn summary(line: &str, sender: Sender, request: Option<&Request>) -> String {
    let Description { title, fields, problem, .. } = describe(line, sender, request);
    if let Some(problem) = problem {
        return format!("no valid block: {problem}");
    }
    let values: Vec<String> = fields.iter().skip(1).map(|field| format!("{} {}", field.name, field.meaning)).collect();
    if values.is_empty() { title } else { format!("{title}: {}", values.join(", ")) }
}

fn citation(row: &'static Row) -> String {
    format!("TO {}", row.section)
}

/// Name and meaning of `@OK` and `@NG`.
fn verdict(text: &str) -> Option<(&'static str, &'static str)> {
    match text.trim_end_matches(' ') {
        "@OK" => Some(("done", "accepted; a longer action has started")),
        "@NG" => Some(("refused", "refused: not possible now, or never possible; the controller sends no code")),
        _ => None,
    }
}

fn describe_verdict(text: &str, what: &str, about: &'static str, request: Option<&Request>) -> Description {
    let title = match request {
        Some(request) => format!("answer to {}: {what}", request.row().word),
        None => format!("answer: {what}"),
    };
    let mut notes = Notes::new(text);
    notes.add(1..3, "verdict", what.to_owned(), about);
    let problem = request.and_then(|request| request.answer(text).err()).map(|error| error.to_string());
    Description { title, section: request.map(|request| citation(request.row())), fields: notes.fields, problem }
}

/// Command word of a block, and the table row of this command.
fn command_of(text: &str) -> Option<(&str, &'static Row)> {
    let word = text.strip_prefix('@').unwrap_or(text).split(' ').next()?;
    Some((word, Row::named(word)?))
}

fn forms(row: &'static Row, sender: Sender) -> &'static [Layout] {
    if sender == Sender::Host { row.requests } else { row.answers }
}

/// Decodes a line by the form that fits, or else by the form that fits the longest part of the line.
fn describe_block<'t>(text: &'t str, row: &'static Row, sender: Sender) -> Notes<'t> {
    let mut best: Option<(usize, Notes<'t>)> = None;
    for form in forms(row, sender) {
        let mut notes = Notes::new(text);
        match notes.block(row, form, sender) {
            Ok(()) => return notes,
            Err((at, problem)) => {
                notes.problem.get_or_insert(problem);
                if best.as_ref().is_none_or(|(other, _)| *other < at) {
                    best = Some((at, notes));
                }
            }
        }
    }
    best.map_or_else(
        || {
            let mut notes = Notes::new(text);
            notes.command(row);
            notes.problem = Some(format!("the answer to {} must be @OK or @NG", row.word));
            notes
        },
        |(_, notes)| notes,
    )
}

/// Fields of a line, collected from left to right.
struct Notes<'t> {
    text: &'t str,
    fields: Vec<FieldNote>,
    problem: Option<String>,
}

/// What the meaning of a value depends on.
#[derive(Clone, Copy)]
struct MessageContext {
    command: Command,
    /// Page number in a STAS request or answer.
    page: Option<i32>,
    sender: Sender,
}

/// Byte offset at which decoding ended, and the reason.
type Damage = (usize, String);

impl<'t> Notes<'t> {
    fn new(text: &'t str) -> Self {
        Self { text, fields: Vec::new(), problem: None }
    }

    /// Adds a part of the line.
    fn add(&mut self, bytes: Range<usize>, name: &'static str, meaning: String, about: &'static str) {
        let raw = self.text.get(bytes.clone()).unwrap_or_default().to_owned();
        let column = self.column(bytes.start);
        self.fields.push(FieldNote { column, width: raw.chars().count(), name, raw, meaning, about });
    }

    fn column(&self, at: usize) -> usize {
        self.text.get(..at).map_or(at, |before| before.chars().count()) + 1
    }

    fn command(&mut self, row: &'static Row) -> usize {
        let start = usize::from(self.text.starts_with('@'));
        self.add(start..start + row.word.len(), "command", row.about.to_owned(), "the command");
        start
    }

    /// Adds the command, its values and their content, decoded with the layout `form`.
    fn block(&mut self, row: &'static Row, form: &Layout, sender: Sender) -> Result<(), Damage> {
        let start = self.command(row);
        // HTSK is another word for CTSK. Both words have the same length, so the byte ranges stay valid.
        let text = format!("{}{}", row.word, self.text.get(start + row.word.len()..).unwrap_or_default());
        let mut values = Vec::new();
        let end = form.scan(&text, |field, value, bytes| values.push((field, value, bytes)));
        let number = |name: &str| {
            values.iter().find(|(field, ..)| field.name == name).and_then(|(_, value, _)| match value {
                Value::Number(number) => Some(*number),
                _ => None,
            })
        };
        let record = number("record");
        let of = MessageContext { command: row.command, page: number("page"), sender };
        for (field, value, bytes) in values {
            let bytes = bytes.start + start..bytes.end + start;
            if field.form == Form::Text && matches!(field.name, "body" | "key" | "text") {
                self.content(of, record, bytes)?;
            } else {
                self.value(of, field, &value, bytes);
            }
        }
        end.map_err(|error| self.damage(start, &error))
    }

    /// Adds the parameter, instruction or palletizing record of a block.
    fn content(&mut self, of: MessageContext, record: Option<i32>, bytes: Range<usize>) -> Result<(), Damage> {
        let start = bytes.start;
        let body = self.text.get(bytes).unwrap_or_default();
        let word = body.split(' ').next().unwrap_or_default();
        let unknown = |what: &str, name: &str| (start, format!("unknown {what} '{}'", name.escape_debug()));
        let layout = match of.command {
            Command::Wpar | Command::Rpar => {
                let parameter = Parameter::from_text(body).ok_or_else(|| unknown("parameter", word))?;
                let id = parameter.id.len().min(body.len());
                self.add(start..start + id, "parameter", parameter.name.to_owned(), parameter.about);
                if of.command == Command::Rpar && of.sender == Sender::Host { parameter.key } else { parameter.layout }
            }
            Command::Wstx | Command::Rstx => {
                let instruction = Instruction::named(word).ok_or_else(|| unknown("instruction", word))?;
                self.add(start..start + word.len(), "instruction", instruction.about.to_owned(), "action of the step");
                instruction.layout
            }
            _ => {
                let number = record.unwrap_or_default();
                Pallet::numbered(number).ok_or_else(|| unknown("record", &number.to_string()))?.layout
            }
        };
        let mut values = Vec::new();
        let end = layout.scan(body, |field, value, bytes| values.push((field, value, bytes)));
        for (field, value, bytes) in values {
            self.value(of, field, &value, bytes.start + start..bytes.end + start);
        }
        end.map_err(|error| self.damage(start, &error))
    }

    /// Adds a value. A value from the host must be in range; a value from the controller may be out of range.
    fn value(&mut self, of: MessageContext, field: &'static Field, value: &Value, bytes: Range<usize>) {
        let wrong = field.check(value).err().filter(|error| matches!(error, FieldError::Range { .. }));
        let mut meaning = meaning_of(of, field, value);
        if let Some(error) = wrong {
            meaning.push_str(", out of range");
            if of.sender == Sender::Host && self.problem.is_none() {
                self.problem = Some(format!("{error} at column {}", self.column(bytes.start)));
            }
        }
        self.add(bytes, field.name, meaning, field.about);
    }

    fn damage(&self, start: usize, error: &LayoutError) -> Damage {
        let at = start + error.at;
        (at, format!("{} at column {}", error.what, self.column(at)))
    }
}

/// Meaning of a value, with names of status bits and error codes.
fn meaning_of(of: MessageContext, field: &Field, value: &Value) -> String {
    match (of.command, field.name, value) {
        (Command::Stas, "st1", Value::Byte(byte)) => page_words(of.page.and_then(|page| page.try_into().ok()), *byte),
        (Command::Ehtr, "error", Value::Byte(code)) => errors::explain(*code).in_a_line(),
        (Command::Ehtr, _, Value::Stars) => "the power was switched off".to_owned(),
        _ => field.meaning(value).into_owned(),
    }
}

/// Description of a status page (TO 2-2, STAS).
fn page_words(page: Option<u8>, byte: u8) -> String {
    match page {
        Some(1) if byte == errors::NONE => return "no error".to_owned(),
        Some(1) => return errors::explain(byte).in_a_line(),
        _ => {}
    }
    let is_so = |bit: u8, is_low: bool| (byte >> bit & 1 == 1) != is_low;
    let bits = BITS.iter().filter(|bit| Some(bit.page) == page && is_so(bit.bit, bit.is_low));
    let mut words: Vec<String> = bits.map(|bit| bit.about.to_owned()).collect();
    if page == Some(2) {
        let status = Status::default().with(2, byte);
        words.push(format!("{} mode", status.program_kind().name().replace('_', " ")));
        words.extend(status.run_mode().map(|mode| format!("{} mode", mode.name())));
    }
    if words.is_empty() { "no bit is set".to_owned() } else { words.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn explain(line: &str) -> Description {
        describe(line, Sender::guess(line), None)
    }

    fn meanings(line: &str) -> Vec<String> {
        let description = explain(line);
        assert_eq!(description.problem, None, "{line}");
        for field in &description.fields {
            let raw: String = line.chars().skip(field.column - 1).take(field.width).collect();
            assert_eq!(raw, field.raw, "{line}");
        }
        description.fields.iter().map(|field| format!("{} {}", field.name, field.meaning)).collect()
    }

    fn problem(line: &str) -> String {
        explain(line).problem.unwrap()
    }

    #[test]
    fn requests_and_answers_are_explained() {
        assert_eq!(meanings("@HSON\r\n"), ["command host ON: the host has control, and the start input is disabled"]);
        assert_eq!(
            meanings("@STAS SNO=0 ST1=22 ST2=00")[1..],
            ["page 0", "st1 in execution, positioning complete", "st2 00"]
        );
        assert_eq!(meanings("@STAS SNO=1 ST1=A1 ST2=00")[2], format!("st1 {}", errors::explain(0xA1).in_a_line()));
        assert_eq!(meanings("@STAS SNO=2 ST1=86 ST2=00")[2], "st1 host ON, external point mode, step mode");
        assert_eq!(meanings("@EHTR NO=01 ER=** AL=** H=*** M=** S=**")[2], "error the power was switched off");
        assert_eq!(meanings("@NG"), ["verdict refused"]);
        assert_eq!(explain("@STAS SNO=0").section.as_deref(), Some("TO 2-2"));
        assert_eq!(explain("@HTSK TASK=02").title, "request: CTSK, select the current task");
    }

    #[test]
    fn the_content_of_a_block_is_explained() {
        assert_eq!(
            meanings("@WPAR P08 L=001.5 H=100.0")[1..],
            ["parameter jog-speed-1", "low 1.5 mm/s", "high 100.0 mm/s"]
        );
        assert_eq!(meanings("@RPAR T1 PT=007")[1..], ["parameter point", "row 7"]);
        assert_eq!(meanings("@RPAR T2 V05=0250.0")[1..], ["parameter speed-table", "row 5", "speed 250.0 mm/s"]);
        assert_eq!(
            meanings("@RSTX 0001 MVB S V=00 POST")[1..],
            ["step 1", "instruction move back", "course axis speed", "speed 0", "arrival stop there"]
        );
        assert_eq!(
            meanings("@WPLT 01 SNO=08 R=+0001.00 TAG=000")[1..],
            ["program 1", "record 8", "r 1.00 mm", "tag 0"]
        );
    }

    #[test]
    fn the_sender_is_guessed_from_the_format() {
        for (host, controller) in [
            ("@STAS SNO=0", "@STAS SNO=0 ST1=00 ST2=00"),
            ("@RPAR M01", "@RPAR M01 0/01/0"),
            ("@RPAR T1 PT=001", "@RPAR T1 PT=001 X=+0000.00 Y=+0000.00 Z=+0000.00 R=+0000.00"),
            ("@RSTX 0001", "@RSTX 0001 NOP"),
            ("@RPLT 01 SNO=16", "@RPLT 01 SNO=16 TAG=000"),
            ("@MCNT CN=01", "@MCNT CN01=0000"),
            ("@MERP", "@MERP         "),
            ("@TYPE AX1 RTYP=000000", "@OK"),
            ("@MTSK", "@MTSK TASK=01"),
            ("@MCST CN01=0000", "@NG"),
            ("@XXXX", "@OK"),
        ] {
            assert_eq!(Sender::guess(host), Sender::Host, "{host}");
            assert_eq!(Sender::guess(controller), Sender::Controller, "{controller}");
        }
    }

    #[test]
    fn every_printed_block_is_explained() {
        let file: serde_json::Value =
            serde_json::from_str(include_str!("../../../tests/data/toyo-transcripts.json")).unwrap();
        for pair in file["pairs"].as_array().unwrap() {
            let pair = if pair["corrected"].is_object() { &pair["corrected"] } else { pair };
            let (tx, rx) = (pair["tx"].as_str().unwrap(), pair["rx"].as_str().unwrap());
            let request = Request::parse(tx).unwrap();
            assert_eq!(Sender::guess(tx), Sender::Host, "{tx}");
            assert_eq!(describe(tx, Sender::Host, None).problem, None, "{tx}");
            assert_eq!(describe(rx, Sender::Controller, Some(&request)).problem, None, "{rx}");
            assert!(request.command() == Command::Type || Sender::guess(rx) == Sender::Controller, "{rx}");
        }
    }

    #[test]
    fn damage_is_reported_with_its_column() {
        assert_eq!(problem("STAS SNO=0"), "a block must begin with @");
        assert_eq!(problem("@STOS SNO=0"), "unknown command 'STOS'");
        assert_eq!(problem("@STAS SNO=x"), "page: 'x' is not a number, 0 to 4 at column 11");
        assert_eq!(problem("@STAS SNO=7"), "page: 7 is out of range (a number, 0 to 4) at column 11");
        assert_eq!(problem("@WPAR P08 L=001.5 H=x"), "high: 'x' is not a number, 0.1 to 999.9 mm/s at column 21");
        assert_eq!(problem("@WPAR P99 AX1=1"), "unknown parameter 'P99'");
        assert_eq!(problem("@WSTX 0001 MOVE a"), "unknown instruction 'MOVE'");
        assert_eq!(problem("@WPLT 01 SNO=20 TAG=000"), "record: 20 is out of range (a number, 1 to 16) at column 14");
        assert_eq!(problem("@HOME now"), "unexpected text ' now' at column 6");
        let cut = explain("@MOUT SNO=0 GN=1 SY01=00000000 PN01=000");
        assert_eq!(
            cut.fields.iter().map(|field| field.name).collect::<Vec<_>>()[..4],
            ["command", "station", "screen", "sy01"]
        );
        assert!(cut.problem.is_some());
        // A value from the controller may be out of range.
        let page = explain("@STAS SNO=7 ST1=00 ST2=00");
        assert_eq!((page.fields[1].meaning.as_str(), page.problem), ("7, out of range", None));
    }

    #[test]
    fn an_answer_to_another_request_is_reported() {
        let request = Request::parse("@MCNT CN=01").unwrap();
        let other = describe("@MCNT CN02=0000", Sender::Controller, Some(&request));
        assert_eq!(other.problem.as_deref(), Some("it answers another request: counter is 02, not 01"));
        assert!(describe("@OK", Sender::Controller, Some(&request)).problem.is_some());
        assert_eq!(describe("@NG", Sender::Controller, Some(&request)).title, "answer to MCNT: refused");
        assert_eq!(describe("@NG", Sender::Controller, Some(&request)).problem, None);
        assert_eq!(
            describe("@HOME", Sender::Controller, None).problem.as_deref(),
            Some("the answer to HOME must be @OK or @NG")
        );
    }

    #[test]
    fn a_summary_is_one_line() {
        let line = |line: &str| summary(line, Sender::guess(line), None);
        assert_eq!(line("@STAS SNO=0"), "request: STAS, a page of the status: page 0");
        assert_eq!(line("@OK"), "answer: done");
        assert_eq!(line("@STAS\nSNO"), "no valid block: character \\n at column 6 is not allowed");
    }
}
