//! Images and remote commands in a capture, with the fieldbus messages around them.

use std::collections::HashMap;

use crate::field_row::FieldRow;
use crate::prelude::basics::*;
use armctl_controller::text::hex;
use armctl_controller::yrcx::answer::Status;
use armctl_controller::yrcx::describe::{Description, FieldNote, answer, command};
use armctl_controller::yrcx::image::Words;
use armctl_controller::yrcx::image_changes::{Change, changes};
use armctl_frame::decode::capture::{DecodedCapture, DecodedMessage, cut, note};
use armctl_transport::capture::Message;
use armctl_transport::tap::Direction;

/// Maximum number of connections and pending requests that the decoder keeps. A real plant has fewer.
pub const MAX_STORED: usize = 1 << 16;

/// Decoder of one fieldbus.
pub trait BusDecoder: fmt::Debug + Send {
    /// Decodes a packet, if it belongs to this fieldbus.
    fn take(&mut self, message: &Message<'_>, images: &mut Images);

    /// Adds notes about missing data, at the end of the capture.
    fn finish(&mut self, images: &mut Images);
}

/// Images and messages that were decoded.
#[derive(Debug, Default)]
pub struct Images {
    decoded: DecodedCapture<FieldRow>,
    /// Whether to list images without new content too.
    all: bool,
    shown: HashMap<(String, String), LastImages>,
}

/// Last images of a connection.
#[derive(Debug, Default)]
struct LastImages {
    /// Last image from the client, and last image from the controller.
    images: [Option<Image>; 2],
    /// Latest command, with its packet number.
    command: Option<(u64, Words)>,
}

impl Images {
    /// Creates an empty result; `all` lists every image.
    pub fn new(all: bool) -> Self {
        Self { all, ..Self::default() }
    }

    /// Whether the result lists every image.
    pub fn lists_all(&self) -> bool {
        self.all
    }

    /// Decoded messages.
    pub fn decoded(&mut self) -> &mut DecodedCapture<FieldRow> {
        &mut self.decoded
    }

    /// Counts a packet of the fieldbus.
    pub fn count(&mut self) {
        self.decoded.packets += 1;
    }

    /// Adds a message of the fieldbus.
    pub fn message(&mut self, message: DecodedMessage<FieldRow>) {
        self.decoded.messages.push(message);
    }

    /// Adds a note on the whole capture.
    pub fn note(&mut self, text: String) {
        note(&mut self.decoded.notes, text);
    }

    /// Adds an image from the client or the controller, if it has new content.
    pub fn image(&mut self, message: &Message<'_>, direction: Direction, link: &(String, String), image: &Image) {
        if self.shown.len() >= MAX_STORED {
            self.shown.clear();
        }
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
                    // If WI0 is 0, there is no command yet: the other words are data of the next command, so they are
                    // not a problem.
                    if words[0] != 0 {
                        describe(&mut decoded, command(words));
                    }
                }
                Change::Words { words, .. } => {
                    let answered = shown.command.filter(|_| Status::from_word(words[0]) != Status::Ready);
                    decoded.answers = answered.map(|(number, _)| number);
                    describe(&mut decoded, answer(words, answered.as_ref().map(|(_, words)| words)));
                }
                Change::Signal { signal, on } => {
                    let side = if side == Side::Input { "WI" } else { "WO" };
                    let place = format!("{side}{} bit {}", signal.word(), signal.bit());
                    let meaning = signal.dedicated().map(|dedicated| dedicated.text).unwrap_or_default();
                    decoded.fields.push(FieldRow(FieldNote::of_message(
                        &place,
                        &signal.to_string(),
                        u8::from(*on).to_string(),
                        meaning,
                    )));
                }
            }
            self.decoded.messages.push(decoded);
        }
    }
}

/// A message with this text.
pub fn decoded(
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
        link: Arc::new(link),
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
    decoded.fields = description.fields.into_iter().map(FieldRow).collect();
    if !description.problems.is_empty() {
        decoded.problem = Some(description.problems.join("; "));
    }
}
