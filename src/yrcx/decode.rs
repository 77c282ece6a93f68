//! `armctl decode yrcx`: explanation of remote command words and answers.

mod capture;
pub mod images;

pub use self::capture::ImageDecoder;
use super::field_row::FieldRow;
use super::raw::words;
use crate::prelude::*;
use armctl_controller::yrcx::describe::{Description, answer, command};
use armctl_controller::yrcx::image::Words;
use armctl_frame::decode::capture::{Input, Selection, holds_telegram, parse_hex};
use armctl_frame::decode::{self, field_table, in_parentheses, problem_lines, stdin_bytes};

/// Decode words of YRCX remote commands and answers
#[derive(Debug, Args)]
#[command(
    after_help = "Missing words are 0. An answer is explained with its command if you type both. Invalid words are \
                  explained as far as possible, and the exit code is 5.\n\nType PROFIBUS telegrams as bytes, one \
                  telegram after the other, or use a file in hexadecimal or binary. Each telegram then counts as a \
                  packet without a time.\n\nFor a capture file, the command lists the images with new content, as \
                  --trace does, and between them the other messages of the fieldbus. NUMBER and TIME are the same as in \
                  Wireshark. A file without messages is not an error. A damaged file is decoded up to the damage, and \
                  the exit code is 1."
)]
pub struct Decode {
    /// WI0 to WI15, for example 0x0001,0x0004,0,0x0032,0x0013
    #[arg(long, value_name = "WORDS", required_unless_present_any = ["wo", "capture"], value_parser = words)]
    wi: Option<Words>,
    /// WO0 to WO15, for example 0x4000,0x0002,0x014E
    #[arg(long, value_name = "WORDS", value_parser = words)]
    wo: Option<Words>,
    /// A capture file (pcap or pcapng), a candump log, or a file of PROFIBUS telegrams. - means stdin. Or the telegrams
    /// themselves in hexadecimal (spaces, colons and 0x are allowed between the bytes)
    #[arg(value_name = "FILE|HEX", conflicts_with_all = ["wi", "wo"])]
    capture: Vec<String>,
    #[command(flatten)]
    selection: Selection,
    /// Also list images without new content
    #[arg(long, help_heading = "Capture files")]
    every_image: bool,
}

impl decode::Decode for Decode {
    const ID: &'static str = "decode.yrcx";
    const CAPTURE_ID: &'static str = "decode.yrcx.capture";
    type Report = DecodedWords;
    type Capture = ImageDecoder;

    fn capture(&self) -> Result<Option<(Input<'_>, ImageDecoder)>> {
        let input = match self.capture.as_slice() {
            [] => return Ok(None),
            [stdin] if stdin == "-" => Input::Bytes("stdin", stdin_bytes()?),
            // An argument that has only hexadecimal digits is a telegram, because no capture file has such a name.
            [file] if parse_hex(file).is_err() => Input::File(Path::new(file)),
            bytes => Input::Bytes("telegrams", telegrams(&bytes.join(" "))?),
        };
        Ok(Some((input, ImageDecoder::new(self.every_image))))
    }

    fn selection(&self) -> &Selection {
        &self.selection
    }

    fn needs_capture(&self) -> bool {
        self.every_image || self.selection.is_given()
    }

    fn decode(&self) -> Result<DecodedWords> {
        let wi = self.wi.map(|wi| Part::new("command", command(&wi)));
        let wo = self.wo.map(|wo| Part::new("answer", answer(&wo, self.wi.as_ref())));
        Ok(DecodedWords { parts: wi.into_iter().chain(wo).collect() })
    }
}

/// Parses telegrams in hexadecimal.
fn telegrams(text: &str) -> Result<Vec<u8>> {
    let hint = "type telegrams as 68 05 05 68 …, or the name of a file";
    let bytes = parse_hex(text).map_err(|error| Failure::usage(error).hint(hint))?;
    if holds_telegram(&bytes) {
        return Ok(text.as_bytes().to_vec());
    }
    let failure = Failure::new(Kind::Malformed, "no PROFIBUS telegram starts in these bytes");
    Err(failure.hint(
        "type telegrams that start with 10, 68, A2, DC or E5. If the file name has only hexadecimal digits, use \
         ./NAME",
    ))
}

/// Explanation of remote command words.
#[derive(Debug, Serialize, JsonSchema)]
pub struct DecodedWords {
    parts: Vec<Part>,
}

/// The explanation of a command or of an answer.
#[derive(Debug, Serialize, JsonSchema)]
struct Part {
    /// `command` or `answer`.
    kind: &'static str,
    /// Name of the command or the answer.
    title: String,
    /// Section of chapter 2 of the manual, if the command is known.
    section: Option<&'static str>,
    fields: Vec<FieldRow>,
    /// Problems in the command or the answer.
    problems: Vec<String>,
}

impl Part {
    fn new(kind: &'static str, description: Description) -> Self {
        let Description { title, section, fields, problems } = description;
        let fields = fields.into_iter().map(FieldRow).collect();
        Self { kind, title, section, fields, problems }
    }
}

impl Report for DecodedWords {
    fn view(&self) -> View {
        let mut sections = Vec::new();
        for Part { kind, title, section, fields, problems } in &self.parts {
            let (section, problems) = (in_parentheses(*section), problem_lines(problems));
            sections.push(Section::Text(format!("{kind}: {title}{section}{problems}")));
            sections.push(field_table(fields));
        }
        View { sections }
    }

    fn failure(&self) -> Option<Failure> {
        let problem = self.parts.iter().flat_map(|part| &part.problems).next()?;
        let failure = Failure::new(Kind::Malformed, format!("the words do not match the manual: {problem}"));
        Some(failure.hint("compare the words with the section of the manual that the command shows"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_frame::decode::Decode as _;

    fn explained(wi: Option<&str>, wo: Option<&str>) -> DecodedWords {
        let read = |text: &str| words(text).unwrap();
        let (selection, capture) = (Selection::default(), Vec::new());
        Decode { wi: wi.map(read), wo: wo.map(read), capture, selection, every_image: false }.decode().unwrap()
    }

    #[test]
    fn a_command_explains_its_answer() {
        let both = explained(Some("0x0001,0x8004,0,0x0032,0x0013"), Some("0x0200,0,0,0,0x3039"));
        assert_eq!(both.parts[1].section, Some("4.2.1"));
        let axis = both.parts[1].fields.iter().find(|field| field.0.key == Some(Key::Axis1)).unwrap();
        assert_eq!(axis.0.meaning, "12.345 mm");
        assert!(both.failure().is_none());
    }

    #[test]
    fn invalid_words_fail_with_their_fields() {
        let wrong = explained(Some("1,0xC000"), None);
        assert!(!wrong.parts[0].fields.is_empty());
        assert_eq!(wrong.failure().unwrap().kind, Kind::Malformed);
    }
}
