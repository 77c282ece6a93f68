//! `armctl decode FAMILY FILE.pcapng`: what a capture file holds of a family, in the words of a trace.

mod stream;

use std::collections::HashMap;
use std::io::{self, Read};
use std::net::{IpAddr, SocketAddr};
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use jiff::Timestamp;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::Report;
use crate::command::run::{Run, Stopped};
use crate::failure::{Failure, Kind};
use crate::files;
use crate::output::Format;
use crate::output::busy::busy;
use crate::output::envelope::ErrorBody;
use crate::output::view::{Cell, Section, Table, Tone, View};
use crate::transport::capture::{Carrier, Message, Summary, Unknown, read};
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

/// The file that the only argument of a command names, if it is one.
pub fn named(arguments: &[String]) -> Option<PathBuf> {
    let [argument] = arguments else { return None };
    let path = Path::new(argument);
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    matches!(extension.as_str(), "pcap" | "pcapng" | "cap").then(|| path.to_owned())
}

/// A mistake where flags for capture files come without one.
pub fn without_file() -> Failure {
    let failure = Failure::usage("--frame and the other flags for capture files need one");
    failure.hint("give a file whose name ends in .pcap, .pcapng or .cap")
}

/// A report, unless there is no room for one, and the listener, ready to hear the file again.
type Captured<L> = (Option<Capture<<L as Listener>::Field>>, L);

/// Makes messages of a family out of what a file holds.
pub trait Listener: Sized {
    /// A field of a message.
    type Field: Field;
    /// Takes what was said, of whatever family.
    fn hear(&mut self, message: &Message<'_>);
    /// Takes note of the end of the file.
    fn end(&mut self);
    /// What has been made of it so far.
    fn told(&mut self) -> &mut Told<Self::Field>;
    /// Begins anew with the same file.
    #[must_use]
    fn again(self) -> Self;
}

/// What a listener made of a file.
#[derive(Debug)]
pub struct Told<F> {
    /// Messages that nobody has taken yet.
    pub messages: Vec<Heard<F>>,
    /// Packets that belong to the family.
    pub packets: u64,
    /// What else there is to say.
    pub notes: Vec<String>,
}

impl<F> Default for Told<F> {
    fn default() -> Self {
        Self { messages: Vec::new(), packets: 0, notes: Vec::new() }
    }
}

/// Messages that are kept until the end of the file: those that are wanted, as far as there is room.
#[derive(Debug)]
struct Kept<F> {
    list: Vec<Heard<F>>,
    /// Those of one packet only.
    frame: Option<u64>,
    /// In a line each, without their parts.
    in_short: bool,
    weight: usize,
    room: usize,
    /// There were more than there is room for.
    is_full: bool,
}

/// Room for messages in bytes where they are written one after the other otherwise.
const FEW: usize = 16 << 20;
/// The same where all of them are one value: for a filter.
const ROOM: usize = 256 << 20;

impl<F> Kept<F> {
    fn new(room: usize, frame: Option<u64>, in_short: bool) -> Self {
        Self { list: Vec::new(), frame, in_short: in_short && frame.is_none(), weight: 0, room, is_full: false }
    }

    /// Keeps a message, if it is wanted. Says whether there is room for more.
    fn push(&mut self, mut heard: Heard<F>) -> bool {
        if !self.is_full && self.frame.is_none_or(|frame| frame == heard.number) {
            if self.in_short {
                (heard.fields, heard.raw, heard.section) = (Vec::new(), String::new(), None);
            }
            self.weight = self.weight.saturating_add(heard.weight());
            self.is_full = self.weight > self.room;
            if !self.is_full {
                self.list.push(heard);
            }
        }
        !self.is_full
    }
}

impl<F> Heard<F> {
    /// Bytes of memory that it takes, as good as.
    fn weight(&self) -> usize {
        /// Names and meanings of a field, with what it takes to keep them.
        const FIELD: usize = 100;

        let texts = [self.text.len(), self.raw.len(), self.link.0.len(), self.link.1.len()].iter().sum::<usize>();
        size_of::<Self>() + texts + self.fields.len() * (size_of::<F>() + FIELD)
    }
}

/// A message of a family.
#[derive(Debug)]
pub struct Heard<F> {
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

/// A field that can stand in a table.
pub trait Field: Serialize + JsonSchema + Sized {
    /// Fields as a table.
    fn table(fields: &[Self]) -> Table;
}

/// Reads a file and reports it.
pub fn tell<L: Listener>(run: &Run, id: &str, path: &Path, selection: &Selection, listener: L) -> Result<(), Stopped> {
    let name = path.display().to_string();
    let source = Source { name: &name, open: || files::open(path), selection };
    let (is_streamed, in_short) = (run.filter.is_none() && run.line.is_none(), run.is_for_people());
    let room = if is_streamed { FEW } else { ROOM };
    let (kept, listener) = {
        let _busy = busy();
        source.capture(listener, room, in_short)?
    };
    let Some(capture) = kept else { return stream::tell(run, id, &source, listener) };
    // Never as a value in between, which takes many times the memory.
    if is_streamed && !run.is_for_people() {
        let failure = capture.failure();
        let whole = Whole::new(run, id, &capture, failure.as_ref());
        run.screen.json(&whole)?;
        return failure.map_or(Ok(()), |failure| Err(Stopped { failure, envelope: None, told: true }));
    }
    run.local(id, &capture)
}

/// An envelope around a report as it is.
#[derive(Serialize)]
struct Whole<'a, D> {
    #[serde(skip_serializing_if = "Option::is_none")]
    time: Option<Timestamp>,
    robot: Option<()>,
    command: &'a str,
    ok: bool,
    data: D,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<ErrorBody>,
}

impl<'a, D> Whole<'a, D> {
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
    /// listener, ready to hear the file again.
    fn capture<L: Listener>(&self, mut listener: L, room: usize, in_short: bool) -> Result<Captured<L>, Failure> {
        let frame = self.selection.frame;
        let mut kept = Kept::new(room, frame, in_short);
        // Of one packet, the links still are those of the whole file.
        let mut links = Links::default();
        let summary = self.pass(&mut listener, |heard| {
            if frame.is_some() {
                links.count(&heard.link);
            }
            kept.push(heard) || room >= ROOM
        })?;
        links.are_counted = frame.is_some();
        if kept.is_full && room < ROOM {
            return Ok((None, listener.again()));
        }
        let Told { packets, notes, .. } = std::mem::take(listener.told());
        // Of one packet, they stay in their order.
        kept.list.sort_by_key(|heard| heard.number);
        let messages: Vec<_> = kept.list.into_iter().map(|heard| links.row(heard, summary.first)).collect();
        if let Some(frame) = frame.filter(|_| messages.is_empty()) {
            let message = format!("there is no message of this family in packet {frame} of {}", self.name);
            return Err(Failure::usage(message).hint("the numbers are in the list, without --frame"));
        }
        let mut problems = Problems::default();
        for row in &messages {
            problems.add(row);
        }
        let mut capture = Capture { messages, problems, ..self.about(&summary, packets, notes) };
        capture.links = links.list;
        if kept.is_full {
            capture.damage = Some(FULL.to_owned());
        }
        Ok((Some(capture), listener.again()))
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

    /// Has a listener hear the whole file, and hands on what it makes of it until nobody wants more.
    fn pass<L: Listener>(
        &self,
        listener: &mut L,
        mut each: impl FnMut(Heard<L::Field>) -> bool,
    ) -> Result<Summary, Failure> {
        let mut goes_on = true;
        let mut hand_on = |listener: &mut L| {
            for heard in listener.told().messages.drain(..) {
                goes_on = goes_on && each(heard);
            }
            goes_on
        };
        let mut is_wanted = true;
        let mut hear = |message: &Message<'_>| {
            if is_wanted {
                listener.hear(message);
                is_wanted = hand_on(listener);
            }
        };
        let summary = self.read(|message| {
            if self.selection.admits(&message.carrier) {
                hear(message);
            }
        })?;
        listener.end();
        hand_on(listener);
        Ok(summary)
    }

    fn read(&self, hear: impl FnMut(&Message<'_>)) -> Result<Summary, Failure> {
        let file = (self.open)().map_err(|error| Failure::io(self.name, &error))?;
        read(file, hear).map_err(|error| {
            let hint = match error {
                Unknown::Compressed => "unpack it first: gunzip, or unzstd",
                Unknown::Unreadable => "check the disk that it is on",
                Unknown::Other => "tcpdump, Wireshark and --trace write such files",
            };
            Failure::local(format!("{}: {error}", self.name)).hint(hint)
        })
    }
}

/// The links of a file, in the order in which they are met.
#[derive(Debug, Default)]
struct Links {
    list: Vec<Link>,
    numbers: HashMap<(String, String), usize>,
    /// Rows are of messages that were counted before.
    are_counted: bool,
}

impl Links {
    /// Where a link is in the list.
    fn at(&mut self, link: &(String, String)) -> usize {
        if let Some(at) = self.numbers.get(link) {
            return *at;
        }
        let at = self.list.len();
        let (client, controller) = link.clone();
        self.list.push(Link { link: at + 1, client, controller, messages: 0 });
        self.numbers.insert(link.clone(), at);
        at
    }

    fn count(&mut self, link: &(String, String)) {
        let at = self.at(link);
        self.list[at].messages += 1;
    }

    /// A message with the link it belongs to.
    fn row<F>(&mut self, heard: Heard<F>, first: Duration) -> Row<F> {
        if !self.are_counted {
            self.count(&heard.link);
        }
        let at = self.at(&heard.link);
        let link = &self.list[at];
        let (from, to, sender) = match heard.direction {
            Direction::Sent => (&link.client, &link.controller, "client"),
            Direction::Received => (&link.controller, &link.client, "controller"),
        };
        Row {
            number: heard.number,
            time_s: seconds(heard.time, first),
            link: link.link,
            sender,
            from: from.clone(),
            to: to.clone(),
            text: heard.text,
            answers: heard.answers,
            section: heard.section,
            raw: heard.raw,
            fields: heard.fields,
            problem: heard.problem,
        }
    }
}

/// What is wrong with messages.
#[derive(Debug, Default)]
struct Problems {
    all: u64,
    damaged: u64,
    /// Packet and problem.
    first: Option<(u64, String)>,
}

impl Problems {
    fn add<F>(&mut self, row: &Row<F>) {
        self.all += 1;
        if let Some(problem) = &row.problem {
            self.damaged += 1;
            self.first.get_or_insert_with(|| (row.number, problem.clone()));
        }
    }
}

/// Packets of several interfaces may come in another order than their times.
fn seconds(time: Duration, first: Duration) -> f64 {
    match time.checked_sub(first) {
        Some(after) => after.as_secs_f64(),
        None => -(first.saturating_sub(time).as_secs_f64()),
    }
}

/// What a capture file holds of a family.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Capture<F> {
    file: String,
    /// All that are in the file.
    packets: u64,
    /// Those with nothing of the family, or left out by --host and --port.
    other_packets: u64,
    links: Vec<Link>,
    messages: Vec<Row<F>>,
    /// What is missing.
    notes: Vec<String>,
    /// Where the file is damaged; all before it was read.
    damage: Option<String>,
    #[serde(skip)]
    problems: Problems,
    /// Every field is shown.
    #[serde(skip)]
    is_detailed: bool,
    /// By host or port.
    #[serde(skip)]
    is_filtered: bool,
}

/// Two ends that talk to each other.
#[derive(Debug, Serialize, JsonSchema)]
struct Link {
    link: usize,
    client: String,
    controller: String,
    messages: u64,
}

/// A message.
#[derive(Debug, Serialize, JsonSchema)]
struct Row<F> {
    /// Of the packet where it ends, as Wireshark counts them.
    number: u64,
    /// Since the first packet of the file.
    time_s: f64,
    link: usize,
    /// `client` or `controller`.
    sender: &'static str,
    from: String,
    to: String,
    /// What it is, as --trace tells it.
    text: String,
    /// Packet with the request that it answers.
    answers: Option<u64>,
    /// Section of the manual, where the command is known.
    section: Option<String>,
    /// As it travels: bytes in hexadecimal, a line, or words.
    raw: String,
    fields: Vec<F>,
    /// What is wrong with it.
    problem: Option<String>,
}

impl<F> Row<F> {
    fn arrow(&self) -> &'static str {
        if self.sender == "client" { "->" } else { "<-" }
    }
}

impl<F> Row<F> {
    /// The columns of its table.
    const COLUMNS: [&'static str; 6] = ["number", "time s", "link", "way", "answers", "message"];

    /// What stands in them, in the words of a trace.
    fn cells(&self) -> [Cell; 6] {
        // Where there is no telling what it is, the text says why already.
        let text = match &self.problem {
            Some(problem) if !self.text.contains("no valid") => format!("{}; problem: {problem}", self.text),
            _ => self.text.clone(),
        };
        let tone = if self.problem.is_some() { Tone::Bad } else { Tone::Plain };
        [
            Cell::number(self.number.to_string()),
            Cell::number(format!("{:.6}", self.time_s)),
            self.link.into(),
            self.arrow().into(),
            self.answers.map_or_else(Cell::default, |packet| Cell::number(packet.to_string())),
            Cell::from(text).tone(tone),
        ]
    }
}

impl<F: Field> Capture<F> {
    /// Rows of a table, in the words of a trace.
    fn list(&self) -> View {
        let mut table = Table::new(&Row::<F>::COLUMNS, "no message of this family");
        self.messages.iter().for_each(|row| table.row(row.cells()));
        let mut sections = vec![Section::Text(self.head()), Section::Table(table)];
        if !self.notes.is_empty() {
            sections.push(Section::Text(self.notes.join("\n")));
        }
        View { sections }
    }

    /// How much there is, and between whom.
    fn head(&self) -> String {
        let told = self.packets.saturating_sub(self.other_packets);
        let what = if self.is_filtered { "selected and of this family" } else { "of this family" };
        let mut head = format!("{}, {told} of them {what}", counted(self.packets, "packet"));
        for Link { link, client, controller, messages } in &self.links {
            head.push_str(&format!("\nlink {link}: {client} -> {controller}, {}", counted(*messages, "message")));
        }
        head
    }

    /// Every field of some messages.
    fn details(&self) -> View {
        let mut sections = Vec::new();
        for row in &self.messages {
            let Row { number, time_s, from, to, text, .. } = row;
            let section = row.section.as_ref().map(|section| format!(" ({section})")).unwrap_or_default();
            let answers = row.answers.map(|packet| format!("\nanswers packet {packet}")).unwrap_or_default();
            let problem = row.problem.as_ref().map(|problem| format!("\nproblem: {problem}")).unwrap_or_default();
            let head = format!("packet {number} at {time_s:.6} s, {from} -> {to}");
            sections.push(Section::Text(format!("{head}\n{text}{section}{answers}{problem}")));
            sections.push(Section::Table(F::table(&row.fields)));
        }
        View { sections }
    }
}

impl<F: Field> Report for Capture<F> {
    fn view(&self) -> View {
        if self.is_detailed { self.details() } else { self.list() }
    }

    fn failure(&self) -> Option<Failure> {
        if self.damage.as_deref() == Some(FULL) {
            let failure = Failure::local(format!("{}: {FULL}", self.file));
            return Some(failure.hint("choose with --host, --port or --frame, or cut the file, as `editcap -c` does"));
        }
        if let Some(damage) = &self.damage {
            let failure = Failure::local(format!("{}: {damage}", self.file));
            return Some(failure.hint("what came before is told; a capture that was broken off ends like this"));
        }
        let Problems { all, damaged, first } = &self.problems;
        let (number, problem) = first.as_ref()?;
        let message = match all {
            1 => format!("the message in packet {number} is damaged: {problem}"),
            _ => format!("{damaged} of {all} messages are damaged; the first, in packet {number}: {problem}"),
        };
        Some(Failure::new(Kind::Malformed, message).hint("--frame NUMBER explains one as far as it goes"))
    }
}

/// Why not all messages are told.
const FULL: &str = "it has more messages than there is room for; the first ones are told";

/// Says what else there is to say, as far as anybody reads it.
pub fn note(notes: &mut Vec<String>, text: String) {
    const MOST: usize = 1000;

    match notes.len() {
        MOST => notes.push("more of the same kind is not told".to_owned()),
        len if len < MOST => notes.push(text),
        _ => {}
    }
}

fn counted(count: u64, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}

/// Problem of a message that was not recorded whole.
pub fn cut() -> String {
    "the capture has only a part of it; record whole packets, as `tcpdump -s 0` does".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    const VLAN: &[u8] = include_bytes!("../../../../../tests/cli/files/vlan.pcap");
    const LINES: &[u8] = include_bytes!("../../../../../tests/cli/files/lines.pcapng");
    const SPEED: &[u8] = include_bytes!("../../../../../tests/cli/files/speed.pcapng");

    fn whole<L: Listener>(file: &[u8], selection: &Selection, listener: L) -> Result<Capture<L::Field>, Failure> {
        let source = Source { name: "file", open: || Ok(file), selection };
        let (capture, _) = source.capture(listener, ROOM, false)?;
        Ok(capture.expect("there is room"))
    }

    /// Messages and packets without one, for each family.
    fn counts(file: &[u8], selection: &Selection) -> [Option<(usize, u64)>; 3] {
        fn count<F: Field>(capture: Result<Capture<F>, Failure>) -> Option<(usize, u64)> {
            let capture = capture.ok()?;
            // Views must cope with anything, too.
            capture.list();
            capture.details();
            Some((capture.messages.len(), capture.other_packets))
        }
        [
            count(whole(file, selection, crate::command::yerc::decode::capture::Frames::default())),
            count(whole(file, selection, crate::command::toyo::decode::capture::Lines::default())),
            count(whole(file, selection, crate::command::yrcx::decode::capture::Images::new(true))),
        ]
    }

    #[test]
    fn each_family_finds_its_own() {
        let all = Selection::default();
        assert_eq!(counts(VLAN, &all), [Some((3, 2)), Some((0, 5)), Some((0, 5))]);
        assert_eq!(counts(LINES, &all), [Some((0, 11)), Some((6, 3)), Some((0, 11))]);
        assert_eq!(counts(SPEED, &all), [Some((0, 18)), Some((0, 18)), Some((24, 0))]);
    }

    #[test]
    fn hosts_and_ports_leave_out_the_rest() {
        let selection = |host: &str, port| Selection { frame: None, host: host.parse().ok(), port };
        assert_eq!(counts(VLAN, &selection("192.168.255.1", Some(10040)))[0], Some((3, 2)));
        assert_eq!(counts(VLAN, &selection("192.168.255.3", None))[0], Some((0, 5)));
        assert_eq!(counts(VLAN, &selection("", Some(10041)))[0], Some((0, 5)));
    }

    #[test]
    fn files_cut_or_damaged_anywhere_are_told() {
        let all = Selection::default();
        for file in [VLAN, LINES, SPEED] {
            for end in 0..file.len() {
                counts(&file[..end], &all);
                let mut damaged = file.to_vec();
                damaged[end] = !damaged[end];
                counts(&damaged, &all);
            }
        }
    }
}
