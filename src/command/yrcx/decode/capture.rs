//! Images and remote commands in a capture, with the EtherNet/IP messages around them.

use std::collections::{HashMap, HashSet};
use std::net::{IpAddr, SocketAddr};

use super::FieldRow;
use super::cip::{explain, may_be_message};
use crate::command::decode::capture::{CaptureDecoder, DecodedCapture, DecodedMessage, cut, note};
use crate::controller::text::hex;
use crate::controller::yrcx::answer::Status;
use crate::controller::yrcx::changes::{Change, changes};
use crate::controller::yrcx::describe::{Description, answer, command};
use crate::controller::yrcx::image::{Image, Words};
use crate::controller::yrcx::signal::Side;
use crate::transport::capture::{Carrier, Message};
use crate::transport::eip::PORT;
use crate::transport::eip::wire::{Cyclic, Frames, RUN};
use crate::transport::tap::Direction;

/// Images, and the messages that open and close their connections.
#[derive(Debug, Default)]
pub struct ImageDecoder {
    decoded: DecodedCapture<FieldRow>,
    /// Whether images that say nothing new are listed, too.
    all: bool,
    /// Directions of TCP streams, as long as they may be EtherNet/IP.
    streams: HashMap<(SocketAddr, SocketAddr), Option<Frames>>,
    /// Requests that were not answered yet, with the number of their packet, by client, controller and context.
    asked: HashMap<(SocketAddr, SocketAddr, [u8; 8]), u64>,
    /// Connections whose opening was seen, by controller and id: those to the controller, and those back with their
    /// client, because what comes back may be sent to a group. The ids of the two directions may be the same.
    forth: HashSet<(IpAddr, u32)>,
    back: HashMap<(IpAddr, u32), IpAddr>,
    flows: HashMap<(SocketAddr, SocketAddr, u32), Flow>,
    shown: HashMap<(String, String), Shown>,
}

/// One direction of a connection.
#[derive(Debug, Clone, Copy)]
struct Flow {
    /// Of the last datagram.
    sequence: u32,
    lost: u64,
    /// The run bit of the last header.
    run: Option<bool>,
}

/// What both ends of a connection showed last.
#[derive(Debug, Default)]
struct Shown {
    /// Of the client, and of the controller.
    images: [Option<Image>; 2],
    /// The command that runs, or ran last.
    command: Option<(u64, Words)>,
}

/// Bytes of an image behind a run/idle header.
const WITH_HEADER: usize = Image::BYTES + 4;

impl ImageDecoder {
    /// Begins; `all` lists every image.
    pub fn new(all: bool) -> Self {
        Self { all, ..Self::default() }
    }

    fn stream(&mut self, message: &Message<'_>, ends: (SocketAddr, SocketAddr), begins: bool, lost: u32) {
        if begins || lost > 0 {
            self.streams.remove(&ends);
        }
        self.forget_if_many();
        if lost > 0 && self.streams.contains_key(&(ends.1, ends.0)) {
            note(
                &mut self.decoded.notes,
                format!("{lost} bytes before packet {} are not in the capture", message.number),
            );
        }
        let fresh = || may_be_message(message.bytes).then(Frames::default);
        let Some(frames) = self.streams.entry(ends).or_insert_with(fresh) else { return };
        let mut frames = std::mem::take(frames);
        frames.push(message.bytes);
        self.decoded.packets += 1;
        while let Some(bytes) = frames.pop() {
            if !may_be_message(&bytes) {
                self.streams.insert(ends, None);
                return;
            }
            self.encapsulated(message, ends, &bytes);
        }
        self.streams.insert(ends, Some(frames));
    }

    /// No plant has so many connections; what follows is decoded without what was before.
    fn forget_if_many(&mut self) {
        const MOST: usize = 1 << 16;

        let known = [
            self.streams.len(),
            self.asked.len(),
            self.forth.len(),
            self.back.len(),
            self.flows.len(),
            self.shown.len(),
        ];
        if known.iter().any(|known| *known >= MOST) {
            let (all, decoded) = (self.all, std::mem::take(&mut self.decoded));
            *self = Self { decoded, all, ..Self::default() };
        }
    }

    /// A message of the encapsulation.
    fn encapsulated(&mut self, message: &Message<'_>, ends: (SocketAddr, SocketAddr), bytes: &[u8]) {
        let described = explain(bytes);
        let (direction, client, controller) =
            if described.is_answer { (Direction::Received, ends.1, ends.0) } else { (Direction::Sent, ends.0, ends.1) };
        let context = bytes.get(12..20).and_then(|bytes| bytes.first_chunk().copied()).unwrap_or_default();
        let key = (client, controller, context);
        let answers = if described.is_answer { self.asked.remove(&key) } else { None };
        if !described.is_answer {
            self.asked.insert(key, message.number);
        }
        if let Some((o_t, t_o)) = described.opened {
            self.forth.insert((controller.ip(), o_t));
            self.back.insert((controller.ip(), t_o), client.ip());
        }
        self.decoded.messages.push(DecodedMessage {
            number: message.number,
            time: message.time,
            direction,
            link: (client.ip().to_string(), controller.ip().to_string()),
            text: described.text,
            answers,
            section: None,
            raw: hex(bytes),
            fields: described.fields,
            problem: described.problem,
        });
    }

    /// A cyclic datagram, if it is one.
    fn cyclic(&mut self, message: &Message<'_>, from: SocketAddr, to: SocketAddr) {
        self.forget_if_many();
        let Ok(cyclic) = Cyclic::parse(message.bytes) else { return };
        let client = self.back.get(&(from.ip(), cyclic.id)).copied();
        let is_forth = self.forth.contains(&(to.ip(), cyclic.id));
        let len = cyclic.body.len();
        let known = match (is_forth, client) {
            // On one machine, equal ids fit both ways; then the size tells, as without an opening.
            (true, Some(_)) | (false, None) => None,
            (true, None) => Some(Direction::Sent),
            (false, Some(_)) => Some(Direction::Received),
        };
        let (direction, header, image) = match (known, cyclic.body.split_first_chunk::<4>()) {
            (known, Some((header, image))) if len == WITH_HEADER => {
                (known.unwrap_or(Direction::Sent), Some(u32::from_le_bytes(*header) & RUN == RUN), image)
            }
            (known, _) if len == Image::BYTES => (known.unwrap_or(Direction::Received), None, cyclic.body),
            // Heartbeats of a connection that was seen to open; all others are not ours.
            (Some(_), _) => {
                self.decoded.packets += 1;
                return;
            }
            (None, _) => return,
        };
        let Some(image) = Image::from_bytes(image) else { return };
        self.decoded.packets += 1;
        let (client, controller) = match direction {
            Direction::Sent => (from.ip(), to.ip()),
            Direction::Received => (client.unwrap_or(to.ip()), from.ip()),
        };
        let link = (client.to_string(), controller.to_string());
        let flow = Flow { sequence: cyclic.sequence.wrapping_sub(1), lost: 0, run: None };
        let flow = self.flows.entry((from, to, cyclic.id)).or_insert(flow);
        let missing = cyclic.sequence.wrapping_sub(flow.sequence).wrapping_sub(1);
        if missing > u32::MAX / 2 {
            // Older than what came before, or the same again.
            return;
        }
        flow.lost += u64::from(missing);
        flow.sequence = cyclic.sequence;
        let before = flow.run;
        flow.run = header.or(before);
        if let Some(run) = header
            && before != header
            && (before.is_some() || !run)
        {
            let text = if run { "run: outputs count" } else { "idle: outputs do not count" };
            self.decoded.messages.push(decoded(message, direction, link.clone(), text.to_owned()));
        }
        self.image(message, direction, &link, &image);
    }

    /// An image that one end showed.
    fn image(&mut self, message: &Message<'_>, direction: Direction, link: &(String, String), image: &Image) {
        let shown = self.shown.entry(link.clone()).or_default();
        let (at, side) = match direction {
            Direction::Sent => (0, Side::Input),
            Direction::Received => (1, Side::Output),
        };
        let before = shown.images[at].replace(*image);
        let changes = changes(side, before.as_ref(), image);
        if changes.is_empty() && self.all {
            let decoded = decoded(message, direction, link.clone(), "image: nothing new".to_owned());
            self.decoded.messages.push(DecodedMessage { raw: hex(&image.to_bytes()), ..decoded });
        }
        for change in changes {
            let mut decoded = decoded(message, direction, link.clone(), change.line(false));
            match &change {
                Change::Words { side: Side::Input, words, .. } => {
                    let was = before.map_or(0, |before| before.0[0]);
                    if words[0] != 0 && (words[0] != was || shown.command.is_none()) {
                        shown.command = Some((message.number, *words));
                    }
                    // Without a command, words are data of the next one, and no problem yet.
                    if words[0] != 0 {
                        describe(&mut decoded, command(words));
                    }
                }
                Change::Words { words, .. } => {
                    let answered = shown.command.filter(|_| Status::of(words[0]) != Status::Ready);
                    decoded.answers = answered.map(|(number, _)| number);
                    describe(&mut decoded, answer(words, answered.as_ref().map(|(_, words)| words)));
                }
                Change::Signal { signal, on } => {
                    let side = if side == Side::Input { "WI" } else { "WO" };
                    let place = format!("{side}{} bit {}", signal.word(), signal.bit());
                    let meaning = signal.dedicated().map(|dedicated| dedicated.text).unwrap_or_default();
                    decoded.fields.push(FieldRow::of_message(
                        &place,
                        &signal.to_string(),
                        u8::from(*on).to_string(),
                        meaning,
                    ));
                }
            }
            self.decoded.messages.push(decoded);
        }
    }
}

fn decoded(
    message: &Message<'_>,
    direction: Direction,
    link: (String, String),
    text: String,
) -> DecodedMessage<FieldRow> {
    let raw = text.split("  # ").next().unwrap_or_default().to_owned();
    let (number, time) = (message.number, message.time);
    let problem = message.is_cut.then(cut);
    DecodedMessage {
        number,
        time,
        direction,
        link,
        text,
        answers: None,
        section: None,
        raw,
        fields: Vec::new(),
        problem,
    }
}

fn describe(decoded: &mut DecodedMessage<FieldRow>, description: Description) {
    decoded.section = description.section.map(str::to_owned);
    decoded.fields = description.fields.into_iter().map(FieldRow::from).collect();
    if !description.problems.is_empty() {
        decoded.problem = Some(description.problems.join("; "));
    }
}

impl CaptureDecoder for ImageDecoder {
    type Field = FieldRow;

    fn take(&mut self, message: &Message<'_>) {
        match message.carrier {
            Carrier::Stream { from, to, begins, lost } => self.stream(message, (from, to), begins, lost),
            Carrier::Datagram { from, to } if from.port() == PORT || to.port() == PORT => {
                if may_be_message(message.bytes) {
                    self.forget_if_many();
                    self.decoded.packets += 1;
                    self.encapsulated(message, (from, to), message.bytes);
                }
            }
            Carrier::Datagram { from, to } => self.cyclic(message, from, to),
            Carrier::Line { direction, .. } => {
                if let Some(image) = Image::from_bytes(message.bytes) {
                    self.decoded.packets += 1;
                    let link = ("host".to_owned(), "simulator".to_owned());
                    self.image(message, direction, &link, &image);
                }
            }
        }
    }

    fn decoded(&mut self) -> &mut DecodedCapture<FieldRow> {
        &mut self.decoded
    }

    fn finish(&mut self) {
        let mut lost: Vec<_> = std::mem::take(&mut self.flows).into_iter().filter(|(_, flow)| flow.lost > 0).collect();
        lost.sort_by_key(|(place, _)| *place);
        for ((from, to, _), flow) in lost {
            note(&mut self.decoded.notes, format!("{} cyclic packets from {from} to {to} are missing", flow.lost));
        }
    }

    fn restart(self) -> Self {
        Self::new(self.all)
    }
}
