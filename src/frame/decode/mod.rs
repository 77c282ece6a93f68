//! Decoding for all families: given bytes, capture files, field tables. `FAMILY/decode.rs` has the decoders of bytes;
//! `armctl decode` combines both.

pub mod capture;

use std::io::{self, BufRead as _, Read as _};

use self::capture::{CaptureDecoder, Input, Selection};
use super::SchemaEntry;
use crate::output::{Format, render};
use crate::prelude::basics::*;
use crate::run::{Run, RunError};

/// Arguments of `armctl decode FAMILY`: bytes to decode, or a capture file.
pub trait Decode {
    /// `decode.yerc`: name in envelopes and schemas.
    const ID: &'static str;
    /// `decode.yerc.capture`: name for capture files.
    const CAPTURE_ID: &'static str;
    /// Report type for given bytes.
    type Report: Report + 'static;
    /// Decoder for capture files.
    type Capture: CaptureDecoder;

    /// The capture, if given, and its decoder.
    fn capture(&self) -> Result<Option<(Input<'_>, Self::Capture)>>;

    /// Selection of messages in the file.
    fn selection(&self) -> &Selection;

    /// Whether an option is set that applies only to a capture file.
    fn needs_capture(&self) -> bool {
        self.selection().is_given()
    }

    /// Decodes the given bytes.
    fn decode(&self) -> Result<Self::Report>;

    /// The lines on stdin, each with its problem as soon as it arrives; `None` if stdin is not read line by line.
    fn decode_stdin(&self) -> Option<impl Iterator<Item = LineReport<Self::Report>>> {
        None::<std::iter::Empty<_>>
    }
}

/// Report about a line, and the problem of the line.
pub type LineReport<R> = Result<(R, Option<String>)>;

/// Decodes the arguments and prints the result.
pub fn run<D: Decode>(arguments: &D, run: &Run) -> Result<(), RunError> {
    if let Some((input, decoder)) = arguments.capture()? {
        return capture::print(run, D::CAPTURE_ID, &input, arguments.selection(), decoder);
    }
    if arguments.needs_capture() {
        let failure = Failure::usage("--frame and the other options for capture files need a capture file");
        return Err(failure.hint("use a file whose name ends in .pcap, .pcapng or .cap").into());
    }
    if run.screen.format == Format::Table
        && run.filter.is_none()
        && run.line.is_none()
        && let Some(reports) = arguments.decode_stdin()
        && let Some(printed) = print_each(reports, run)
    {
        return printed;
    }
    run.local(D::ID, &arguments.decode()?)
}

/// Prints each report as it comes; `None` if there is none.
fn print_each<R: Report>(reports: impl Iterator<Item = LineReport<R>>, run: &Run) -> Option<Result<(), RunError>> {
    let (mut count, mut damaged, mut first) = (0, 0, None);
    for report in reports {
        let printed = report.and_then(|(report, problem)| {
            let text = render::text(&report.view(), run.screen.width(), run.screen.stdout_color());
            damaged += usize::from(problem.is_some());
            first = first.take().or(problem);
            run.screen.data(&if count == 0 { text } else { format!("\n{text}") })
        });
        if let Err(failure) = printed {
            return Some(Err(failure.into()));
        }
        count += 1;
    }
    let failure = first.map(|first| damage_failure("line", count, damaged, &first));
    (count > 0).then(|| failure.map_or(Ok(()), |failure| Err(failure.into())))
}

/// Schemas of the decoding reports of a family.
pub fn schemas<D: Decode>() -> [SchemaEntry; 2] {
    type Field<D> = <<D as Decode>::Capture as CaptureDecoder>::Field;
    [SchemaEntry::of::<D::Report>(D::ID), SchemaEntry::of::<capture::Capture<Field<D>>>(D::CAPTURE_ID)]
}

/// Lines on stdin, as they arrive. A line that is much too long is several lines.
pub fn stdin_lines() -> impl Iterator<Item = Result<String>> {
    const MAX_LINE_SIZE: u64 = 64 << 10;

    let mut input = io::stdin().lock();
    std::iter::from_fn(move || {
        let mut line = Vec::new();
        match (&mut input).take(MAX_LINE_SIZE).read_until(b'\n', &mut line).context("stdin") {
            Ok(0) => None,
            Ok(_) => Some(Ok(String::from_utf8_lossy(&line).trim_end_matches(['\r', '\n']).to_owned())),
            Err(error) => Some(Err(error.into())),
        }
    })
}

/// Text on stdin; invalid bytes are replaced and then reported as invalid.
pub fn stdin() -> Result<String> {
    Ok(String::from_utf8_lossy(&stdin_bytes()?).into_owned())
}

/// Bytes on stdin.
pub fn stdin_bytes() -> Result<Vec<u8>> {
    /// Maximum size. It is enough for thousands of frames.
    const MAX_INPUT_SIZE: u64 = 16 << 20;

    Ok(files::stdin(MAX_INPUT_SIZE).context("stdin")?)
}

/// A field of a message: an object in JSON, a row of a table.
pub trait Field: Serialize + JsonSchema {
    /// Columns of the table.
    const COLUMNS: &'static [&'static str];
    /// Text for a message without fields.
    const NONE: &'static str = "no fields";

    /// Cells of the columns.
    fn cells(&self) -> Vec<Cell>;
}

/// Declares `FieldRow`, the type of the family's crate that implements [`Field`] for a field of the family's decoder.
/// Its JSON and schema are the JSON and schema of this field.
#[macro_export]
macro_rules! field_row {
    ($note:ty) => {
        /// A field of a message, as a row of a table.
        #[derive(Debug, Clone, serde::Serialize)]
        #[serde(transparent)]
        pub struct FieldRow(pub $note);

        impl schemars::JsonSchema for FieldRow {
            fn inline_schema() -> bool {
                <$note>::inline_schema()
            }

            fn schema_name() -> std::borrow::Cow<'static, str> {
                <$note>::schema_name()
            }

            fn schema_id() -> std::borrow::Cow<'static, str> {
                <$note>::schema_id()
            }

            fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
                <$note>::json_schema(generator)
            }
        }
    };
}

/// Fields as a table.
pub fn field_table<F: Field>(fields: &[F]) -> Section {
    let mut table = Table::new(F::COLUMNS, F::NONE);
    table.rows = fields.iter().map(Field::cells).collect();
    Section::Table(table)
}

/// Problems below the text of a message, one line each.
pub fn problem_lines<'a>(problems: impl IntoIterator<Item = &'a String>) -> String {
    problems.into_iter().map(|problem| format!("\nproblem: {problem}")).collect()
}

/// Section of the manual after the title of a message, if known.
pub fn in_parentheses(section: Option<&str>) -> String {
    section.map(|section| format!(" ({section})")).unwrap_or_default()
}

/// Failure if any of the messages is damaged; `what` is the noun for a message.
pub fn damage<'a>(what: &str, problems: impl ExactSizeIterator<Item = Option<&'a String>>) -> Option<Failure> {
    let all = problems.len();
    let problems: Vec<&String> = problems.flatten().collect();
    problems.first().map(|first| damage_failure(what, all, problems.len(), first))
}

fn damage_failure(what: &str, all: usize, damaged: usize, first: &str) -> Failure {
    let message = match all {
        1 => format!("the {what} is damaged: {first}"),
        _ => format!("{damaged} of {all} {what}s are damaged; the first: {first}"),
    };
    Failure::new(Kind::Malformed, message).hint("see the output for the fields before the damage")
}
