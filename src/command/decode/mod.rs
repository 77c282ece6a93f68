//! What decoding is for all families: bytes that are given, capture files, fields as a table. The rest, from bytes to
//! words, is in `FAMILY/decode.rs`; `armctl decode` brings both together.

pub mod capture;

use anyhow::Context as _;
use schemars::JsonSchema;
use serde::Serialize;

use self::capture::{CaptureDecoder, Input, Selection};
use super::frame::run::{Run, RunError};
use super::{Report, SchemaEntry};
use crate::failure::{Failure, Kind};
use crate::files;
use crate::output::view::{Cell, Section, Table};

/// The arguments of `armctl decode FAMILY`: bytes to decode, or a capture file.
pub trait Decode {
    /// `decode.yerc`: its name in envelopes and schemas.
    const ID: &'static str;
    /// `decode.yerc.capture`: the same for capture files.
    const CAPTURE_ID: &'static str;
    /// What it reports of the bytes that are given.
    type Report: Report + 'static;
    /// What finds messages in a capture file.
    type Capture: CaptureDecoder;

    /// The capture, where one is given, and what decodes it.
    fn capture(&self) -> Result<Option<(Input<'_>, Self::Capture)>, Failure>;

    /// What of the file is shown.
    fn selection(&self) -> &Selection;

    /// Whether there are flags that only say something about a capture file.
    fn needs_capture(&self) -> bool {
        self.selection().is_given()
    }

    /// Decodes the bytes that are given.
    fn decode(&self) -> Result<Self::Report, Failure>;
}

/// Decodes what is given, and prints it.
pub fn run<D: Decode>(arguments: &D, run: &Run) -> Result<(), RunError> {
    if let Some((input, decoder)) = arguments.capture()? {
        return capture::print(run, D::CAPTURE_ID, &input, arguments.selection(), decoder);
    }
    if arguments.needs_capture() {
        let failure = Failure::usage("--frame and the other flags for capture files need one");
        return Err(failure.hint("give a file whose name ends in .pcap, .pcapng or .cap").into());
    }
    run.local(D::ID, &arguments.decode()?)
}

/// The schemas of what a family's decoding reports.
pub fn schemas<D: Decode>() -> [SchemaEntry; 2] {
    type Field<D> = <<D as Decode>::Capture as CaptureDecoder>::Field;
    [SchemaEntry::of::<D::Report>(D::ID), SchemaEntry::of::<capture::Capture<Field<D>>>(D::CAPTURE_ID)]
}

/// What stands on stdin; bytes that are no text are replaced, and then told as such.
pub fn stdin() -> Result<String, Failure> {
    Ok(String::from_utf8_lossy(&stdin_bytes()?).into_owned())
}

/// The same as it is.
pub fn stdin_bytes() -> Result<Vec<u8>, Failure> {
    /// Room for thousands of frames.
    const MOST: u64 = 16 << 20;

    Ok(files::stdin(MOST).context("stdin")?)
}

/// A field of a message: an object in JSON, a row of a table.
pub trait Field: Serialize + JsonSchema {
    /// The columns of the table.
    const COLUMNS: &'static [&'static str];
    /// What stands there where a message has no fields.
    const NONE: &'static str = "no fields";

    /// What stands in the columns.
    fn cells(&self) -> Vec<Cell>;
}

/// Fields as a table.
pub fn field_table<F: Field>(fields: &[F]) -> Section {
    let mut table = Table::new(F::COLUMNS, F::NONE);
    table.rows = fields.iter().map(Field::cells).collect();
    Section::Table(table)
}

/// What is wrong, below the text of a message: a line for each problem.
pub fn problem_lines<'a>(problems: impl IntoIterator<Item = &'a String>) -> String {
    problems.into_iter().map(|problem| format!("\nproblem: {problem}")).collect()
}

/// The section of the manual behind the title of a message, where it is known.
pub fn in_parentheses(section: Option<&str>) -> String {
    section.map(|section| format!(" ({section})")).unwrap_or_default()
}

/// A failure if any of the messages is damaged; `what` is what one is called.
pub fn damage<'a>(what: &str, problems: impl ExactSizeIterator<Item = Option<&'a String>>) -> Option<Failure> {
    let all = problems.len();
    let problems: Vec<&String> = problems.flatten().collect();
    let first = problems.first()?;
    let message = match all {
        1 => format!("the {what} is damaged: {first}"),
        _ => format!("{} of {all} {what}s are damaged; the first: {first}", problems.len()),
    };
    let hint = "the fields before the damage are explained as far as they go";
    Some(Failure::new(Kind::Malformed, message).hint(hint))
}
