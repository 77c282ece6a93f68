//! `armctl decode FAMILY FILE.pcapng`: messages of a family in a capture file. `report` is the printed report,
//! `stream` prints long reports.

mod report;
mod stream;
#[cfg(any(test, feature = "testing"))]
pub mod testing;

use std::io::{self, Read};
use std::net::{IpAddr, SocketAddr};
use std::panic::resume_unwind;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread;

use jiff::Timestamp;

pub use self::report::Capture;
use self::report::{Links, Problems, TOO_MANY_MESSAGES, count_text};
use super::Field;
use crate::output::Format;
use crate::output::busy_work::register;
use crate::output::envelope::ErrorBody;
use crate::prelude::basics::*;
use crate::run::{Run, RunError};
use armctl_transport::capture::{Carrier, Message, OpenError, Summary, read_while};
pub use armctl_transport::capture::{holds_telegram, parse_hex};
use armctl_transport::tap::Direction;

/// Selection of messages in a capture file.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Capture files")]
pub struct Selection {
    /// Show the messages of one packet with all fields
    #[arg(long, value_name = "NUMBER")]
    pub frame: Option<u64>,
    /// Only messages from or to this address
    #[arg(long, value_name = "ADDRESS")]
    pub host: Option<IpAddr>,
    /// Only messages from or to this port
    #[arg(long, value_name = "PORT")]
    pub port: Option<u16>,
}

impl Selection {
    /// Whether anything is filtered.
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

/// Capture file, if it is the only argument.
pub fn file_among(arguments: &[String]) -> Option<&Path> {
    let [argument] = arguments else { return None };
    let path = Path::new(argument);
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    matches!(extension.as_str(), "pcap" | "pcapng" | "cap").then_some(path)
}

/// Source of a capture.
#[derive(Debug)]
pub enum Input<'a> {
    /// A file.
    File(&'a Path),
    /// Bytes, with their name.
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

/// Report, unless it is long, and the decoder, ready to restart.
type Captured<D> = (Option<Capture<<D as CaptureDecoder>::Field>>, D);

/// Decoder for the messages of a family.
pub trait CaptureDecoder: Sized + Send {
    /// A field of a message.
    type Field: Field + Send;
    /// Handles a message of any family.
    fn take(&mut self, message: &Message<'_>);
    /// Handles the end of the file.
    fn finish(&mut self);
    /// Messages decoded so far.
    fn decoded(&mut self) -> &mut DecodedCapture<Self::Field>;
    /// Restarts on the same file.
    #[must_use]
    fn restart(self) -> Self;
}

/// Parts of a message that the output shows. Each level includes the levels before it. A decoder can leave out the
/// other parts, because they cost most of its time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Detail {
    /// Packet, link, text and problem.
    Text,
    /// Also the section and the raw data.
    Raw,
    /// Also the fields.
    #[default]
    Fields,
}

/// Decoded content of a file.
#[derive(Debug)]
pub struct DecodedCapture<F> {
    /// Parts of the messages to decode.
    pub detail: Detail,
    /// Messages that were not taken yet.
    pub messages: Vec<DecodedMessage<F>>,
    /// Number of packets of the family.
    pub packets: u64,
    /// Notes.
    pub notes: Vec<String>,
}

impl<F> Default for DecodedCapture<F> {
    fn default() -> Self {
        Self { detail: Detail::default(), messages: Vec::new(), packets: 0, notes: Vec::new() }
    }
}

/// Adds a note, up to a reasonable number.
pub fn note(notes: &mut Vec<String>, text: String) {
    const MAX_NOTES: usize = 1000;

    match notes.len() {
        MAX_NOTES => notes.push("further notes are omitted".to_owned()),
        len if len < MAX_NOTES => notes.push(text),
        _ => {}
    }
}

/// A message of a family.
#[derive(Debug)]
pub struct DecodedMessage<F> {
    /// Packet number.
    pub number: u64,
    /// Time since 1970.
    pub time: Duration,
    /// Direction.
    pub direction: Direction,
    /// Client and controller, as in the table of links.
    pub link: Arc<(String, String)>,
    /// Text, as in a trace.
    pub text: String,
    /// Packet of the request that this message answers.
    pub answers: Option<u64>,
    /// Section of the manual.
    pub section: Option<String>,
    /// Raw data.
    pub raw: String,
    /// Fields.
    pub fields: Vec<F>,
    /// Problem found in the message.
    pub problem: Option<String>,
}

/// Buffer of the selected messages, with limited size.
#[derive(Debug)]
struct MessageBuffer<F> {
    list: Vec<DecodedMessage<F>>,
    /// Only the messages of this packet.
    frame: Option<u64>,
    detail: Detail,
    weight: usize,
    room: usize,
    /// Whether there were too many messages.
    is_full: bool,
}

/// Memory of the messages above which a report is printed while the file is read. It is small, so that printing begins
/// early.
const STREAM_ABOVE: usize = 1 << 20;
/// Memory limit if all messages are needed as one value, for a filter.
const MEMORY_LIMIT: usize = 256 << 20;

impl<F> MessageBuffer<F> {
    fn new(room: usize, frame: Option<u64>, detail: Detail) -> Self {
        Self { list: Vec::new(), frame, detail, weight: 0, room, is_full: false }
    }

    /// Stores a message, if it is selected. Returns the message if there is no space for it.
    fn push(&mut self, mut message: DecodedMessage<F>) -> Option<DecodedMessage<F>> {
        if !self.is_full && self.frame.is_none_or(|frame| frame == message.number) {
            if self.detail <= Detail::Text {
                (message.fields, message.raw, message.section) = (Vec::new(), String::new(), None);
            }
            self.weight = self.weight.saturating_add(message.weight());
            self.is_full = self.weight > self.room;
            if !self.is_full {
                self.list.push(message);
                return None;
            }
        }
        self.is_full.then_some(message)
    }
}

impl<F> DecodedMessage<F> {
    /// Approximate memory size.
    fn weight(&self) -> usize {
        /// Approximate memory of a field: names and meanings.
        const FIELD: usize = 100;

        let texts = [self.text.len(), self.raw.len(), self.link.0.len(), self.link.1.len()].iter().sum::<usize>();
        size_of::<Self>() + texts + self.fields.len() * (size_of::<F>() + FIELD)
    }
}

/// Decodes a file and prints the result.
pub fn print<D: CaptureDecoder>(
    run: &Run,
    id: &str,
    input: &Input<'_>,
    selection: &Selection,
    decoder: D,
) -> Result<(), RunError> {
    let name = input.name();
    let source = Source { name: &name, open: || input.open(), selection };
    // CSV rows are written immediately, except for the fields of one packet.
    if run.screen.format == Format::Csv && selection.frame.is_none() {
        return stream::csv(run, &source, decoder);
    }
    let is_streamed = run.filter.is_none() && run.line.is_none();
    if is_streamed && run.screen.format == Format::Table && selection.frame.is_none() {
        return stream::table(run, id, &source, decoder);
    }
    let room = if is_streamed { STREAM_ABOVE } else { MEMORY_LIMIT };
    let detail = if run.is_for_people() && selection.frame.is_none() { Detail::Text } else { Detail::Fields };
    let (capture, decoder) = {
        let _busy = register();
        source.capture(decoder, room, detail)?
    };
    if run.screen.format == Format::Value {
        return Err(Failure::usage("a capture has no list of values")
            .hint("use -o csv for one row per message")
            .into());
    }
    let Some(capture) = capture else { return stream::json(run, id, &source, decoder) };
    // The report is never an intermediate JSON value, because a JSON value needs many times the memory.
    if is_streamed && !run.is_for_people() {
        let failure = capture.failure();
        let whole = ReportEnvelope::new(run, id, &capture, failure.as_ref());
        run.screen.json(&whole)?;
        return failure.map_or(Ok(()), |failure| Err(RunError { failure, envelope: None, is_reported: true }));
    }
    run.local(id, &capture)
}

/// Envelope around a report.
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

/// A file that can be read several times.
struct Source<'a, O> {
    name: &'a str,
    open: O,
    selection: &'a Selection,
}

impl<R: Read, O: Fn() -> io::Result<R> + Sync> Source<'_, O> {
    /// Content of the file, unless it is long and must be streamed; also the decoder, ready to restart.
    fn capture<D: CaptureDecoder>(&self, mut decoder: D, room: usize, detail: Detail) -> Result<Captured<D>> {
        let frame = self.selection.frame;
        let mut kept = MessageBuffer::new(room, frame, detail);
        // For one packet, the links are still those of the whole file.
        let mut links = Links::default();
        let summary = self.decode(&mut decoder, detail, |message| {
            if frame.is_some() {
                links.count(&message.link);
            }
            kept.push(message).is_none() || room >= MEMORY_LIMIT
        })?;
        links.are_counted = frame.is_some();
        if kept.is_full && room < MEMORY_LIMIT {
            return Ok((None, decoder.restart()));
        }
        let content = std::mem::take(decoder.decoded());
        Ok((Some(self.content(kept, links, &summary, content)?), decoder.restart()))
    }

    /// Content of a file whose messages are in memory.
    fn content<F>(
        &self,
        mut kept: MessageBuffer<F>,
        mut links: Links,
        summary: &Summary,
        DecodedCapture { packets, notes, .. }: DecodedCapture<F>,
    ) -> Result<Capture<F>> {
        // Messages of one packet stay in their order.
        kept.list.sort_by_key(|message| message.number);
        let messages: Vec<_> = kept.list.into_iter().map(|message| links.row(message, summary.first)).collect();
        if let Some(frame) = self.selection.frame.filter(|_| messages.is_empty()) {
            let message = format!("no message of this family in packet {frame} of {}", self.name);
            return Err(Failure::usage(message).hint("list the packet numbers without --frame"));
        }
        let mut problems = Problems::default();
        for row in &messages {
            problems.add(row.number(), row.problem());
        }
        let mut capture = Capture { messages, problems, links: links.list, ..self.about(summary, packets, notes) };
        if kept.is_full {
            capture.damage = Some(TOO_MANY_MESSAGES.to_owned());
        }
        Ok(capture)
    }

    /// Report without messages.
    fn about<F>(&self, summary: &Summary, packets: u64, mut notes: Vec<String>) -> Capture<F> {
        if summary.fragments > 0 {
            notes.push(format!("{} left out", count_text(summary.fragments, "IP fragment")));
        }
        if summary.repeated > 0 {
            notes.push(format!("{} left out", count_text(summary.repeated, "repeated TCP segment")));
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

    /// Decodes the file to this detail, and passes on its messages until the callback ends. A thread decodes while the
    /// callback works, because each of them takes about half of the time.
    fn decode<D: CaptureDecoder>(
        &self,
        decoder: &mut D,
        detail: Detail,
        mut each: impl FnMut(DecodedMessage<D::Field>) -> bool,
    ) -> Result<Summary> {
        decoder.decoded().detail = detail;
        thread::scope(|scope| {
            let (sender, batches) = sync_channel(BATCHES);
            let decoding = scope.spawn(move || {
                let mut batch = Batch { sender, messages: Vec::new(), weight: 0 };
                let summary = self.read(|message| {
                    if !self.selection.admits(&message.carrier) {
                        return true;
                    }
                    decoder.take(message);
                    batch.take(&mut decoder.decoded().messages)
                })?;
                decoder.finish();
                batch.take(&mut decoder.decoded().messages);
                batch.send();
                Ok(summary)
            });
            // Without a receiver, the thread ends.
            let _ = batches.into_iter().flatten().all(&mut each);
            decoding.join().unwrap_or_else(|panic| resume_unwind(panic))
        })
    }

    /// Time of the first packet, if the file has messages.
    fn first_time(&self) -> Result<Duration> {
        Ok(self.read(|_| false)?.first)
    }

    /// Reads the file as long as the callback wants more.
    fn read(&self, mut each: impl FnMut(&Message<'_>) -> bool) -> Result<Summary> {
        let mut file = (self.open)().with_context(|| self.name.to_owned())?;
        read_while(&mut file, &mut each).map_err(|error| {
            let hint = match error {
                OpenError::Compressed => "decompress the file first with gunzip or unzstd",
                OpenError::Unreadable => "check the disk of the file",
                OpenError::Other => "use a file from tcpdump, Wireshark or --trace",
            };
            Failure::local(format!("{}: {error}", self.name)).hint(hint)
        })
    }
}

/// Number of batches that wait for their receiver.
const BATCHES: usize = 4;
/// Memory of the messages in a batch.
const BATCH_LIMIT: usize = 256 << 10;

/// Messages on their way to another thread.
struct Batch<F> {
    sender: SyncSender<Vec<DecodedMessage<F>>>,
    messages: Vec<DecodedMessage<F>>,
    weight: usize,
}

impl<F> Batch<F> {
    /// Adds messages, and sends full batches. Returns whether anyone receives them.
    fn take(&mut self, messages: &mut Vec<DecodedMessage<F>>) -> bool {
        messages.drain(..).all(|message| {
            self.weight += message.weight();
            self.messages.push(message);
            self.weight < BATCH_LIMIT || self.send()
        })
    }

    /// Sends all messages. Returns whether anyone receives them.
    fn send(&mut self) -> bool {
        self.weight = 0;
        self.sender.send(std::mem::take(&mut self.messages)).is_ok()
    }
}

/// Problem of a message that was not recorded completely.
pub fn cut() -> String {
    "the capture has only part of the message; record whole packets, for example with `tcpdump -s 0`".to_owned()
}
