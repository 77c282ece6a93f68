//! Decoder of a frame into described fields. It uses the command table and never fails: a damaged frame is decoded up
//! to the damage.

mod data;

use std::fmt;

use compact_str::{CompactString, ToCompactString as _};
use schemars::JsonSchema;
use serde::Serialize;

use super::Model;
use super::payload::PositionKind;
use super::request::Request;
use super::table::{Action, BATCH_BACKUP_PATH, Row, service};
use super::wire::{ANSWER_BIT, AnswerFrame, Division, HEADER_LEN, LAST_BLOCK, RequestFrame, Status, WireError};
use crate::text::hex;

/// A decoded frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Description {
    /// One-line summary.
    pub title: String,
    /// Manual and section, if the command is known.
    pub section: Option<String>,
    /// All bytes in order.
    pub fields: Vec<FieldNote>,
    /// The problem of the frame, if any.
    pub problem: Option<String>,
}

// Short texts need no memory of their own: a capture has millions of parts, and one thread would free what another
// one allocated.
/// A part of a frame.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[schemars(rename = "FieldRow")]
pub struct FieldNote {
    /// Offset from the start of the frame.
    pub offset: usize,
    /// Number of bytes.
    pub size: usize,
    /// Name of the part.
    #[schemars(with = "String")]
    pub name: CompactString,
    /// Bytes of the part in the frame.
    #[serde(rename = "raw_hex")]
    #[schemars(with = "String")]
    pub raw: CompactString,
    /// Meaning of the bytes.
    #[schemars(with = "String")]
    pub meaning: CompactString,
}

/// Sender of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sender {
    /// The client: requests, file data to the controller, ACKs.
    Client,
    /// The controller: answers, file data from the controller, ACKs.
    Controller,
}

impl Sender {
    /// Guesses the sender from the ACK flag. For file frames, the sub-header decides.
    pub fn guess(frame: &[u8]) -> Self {
        if frame.get(ACK_AT).is_none_or(|&ack| ack == 0) {
            return Self::Client;
        }
        // In transfer frames of the client, the bytes of command, instance and attribute are 0. In an answer, the first
        // of these bytes is the service, which is never 0.
        match frame.get(24..30) {
            Some([0, 0, 0, 0, 0, service]) if *service != 0 => Self::Client,
            _ => Self::Controller,
        }
    }
}

/// Offset of the ACK flag in a frame.
const ACK_AT: usize = 10;

/// Decodes a frame. `request` is the request that an answer belongs to, if it is known: an answer does not contain its
/// request.
pub fn describe(frame: &[u8], sender: Sender, request: Option<&Request>) -> Description {
    let mut notes = Notes { frame, has_fields: true, at: 0, fields: Vec::new(), problem: None };
    let (title, row) = notes.walk(sender, request);
    Description { title, section: row.map(Row::citation), fields: notes.fields, problem: notes.problem }
}

/// Row of the command table, and problem of a frame: [`describe`] without the cost of texts.
pub fn outline(frame: &[u8], sender: Sender, request: Option<&Request>) -> (Option<&'static Row>, Option<String>) {
    let mut notes = Notes { frame, has_fields: false, at: 0, fields: Vec::new(), problem: None };
    let (_, row) = notes.walk(sender, request);
    (row, notes.problem)
}

/// One-line summary of a frame, for traces.
pub fn summary(frame: &[u8], sender: Sender, request: Option<&Request>) -> String {
    match sender {
        Sender::Client => match RequestFrame::parse(frame) {
            Ok(parsed) => client_summary(&parsed),
            Err(error) => damaged(&error),
        },
        Sender::Controller => match AnswerFrame::parse(frame) {
            Ok(parsed) => answer_summary(&parsed, request),
            Err(error) => damaged(&error),
        },
    }
}

fn damaged(error: &WireError) -> String {
    format!("no valid frame: {error}")
}

fn client_summary(frame: &RequestFrame<'_>) -> String {
    let request = request_of(frame);
    let row = request.row();
    let name = title_of(row, &request);
    let id = frame.id;
    if frame.ack {
        let what = if frame.data.is_empty() { "ack" } else { "data" };
        return format!("#{id} {what}: {name}, {}, {} bytes", block_words(frame.block), frame.data.len());
    }
    if frame.division == Division::File {
        return format!("#{id} {name} '{}'", frame.data.escape_ascii());
    }
    let service = row.and_then(|row| row.service(request.service));
    let action = service.map_or("unknown service", |service| service.meaning);
    format!(
        "#{id} {name}: instance {} {}, attribute {}, {action}, {} bytes",
        request.instance,
        instance_words(row, request.instance),
        request.attribute,
        frame.data.len()
    )
}

fn answer_summary(frame: &AnswerFrame<'_>, request: Option<&Request>) -> String {
    let name = request.map(|request| format!(" to {}", title_of(request.row(), request))).unwrap_or_default();
    let block = if frame.block == LAST_BLOCK { String::new() } else { format!(", {}", block_words(frame.block)) };
    format!("#{} answer{name}: {}{block}, {} bytes", frame.id, status_words(frame.status), frame.data.len())
}

/// Request in a frame. Its data is copied only if it identifies the request: for a file.
pub fn request_of(frame: &RequestFrame<'_>) -> Request {
    let is_file = frame.command == 0 && !frame.ack;
    Request {
        command: frame.command,
        instance: frame.instance,
        attribute: frame.attribute,
        service: frame.service,
        data: if is_file { frame.data.to_vec() } else { Vec::new() },
    }
}

fn title_of(row: Option<&Row>, request: &Request) -> String {
    match (row, request.division()) {
        (Some(row), Division::Robot) => format!("{:#04x} {}", row.number, row.name),
        (Some(row), Division::File) => row.name.to_owned(),
        (None, Division::Robot) => format!("unknown command {:#04x}", request.command),
        (None, Division::File) => format!("unknown file service {:#04x}", request.service),
    }
}

fn status_words(status: Status) -> String {
    let added = match status.added_size {
        0 => String::new(),
        1 => format!(", added status {:04X}", status.added),
        _ => format!(", added status {:08X}", status.added),
    };
    match status.code {
        0 => format!("ok{added}"),
        code => format!("refused, status {code:#04x}{added}"),
    }
}

fn block_words(block: u32) -> String {
    match (block & LAST_BLOCK != 0, block & !LAST_BLOCK) {
        (true, 0) => "single frame".to_owned(),
        (true, number) => format!("block {number}, the last block"),
        (false, number) => format!("block {number}"),
    }
}

/// Name of an instance in parentheses. Contains both names if the name depends on the model.
fn instance_words(row: Option<&Row>, instance: u16) -> String {
    let label = |model| row?.instances.find(model, instance).map(|span| span.label(instance));
    match (label(Model::Fs100), label(Model::Dx200)) {
        (Some(fs100), Some(dx200)) if fs100 == dx200 => format!("({dx200})"),
        (Some(fs100), Some(dx200)) => format!("(fs100: {fs100}; dx200: {dx200})"),
        (Some(fs100), None) => format!("(fs100: {fs100})"),
        (None, Some(dx200)) => format!("(dx200: {dx200})"),
        (None, None) => "(not defined)".to_owned(),
    }
}

/// Fields of a frame, collected from front to back.
struct Notes<'a> {
    frame: &'a [u8],
    /// Whether fields and title are needed, and not only the problem.
    has_fields: bool,
    at: usize,
    fields: Vec<FieldNote>,
    problem: Option<String>,
}

impl Notes<'_> {
    /// Adds all bytes. Returns the title, and the row of the command table.
    fn walk(&mut self, sender: Sender, request: Option<&Request>) -> (String, Option<&'static Row>) {
        self.header();
        match sender {
            Sender::Client => self.client(),
            Sender::Controller => self.controller(request),
        }
    }

    /// Adds the next `size` bytes. If bytes are missing, or were missing before, adds no field.
    fn take(&mut self, size: usize, name: impl fmt::Display, meaning: impl FnOnce(&[u8]) -> String) -> bool {
        if self.problem.is_some() {
            return false;
        }
        let Some(bytes) = self.at.checked_add(size).and_then(|end| self.frame.get(self.at..end)) else {
            self.problem = Some(format!("the frame ends inside '{name}' at offset {}", self.at));
            return false;
        };
        if self.has_fields {
            self.fields.push(FieldNote {
                offset: self.at,
                size,
                name: name.to_compact_string(),
                raw: hex(bytes).into(),
                meaning: meaning(bytes).into(),
            });
        }
        self.at += size;
        true
    }

    fn title(&self, title: impl FnOnce() -> String) -> String {
        if self.has_fields { title() } else { String::new() }
    }

    /// Adds the remaining bytes, if any.
    fn take_rest(&mut self, name: &str, meaning: impl FnOnce(&[u8]) -> String) {
        let size = self.frame.len().saturating_sub(self.at);
        if size > 0 {
            self.take(size, name, meaning);
        }
    }

    fn left(&self) -> usize {
        self.frame.len().saturating_sub(self.at)
    }

    /// The 24-byte header of both sides.
    fn header(&mut self) {
        self.take(4, "identifier", |bytes| format!("\"{}\"", bytes.escape_ascii()));
        self.take(2, "header size", |bytes| format!("{} bytes", little(bytes)));
        self.take(2, "data size", |bytes| format!("{} bytes", little(bytes)));
        self.take(1, "reserve 1", |_| "reserved, 0x03".to_owned());
        self.take(1, "processing division", |bytes| match bytes {
            [1] => "robot control".to_owned(),
            [2] => "file control".to_owned(),
            _ => "not defined".to_owned(),
        });
        self.take(1, "ACK", |bytes| match bytes {
            [0] => "request".to_owned(),
            [1] => "any frame except a request".to_owned(),
            _ => "not defined".to_owned(),
        });
        self.take(1, "request ID", |bytes| little(bytes).to_string());
        self.take(4, "block number", |bytes| match u32::try_from(little(bytes)) {
            Ok(0) => "0".to_owned(),
            Ok(block) => block_words(block),
            Err(_) => String::new(),
        });
        self.take(8, "reserve 2", |_| "reserved, \"99999999\"".to_owned());
    }

    fn client(&mut self) -> (String, Option<&'static Row>) {
        let Some(request) = self.sub_header() else {
            for (size, name) in [(2, "command"), (2, "instance"), (1, "attribute"), (1, "service")] {
                self.take(size, name, |bytes| little(bytes).to_string());
            }
            return ("truncated frame of a client".to_owned(), None);
        };
        let ack = self.frame.get(ACK_AT) == Some(&1);
        let row = request.row();
        let name = self.title(|| title_of(row, &request));
        self.take(2, "command", |_| row.map_or("not defined", |row| row.name).to_owned());
        self.take(2, "instance", |_| format!("{} {}", request.instance, instance_words(row, request.instance)));
        let service = row.and_then(|row| row.service(request.service));
        self.take(1, "attribute", |_| match (row, service) {
            (Some(row), Some(service)) => {
                attribute_words(row, service.takes(request.attribute, row.fields.len()), &request)
            }
            _ => request.attribute.to_string(),
        });
        self.take(1, "service", |_| service.map_or("not defined", |service| service.meaning).to_owned());
        self.take(2, "padding", |_| String::new());
        let title = if ack {
            let size = self.left();
            self.take_rest("file data", |bytes| format!("{} bytes", bytes.len()));
            let what = if size == 0 { "ACK" } else { "data block" };
            self.title(|| format!("{what} of the client: {name}"))
        } else {
            match (row, service) {
                (Some(row), Some(service)) if row.division == Division::File || service.action == Action::Write => {
                    self.payload(row, &request);
                }
                (Some(row), Some(_)) if row.plural.is_some() => self.payload(row, &request),
                _ => {}
            }
            self.take_rest("data", |_| "not expected".to_owned());
            self.title(|| format!("request: {name}"))
        };
        let damage = RequestFrame::parse(self.frame).err().map(|error| error.to_string());
        self.problem = damage.or(self.problem.take());
        (title, row)
    }

    /// Parses command, instance, attribute and service, but does not add them to the fields.
    fn sub_header(&self) -> Option<Request> {
        let bytes = self.frame.get(24..30)?;
        let word = |at: usize| u16::try_from(little(&bytes[at..at + 2])).unwrap_or_default();
        let division = self.frame.get(9);
        // In a file frame, only service and data have a meaning. In another frame, the data does not identify the request.
        let command = if division == Some(&2) { 0 } else { word(0) };
        let data = self.frame.get(HEADER_LEN..).filter(|_| command == 0).unwrap_or_default().to_vec();
        Some(Request { command, instance: word(2), attribute: bytes[4], service: bytes[5], data })
    }

    fn controller(&mut self, request: Option<&Request>) -> (String, Option<&'static Row>) {
        let row = request.and_then(Request::row);
        let service = request.map(|request| request.service);
        self.take(1, "service", |bytes| match (bytes, service) {
            ([byte], Some(service)) if *byte == service.wrapping_add(ANSWER_BIT) => {
                format!("answer to {service:#04x}")
            }
            ([byte], Some(service)) => {
                format!("answer to {:#04x}, not to {service:#04x}", byte.wrapping_sub(ANSWER_BIT))
            }
            ([byte], None) if *byte >= ANSWER_BIT => format!("answer to {:#04x}", byte - ANSWER_BIT),
            _ => "not defined".to_owned(),
        });
        self.take(1, "status", |bytes| match bytes {
            [0] => "ok".to_owned(),
            [0x1F] => "refused, see the added status".to_owned(),
            _ => "refused".to_owned(),
        });
        self.take(1, "added status size", |bytes| format!("{} words of 16 bits", little(bytes)));
        self.take(1, "padding", |_| String::new());
        self.take(4, "added status", |bytes| format!("{:04X}", little(bytes)));
        let is_file = self.frame.get(9) == Some(&2);
        let answered = self.frame.get(24).map(|byte| byte.wrapping_sub(ANSWER_BIT));
        let refused = self.frame.get(25).is_some_and(|&status| status != 0);
        match (row, request) {
            (Some(row), Some(request)) if !refused && row.division == Division::Robot => {
                let reads = row.service(request.service).is_some_and(|service| service.action == Action::Read);
                if reads {
                    self.payload(row, request);
                }
                self.take_rest("data", |_| "more data than the command has".to_owned());
            }
            (Some(_), _) => self.take_rest("file data", |bytes| format!("{} bytes", bytes.len())),
            // The service of a file server answer determines its content.
            _ if is_file && answered == Some(service::LIST) => {
                self.take_rest("names", |bytes| format!("\"{}\"", bytes.escape_ascii()));
            }
            _ if is_file => self.take_rest("file data", |bytes| format!("{} bytes", bytes.len())),
            _ => self.take_rest("data", |_| "depends on the command".to_owned()),
        }
        let damage = AnswerFrame::parse(self.frame).err().map(|error| error.to_string());
        self.problem = damage.or(self.problem.take());
        let title = self.title(|| match request {
            Some(request) => format!("answer: {}", title_of(row, request)),
            None => "answer".to_owned(),
        });
        (title, row)
    }
}

fn attribute_words(row: &Row, allowed: bool, request: &Request) -> String {
    if !allowed {
        return format!("{}, not allowed", request.attribute);
    }
    let named = row.service(request.service).map(|service| row.fields_of(service, request.attribute));
    match named {
        Some([field]) if request.attribute > 0 => format!("{}: {}", request.attribute, field.name),
        _ => request.attribute.to_string(),
    }
}

/// Little-endian value of up to 8 bytes.
fn little(bytes: &[u8]) -> u64 {
    bytes.iter().take(8).rev().fold(0, |value, byte| value << 8 | u64::from(*byte))
}

/// Fields of an element that determine the meaning of the fields after them.
#[derive(Default)]
struct Meaning {
    kind: Option<PositionKind>,
    speed_class: Option<u32>,
}

/// Whether a name is the path of the batch backup.
fn is_backup(name: &[u8]) -> bool {
    name == BATCH_BACKUP_PATH
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(command: u16, instance: u16, attribute: u8, service: u8, data: &[u8]) -> Request {
        Request { command, instance, attribute, service, data: data.to_vec() }
    }

    fn meaning<'a>(description: &'a Description, name: &str) -> &'a str {
        &description.fields.iter().find(|field| field.name == name).unwrap().meaning
    }

    #[test]
    fn a_request_is_explained_to_the_last_byte() {
        let frame = request(0x302, 10, 0, 0x34, &[2, 0, 0, 0, 7, 8]).frame(5);
        let description = describe(&frame, Sender::guess(&frame), None);
        assert_eq!(description.title, "request: 0x302 plural byte variable (B)");
        assert_eq!(description.section.as_deref(), Some("FS and DX 3.3.29"));
        assert_eq!(description.problem, None);
        assert_eq!(meaning(&description, "11 value"), "8");
        let end = description.fields.iter().try_fold(0, |at, field| (field.offset == at).then_some(at + field.size));
        assert_eq!(end, Some(frame.len()));
        assert_eq!(
            summary(&frame, Sender::Client, None),
            "#5 0x302 plural byte variable (B): instance 10 (variable), attribute 0, write several elements, 6 bytes"
        );
    }

    #[test]
    fn an_answer_needs_its_request() {
        let ask = request(0x75, 101, 0, 0x01, &[]);
        let data: Vec<u8> = [16_u32, 5, 1, 0, 0, 100_000].into_iter().flat_map(u32::to_le_bytes).collect();
        let frame = AnswerFrame {
            division: Division::Robot,
            ack: true,
            id: 1,
            block: LAST_BLOCK,
            service: 0x81,
            status: Status::OK,
            data: &data,
        }
        .emit();
        let known = describe(&frame, Sender::guess(&frame), Some(&ask));
        assert_eq!(meaning(&known, "axis 1"), "100.000 mm");
        assert_eq!(
            meaning(&known, "form"),
            "back, upper, noflip, r-lt180, t-lt180, s-lt180, redundant-front, previous-step"
        );
        assert_eq!(known.problem, None);
        let unknown = describe(&frame, Sender::guess(&frame), None);
        assert_eq!(meaning(&unknown, "data"), "depends on the command");
        assert_eq!(
            summary(&frame, Sender::Controller, Some(&ask)),
            "#1 answer to 0x75 robot position read: ok, 24 bytes"
        );
    }

    #[test]
    fn service_determines_the_content_of_a_file_frame() {
        let answer = |service: u8, data: &[u8]| {
            let (block, status) = (1 | LAST_BLOCK, Status::OK);
            let frame = AnswerFrame { division: Division::File, ack: true, id: 8, block, service, status, data }.emit();
            describe(&frame, Sender::Controller, None)
        };
        assert_eq!(meaning(&answer(0xB2, b"1.JBI\r\n22.JBI\r\n"), "names"), r#""1.JBI\r\n22.JBI\r\n""#);
        assert_eq!(meaning(&answer(0x96, b"NOP\r\n"), "file data"), "5 bytes");
    }

    #[test]
    fn shows_an_invalid_count() {
        let count = |command, count: u8| {
            let frame = request(command, 0, 0, 0x33, &[count, 0, 0, 0]).frame(0);
            let description = describe(&frame, Sender::Client, None);
            assert_eq!(meaning(&description, "attribute"), "0", "no field is named by 0");
            meaning(&description, "count").to_owned()
        };
        assert_eq!(count(0x304, 118), "118");
        assert_eq!(count(0x304, 119), "119, not allowed: 1 to 118");
        assert_eq!(count(0x302, 3), "3, not allowed: even counts only");
    }

    #[test]
    fn describes_damage() {
        let frame = request(0x72, 1, 0, 1, &[]).frame(0);
        let cut = describe(&frame[..20], Sender::Client, None);
        assert_eq!(cut.fields.last().unwrap().name, "block number");
        assert_eq!(cut.problem.as_deref(), Some("the frame ends inside 'reserve 2' at offset 16"));
        let mut wrong = frame;
        wrong[9] = 3;
        let problem = describe(&wrong, Sender::Client, None).problem.unwrap();
        assert!(problem.starts_with("processing division at offset 9 is 3"), "{problem}");
    }
}
