//! What a capture file holds of a family, as it is printed.

use std::collections::HashMap;
use std::time::Duration;

use schemars::JsonSchema;
use serde::Serialize;

use super::DecodedMessage;
use crate::command::Report;
use crate::command::decode::{Field, field_table, in_parentheses, problem_lines};
use crate::failure::{Failure, Kind};
use crate::output::csv::RowsOf;
use crate::output::view::{Cell, Section, Table, Tone, View};
use crate::transport::tap::Direction;

/// What a capture file holds of a family.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Capture<F> {
    pub(super) file: String,
    /// All that are in the file.
    pub(super) packets: u64,
    /// Those with nothing of the family, or left out by --host and --port.
    pub(super) other_packets: u64,
    pub(super) links: Vec<Link>,
    pub(super) messages: Vec<Row<F>>,
    /// What is missing.
    pub(super) notes: Vec<String>,
    /// Where the file is damaged; all before it was read.
    pub(super) damage: Option<String>,
    #[serde(skip)]
    pub(super) problems: Problems,
    /// Every field is shown.
    #[serde(skip)]
    pub(super) is_detailed: bool,
    /// By host or port.
    #[serde(skip)]
    pub(super) is_filtered: bool,
}

/// Two ends that talk to each other.
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
    pub(super) const COLUMNS: [&'static str; 6] = ["number", "time s", "link", "way", "answers", "message"];

    /// What stands in them, in the words of a trace.
    pub(super) fn cells(&self) -> [Cell; 6] {
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
    pub(super) fn list(&self) -> View {
        let mut table = Table::new(&Row::<F>::COLUMNS, "no message of this family");
        self.messages.iter().for_each(|row| table.row(row.cells()));
        let mut sections = vec![Section::Text(self.head()), Section::Table(table)];
        if !self.notes.is_empty() {
            sections.push(Section::Text(self.notes.join("\n")));
        }
        View { sections }
    }

    /// How much there is, and between whom.
    pub(super) fn head(&self) -> String {
        let told = self.packets.saturating_sub(self.other_packets);
        let what = if self.is_filtered { "selected and of this family" } else { "of this family" };
        let mut head = format!("{}, {told} of them {what}", counted(self.packets, "packet"));
        for Link { link, client, controller, messages } in &self.links {
            head.push_str(&format!("\nlink {link}: {client} -> {controller}, {}", counted(*messages, "message")));
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
    fn view(&self) -> View {
        if self.is_detailed { self.details() } else { self.list() }
    }

    fn rows(&self) -> RowsOf {
        RowsOf::List("messages")
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
pub const FULL: &str = "it has more messages than there is room for; the first ones are told";

/// The links of a file, in the order in which they are met.
#[derive(Debug, Default)]
pub struct Links {
    pub(super) list: Vec<Link>,
    numbers: HashMap<(String, String), usize>,
    /// Rows are of messages that were counted before.
    pub(super) are_counted: bool,
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

    pub(super) fn count(&mut self, link: &(String, String)) {
        let at = self.at(link);
        self.list[at].messages += 1;
    }

    /// A message with the link it belongs to.
    pub(super) fn row<F>(&mut self, message: DecodedMessage<F>, first: Duration) -> Row<F> {
        if !self.are_counted {
            self.count(&message.link);
        }
        let at = self.at(&message.link);
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

/// What is wrong with messages.
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

/// Packets of several interfaces may come in another order than their times.
fn seconds(time: Duration, first: Duration) -> f64 {
    match time.checked_sub(first) {
        Some(after) => after.as_secs_f64(),
        None => -(first.saturating_sub(time).as_secs_f64()),
    }
}

/// So many of them.
pub fn counted(count: u64, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}
