//! SLCAN, the ASCII protocol of Lawicel CAN adapters. Lines end with CR. This module has both sides of the protocol.

use super::{Bitrate, Frame, MAX_DATA};

/// End of a line. A line that consists only of a CR is a positive answer.
pub const CR: u8 = 0x0D;
/// BELL character. It ends a line that is a negative answer.
pub const BELL: u8 = 0x07;
/// Maximum length of a line in characters. The longest valid line is an extended frame with a timestamp, and is
/// shorter.
const MAX_LINE_LEN: usize = 32;

/// Status flags of an adapter (answer to `F`).
pub mod flag {
    /// The queue of received frames is full.
    pub const RECEIVE_FULL: u8 = 0x01;
    /// The queue of frames to send is full.
    pub const SEND_FULL: u8 = 0x02;
    /// The error warning level is reached.
    pub const WARNING: u8 = 0x04;
    /// Overrun: received frames were lost.
    pub const OVERRUN: u8 = 0x08;
    /// The adapter is in the state error passive.
    pub const PASSIVE: u8 = 0x20;
    /// An error occurred on the bus.
    pub const BUS_ERROR: u8 = 0x80;
}

/// Command that sets a bit rate.
pub const fn bitrate_command(bitrate: Bitrate) -> &'static [u8] {
    match bitrate {
        Bitrate::K125 => b"S4\r",
        Bitrate::K250 => b"S5\r",
        Bitrate::K500 => b"S6\r",
    }
}

/// Encodes a frame as a line. The format is the same in both directions.
pub fn emit(frame: &Frame) -> Vec<u8> {
    let mut line = format!("t{:03X}{}", frame.id(), frame.data().len());
    for byte in frame.data() {
        line.push_str(&format!("{byte:02X}"));
    }
    line.push('\r');
    line.into_bytes()
}

/// A line from an adapter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AdapterMessage {
    /// A frame from the bus.
    Frame(Frame),
    /// A frame of a type that DeviceNet does not use (extended or remote).
    Other,
    /// Status flags.
    Flags(u8),
    /// Version or serial number.
    About(String),
    /// Positive answer. It can also be the answer to a frame.
    Done,
    /// Negative answer.
    No,
}

/// A line to an adapter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Command {
    /// Bit rate, as the digit of the command.
    Bitrate(u8),
    /// Open the channel.
    Open,
    /// Open the channel in listen-only mode.
    Listen,
    /// Close the channel.
    Close,
    /// Send a frame.
    Send(Frame),
    /// Send a frame of a type that DeviceNet does not use.
    SendOther {
        /// Whether the frame is extended. The answer to an extended frame is `Z`.
        is_extended: bool,
    },
    /// Ask for the version.
    Version,
    /// Ask for the serial number.
    Number,
    /// Ask for the status flags.
    Flags,
    /// Switch timestamps of received frames on or off.
    Timestamps(bool),
    /// Set filters or other settings. The simulated adapter accepts and ignores them.
    Setting,
    /// An empty line.
    Empty,
    /// Unknown command.
    Unknown,
}

/// Line assembler.
#[derive(Debug, Clone, Default)]
pub struct Lines {
    line: Vec<u8>,
    is_long: bool,
}

/// A complete line. A line that was too long has an empty text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// Whether the line ended with [`BELL`].
    pub is_bell: bool,
    /// Text without the terminator.
    pub text: String,
}

impl Lines {
    /// Adds a byte. Returns the line if the byte completes one. LF is ignored, because some devices send CR LF.
    pub fn push(&mut self, byte: u8) -> Option<Line> {
        match byte {
            CR | BELL => {
                let text = String::from_utf8_lossy(&std::mem::take(&mut self.line)).into_owned();
                let is_long = std::mem::take(&mut self.is_long);
                Some(Line { is_bell: byte == BELL, text: if is_long { "?".to_owned() } else { text } })
            }
            b'\n' => None,
            _ if self.line.len() >= MAX_LINE_LEN => {
                self.is_long = true;
                None
            }
            _ => {
                self.line.push(byte);
                None
            }
        }
    }
}

impl Line {
    /// Decodes a line from an adapter; `None` if it is not valid.
    pub fn adapter_messages(&self) -> Option<AdapterMessage> {
        if self.is_bell {
            return Some(AdapterMessage::No);
        }
        let text = self.text.as_str();
        match text.as_bytes().first() {
            None | Some(b'z' | b'Z') if text.len() <= 1 => Some(AdapterMessage::Done),
            Some(b'F') if text.len() == 3 => u8::from_str_radix(text.get(1..)?, 16).ok().map(AdapterMessage::Flags),
            Some(b'V' | b'N') => Some(AdapterMessage::About(text.to_owned())),
            Some(b'T' | b'r' | b'R') => Some(AdapterMessage::Other),
            // If there is text before a frame, it is the rest of a damaged line. It is skipped.
            _ => text.match_indices('t').find_map(|(at, _)| frame(text.get(at..)?, true)).map(AdapterMessage::Frame),
        }
    }

    /// Decodes a line to an adapter.
    pub fn command(&self) -> Command {
        if self.is_bell {
            return Command::Unknown;
        }
        let text = self.text.as_str();
        match text.as_bytes() {
            [] => Command::Empty,
            [b'S', digit @ b'0'..=b'8'] => Command::Bitrate(digit - b'0'),
            b"O" => Command::Open,
            b"L" => Command::Listen,
            b"C" => Command::Close,
            b"V" | b"v" => Command::Version,
            b"N" => Command::Number,
            b"F" => Command::Flags,
            b"Z0" => Command::Timestamps(false),
            b"Z1" => Command::Timestamps(true),
            [b't', ..] => frame(text, false).map_or(Command::Unknown, Command::Send),
            [b'r', ..] if text.len() == 5 => Command::SendOther { is_extended: false },
            [b'T' | b'R', ..] if text.len() >= 10 => Command::SendOther { is_extended: true },
            [b'M' | b'm' | b's' | b'X' | b'U' | b'W', ..] => Command::Setting,
            _ => Command::Unknown,
        }
    }
}

/// Parses a frame of the form `tIIILDD..`. With `with_time`, the frame may end with the four digits of a timestamp, as
/// in lines from an adapter.
fn frame(text: &str, with_time: bool) -> Option<Frame> {
    let id = u16::from_str_radix(text.get(1..4)?, 16).ok()?;
    let len: usize = text.get(4..5)?.parse().ok()?;
    let rest = text.get(5..)?;
    if len > MAX_DATA || !(rest.len() == 2 * len || with_time && rest.len() == 2 * len + 4) {
        return None;
    }
    let byte = |at: usize| u8::from_str_radix(rest.get(2 * at..2 * at + 2)?, 16).ok();
    let data: Option<Vec<u8>> = (0..len).map(byte).collect();
    Frame::new(id, &data?)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn lines(bytes: &[u8]) -> Vec<Line> {
        let mut lines = Lines::default();
        bytes.iter().filter_map(|byte| lines.push(*byte)).collect()
    }

    fn adapter_messages(bytes: &[u8]) -> Vec<Option<AdapterMessage>> {
        lines(bytes).iter().map(Line::adapter_messages).collect()
    }

    #[test]
    fn parses_lines_of_an_adapter() {
        let frame = Frame::new(0x42D, &[0, 1, 0xFF]).unwrap();
        assert_eq!(emit(&frame), b"t42D30001FF\r");
        let empty = Frame::new(0x42D, &[]).unwrap();
        let all =
            b"t42D30001FF\rt42D30001FF1A2B\rt42D0\r\r\x07z\rZ\rF2C\rV1013\rNA123\rT000004200\rxxt42D0\rt42D9\rtt\r";
        let expected = [
            Some(AdapterMessage::Frame(frame)),
            Some(AdapterMessage::Frame(frame)),
            Some(AdapterMessage::Frame(empty)),
            Some(AdapterMessage::Done),
            Some(AdapterMessage::No),
            Some(AdapterMessage::Done),
            Some(AdapterMessage::Done),
            Some(AdapterMessage::Flags(0x2C)),
            Some(AdapterMessage::About("V1013".to_owned())),
            Some(AdapterMessage::About("NA123".to_owned())),
            Some(AdapterMessage::Other),
            Some(AdapterMessage::Frame(empty)),
            None,
            None,
        ];
        assert_eq!(adapter_messages(all), expected);
    }

    #[test]
    fn formats_commands_for_an_adapter() {
        let frame = Frame::new(0x42F, &[0]).unwrap();
        let commands: Vec<Command> =
            lines(b"C\rS6\r\rO\rO\rL\rt42F100\rt42F1001A2B\rr42F0\rT0000042F0\rV\rN\rF\rZ1\rM00000000\rS9\rq\r")
                .iter()
                .map(Line::command)
                .collect();
        let expected = [
            Command::Close,
            Command::Bitrate(6),
            Command::Empty,
            Command::Open,
            Command::Open,
            Command::Listen,
            Command::Send(frame),
            // Only a line from an adapter can have a timestamp.
            Command::Unknown,
            Command::SendOther { is_extended: false },
            Command::SendOther { is_extended: true },
            Command::Version,
            Command::Number,
            Command::Flags,
            Command::Timestamps(true),
            Command::Setting,
            Command::Unknown,
            Command::Unknown,
        ];
        assert_eq!(commands, expected);
    }

    #[test]
    fn endless_line_uses_limited_memory() {
        let mut noise = vec![b't'; 10_000];
        noise.extend(b"\rt42D0\r");
        assert_eq!(adapter_messages(&noise), [None, Some(AdapterMessage::Frame(Frame::new(0x42D, &[]).unwrap()))]);
    }

    proptest! {
        #[test]
        fn frames_round_trip(id in 0u16..=0x7FF, data in proptest::collection::vec(any::<u8>(), 0..=8)) {
            let frame = Frame::new(id, &data).unwrap();
            prop_assert_eq!(adapter_messages(&emit(&frame)), [Some(AdapterMessage::Frame(frame))]);
            prop_assert_eq!(lines(&emit(&frame))[0].command(), Command::Send(frame));
        }
    }
}
