//! Lines of the host communication in a capture: of serial lines as `--trace` records them, and of device servers.

use std::collections::BTreeMap;
use std::net::SocketAddr;

use super::super::toyo::{FieldRow, field_table};
use super::{Field, Heard, Listener, Told, cut, note};
use crate::controller::toyo::describe::{Sender, describe, summary};
use crate::controller::toyo::request::Request;
use crate::output::view::Table;
use crate::transport::capture::{Carrier, Message};
use crate::transport::tap::Direction;

/// Everything that may be a conversation. Which is, and which end is the controller, its lines tell together: they are
/// heard once for that, and a second time to be told.
#[derive(Debug, Default)]
pub struct Lines {
    talks: BTreeMap<Place, Talk>,
    /// Where there are conversations, and which end of each is the controller.
    known: Option<BTreeMap<Place, usize>>,
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
    /// Characters of each end since its last line end.
    coming: [Vec<u8>; 2],
    /// Lines so far.
    lines: usize,
    /// Of each end, those that are answers less those that are not.
    answers: [i64; 2],
    /// Whether any line can only be of this communication.
    is_ours: bool,
    /// The request that was not answered yet.
    asked: Option<(u64, Request)>,
}

/// A line.
#[derive(Debug)]
struct Said {
    /// 0 for the end that is first in the place.
    by: usize,
    text: String,
    is_cut: bool,
}

/// Longest piece without a line end; the longest block is shorter.
const MOST: usize = 512;
/// Lines without a block after which a stream is something else.
const MOST_FOREIGN: usize = 1000;
/// Conversations at a time: more than a plant has.
const MOST_TALKS: usize = 1 << 16;

impl Listener for Lines {
    type Field = FieldRow;
    const LEARNS: bool = true;

    fn hear(&mut self, message: &Message<'_>) {
        let (place, by) = match message.carrier {
            Carrier::Datagram { .. } => return,
            Carrier::Stream { from, to, .. } if from <= to => (Place::Stream(from, to), 0),
            Carrier::Stream { from, to, .. } => (Place::Stream(to, from), 1),
            Carrier::Line { direction, section } => {
                (Place::Line(section), usize::from(direction == Direction::Received))
            }
        };
        let controller = match &self.known {
            None => None,
            Some(known) => match known.get(&place) {
                None => return,
                controller => controller.copied(),
            },
        };
        if !self.talks.contains_key(&place) && self.talks.len() >= MOST_TALKS {
            return;
        }
        let talk = self.talks.entry(place).or_default();
        self.told.packets += 1;
        let mut lines = Vec::new();
        if let Carrier::Stream { begins, lost, .. } = message.carrier {
            if begins {
                talk.coming = [Vec::new(), Vec::new()];
            }
            if lost > 0 {
                let before = message.number;
                note(&mut self.told.notes, format!("{lost} characters before packet {before} are not in the capture"));
                lines.extend(talk.line(by, message.is_cut));
            }
        }
        for byte in message.bytes {
            talk.coming[by].push(*byte);
            if *byte == b'\n' || talk.coming[by].len() >= MOST {
                lines.extend(talk.line(by, false));
            }
        }
        if message.is_cut {
            lines.extend(talk.line(by, true));
        }
        if let Some(controller) = controller {
            let told = lines.into_iter().map(|said| talk.tell(place, controller, message, said));
            self.told.messages.extend(told);
        }
    }

    fn end(&mut self) {
        for rest in self.talks.values().flat_map(|talk| &talk.coming).filter(|rest| !rest.is_empty()) {
            let rest = format!("left out at the end, without a line end: '{}'", rest.escape_ascii());
            note(&mut self.told.notes, rest);
        }
    }

    fn told(&mut self) -> &mut Told<FieldRow> {
        &mut self.told
    }

    fn again(self) -> Self {
        let learned = || {
            let ours = self.talks.into_iter().filter(|(_, talk)| talk.is_ours);
            ours.map(|(place, talk)| (place, talk.controller(place))).collect()
        };
        Self { known: Some(self.known.unwrap_or_else(learned)), ..Self::default() }
    }
}

impl Talk {
    /// Ends the line of one end, if that is one.
    fn line(&mut self, by: usize, is_cut: bool) -> Option<Said> {
        let bytes = std::mem::take(&mut self.coming[by]);
        let text = String::from_utf8_lossy(&bytes).trim_end_matches(['\r', '\n']).to_owned();
        if text.is_empty() || (self.lines >= MOST_FOREIGN && !self.is_ours) {
            return None;
        }
        self.lines += 1;
        self.is_ours = self.is_ours || is_block(&text);
        self.answers[by] += if Sender::guess(&text) == Sender::Controller { 1 } else { -1 };
        Some(Said { by, text, is_cut })
    }

    /// Which end is the controller: the one whose lines are answers.
    fn controller(&self, place: Place) -> usize {
        match place {
            Place::Line(_) => 1,
            Place::Stream(..) => usize::from(self.answers[1] >= self.answers[0]),
        }
    }

    fn tell(&mut self, place: Place, controller: usize, message: &Message<'_>, said: Said) -> Heard<FieldRow> {
        let link = match place {
            Place::Line(_) => ("host".to_owned(), "serial line".to_owned()),
            Place::Stream(first, second) if controller == 1 => (first.to_string(), second.to_string()),
            Place::Stream(first, second) => (second.to_string(), first.to_string()),
        };
        let Said { by, text, is_cut } = said;
        let is_answer = by == controller;
        let (sender, direction) =
            if is_answer { (Sender::Controller, Direction::Received) } else { (Sender::Host, Direction::Sent) };
        let before = self.asked.take().filter(|_| is_answer);
        let request = before.as_ref().map(|(_, request)| request);
        let description = describe(&text, sender, request);
        let heard = Heard {
            number: message.number,
            time: message.time,
            direction,
            link,
            text: format!("{text}  # {}", summary(&text, sender, request)),
            answers: before.as_ref().map(|(number, _)| *number),
            section: description.section,
            fields: description.fields.into_iter().map(FieldRow::from).collect(),
            problem: if is_cut { Some(cut()) } else { description.problem },
            raw: text.clone(),
        };
        if !is_answer {
            self.asked = Request::parse(&text).ok().map(|request| (message.number, request));
        }
        heard
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
