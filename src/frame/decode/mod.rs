//! Decoding for all families: given bytes, capture files, field tables. `FAMILY/decode.rs` has the decoders of bytes;
//! `armctl decode` combines both.

pub mod capture;

use anyhow::Context as _;

use self::capture::{CaptureDecoder, Input, Selection};
use super::{Report, SchemaEntry};
use crate::prelude::basics::*;
use crate::run::{Run, RunError};
use armctl_files as files;

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
    fn capture(&self) -> Result<Option<(Input<'_>, Self::Capture)>, Failure>;

    /// Selection of messages in the file.
    fn selection(&self) -> &Selection;

    /// Whether an option is set that applies only to a capture file.
    fn needs_capture(&self) -> bool {
        self.selection().is_given()
    }

    /// Decodes the given bytes.
    fn decode(&self) -> Result<Self::Report, Failure>;
}

/// Decodes the arguments and prints the result.
pub fn run<D: Decode>(arguments: &D, run: &Run) -> Result<(), RunError> {
    if let Some((input, decoder)) = arguments.capture()? {
        return capture::print(run, D::CAPTURE_ID, &input, arguments.selection(), decoder);
    }
    if arguments.needs_capture() {
        let failure = Failure::usage("--frame and the other options for capture files need a capture file");
        return Err(failure.hint("use a file whose name ends in .pcap, .pcapng or .cap").into());
    }
    run.local(D::ID, &arguments.decode()?)
}

/// Schemas of the decoding reports of a family.
pub fn schemas<D: Decode>() -> [SchemaEntry; 2] {
    type Field<D> = <<D as Decode>::Capture as CaptureDecoder>::Field;
    [SchemaEntry::of::<D::Report>(D::ID), SchemaEntry::of::<capture::Capture<Field<D>>>(D::CAPTURE_ID)]
}

/// Text on stdin; invalid bytes are replaced and then reported as invalid.
pub fn stdin() -> Result<String, Failure> {
    Ok(String::from_utf8_lossy(&stdin_bytes()?).into_owned())
}

/// Bytes on stdin.
pub fn stdin_bytes() -> Result<Vec<u8>, Failure> {
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
    let first = problems.first()?;
    let message = match all {
        1 => format!("the {what} is damaged: {first}"),
        _ => format!("{} of {all} {what}s are damaged; the first: {first}", problems.len()),
    };
    let hint = "see the output for the fields before the damage";
    Some(Failure::new(Kind::Malformed, message).hint(hint))
}
