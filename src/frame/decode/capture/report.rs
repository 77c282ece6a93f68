//! Report of the messages of a family in a capture file.

use std::collections::HashMap;
use std::time::Duration;

use super::DecodedMessage;
use crate::Report;
use crate::decode::{Field, field_table, in_parentheses, problem_lines};
use crate::output::csv::RowsOf;
use crate::prelude::basics::*;
use armctl_transport::tap::Direction;

/// Messages of a family in a capture file.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Capture<F> {
    pub(super) file: String,
    /// Number of packets in the file.
    pub(super) packets: u64,
    /// Number of packets without messages of the family, or excluded by --host and --port.
    pub(super) other_packets: u64,
    pub(super) links: Vec<Link>,
    pub(super) messages: Vec<Row<F>>,
    /// Notes on missing data.
    pub(super) notes: Vec<String>,
    /// Damage of the file; everything before it was read.
    pub(super) damage: Option<String>,
    #[serde(skip)]
    pub(super) problems: Problems,
    /// Whether all fields are shown.
    #[serde(skip)]
    pub(super) is_detailed: bool,
    /// Whether messages are filtered by host or port.
    #[serde(skip)]
    pub(super) is_filtered: bool,
}

/// Two communicating ends.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Link {
    link: usize,
    client: String,
    controller: String,
    messages: u64,
}

/// A message.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Row<F> {
    /// Number of the packet that contains the end of the message, as in Wireshark.
    number: u64,
    /// Time since the first packet of the file.
    time_s: f64,
    link: usize,
    /// `client` or `controller`.
    sender: &'static str,
    from: String,
    to: String,
    /// Text, as in --trace.
    text: String,
    /// Packet of the request that this message answers.
    answers: Option<u64>,
    /// Section of the manual, if the command is known.
    section: Option<String>,
    /// Raw data: bytes in hexadecimal, a line, or words.
    raw: String,
    fields: Vec<F>,
    /// Problem found in the message.
    problem: Option<String>,
}

impl<F> Row<F> {
    fn arrow(&self) -> &'static str {
        if self.sender == "client" { "->" } else { "<-" }
    }
}

impl<F> Row<F> {
    /// Columns of the table.
    pub(super) const COLUMNS: [&'static str; 6] = ["number", "time s", "link", "way", "answers", "message"];

    /// Cells of the columns, as in a trace.
    pub(super) fn cells(&self) -> [Cell; 6] {
        // If the message cannot be identified, the text already contains the reason.
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
    /// Table rows, as in a trace.
    pub(super) fn list(&self) -> View {
        let mut table = Table::new(&Row::<F>::COLUMNS, "no message of this family");
        self.messages.iter().for_each(|row| table.row(row.cells()));
        let mut sections = vec![Section::Text(self.head()), Section::Table(table)];
        if !self.notes.is_empty() {
            sections.push(Section::Text(self.notes.join("\n")));
        }
        View { sections }
    }

    /// Summary of the number of messages and their links.
    pub(super) fn head(&self) -> String {
        let family_packets = self.packets.saturating_sub(self.other_packets);
        let what = if self.is_filtered { "selected and of this family" } else { "of this family" };
        let mut head = format!("{}, {family_packets} of them {what}", count_text(self.packets, "packet"));
        for Link { link, client, controller, messages } in &self.links {
            head.push_str(&format!("\nlink {link}: {client} -> {controller}, {}", count_text(*messages, "message")));
        }
        head
    }

    /// Every field of some messages.
    pub(super) fn details(&self) -> View {
        let mut sections = Vec::new();
        for row in &self.messages {
            let Row { number, time_s, from, to, text, .. } = row;
            let section = in_parentheses(row.section.as_deref());
            let answers = row.answers.map(|packet| format!("\nanswers packet {packet}")).unwrap_or_default();
            let problem = problem_lines(&row.problem);
            let head = format!("packet {number} at {time_s:.6} s, {from} -> {to}");
            sections.push(Section::Text(format!("{head}\n{text}{section}{answers}{problem}")));
            sections.push(field_table(&row.fields));
        }
        View { sections }
    }
}

impl<F: Field> Report for Capture<F> {
    const ROWS: RowsOf = RowsOf::List("messages");

    fn view(&self) -> View {
        if self.is_detailed { self.details() } else { self.list() }
    }

    fn failure(&self) -> Option<Failure> {
        if self.damage.as_deref() == Some(TOO_MANY_MESSAGES) {
            let failure = Failure::local(format!("{}: {TOO_MANY_MESSAGES}", self.file));
            return Some(
                failure.hint("select messages with --host, --port or --frame, or split the file with `editcap -c`"),
            );
        }
        if let Some(damage) = &self.damage {
            let failure = Failure::local(format!("{}: {damage}", self.file));
            return Some(
                failure.hint("check whether the capture was aborted; the command shows the part before the damage"),
            );
        }
        let Problems { all, damaged, first } = &self.problems;
        let (number, problem) = first.as_ref()?;
        let message = match all {
            1 => format!("the message in packet {number} is damaged: {problem}"),
            _ => format!("{damaged} of {all} messages are damaged; the first, in packet {number}: {problem}"),
        };
        Some(
            Failure::new(Kind::Malformed, message)
                .hint("use --frame NUMBER to see the fields of a message up to the damage"),
        )
    }
}

/// Reason why not all messages are shown.
pub const TOO_MANY_MESSAGES: &str = "the capture has too many messages; only the first messages are shown";

/// Links of a file, in the order of their first message.
#[derive(Debug, Default)]
pub struct Links {
    pub(super) list: Vec<Link>,
    numbers: HashMap<(String, String), usize>,
    /// Whether the rows come from messages that were already counted.
    pub(super) are_counted: bool,
}

impl Links {
    /// Index of a link.
    fn index(&mut self, link: &(String, String)) -> usize {
        if let Some(at) = self.numbers.get(link) {
            return *at;
        }
        let at = self.list.len();
        let (client, controller) = link.clone();
        self.list.push(Link { link: at + 1, client, controller, messages: 0 });
        self.numbers.insert(link.clone(), at);
        at
    }

    pub(super) fn count(&mut self, link: &(String, String)) {
        let at = self.index(link);
        self.list[at].messages += 1;
    }

    /// Message with its link.
    pub(super) fn row<F>(&mut self, message: DecodedMessage<F>, first: Duration) -> Row<F> {
        if !self.are_counted {
            self.count(&message.link);
        }
        let at = self.index(&message.link);
        let link = &self.list[at];
        let (from, to, sender) = match message.direction {
            Direction::Sent => (&link.client, &link.controller, "client"),
            Direction::Received => (&link.controller, &link.client, "controller"),
        };
        Row {
            number: message.number,
            time_s: seconds(message.time, first),
            link: link.link,
            sender,
            from: from.clone(),
            to: to.clone(),
            text: message.text,
            answers: message.answers,
            section: message.section,
            raw: message.raw,
            fields: message.fields,
            problem: message.problem,
        }
    }
}

/// Problems of messages.
#[derive(Debug, Default)]
pub struct Problems {
    pub(super) all: u64,
    damaged: u64,
    /// Packet and problem.
    first: Option<(u64, String)>,
}

impl Problems {
    pub(super) fn add<F>(&mut self, row: &Row<F>) {
        self.all += 1;
        if let Some(problem) = &row.problem {
            self.damaged += 1;
            self.first.get_or_insert_with(|| (row.number, problem.clone()));
        }
    }
}

/// Packets of several interfaces may not be in the order of their times.
fn seconds(time: Duration, first: Duration) -> f64 {
    match time.checked_sub(first) {
        Some(after) => after.as_secs_f64(),
        None => -(first.saturating_sub(time).as_secs_f64()),
    }
}

/// Count with singular or plural noun.
pub fn count_text(count: u64, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}
