//! Blocks of the host (requests) and of the controller (answers), for example `@STAS SNO=0`, `@OK` and `@STAS SNO=0
//! ST1=22 ST2=00`.

use thiserror::Error;

use super::field::Value;
use super::layout::{Layout, LayoutError, LayoutProblem, Record, UNLISTED};
use super::table::commands::{Command, Row};
use super::table::{Instruction, Op, Pallet, Parameter};
use crate::Risk;

/// Maximum length of a block in bytes, including `@` and line end (TO 1-4; ambiguity A1).
pub const MAX_BLOCK_LEN: usize = 128;

/// A block of the host.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Request {
    row: &'static Row,
    record: Record,
}

/// A block of the controller.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// `@OK`.
    Done,
    /// `@NG`: the controller refuses, without a code.
    Refused,
    /// The requested data.
    Data(Record),
}

/// Why a text is not a valid block.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum BlockError {
    /// A block begins with `@`.
    #[error("a block must begin with @")]
    Start,
    /// The block is too long.
    #[error("the block has {len} characters; the maximum is {MAX_BLOCK_LEN}, with the line end")]
    Long {
        /// Characters, without line end.
        len: usize,
    },
    /// A character below 20H, or beyond ASCII.
    #[error("character {} at column {} is not allowed", char.escape_default(), at + 1)]
    Character {
        /// Byte offset.
        at: usize,
        /// The character.
        char: char,
    },
    /// Unknown command.
    #[error("unknown command '{}'", word.escape_debug())]
    Command {
        /// The word after `@`.
        word: String,
    },
    /// The command is known, but the text fits none of its forms.
    #[error("{0}")]
    Layout(#[from] LayoutError),
    /// Values that must not be sent.
    #[error("{0}")]
    Values(#[from] LayoutProblem),
    /// Unknown parameter, instruction or record.
    #[error("unknown {what} '{}'", name.escape_debug())]
    Unknown {
        /// `parameter`, `instruction` or `record`.
        what: &'static str,
        /// Name of the parameter, instruction or record.
        name: String,
    },
    /// An answer that belongs to another request.
    #[error("it answers another request: {field} is {found}, not {asked}")]
    Other {
        /// The field that differs.
        field: &'static str,
        /// Value in the answer.
        found: String,
        /// Value in the request.
        asked: String,
    },
}

impl Request {
    /// A request in the first form of a command, with values in field order and in range.
    pub fn new(command: Command, values: Vec<Value>) -> Result<Self, LayoutProblem> {
        Self::in_form(command, 0, values)
    }

    /// A request in a certain form of a command.
    pub fn in_form(command: Command, form: usize, values: Vec<Value>) -> Result<Self, LayoutProblem> {
        let row = command.row();
        let no_form = LayoutProblem::Count { expected: 0, found: values.len() };
        let record = row.requests.get(form).ok_or(no_form)?.record(values)?;
        record.emit()?;
        Ok(Self { row, record })
    }

    /// A request in the first form of a command, with constant values. If they do not fit the command, [`Self::check`]
    /// refuses the request, so that it is never sent.
    pub fn of<const N: usize>(command: Command, values: [Value; N]) -> Self {
        let row = command.row();
        Self { row, record: row.requests.first().unwrap_or(&UNLISTED).unchecked(values.into()) }
    }

    /// A request without fields, like [`Self::of`].
    pub fn bare(command: Command) -> Self {
        Self::of(command, [])
    }

    /// A request to read a parameter, or a row of a table.
    pub fn read_parameter(parameter: &Parameter, row: Option<i32>) -> Result<Self, LayoutProblem> {
        let key = parameter.key.emit(&row.map(Value::Number).into_iter().collect::<Vec<_>>())?;
        Self::new(Command::Rpar, vec![Value::Text(key)])
    }

    /// A request to write a parameter, or a row of a table, with all fields of [`Parameter::layout`].
    pub fn write_parameter(parameter: &Parameter, values: &[Value]) -> Result<Self, LayoutProblem> {
        Self::new(Command::Wpar, vec![Value::Text(parameter.layout.emit(values)?)])
    }

    /// A request to read a step of the sequential program; 0 is the current step.
    pub fn read_step(step: i32) -> Result<Self, LayoutProblem> {
        Self::new(Command::Rstx, vec![Value::Number(step)])
    }

    /// A request to write a step of the sequential program.
    pub fn write_step(step: i32, instruction: &Record) -> Result<Self, LayoutProblem> {
        Self::new(Command::Wstx, vec![Value::Number(step), Value::Text(instruction.emit()?)])
    }

    /// A request to read a record of a palletizing program.
    pub fn read_pallet(program: i32, record: &Pallet) -> Result<Self, LayoutProblem> {
        Self::new(Command::Rplt, vec![Value::Number(program), Value::Number(record.number.into())])
    }

    /// A request to write a record of a palletizing program.
    pub fn write_pallet(program: i32, record: &Pallet, values: &[Value]) -> Result<Self, LayoutProblem> {
        let body = Value::Text(record.layout.emit(values)?);
        Self::new(Command::Wplt, vec![Value::Number(program), Value::Number(record.number.into()), body])
    }

    /// Parses a block without line end. Values may be out of range.
    pub fn parse(block: &str) -> Result<Self, BlockError> {
        let text = unwrapped(block)?;
        let word = text.split(' ').next().unwrap_or_default();
        let row = Row::named(word).ok_or_else(|| BlockError::Command { word: word.to_owned() })?;
        // HTSK is another word for CTSK, and only CTSK is in the layouts.
        let text = text.replacen(word, row.word, 1);
        Ok(Self { row, record: fitting(row.requests, &text)? })
    }

    /// Table row of the command.
    pub fn row(&self) -> &'static Row {
        self.row
    }

    /// Command of the request.
    pub fn command(&self) -> Command {
        self.row.command
    }

    /// Values of the request.
    pub fn record(&self) -> &Record {
        &self.record
    }

    /// Text of the block, without line end.
    pub fn text(&self) -> String {
        format!("@{}", self.record.written())
    }

    /// Whether all values are in range.
    pub fn check(&self) -> Result<(), BlockError> {
        self.record.emit()?;
        self.content()?.map_or(Ok(()), |content| content.emit().map(|_| ()).map_err(BlockError::from))
    }

    /// Risk of the request. A JOG that moves no axis is a stop.
    pub fn risk(&self) -> Risk {
        let moves = |value: &Value| !matches!(value, Value::Word("SP" | "RS"));
        if self.command() == Command::Jgst && !self.record.values().iter().any(moves) {
            return Risk::Write;
        }
        self.row.risk
    }

    /// The parameter, instruction or palletizing record of the request, if the command has one. A read request contains
    /// only the key.
    pub fn content(&self) -> Result<Option<Record>, BlockError> {
        let text = |name| self.record.text(name).unwrap_or_default();
        Ok(match self.command() {
            Command::Wpar => Some(parameter(text("body"))?.layout.parse(text("body"))?),
            Command::Rpar => Some(parameter(text("key"))?.key.parse(text("key"))?),
            Command::Wstx => Some(instruction(text("text"))?),
            Command::Wplt => Some(self.pallet()?.layout.parse(text("body"))?),
            _ => None,
        })
    }

    /// The parameter of WPAR or RPAR.
    pub fn parameter(&self) -> Option<&'static Parameter> {
        Parameter::from_text(self.record.text("body").or(self.record.text("key"))?)
    }

    /// Parses an answer strictly, except for the stored content of a step or record.
    pub fn answer(&self, block: &str) -> Result<Answer, BlockError> {
        self.answer_as(block, Reading::Strict)
    }

    /// Parses an answer. Stored content may have a form that is not in the manual.
    pub fn answer_kept(&self, block: &str) -> Result<Answer, BlockError> {
        self.answer_as(block, Reading::Kept)
    }

    /// Checks strictly whether a block is the answer. The line has no checksum, so only this check detects a damaged
    /// answer.
    pub fn check_answer(&self, block: &str) -> Result<(), BlockError> {
        if let Answer::Data(record) = self.answer(block)? {
            self.content_of(&record, Reading::Strict)?;
        }
        Ok(())
    }

    fn answer_as(&self, block: &str, reading: Reading) -> Result<Answer, BlockError> {
        let text = unwrapped(block)?;
        match text {
            "NG" => return Ok(Answer::Refused),
            "OK" if self.row.is_order() => return Ok(Answer::Done),
            _ => {}
        }
        let word = text.split(' ').next().unwrap_or_default();
        if word != self.row.word {
            let (found, asked) = (word.to_owned(), self.row.word.to_owned());
            return Err(BlockError::Other { field: "the command", found, asked });
        }
        let reading = if self.may_hold_more() { reading } else { Reading::Strict };
        let record = match (fitting(self.row.answers, text), reading, self.row.answers) {
            (Err(error), Reading::Kept, [form]) => form.parse_kept(text).map_err(|_| error)?,
            (record, ..) => record?,
        };
        self.same(&record, reading)?;
        Ok(Answer::Data(record))
    }

    /// Whether the answer may contain data that is not in the manual: stored content, or an identification.
    fn may_hold_more(&self) -> bool {
        matches!(self.command(), Command::Rpar | Command::Rstx | Command::Rplt | Command::Resy | Command::Sysp)
    }

    /// The parameter, instruction or palletizing record of an answer. Content that is not in the manual is kept as
    /// received.
    pub fn answered(&self, answer: &Record) -> Result<Option<Record>, BlockError> {
        self.content_of(answer, Reading::Kept)
    }

    fn content_of(&self, answer: &Record, reading: Reading) -> Result<Option<Record>, BlockError> {
        let text = |name| answer.text(name).unwrap_or_default();
        let (read, text) = match self.command() {
            Command::Rpar => {
                let (parameter, text) = (parameter(text("body"))?, text("body"));
                (parsed(&parameter.layout, text, reading), text)
            }
            Command::Rstx => {
                let text = text("text");
                (instruction_as(text, reading), text)
            }
            Command::Rplt => {
                let text = text("body");
                (parsed(&self.pallet()?.layout, text, reading), text)
            }
            _ => return Ok(None),
        };
        match (read, reading) {
            (Err(_), Reading::Kept) if !text.trim().is_empty() => Ok(Some(Record::unlisted(text))),
            (read, _) => read.map(Some),
        }
    }

    /// Checks that an answer belongs to the request: fields with the same name must have the same value. The answer to
    /// RSTX 0000 contains the number of the current step (ambiguity C4).
    fn same(&self, answer: &Record, reading: Reading) -> Result<(), BlockError> {
        if self.command() == Command::Rpar {
            let (key, body) = (self.content()?, self.content_of(answer, reading)?);
            return match (key, body) {
                (Some(key), Some(body))
                    if self.parameter() != Parameter::from_text(&body.written())
                        || body.layout() == UNLISTED && !body.written().starts_with(&key.written()) =>
                {
                    let (found, asked) = (body.written(), key.written());
                    Err(BlockError::Other { field: "the parameter", found, asked })
                }
                (Some(key), Some(body)) => agree(&key, &body),
                _ => Ok(()),
            };
        }
        if self.command() == Command::Rstx && self.record.number("step") == Some(0) {
            return Ok(());
        }
        if self.command() == Command::Mbus && self.record.layout().text.get(..7) != answer.layout().text.get(..7) {
            let (found, asked) = (answer.written(), self.record.written());
            return Err(BlockError::Other { field: "the page", found, asked });
        }
        agree(&self.record, answer)
    }

    fn pallet(&self) -> Result<&'static Pallet, BlockError> {
        let number = self.record.number("record").unwrap_or_default();
        Pallet::numbered(number).ok_or_else(|| BlockError::Unknown { what: "record", name: number.to_string() })
    }
}

impl Answer {
    /// Text of the block, without line end.
    pub fn text(&self) -> String {
        match self {
            Self::Done => "@OK".to_owned(),
            Self::Refused => "@NG".to_owned(),
            Self::Data(record) => format!("@{}", record.written()),
        }
    }
}

/// Strictness of parsing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Reading {
    /// Everything must be in the format of the manual.
    Strict,
    /// Content in other formats is kept as received.
    Kept,
}

fn parsed(layout: &Layout, text: &str, reading: Reading) -> Result<Record, BlockError> {
    Ok(match reading {
        Reading::Strict => layout.parse(text)?,
        Reading::Kept => layout.parse_kept(text)?,
    })
}

/// Parses the instruction of a step, for example `MOVP a PT=001 CN=00 S V=00 POST`.
pub fn instruction(text: &str) -> Result<Record, BlockError> {
    instruction_as(text, Reading::Strict)
}

fn instruction_as(text: &str, reading: Reading) -> Result<Record, BlockError> {
    let word = text.split(' ').find(|word| !word.is_empty()).unwrap_or_default();
    let row = Instruction::named(word);
    let row = row.ok_or_else(|| BlockError::Unknown { what: "instruction", name: word.to_owned() })?;
    let record = parsed(&row.layout, text, reading)?;
    // RSMV always passes its point. The template of the manual says POST, but its legend says PASS (ambiguity R4).
    Ok(if row.op == Op::Rsmv { record.with("arrival", Value::Word("PASS")) } else { record })
}

fn parameter(text: &str) -> Result<&'static Parameter, BlockError> {
    Parameter::from_text(text).ok_or_else(|| {
        let name = text.split(' ').next().unwrap_or_default().to_owned();
        BlockError::Unknown { what: "parameter", name }
    })
}

/// Checks that the common fields are equal.
fn agree(request: &Record, answer: &Record) -> Result<(), BlockError> {
    for (field, asked) in request.pairs() {
        match answer.value(field.name) {
            Some(found) if found != asked => {
                let (found, asked) = (field.written(found), field.written(asked));
                return Err(BlockError::Other { field: field.name, found, asked });
            }
            _ => {}
        }
    }
    Ok(())
}

/// The text between `@` and line end.
fn unwrapped(block: &str) -> Result<&str, BlockError> {
    let text = block.trim_end_matches(['\r', '\n']);
    if text.len() + 2 > MAX_BLOCK_LEN {
        return Err(BlockError::Long { len: text.len() });
    }
    if let Some((at, char)) = text.char_indices().find(|(_, char)| !matches!(char, ' '..='~')) {
        return Err(BlockError::Character { at, char });
    }
    Ok(text.strip_prefix('@').ok_or(BlockError::Start)?.trim_end_matches(' '))
}

/// Parses by the first form that fits. If no form fits, returns the error of the form that fits the longest part of the
/// text.
fn fitting(forms: &[Layout], text: &str) -> Result<Record, LayoutError> {
    let mut furthest: Option<LayoutError> = None;
    for form in forms {
        match form.parse(text) {
            Ok(record) => return Ok(record),
            Err(error) if furthest.as_ref().is_none_or(|other| other.at < error.at) => furthest = Some(error),
            Err(_) => {}
        }
    }
    let none = || LayoutError { at: 0, what: LayoutProblem::Rest { found: text.to_owned() } };
    // The layout error counts from the text after the `@`; the reported position counts from the `@`.
    Err(furthest.map_or_else(none, |error| LayoutError { at: error.at + 1, ..error }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::toyo::table::commands::ROWS;

    fn answer(request: &str, answer: &str) -> Result<Answer, BlockError> {
        Request::parse(request).unwrap().answer(answer)
    }

    #[test]
    fn every_command_without_fields_is_made_bare() {
        for row in ROWS.iter().filter(|row| row.requests[0].fields.is_empty()) {
            assert!(Request::bare(row.command).text().starts_with(&format!("@{}", row.word)));
        }
    }

    #[test]
    fn an_answer_to_another_request_is_rejected() {
        assert!(answer("@STAS SNO=0", "@STAS SNO=0 ST1=22 ST2=00").is_ok());
        assert!(matches!(answer("@STAS SNO=0", "@STAS SNO=1 ST1=22 ST2=00"), Err(BlockError::Other { .. })));
        assert!(matches!(answer("@STAS SNO=0", "@MTSK TASK=01"), Err(BlockError::Other { .. })));
        assert!(matches!(answer("@STAS SNO=0", "@OK"), Err(BlockError::Other { .. })));
        assert!(matches!(answer("@RPAR T1 PT=001", "@RPAR T2 V01=0001.0"), Err(BlockError::Other { .. })));
        let point = "@RPAR T1 PT=002 X=+0000.00 Y=+0000.00 Z=+0000.00 R=+0000.00";
        assert!(matches!(answer("@RPAR T1 PT=001", point), Err(BlockError::Other { .. })));
        assert!(answer("@RPAR T1 PT=002", point).is_ok());
        assert!(matches!(
            answer("@MBUS C1", "@MBUS C2 ER1=00 ER2=00 ER3=00 MS1=00 MS2=00"),
            Err(BlockError::Other { .. })
        ));
    }

    #[test]
    fn the_answer_about_the_current_step_has_its_real_number() {
        assert!(answer("@RSTX 0000", "@RSTX 0017 NOP").is_ok());
        assert!(answer("@RSTX 0001", "@RSTX 0017 NOP").is_err());
    }

    #[test]
    fn stored_content_outside_the_manual_is_kept() {
        let kept = |request: &str, block: &str| {
            let request = Request::parse(request).unwrap();
            assert!(request.check_answer(block).is_err(), "{block}");
            let Answer::Data(answer) = request.answer_kept(block).unwrap() else { panic!("{block}") };
            let content = request.answered(&answer).unwrap().unwrap_or(answer);
            assert!(!content.is_listed(), "{block}");
            assert_eq!(format!("@{}", request.record().emit().unwrap()), request.text());
            content.written()
        };
        let m18 = "M18 STN=01 BRT=156K OPT=00";
        assert!(kept("@RPAR M18", &format!("@RPAR {m18}")).starts_with("M18 STN=01 BRT=156K"));
        assert_eq!(kept("@RPAR M18", "@RPAR M18 STN=01 BRT=156K"), "M18 STN=01 BRT=156K");
        let p06 = "P06 AX1=+000.50 AX2=+00.5 AX3=+1.234 AX4=+000.00";
        assert_eq!(kept("@RPAR P06", &format!("@RPAR {p06}")), p06);
        assert_eq!(kept("@RPAR E17", "@RPAR E17 E=I"), "E17 E=I");
        assert_eq!(kept("@RPAR E19", "@RPAR E19 1130"), "E19 1130");
        assert_eq!(kept("@RSTX 0007", "@RSTX 0007 FOO X=1"), "FOO X=1");
        assert_eq!(kept("@RSTX 0007", "@RSTX 0007 SPD V=99X"), "SPD V=99X");
        assert!(kept("@RPAR T2 V05", "@RPAR T2 V05=250").contains("=250"));
        // Content that does not match is not a format error.
        for (request, block) in
            [("@RPAR E17", "@RPAR E18 E=I"), ("@RPAR T2 V05", "@RPAR T2 V06=250"), ("@STAS SNO=0", "@STAS SNO=0 ST1=2")]
        {
            assert!(Request::parse(request).unwrap().answer_kept(block).is_err(), "{block}");
        }
    }

    #[test]
    fn rsmv_is_always_sent_with_pass() {
        let record = instruction("RSMV a X=+0000.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=00 POST").unwrap();
        assert!(record.emit().unwrap().ends_with(" PASS"));
    }

    #[test]
    fn every_request_can_be_refused() {
        for request in ["@HOME", "@STAS SNO=0"] {
            assert_eq!(answer(request, "@NG\r\n"), Ok(Answer::Refused));
        }
        assert_eq!(answer("@HOME", "@OK"), Ok(Answer::Done));
    }

    #[test]
    fn a_jog_without_a_moving_axis_is_a_stop() {
        let risk = |text| Request::parse(text).unwrap().risk();
        assert_eq!(risk("@JGST X=SP Y=SP Z=SP R=SP"), Risk::Write);
        assert_eq!(risk("@JGST X=RS Y=RS Z=RS R=RS"), Risk::Write);
        assert_eq!(risk("@JGST X=SP Y=-C Z=SP R=SP"), Risk::Motion);
    }

    #[test]
    fn an_invalid_block_gives_the_reason() {
        let error = |text: &str| Request::parse(text).unwrap_err().to_string();
        assert_eq!(error("STAS"), "a block must begin with @");
        assert_eq!(error("@XXXX"), "unknown command 'XXXX'");
        assert_eq!(error("@STAS SNO=x"), "page: 'x' is not a number, 0 to 4 at column 11");
        assert_eq!(error("@STAS\tSNO=0"), "character \\t at column 6 is not allowed");
        assert!(error(&format!("@{}", "A".repeat(130))).starts_with("the block has 131 characters"));
        assert!(Request::parse("@STAS SNO=9").unwrap().check().is_err());
        assert_eq!(Request::parse("@HTSK TASK=01").unwrap().text(), "@CTSK TASK=01");
    }
}
