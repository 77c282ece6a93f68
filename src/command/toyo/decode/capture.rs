//! Lines of the host communication in a capture: of serial lines as `--trace` records them, and of device servers.

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::time::Duration;

use super::{FieldRow, field_table};
use crate::command::common::decode::capture::{Field, Heard, Listener, Told, cut, note};
use crate::controller::toyo::describe::{Sender, describe, summary};
use crate::controller::toyo::request::Request;
use crate::output::view::Table;
use crate::transport::capture::{Carrier, Message};
use crate::transport::tap::Direction;

/// Everything that may be a conversation; which is, its lines tell in the end.
#[derive(Debug, Default)]
pub struct Lines {
    talks: BTreeMap<Place, Talk>,
    /// Bytes that they take.
    kept: usize,
    told: Told<FieldRow>,
}

/// Where a conversation takes place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Place {
    /// A serial line, of a section of the file.
    Line(usize),
    /// A TCP connection, its ends in order.
    Stream(SocketAddr, SocketAddr),
}

/// What both ends said.
#[derive(Debug, Default)]
struct Talk {
    said: Vec<Said>,
    /// Characters of each end since its last line end.
    coming: [Vec<u8>; 2],
    packets: u64,
    notes: Vec<String>,
    /// Whether any line can only be of this communication.
    is_ours: bool,
    /// Bytes that the lines take.
    kept: usize,
}

/// A line.
#[derive(Debug)]
struct Said {
    number: u64,
    time: Duration,
    /// 0 for the end that is first in the place.
    by: usize,
    text: String,
    is_cut: bool,
}

/// Bytes that a conversation takes beside its lines.
const TALK: usize = 1024;
/// Bytes of conversations that are kept: their lines are told in order at the end, which takes all of them.
const ROOM: usize = 64 << 20;
/// Longest piece without a line end; the longest block is shorter.
const MOST: usize = 512;
/// Lines without a block after which a stream is something else, which need not be kept.
const MOST_FOREIGN: usize = 1000;

impl Listener for Lines {
    type Field = FieldRow;

    fn hear(&mut self, message: &Message<'_>) {
        let (place, by) = match message.carrier {
            Carrier::Datagram { .. } => return,
            Carrier::Stream { from, to, .. } if from <= to => (Place::Stream(from, to), 0),
            Carrier::Stream { from, to, .. } => (Place::Stream(to, from), 1),
            Carrier::Line { direction, section } => {
                (Place::Line(section), usize::from(direction == Direction::Received))
            }
        };
        if self.kept > ROOM {
            let full = "there are more lines than there is room for; the first ones are told";
            if !self.told.notes.iter().any(|note| note == full) {
                self.told.notes.push(full.to_owned());
            }
            return;
        }
        let talk = self.talks.entry(place).or_insert_with(|| {
            self.kept += TALK;
            Talk::default()
        });
        talk.packets += 1;
        let kept = talk.kept;
        let (mut begins, mut lost) = (false, 0);
        if let Carrier::Stream { begins: anew, lost: missing, .. } = message.carrier {
            (begins, lost) = (anew, missing);
        }
        if begins {
            talk.coming = [Vec::new(), Vec::new()];
        }
        if lost > 0 {
            let notes = &mut talk.notes;
            note(notes, format!("{lost} characters before packet {} are not in the capture", message.number));
            talk.line(by, message, message.is_cut);
        }
        for byte in message.bytes {
            talk.coming[by].push(*byte);
            if *byte == b'\n' || talk.coming[by].len() >= MOST {
                talk.line(by, message, false);
            }
        }
        if message.is_cut {
            talk.line(by, message, true);
        }
        self.kept += talk.kept - kept;
    }

    fn told(&mut self) -> &mut Told<FieldRow> {
        &mut self.told
    }

    fn end(&mut self) {
        for (place, talk) in std::mem::take(&mut self.talks) {
            if !talk.is_ours {
                continue;
            }
            self.told.packets += talk.packets;
            talk.tell(place, &mut self.told);
        }
    }

    fn again(self) -> Self {
        Self::default()
    }
}

impl Talk {
    /// Ends the line of one end.
    fn line(&mut self, by: usize, message: &Message<'_>, is_cut: bool) {
        let bytes = std::mem::take(&mut self.coming[by]);
        let text = String::from_utf8_lossy(&bytes).trim_end_matches(['\r', '\n']).to_owned();
        if self.said.len() >= MOST_FOREIGN && !self.is_ours {
            return;
        }
        if !text.is_empty() {
            self.is_ours = self.is_ours || is_block(&text);
            self.kept += text.len() + size_of::<Said>();
            self.said.push(Said { number: message.number, time: message.time, by, text, is_cut });
        }
    }

    /// Which end is the controller: the one whose lines are answers.
    fn controller(&self, place: Place) -> usize {
        if let Place::Line(_) = place {
            return 1;
        }
        let answers = |by: usize| {
            let lines = self.said.iter().filter(|said| said.by == by);
            lines.map(|said| if Sender::guess(&said.text) == Sender::Controller { 1i64 } else { -1 }).sum::<i64>()
        };
        usize::from(answers(1) >= answers(0))
    }

    fn tell(mut self, place: Place, told: &mut Told<FieldRow>) {
        let controller = self.controller(place);
        let link = match place {
            Place::Line(_) => ("host".to_owned(), "serial line".to_owned()),
            Place::Stream(first, second) if controller == 1 => (first.to_string(), second.to_string()),
            Place::Stream(first, second) => (second.to_string(), first.to_string()),
        };
        told.notes.append(&mut self.notes);
        for rest in self.coming.iter().filter(|rest| !rest.is_empty()) {
            told.notes.push(format!("left out at the end, without a line end: '{}'", rest.escape_ascii()));
        }
        self.said.sort_by_key(|said| said.number);
        let mut asked: Option<(u64, Request)> = None;
        for Said { number, time, by, text, is_cut } in self.said {
            let is_answer = by == controller;
            let (sender, direction) =
                if is_answer { (Sender::Controller, Direction::Received) } else { (Sender::Host, Direction::Sent) };
            let before = asked.take().filter(|_| is_answer);
            let request = before.as_ref().map(|(_, request)| request);
            let description = describe(&text, sender, request);
            told.messages.push(Heard {
                number,
                time,
                direction,
                link: link.clone(),
                text: format!("{text}  # {}", summary(&text, sender, request)),
                answers: before.as_ref().map(|(number, _)| *number),
                section: description.section,
                fields: description.fields.into_iter().map(FieldRow::from).collect(),
                problem: if is_cut { Some(cut()) } else { description.problem },
                raw: text.clone(),
            });
            if !is_answer {
                asked = Request::parse(&text).ok().map(|request| (number, request));
            }
        }
    }
}

/// Whether a line can only be of this communication: a verdict, or `@` and a word of the table.
fn is_block(text: &str) -> bool {
    matches!(text.trim_end_matches(' '), "@OK" | "@NG") || Request::parse(text).is_ok()
}

impl Field for FieldRow {
    fn table(fields: &[Self]) -> Table {
        field_table(fields)
    }
}
