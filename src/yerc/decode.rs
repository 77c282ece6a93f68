//! `armctl decode yerc`: explanation of frames.

mod capture;

pub use self::capture::FrameDecoder;
use crate::prelude::*;
use armctl_controller::yerc::describe::{Description, FieldNote, Sender, describe};
use armctl_controller::yerc::table::service;
use armctl_controller::yerc::wire::{ANSWER_BIT, HEADER_LEN, RequestFrame};
use armctl_frame::decode::capture::{Input, Selection, file_among, parse_hex};
use armctl_frame::decode::{self, damage, field_table, in_parentheses, problem_lines, stdin};

/// Decode frames of the high-speed Ethernet server
#[derive(Debug, Args)]
#[command(
    after_help = "An answer does not contain its command: type the request before the answer, or use --command. A \
                  damaged frame is explained up to the damage, and the exit code is 5.\n\nFor a capture file, the \
                  command lists the frames as --trace does. NUMBER and TIME are the same as in Wireshark. A file \
                  without frames is not an error. A damaged file is decoded up to the damage, and the exit code is 1."
)]
pub struct Decode {
    /// Frames in hexadecimal (spaces, colons and 0x are allowed between the bytes), or - to read stdin with one frame
    /// per line, or a capture file (FILE.pcap or FILE.pcapng)
    #[arg(required = true, value_name = "HEX")]
    hex: Vec<String>,
    /// Command of the answer, such as 0x75
    #[arg(long, value_name = "N", value_parser = number)]
    command: Option<u16>,
    /// Instance of the request
    #[arg(long, value_name = "N", value_parser = number, requires = "command")]
    instance: Option<u16>,
    /// Attribute of the request
    #[arg(long, value_name = "N", value_parser = number, requires = "command")]
    attribute: Option<u16>,
    #[command(flatten)]
    selection: Selection,
}

fn number(text: &str) -> Result<u16, String> {
    user_input::unsigned(text).ok_or_else(|| "expected a number from 0 to 65535 (0x0000 to 0xFFFF)".to_owned())
}

impl decode::Decode for Decode {
    const ID: &'static str = "decode.yerc";
    const CAPTURE_ID: &'static str = "decode.yerc.capture";
    type Report = DecodedFrames;
    type Capture = FrameDecoder;

    fn capture(&self) -> Result<Option<(Input<'_>, FrameDecoder)>> {
        Ok(file_among(&self.hex).map(|path| (Input::File(path), FrameDecoder::default())))
    }

    fn selection(&self) -> &Selection {
        &self.selection
    }

    fn decode(&self) -> Result<DecodedFrames> {
        Ok(self.explain_frames(&self.frames()?))
    }
}

impl Decode {
    /// Bytes of each frame that the user typed.
    fn frames(&self) -> Result<Vec<Vec<u8>>> {
        let wrong = |error| Failure::usage(error).hint("type bytes as 59455243… or 59 45 52 43 …");
        let mut pieces = Vec::new();
        if self.hex == ["-"] {
            for line in stdin()?.lines().map(str::trim).filter(|line| !line.is_empty()) {
                pieces.push(parse_hex(line).map_err(wrong)?);
            }
        } else {
            let parsed: Result<Vec<_>, _> = self.hex.iter().map(|text| parse_hex(text)).collect();
            pieces = join_pieces(parsed.map_err(wrong)?);
        }
        let frames: Vec<Vec<u8>> = pieces.iter().flat_map(|bytes| split(bytes)).collect();
        if frames.is_empty() { Err(wrong("no bytes to decode".to_owned())) } else { Ok(frames) }
    }

    /// Decodes each frame. An answer is decoded with the earlier request that has the same id, or with the options.
    fn explain_frames(&self, frames: &[Vec<u8>]) -> DecodedFrames {
        let mut asked: Vec<(u8, Request)> = Vec::new();
        let mut explained = Vec::new();
        for bytes in frames {
            let sender = Sender::guess(bytes);
            let description = match sender {
                Sender::Client => {
                    if let Ok(frame) = RequestFrame::parse(bytes)
                        && !frame.ack
                    {
                        asked.push((frame.id, Request::from(frame)));
                    }
                    describe(bytes, sender, None)
                }
                Sender::Controller => {
                    let before = asked.iter().rev().find(|(id, _)| bytes.get(ID_AT) == Some(id));
                    let request = before.map(|(_, request)| request.clone()).or_else(|| self.request(bytes));
                    describe(bytes, sender, request.as_ref())
                }
            };
            explained.push(DecodedFrame::new(sender, bytes.len(), description));
        }
        DecodedFrames { frames: explained }
    }

    /// Request that the options describe. Its service is taken from the answer.
    fn request(&self, answer: &[u8]) -> Option<Request> {
        let service = answer.get(SERVICE_AT)?.wrapping_sub(ANSWER_BIT);
        let attribute = match (self.attribute, service) {
            (Some(attribute), _) => u8::try_from(attribute).ok()?,
            (None, service::GET_SINGLE | service::SET_SINGLE) => 1,
            (None, _) => 0,
        };
        let instance = self.instance.unwrap_or(0);
        Some(Request { command: self.command?, instance, attribute, service, data: Vec::new() })
    }
}

/// Offset of the request id.
pub const ID_AT: usize = 11;
/// Offset of the service in an answer.
const SERVICE_AT: usize = 24;
/// Bytes at the beginning of every frame.
pub const IDENTIFIER: &[u8] = b"YERC";

/// Joins arguments that the shell separated at spaces. A new frame starts with an argument that begins like a frame, or
/// that is as long as a frame.
fn join_pieces(arguments: Vec<Vec<u8>>) -> Vec<Vec<u8>> {
    let mut pieces: Vec<Vec<u8>> = Vec::new();
    for bytes in arguments {
        match pieces.last_mut() {
            Some(last) if !bytes.starts_with(IDENTIFIER) && bytes.len() < HEADER_LEN => last.extend(bytes),
            _ => pieces.push(bytes),
        }
    }
    pieces.retain(|bytes| !bytes.is_empty());
    pieces
}

/// Splits concatenated frames. A frame has the length in its header, if another frame starts at its end.
fn split(mut bytes: &[u8]) -> Vec<Vec<u8>> {
    let mut frames = Vec::new();
    while let Some(size) = bytes.get(6..8) {
        let end = HEADER_LEN + usize::from(u16::from_le_bytes([size[0], size[1]]));
        let Some((frame, rest)) = bytes.split_at_checked(end).filter(|(_, rest)| rest.starts_with(IDENTIFIER)) else {
            break;
        };
        frames.push(frame.to_vec());
        bytes = rest;
    }
    frames.push(bytes.to_vec());
    frames
}

/// Decoded frames.
#[derive(Debug, Serialize, JsonSchema)]
pub struct DecodedFrames {
    frames: Vec<DecodedFrame>,
}

/// Decoded frame.
#[derive(Debug, Serialize, JsonSchema)]
struct DecodedFrame {
    /// One-line description of the frame.
    title: String,
    /// Manual and section; null if the command is unknown.
    section: Option<String>,
    /// `client` or `controller`.
    sender: &'static str,
    bytes: usize,
    fields: Vec<FieldRow>,
    /// Problem found in the frame.
    problem: Option<String>,
}

impl DecodedFrame {
    fn new(sender: Sender, bytes: usize, description: Description) -> Self {
        let Description { title, section, fields, problem } = description;
        let sender = match sender {
            Sender::Client => "client",
            Sender::Controller => "controller",
        };
        let fields = fields.into_iter().map(FieldRow).collect();
        Self { title, section, sender, bytes, fields, problem }
    }
}

armctl_frame::field_row!(FieldNote);

impl decode::Field for FieldRow {
    const COLUMNS: &'static [&'static str] = &["offset", "size", "field", "raw", "meaning"];
    const NONE: &'static str = "no data";

    /// Long values are cut here. JSON has them in full.
    fn cells(&self) -> Vec<Cell> {
        const MAX_SHOWN_LEN: usize = 32;

        let FieldNote { offset, size, name, raw, meaning } = &self.0;
        let raw = shortened(raw, MAX_SHOWN_LEN);
        vec![(*offset).into(), (*size).into(), name.as_str().into(), raw.into(), meaning.as_str().into()]
    }
}

fn shortened(text: &str, longest: usize) -> String {
    if text.chars().count() <= longest {
        return text.to_owned();
    }
    text.chars().take(longest).chain(['…']).collect()
}

impl Report for DecodedFrames {
    fn view(&self) -> View {
        let mut sections = Vec::new();
        for DecodedFrame { title, section, bytes, fields, problem, .. } in &self.frames {
            let (section, problem) = (in_parentheses(section.as_deref()), problem_lines(problem));
            sections.push(Section::Text(format!("{title}{section}, {bytes} bytes{problem}")));
            sections.push(field_table(fields));
        }
        View { sections }
    }

    fn failure(&self) -> Option<Failure> {
        damage("frame", self.frames.iter().map(|frame| frame.problem.as_ref()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STATUS: &str = "5945524320000000030100000000000039393939393939397200010000010000";

    fn yerc(hex: &[&str]) -> Decode {
        let hex = hex.iter().map(ToString::to_string).collect();
        Decode { hex, command: None, instance: None, attribute: None, selection: Selection::default() }
    }

    fn spaced(hex: &str, separator: &str) -> String {
        hex.as_bytes().chunks(2).map(|pair| std::str::from_utf8(pair).unwrap()).collect::<Vec<_>>().join(separator)
    }

    #[test]
    fn parses_bytes_as_tools_print_them() {
        let bytes = parse_hex(STATUS).unwrap();
        assert_eq!(bytes.len(), 32);
        for separator in [" ", ":", ", ", "-", " 0x", "\n"] {
            assert_eq!(parse_hex(&spaced(STATUS, separator)).unwrap(), bytes, "{separator:?}");
        }
        assert_eq!(parse_hex(&format!("0x{STATUS}")).unwrap(), bytes);
        assert_eq!(parse_hex("9 a").unwrap(), [9, 10]);
        assert_eq!(parse_hex("595").unwrap_err(), "'595' has an odd number of digits");
        assert_eq!(parse_hex("59\u{1b}").unwrap_err(), "'\\u{1b}' is not a valid hexadecimal digit");
    }

    #[test]
    fn decodes_split_and_consecutive_frames() {
        let apart = spaced(STATUS, " ");
        let words: Vec<&str> = apart.split(' ').collect();
        assert_eq!(yerc(&words).frames().unwrap().len(), 1);
        assert_eq!(yerc(&[STATUS, STATUS]).frames().unwrap().len(), 2);
        assert_eq!(yerc(&[&STATUS.repeat(3)]).frames().unwrap().len(), 3);
        assert!(yerc(&[""]).frames().is_err());
    }

    #[test]
    fn decodes_an_answer_with_its_request() {
        let answer = "594552432000080003010100000000803939393939393939810000000000000012000000c0000000";
        let alone = yerc(&[answer]);
        let title = |yerc: &Decode, at: usize| yerc.explain_frames(&yerc.frames().unwrap()).frames[at].title.clone();
        assert_eq!(title(&alone, 0), "answer");
        assert_eq!(title(&yerc(&[STATUS, answer]), 1), "answer: 0x72 status read");
        assert_eq!(title(&Decode { command: Some(0x72), ..alone }, 0), "answer: 0x72 status read");
    }

    #[test]
    fn damaged_frame_fails_with_the_fields_before_the_damage() {
        let cut = yerc(&[&STATUS[..40]]);
        let frames = cut.explain_frames(&cut.frames().unwrap());
        assert_eq!(frames.frames[0].fields.len(), 8);
        let failure = Report::failure(&frames).unwrap();
        assert_eq!(failure.kind.exit(), 5);
        assert_eq!(failure.message, "the frame is damaged: the frame ends inside 'reserve 2' at offset 16");
    }
}
