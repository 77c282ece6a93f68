//! `armctl decode FAMILY FILE.pcapng`: what a capture file holds of a family, in the words of a trace.

mod cip;
pub mod toyo;
pub mod yerc;
pub mod yrcx;

use std::collections::HashMap;
use std::io::Read;
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
use crate::transport::capture::{Carrier, Message, Unknown, read};
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

/// Makes messages of a family out of what a file holds.
pub trait Listener {
    /// A field of a message.
    type Field: Field;
    /// Takes what was said, of whatever family.
    fn hear(&mut self, message: &Message<'_>);
    /// What has been heard so far.
    fn told(&mut self) -> &mut Told<Self::Field>;
    /// Everything that was heard, and in how many packets.
    fn finish(self) -> Told<Self::Field>;
}

/// What a listener made of a file.
#[derive(Debug)]
pub struct Told<F> {
    /// In any order.
    pub messages: Kept<F>,
    /// Packets that belong to the family.
    pub packets: u64,
    /// What else there is to say.
    pub notes: Vec<String>,
}

impl<F> Default for Told<F> {
    fn default() -> Self {
        Self { messages: Kept::default(), packets: 0, notes: Vec::new() }
    }
}

/// Messages that are kept until the end of the file: those that are wanted, as far as there is room.
#[derive(Debug)]
pub struct Kept<F> {
    list: Vec<Heard<F>>,
    wanted: Wanted,
    weight: usize,
    /// There were more than there is room for.
    is_full: bool,
}

/// What of the messages is needed.
#[derive(Debug, Clone, Copy, Default)]
pub struct Wanted {
    /// Those of one packet.
    frame: Option<u64>,
    /// In a line each, without their parts.
    in_short: bool,
}

/// Room for messages in bytes, whatever the size of the file.
const ROOM: usize = 256 << 20;

impl<F> Default for Kept<F> {
    fn default() -> Self {
        Self { list: Vec::new(), wanted: Wanted::default(), weight: 0, is_full: false }
    }
}

impl<F> Kept<F> {
    /// Keeps a message, if it is wanted.
    pub fn push(&mut self, mut heard: Heard<F>) {
        if self.is_full || self.wanted.frame.is_some_and(|frame| frame != heard.number) {
            return;
        }
        if self.wanted.in_short {
            (heard.fields, heard.raw, heard.section) = (Vec::new(), String::new(), None);
        }
        self.weigh(heard.weight());
        if !self.is_full {
            self.list.push(heard);
        }
    }

    /// Counts what is kept elsewhere to the same end.
    pub fn weigh(&mut self, bytes: usize) {
        self.weight = self.weight.saturating_add(bytes);
        self.is_full = self.is_full || self.weight > ROOM;
    }

    /// Whether there is no room any more.
    pub fn is_full(&self) -> bool {
        self.is_full
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
    let failed = |error: std::io::Error| Failure::io(path.display(), &error);
    let capture = {
        let _busy = busy();
        let file = files::open(path).map_err(failed)?;
        capture(&path.display().to_string(), file, selection, run.is_for_people(), listener)?
    };
    // Never as a value in between, which takes many times the memory.
    if !run.is_for_people() && run.filter.is_none() && run.line.is_none() {
        let failure = capture.failure();
        let time = (run.screen.format == Format::Jsonl).then(Timestamp::now);
        let error = failure.clone().map(ErrorBody::from);
        run.screen.json(&Whole { time, robot: None, command: id, ok: error.is_none(), data: &capture, error })?;
        return failure.map_or(Ok(()), |failure| Err(Stopped { failure, envelope: None, told: true }));
    }
    run.local(id, &capture)
}

/// An envelope around a report as it is.
#[derive(Serialize)]
struct Whole<'a, F> {
    #[serde(skip_serializing_if = "Option::is_none")]
    time: Option<Timestamp>,
    robot: Option<()>,
    command: &'a str,
    ok: bool,
    data: &'a Capture<F>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<ErrorBody>,
}

fn capture<L: Listener>(
    name: &str,
    file: impl Read,
    selection: &Selection,
    in_short: bool,
    mut listener: L,
) -> Result<Capture<L::Field>, Failure> {
    let frame = selection.frame;
    listener.told().messages.wanted = Wanted { frame, in_short: in_short && frame.is_none() };
    let summary = read(file, |message| {
        if selection.admits(&message.carrier) {
            listener.hear(message);
        }
    });
    let summary = summary.map_err(|error| {
        let hint = match error {
            Unknown::Compressed => "unpack it first: gunzip, or unzstd",
            Unknown::Unreadable => "check the disk that it is on",
            Unknown::Other => "tcpdump, Wireshark and --trace write such files",
        };
        Failure::local(format!("{name}: {error}")).hint(hint)
    })?;
    let Told { messages, packets, mut notes } = listener.finish();
    if summary.fragments > 0 {
        notes.push(format!("{} left out", counted(summary.fragments, "IP fragment")));
    }
    if summary.repeated > 0 {
        notes.push(format!("{} left out", counted(summary.repeated, "repeated TCP segment")));
    }
    let damage = match summary.damage {
        _ if messages.is_full => Some(FULL.to_owned()),
        damage => damage.map(|damage| damage.to_string()),
    };
    let (links, messages) = linked(messages.list, summary.first);
    if let Some(frame) = selection.frame.filter(|_| messages.is_empty()) {
        let message = format!("there is no message of this family in packet {frame} of {name}");
        return Err(Failure::usage(message).hint("the numbers are in the list, without --frame"));
    }
    Ok(Capture {
        file: name.to_owned(),
        packets: summary.packets,
        other_packets: summary.packets.saturating_sub(packets),
        links,
        messages,
        notes,
        damage,
        is_detailed: selection.frame.is_some(),
        is_filtered: selection.host.is_some() || selection.port.is_some(),
    })
}

/// Messages in the order of packets, with the links they belong to.
fn linked<F>(mut heard: Vec<Heard<F>>, first: Duration) -> (Vec<Link>, Vec<Row<F>>) {
    // Of one packet, they stay in their order.
    heard.sort_by_key(|heard| heard.number);
    let mut links: Vec<Link> = Vec::new();
    let mut numbers: HashMap<(String, String), usize> = HashMap::new();
    let mut rows = Vec::with_capacity(heard.len());
    for heard in heard {
        let at = *numbers.entry(heard.link).or_insert_with_key(|(client, controller)| {
            let (client, controller) = (client.clone(), controller.clone());
            links.push(Link { link: links.len() + 1, client, controller, messages: 0 });
            links.len() - 1
        });
        let Some(link) = links.get_mut(at) else { continue };
        link.messages += 1;
        let (from, to, sender) = match heard.direction {
            Direction::Sent => (&link.client, &link.controller, "client"),
            Direction::Received => (&link.controller, &link.client, "controller"),
        };
        rows.push(Row {
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
        });
    }
    (links, rows)
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

impl<F: Field> Capture<F> {
    /// Rows of a table, in the words of a trace.
    fn list(&self) -> View {
        let mut table =
            Table::new(&["number", "time s", "link", "way", "answers", "message"], "no message of this family");
        for row in &self.messages {
            // Where there is no telling what it is, the text says why already.
            let text = match &row.problem {
                Some(problem) if !row.text.contains("no valid") => format!("{}; problem: {problem}", row.text),
                _ => row.text.clone(),
            };
            let tone = if row.problem.is_some() { Tone::Bad } else { Tone::Plain };
            table.row([
                Cell::number(row.number.to_string()),
                Cell::number(format!("{:.6}", row.time_s)),
                row.link.into(),
                row.arrow().into(),
                row.answers.map_or_else(Cell::default, |packet| Cell::number(packet.to_string())),
                Cell::from(text).tone(tone),
            ]);
        }
        let told = self.packets.saturating_sub(self.other_packets);
        let what = if self.is_filtered { "selected and of this family" } else { "of this family" };
        let mut head = format!("{}, {told} of them {what}", counted(self.packets, "packet"));
        for Link { link, client, controller, messages } in &self.links {
            head.push_str(&format!("\nlink {link}: {client} -> {controller}, {}", counted(*messages, "message")));
        }
        let mut sections = vec![Section::Text(head), Section::Table(table)];
        if !self.notes.is_empty() {
            sections.push(Section::Text(self.notes.join("\n")));
        }
        View { sections }
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
        let problems = || self.messages.iter().filter_map(|row| Some((row.number, row.problem.as_ref()?)));
        let (number, problem) = problems().next()?;
        let (damaged, all) = (problems().count(), self.messages.len());
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
fn note(notes: &mut Vec<String>, text: String) {
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
fn cut() -> String {
    "the capture has only a part of it; record whole packets, as `tcpdump -s 0` does".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    const VLAN: &[u8] = include_bytes!("../../../../../tests/cli/files/vlan.pcap");
    const LINES: &[u8] = include_bytes!("../../../../../tests/cli/files/lines.pcapng");
    const SPEED: &[u8] = include_bytes!("../../../../../tests/cli/files/speed.pcapng");

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
            count(capture("file", file, selection, false, yerc::Frames::default())),
            count(capture("file", file, selection, false, toyo::Lines::default())),
            count(capture("file", file, selection, false, yrcx::Images::new(true))),
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
