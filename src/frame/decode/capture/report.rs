//! Report of the messages of a family in a capture file.

use std::borrow::Cow;
use std::collections::HashMap;

use serde::Serializer;

use super::DecodedMessage;
use crate::decode::{Field, field_table, in_parentheses, problem_lines};
use crate::output::csv::{self, neutralize_formula};
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
    #[schemars(with = "String")]
    from: End,
    #[schemars(with = "String")]
    to: End,
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

/// An end of a link. Its name is not copied, because a large file has millions of rows.
#[derive(Debug, Clone)]
struct End {
    link: Arc<(String, String)>,
    is_client: bool,
}

impl End {
    fn name(&self) -> &str {
        if self.is_client { &self.link.0 } else { &self.link.1 }
    }
}

impl Serialize for End {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// Columns of the table.
pub(super) const COLUMNS: [&str; 6] = ["number", "time s", "link", "way", "answers", "message"];

impl<F> Row<F> {
    /// Number of the packet.
    pub(super) fn number(&self) -> u64 {
        self.number
    }

    /// Problem found in the message.
    pub(super) fn problem(&self) -> Option<&String> {
        self.problem.as_ref()
    }

    /// Cells of the columns, as in a trace.
    pub(super) fn cells(&self) -> [Cell; 6] {
        let Self { number, time_s, link, answers, .. } = *self;
        let message = message_cell(&self.text, self.problem.as_deref());
        row_cells(number, time_s, link, self.from.is_client, answers, message)
    }

    /// Appends the row as CSV, without the list of fields. The columns are those of the schema.
    pub(super) fn push_csv(&self, out: &mut String) {
        let number = |number: u64| Cow::Owned(number.to_string());
        let cells = [
            number(self.number),
            Value::from(self.time_s).to_string().into(),
            self.link.to_string().into(),
            self.sender.into(),
            neutralize_formula(self.from.name()),
            neutralize_formula(self.to.name()),
            neutralize_formula(&self.text),
            self.answers.map(number).unwrap_or_default(),
            neutralize_formula(self.section.as_deref().unwrap_or_default()),
            neutralize_formula(&self.raw),
            neutralize_formula(self.problem.as_deref().unwrap_or_default()),
        ];
        csv::line(out, cells.iter().map(AsRef::as_ref));
    }
}

/// Cell with the text of a message.
fn message_cell(text: &str, problem: Option<&str>) -> Cell {
    // If the message cannot be identified, the text already contains the reason.
    let shown = match problem {
        Some(problem) if !text.contains("no valid") => format!("{text}; problem: {problem}"),
        _ => text.to_owned(),
    };
    Cell::from(shown).tone(if problem.is_some() { Tone::Bad } else { Tone::Plain })
}

/// Cells of a row.
fn row_cells(
    number: u64,
    time_s: f64,
    link: usize,
    is_from_client: bool,
    answers: Option<u64>,
    message: Cell,
) -> [Cell; 6] {
    [
        Cell::number(number.to_string()),
        Cell::number(format!("{time_s:.6}")),
        link.into(),
        (if is_from_client { "->" } else { "<-" }).into(),
        answers.map_or_else(Cell::default, |packet| Cell::number(packet.to_string())),
        message,
    ]
}

/// A row with the longest number and time that a capture has in practice (some gigabytes, 11 days), and with a text of
/// this length.
pub(super) fn row_of_the_longest(text: usize) -> [Cell; 6] {
    const NUMBER: u64 = 99_999_999;
    const TIME: f64 = 999_999.0;

    row_cells(NUMBER, TIME, 1, true, Some(NUMBER), Cell::from("- ".repeat(text)))
}

impl<F: Field> Capture<F> {
    /// Table rows, as in a trace.
    pub(super) fn list(&self) -> View {
        let mut table = Table::new(&COLUMNS, "no message of this family");
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
            let Row { number, time_s, text, .. } = row;
            let (from, to) = (row.from.name(), row.to.name());
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
    numbers: HashMap<Arc<(String, String)>, usize>,
    /// Link of the last message. Most messages have the same link as the message before.
    last: Option<(Arc<(String, String)>, usize)>,
    /// Whether the rows come from messages that were already counted.
    pub(super) are_counted: bool,
}

impl Links {
    /// Adds a message to its link, which gets the next number if it is new.
    fn add(&mut self, link: &Arc<(String, String)>, count: u64) -> usize {
        let last = self.last.as_ref().filter(|(last, _)| Arc::ptr_eq(last, link));
        let known = last.map(|(_, at)| *at).or_else(|| self.numbers.get(link).copied());
        let at = known.unwrap_or_else(|| {
            let at = self.list.len();
            let (client, controller) = (**link).clone();
            self.list.push(Link { link: at + 1, client, controller, messages: 0 });
            self.numbers.insert(Arc::clone(link), at);
            at
        });
        if last.is_none() {
            self.last = Some((Arc::clone(link), at));
        }
        let link = &mut self.list[at];
        link.messages += count;
        link.link
    }

    pub(super) fn count(&mut self, link: &Arc<(String, String)>) {
        self.add(link, 1);
    }

    /// Message with its link.
    pub(super) fn row<F>(&mut self, message: DecodedMessage<F>, first: Duration) -> Row<F> {
        let number = self.add(&message.link, u64::from(!self.are_counted));
        let is_from_client = message.direction == Direction::Sent;
        Row {
            number: message.number,
            time_s: seconds(message.time, first),
            link: number,
            sender: if is_from_client { "client" } else { "controller" },
            from: End { link: Arc::clone(&message.link), is_client: is_from_client },
            to: End { link: message.link, is_client: !is_from_client },
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
    /// Adds the problem of the message in a packet, if it has one.
    pub(super) fn add(&mut self, number: u64, problem: Option<&String>) {
        self.all += 1;
        if let Some(problem) = problem {
            self.damaged += 1;
            self.first.get_or_insert_with(|| (number, problem.clone()));
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

#[cfg(test)]
mod tests {

    use super::*;
    use crate::output::csv::Sheet;
    use crate::schema_of;

    /// A field, which no list shows.
    #[derive(Debug, Serialize, JsonSchema)]
    struct Offset {
        offset: u8,
    }

    impl Field for Offset {
        const COLUMNS: &'static [&'static str] = &[];

        fn cells(&self) -> Vec<Cell> {
            Vec::new()
        }
    }

    fn messages() -> impl Iterator<Item = DecodedMessage<Offset>> {
        let link = Arc::new(("10.0.0.9:50000".to_owned(), "=10.0.0.1".to_owned()));
        let texts = ["=1+1", "a, \"b\"\n\u{1b}[0m", "-1.5 2", "no valid frame: one word of many", "溶接"];
        (0..).zip(texts).map(move |(at, text)| DecodedMessage {
            number: 98 + at,
            time: Duration::from_micros(1_000_000_007 * (5 + at * 7 % 3)),
            direction: if at % 2 == 0 { Direction::Sent } else { Direction::Received },
            link: Arc::clone(&link),
            text: text.to_owned(),
            answers: (at % 2 == 1).then_some(97 + at),
            section: (at == 2).then(|| "FS, DX 3".to_owned()),
            raw: "-0f".to_owned(),
            fields: vec![Offset { offset: 0 }],
            problem: (at > 2).then(|| "@ a very_long_word".to_owned()),
        })
    }

    #[test]
    fn csv_row_has_the_columns_of_the_schema() {
        let sheet = Sheet::from_schema(&schema_of::<Capture<Offset>>().to_value(), RowsOf::List("messages"));
        let mut links = Links::default();
        for message in messages() {
            let row = links.row(message, Duration::from_secs(6000));
            let (mut expected, mut written) = (String::new(), String::new());
            sheet.rows(&[], &json!({ "messages": [row] }), None, &mut expected);
            row.push_csv(&mut written);
            assert_eq!(written, expected);
        }
        assert_eq!(links.list[0].messages, 5);
    }
}
