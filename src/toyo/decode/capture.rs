//! Lines of the host communication in a capture file of a serial line or a device server.

use std::net::SocketAddr;

use super::FieldRow;
use crate::prelude::basics::*;
use armctl_controller::toyo::describe::{Sender, describe, summary};
use armctl_frame::decode::capture::{CaptureDecoder, DecodedCapture, DecodedMessage, cut, note};
use armctl_transport::capture::{Carrier, Message};
use armctl_transport::tap::Direction;

/// All streams that may be host communication. At the end, their lines decide whether they are host communication.
#[derive(Debug, Default)]
pub struct LineDecoder {
    conversations: BTreeMap<Connection, Conversation>,
    /// Bytes that the stored conversations use.
    kept: usize,
    decoded: DecodedCapture<FieldRow>,
}

/// Connection over which a conversation runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Connection {
    /// A serial line; the number is its section in the file.
    Serial(usize),
    /// A TCP connection; the smaller address comes first.
    Tcp(SocketAddr, SocketAddr),
}

/// Lines of both ends of a connection.
#[derive(Debug, Default)]
struct Conversation {
    lines: Vec<ReceivedLine>,
    /// Characters of each end since its last line end.
    pending: [Vec<u8>; 2],
    packets: u64,
    notes: Vec<String>,
    /// Whether a line proves that the stream is host communication.
    is_ours: bool,
    /// Bytes that the stored lines use.
    kept: usize,
}

/// A line, and the packet that contains its end.
#[derive(Debug)]
struct ReceivedLine {
    number: u64,
    time: Duration,
    /// End that sent the line: 0 for the first end of the connection.
    end: usize,
    text: String,
    is_cut: bool,
}

/// Size of a conversation in bytes, without its lines.
const CONVERSATION: usize = 1024;
/// Maximum number of stored bytes. All lines are stored, because they are printed in order at the end.
const MEMORY_LIMIT: usize = 64 << 20;
/// Maximum number of characters without a line end. The longest block is shorter.
const MAX_LINE_CHARS: usize = 512;
/// If a stream has this number of lines without a block, no more of it is stored.
const MAX_FOREIGN_LINES: usize = 1000;

impl CaptureDecoder for LineDecoder {
    type Field = FieldRow;

    fn take(&mut self, message: &Message<'_>) {
        let (connection, end) = match message.carrier {
            Carrier::Datagram { .. } | Carrier::Frame { .. } => return,
            Carrier::Stream { from, to, .. } if from <= to => (Connection::Tcp(from, to), 0),
            Carrier::Stream { from, to, .. } => (Connection::Tcp(to, from), 1),
            Carrier::Line { direction, section } => {
                (Connection::Serial(section), usize::from(direction == Direction::Received))
            }
        };
        if self.kept > MEMORY_LIMIT {
            let full = "the capture exceeds the memory limit; only the first lines are shown";
            if !self.decoded.notes.iter().any(|note| note == full) {
                self.decoded.notes.push(full.to_owned());
            }
            return;
        }
        let conversation = self.conversations.entry(connection).or_insert_with(|| {
            self.kept += CONVERSATION;
            Conversation::default()
        });
        conversation.packets += 1;
        let stored_before = conversation.kept;
        let (mut is_new_connection, mut lost) = (false, 0);
        if let Carrier::Stream { begins, lost: missing, .. } = message.carrier {
            (is_new_connection, lost) = (begins, missing);
        }
        if is_new_connection {
            conversation.pending = [Vec::new(), Vec::new()];
        }
        if lost > 0 {
            let notes = &mut conversation.notes;
            note(notes, format!("{lost} characters before packet {} are not in the capture", message.number));
            conversation.line(end, message, message.is_cut);
        }
        for byte in message.bytes {
            conversation.pending[end].push(*byte);
            if *byte == b'\n' || conversation.pending[end].len() >= MAX_LINE_CHARS {
                conversation.line(end, message, false);
            }
        }
        if message.is_cut {
            conversation.line(end, message, true);
        }
        self.kept += conversation.kept - stored_before;
    }

    fn decoded(&mut self) -> &mut DecodedCapture<FieldRow> {
        &mut self.decoded
    }

    fn finish(&mut self) {
        for (connection, conversation) in std::mem::take(&mut self.conversations) {
            if !conversation.is_ours {
                continue;
            }
            self.decoded.packets += conversation.packets;
            conversation.decode(connection, &mut self.decoded);
        }
    }

    fn restart(self) -> Self {
        Self::default()
    }
}

impl Conversation {
    /// Completes the line of one end.
    fn line(&mut self, end: usize, message: &Message<'_>, is_cut: bool) {
        let bytes = std::mem::take(&mut self.pending[end]);
        let text = String::from_utf8_lossy(&bytes).trim_end_matches(['\r', '\n']).to_owned();
        if self.lines.len() >= MAX_FOREIGN_LINES && !self.is_ours {
            return;
        }
        if !text.is_empty() {
            self.is_ours = self.is_ours || is_block(&text);
            self.kept += text.len() + size_of::<ReceivedLine>();
            self.lines.push(ReceivedLine { number: message.number, time: message.time, end, text, is_cut });
        }
    }

    /// Index of the controller: the end that sends answers.
    fn controller(&self, connection: Connection) -> usize {
        if let Connection::Serial(_) = connection {
            return 1;
        }
        let answers = |end: usize| {
            let lines = self.lines.iter().filter(|line| line.end == end);
            lines.map(|line| if Sender::guess(&line.text) == Sender::Controller { 1i64 } else { -1 }).sum::<i64>()
        };
        usize::from(answers(1) >= answers(0))
    }

    fn decode(mut self, connection: Connection, decoded: &mut DecodedCapture<FieldRow>) {
        let controller = self.controller(connection);
        let link = Arc::new(match connection {
            Connection::Serial(_) => ("host".to_owned(), "serial line".to_owned()),
            Connection::Tcp(first, second) if controller == 1 => (first.to_string(), second.to_string()),
            Connection::Tcp(first, second) => (second.to_string(), first.to_string()),
        });
        decoded.notes.append(&mut self.notes);
        for rest in self.pending.iter().filter(|rest| !rest.is_empty()) {
            decoded.notes.push(format!("incomplete last line: '{}'", rest.escape_ascii()));
        }
        self.lines.sort_by_key(|line| line.number);
        let mut pending_request: Option<(u64, Request)> = None;
        for ReceivedLine { number, time, end, text, is_cut } in self.lines {
            let is_answer = end == controller;
            let (sender, direction) =
                if is_answer { (Sender::Controller, Direction::Received) } else { (Sender::Host, Direction::Sent) };
            let question = pending_request.take().filter(|_| is_answer);
            let request = question.as_ref().map(|(_, request)| request);
            let description = describe(&text, sender, request);
            decoded.messages.push(DecodedMessage {
                number,
                time,
                direction,
                link: Arc::clone(&link),
                text: format!("{text}  # {}", summary(&text, sender, request)),
                answers: question.as_ref().map(|(number, _)| *number),
                section: description.section,
                fields: description.fields.into_iter().map(FieldRow).collect(),
                problem: if is_cut { Some(cut()) } else { description.problem },
                raw: text.clone(),
            });
            if !is_answer {
                pending_request = Request::parse(&text).ok().map(|request| (number, request));
            }
        }
    }
}

/// Whether a line certainly belongs to this protocol: `@OK`, `@NG`, or `@` and a word of the command table.
fn is_block(text: &str) -> bool {
    matches!(text.trim_end_matches(' '), "@OK" | "@NG") || Request::parse(text).is_ok()
}
