//! `armctl decode FAMILY FILE.pcapng`: what a capture file holds of a family, in the words of a trace. `report` is what
//! is printed, `stream` prints what there is no room for at once.

mod report;
mod stream;
#[cfg(test)]
mod tests;

use std::io::{self, Read};
use std::net::{IpAddr, SocketAddr};
use std::path::Path;
use std::time::Duration;

use anyhow::Context as _;
use clap::Args;
use jiff::Timestamp;
use serde::Serialize;

pub use self::report::Capture;
use self::report::{FULL, Links, Problems, counted};
use super::Field;
use crate::command::Report as _;
use crate::command::frame::run::{Run, RunError};
use crate::failure::Failure;
use crate::files;
use crate::output::Format;
use crate::output::busy::busy;
use crate::output::envelope::ErrorBody;
use crate::transport::capture::{Carrier, Message, OpenError, Summary, read};
pub use crate::transport::capture::{holds_telegram, parse_hex};
use crate::transport::tap::Direction;

/// What of a capture file is shown.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Capture files")]
pub struct Selection {
    /// Show the messages of one packet, field by field
    #[arg(long, value_name = "NUMBER")]
    frame: Option<u64>,
    /// Only what comes from or goes to this address
    #[arg(long, value_name = "ADDRESS")]
    host: Option<IpAddr>,
    /// Only what comes from or goes to this port
    #[arg(long, value_name = "PORT")]
    port: Option<u16>,
}

impl Selection {
    /// Whether anything is left out.
    pub const fn is_given(&self) -> bool {
        self.frame.is_some() || self.host.is_some() || self.port.is_some()
    }

    fn admits(&self, carrier: &Carrier) -> bool {
        let is = |end: SocketAddr| {
            self.host.is_none_or(|host| host == end.ip().to_canonical())
                && self.port.is_none_or(|port| port == end.port())
        };
        match carrier.ends() {
            Some((from, to)) => is(from) || is(to),
            None => self.host.is_none() && self.port.is_none(),
        }
    }
}

/// The capture file that the only argument of a command names, if it is one.
pub fn file_among(arguments: &[String]) -> Option<&Path> {
    let [argument] = arguments else { return None };
    let path = Path::new(argument);
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    matches!(extension.as_str(), "pcap" | "pcapng" | "cap").then_some(path)
}

/// Where a capture is.
#[derive(Debug)]
pub enum Input<'a> {
    /// In a file.
    File(&'a Path),
    /// Here; with what it is called.
    Bytes(&'static str, Vec<u8>),
}

impl Input<'_> {
    fn name(&self) -> String {
        match self {
            Self::File(path) => path.display().to_string(),
            Self::Bytes(name, _) => (*name).to_owned(),
        }
    }

    fn open(&self) -> io::Result<Box<dyn Read + '_>> {
        Ok(match self {
            Self::File(path) => Box::new(files::open(path)?),
            Self::Bytes(_, bytes) => Box::new(bytes.as_slice()),
        })
    }
}

/// A report, unless there is no room for one, and the decoder, ready to begin anew.
type Captured<D> = (Option<Capture<<D as CaptureDecoder>::Field>>, D);

/// Finds the messages of a family in what a file holds.
pub trait CaptureDecoder: Sized {
    /// A field of a message.
    type Field: Field;
    /// Takes what passed, of whatever family.
    fn take(&mut self, message: &Message<'_>);
    /// Takes note of the end of the file.
    fn finish(&mut self);
    /// What has been decoded so far.
    fn decoded(&mut self) -> &mut DecodedCapture<Self::Field>;
    /// Begins anew with the same file.
    #[must_use]
    fn restart(self) -> Self;
}

/// What was decoded of a file.
#[derive(Debug)]
pub struct DecodedCapture<F> {
    /// Messages that nobody has taken yet.
    pub messages: Vec<DecodedMessage<F>>,
    /// Packets that belong to the family.
    pub packets: u64,
    /// What else there is to say.
    pub notes: Vec<String>,
}

impl<F> Default for DecodedCapture<F> {
    fn default() -> Self {
        Self { messages: Vec::new(), packets: 0, notes: Vec::new() }
    }
}

/// Says what else there is to say, as far as anybody reads it.
pub fn note(notes: &mut Vec<String>, text: String) {
    const MOST: usize = 1000;

    match notes.len() {
        MOST => notes.push("more of the same kind is not told".to_owned()),
        len if len < MOST => notes.push(text),
        _ => {}
    }
}

/// A message of a family.
#[derive(Debug)]
pub struct DecodedMessage<F> {
    /// Of its packet.
    pub number: u64,
    /// Since 1970.
    pub time: Duration,
    /// Which way.
    pub direction: Direction,
    /// Client and controller, as the table of links has them.
    pub link: (String, String),
    /// As a trace tells it.
    pub text: String,
    /// Packet with the request that it answers.
    pub answers: Option<u64>,
    /// Section of the manual.
    pub section: Option<String>,
    /// As it travels.
    pub raw: String,
    /// In all its parts.
    pub fields: Vec<F>,
    /// What is wrong with it.
    pub problem: Option<String>,
}

/// Messages that are kept until the end of the file: those that are wanted, as far as there is room.
#[derive(Debug)]
struct MessageBuffer<F> {
    list: Vec<DecodedMessage<F>>,
    /// Those of one packet only.
    frame: Option<u64>,
    /// A line of each is enough: fields, bytes and section are left out.
    without_fields: bool,
    weight: usize,
    room: usize,
    /// There were more than there is room for.
    is_full: bool,
}

/// Room for messages in bytes where they are written one after the other otherwise.
const FEW: usize = 16 << 20;
/// The same where all of them are one value: for a filter.
const ROOM: usize = 256 << 20;

impl<F> MessageBuffer<F> {
    fn new(room: usize, frame: Option<u64>, without_fields: bool) -> Self {
        Self {
            list: Vec::new(),
            frame,
            without_fields: without_fields && frame.is_none(),
            weight: 0,
            room,
            is_full: false,
        }
    }

    /// Keeps a message, if it is wanted. Says whether there is room for more.
    fn push(&mut self, mut message: DecodedMessage<F>) -> bool {
        if !self.is_full && self.frame.is_none_or(|frame| frame == message.number) {
            if self.without_fields {
                (message.fields, message.raw, message.section) = (Vec::new(), String::new(), None);
            }
            self.weight = self.weight.saturating_add(message.weight());
            self.is_full = self.weight > self.room;
            if !self.is_full {
                self.list.push(message);
            }
        }
        !self.is_full
    }
}

impl<F> DecodedMessage<F> {
    /// Bytes of memory that it takes, as good as.
    fn weight(&self) -> usize {
        /// Names and meanings of a field, with what it takes to keep them.
        const FIELD: usize = 100;

        let texts = [self.text.len(), self.raw.len(), self.link.0.len(), self.link.1.len()].iter().sum::<usize>();
        size_of::<Self>() + texts + self.fields.len() * (size_of::<F>() + FIELD)
    }
}

/// Decodes a file and prints what it holds.
pub fn print<D: CaptureDecoder>(
    run: &Run,
    id: &str,
    input: &Input<'_>,
    selection: &Selection,
    decoder: D,
) -> Result<(), RunError> {
    let name = input.name();
    let source = Source { name: &name, open: || input.open(), selection };
    let (is_streamed, without_fields) = (run.filter.is_none() && run.line.is_none(), run.is_for_people());
    let room = if is_streamed { FEW } else { ROOM };
    let (capture, decoder) = {
        let _busy = busy();
        source.capture(decoder, room, without_fields)?
    };
    if run.screen.format == Format::Value {
        return Err(Failure::usage("a capture is no list of values").hint("-o csv has a row a message").into());
    }
    // Rows of CSV are written as they come, but for the fields of one packet.
    let is_whole = run.screen.format != Format::Csv || selection.frame.is_some();
    let Some(capture) = capture.filter(|_| is_whole) else { return stream::print(run, id, &source, decoder) };
    // Never as a value in between, which takes many times the memory.
    if is_streamed && !run.is_for_people() {
        let failure = capture.failure();
        let whole = ReportEnvelope::new(run, id, &capture, failure.as_ref());
        run.screen.json(&whole)?;
        return failure.map_or(Ok(()), |failure| Err(RunError { failure, envelope: None, told: true }));
    }
    run.local(id, &capture)
}

/// An envelope around a report as it is.
#[derive(Serialize)]
struct ReportEnvelope<'a, D> {
    #[serde(skip_serializing_if = "Option::is_none")]
    time: Option<Timestamp>,
    robot: Option<()>,
    command: &'a str,
    ok: bool,
    data: D,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<ErrorBody>,
}

impl<'a, D> ReportEnvelope<'a, D> {
    fn new(run: &Run, command: &'a str, data: D, failure: Option<&Failure>) -> Self {
        let time = (run.screen.format == Format::Jsonl).then(Timestamp::now);
        let error = failure.cloned().map(ErrorBody::from);
        Self { time, robot: None, command, ok: error.is_none(), data, error }
    }
}

/// A file, to be read as often as it takes.
struct Source<'a, O> {
    name: &'a str,
    open: O,
    selection: &'a Selection,
}

impl<R: Read, O: Fn() -> io::Result<R>> Source<'_, O> {
    /// What the file holds, unless there is no room for that; then it has to be written as it is read. With the
    /// decoder, ready to begin anew.
    fn capture<D: CaptureDecoder>(
        &self,
        mut decoder: D,
        room: usize,
        without_fields: bool,
    ) -> Result<Captured<D>, Failure> {
        let frame = self.selection.frame;
        let mut kept = MessageBuffer::new(room, frame, without_fields);
        // Of one packet, the links still are those of the whole file.
        let mut links = Links::default();
        let summary = self.decode(&mut decoder, |message| {
            if frame.is_some() {
                links.count(&message.link);
            }
            kept.push(message) || room >= ROOM
        })?;
        links.are_counted = frame.is_some();
        if kept.is_full && room < ROOM {
            return Ok((None, decoder.restart()));
        }
        let DecodedCapture { packets, notes, .. } = std::mem::take(decoder.decoded());
        // Of one packet, they stay in their order.
        kept.list.sort_by_key(|message| message.number);
        let messages: Vec<_> = kept.list.into_iter().map(|message| links.row(message, summary.first)).collect();
        if let Some(frame) = frame.filter(|_| messages.is_empty()) {
            let message = format!("there is no message of this family in packet {frame} of {}", self.name);
            return Err(Failure::usage(message).hint("the numbers are in the list, without --frame"));
        }
        let mut problems = Problems::default();
        for row in &messages {
            problems.add(row);
        }
        let mut capture = Capture { messages, problems, links: links.list, ..self.about(&summary, packets, notes) };
        if kept.is_full {
            capture.damage = Some(FULL.to_owned());
        }
        Ok((Some(capture), decoder.restart()))
    }

    /// A report without messages.
    fn about<F>(&self, summary: &Summary, packets: u64, mut notes: Vec<String>) -> Capture<F> {
        if summary.fragments > 0 {
            notes.push(format!("{} left out", counted(summary.fragments, "IP fragment")));
        }
        if summary.repeated > 0 {
            notes.push(format!("{} left out", counted(summary.repeated, "repeated TCP segment")));
        }
        Capture {
            file: self.name.to_owned(),
            packets: summary.packets,
            other_packets: summary.packets.saturating_sub(packets),
            links: Vec::new(),
            messages: Vec::new(),
            notes,
            damage: summary.damage.as_ref().map(ToString::to_string),
            problems: Problems::default(),
            is_detailed: self.selection.frame.is_some(),
            is_filtered: self.selection.host.is_some() || self.selection.port.is_some(),
        }
    }

    /// Decodes the whole file, and hands on its messages until nobody wants more.
    fn decode<D: CaptureDecoder>(
        &self,
        decoder: &mut D,
        mut each: impl FnMut(DecodedMessage<D::Field>) -> bool,
    ) -> Result<Summary, Failure> {
        let mut hand_on = |decoder: &mut D| decoder.decoded().messages.drain(..).all(&mut each);
        let mut is_wanted = true;
        let summary = self.read(|message| {
            if is_wanted && self.selection.admits(&message.carrier) {
                decoder.take(message);
                is_wanted = hand_on(decoder);
            }
        })?;
        decoder.finish();
        if is_wanted {
            hand_on(decoder);
        }
        Ok(summary)
    }

    fn read(&self, each: impl FnMut(&Message<'_>)) -> Result<Summary, Failure> {
        let file = (self.open)().with_context(|| self.name.to_owned())?;
        read(file, each).map_err(|error| {
            let hint = match error {
                OpenError::Compressed => "unpack it first: gunzip, or unzstd",
                OpenError::Unreadable => "check the disk that it is on",
                OpenError::Other => "tcpdump, Wireshark and --trace write such files",
            };
            Failure::local(format!("{}: {error}", self.name)).hint(hint)
        })
    }
}

/// Problem of a message that was not recorded whole.
pub fn cut() -> String {
    "the capture has only a part of it; record whole packets, as `tcpdump -s 0` does".to_owned()
}
