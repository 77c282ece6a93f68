//! Frames of the high-speed Ethernet server in a capture.

use std::collections::{HashMap, HashSet};
use std::net::SocketAddr;
use std::sync::Arc;

use super::FieldRow;
use super::{ID_AT, IDENTIFIER};
use armctl_controller::text::hex;
use armctl_controller::yerc::describe::{Description, Sender, describe, outline, request_of, summary};
use armctl_controller::yerc::request::Request;
use armctl_controller::yerc::table::Row;
use armctl_controller::yerc::wire::RequestFrame;
use armctl_frame::decode::capture::{CaptureDecoder, DecodedCapture, DecodedMessage, Detail, cut};
use armctl_transport::capture::{Carrier, Message};
use armctl_transport::tap::Direction;

/// Maximum number of pending requests, and of conversations. No plant has so many at the same time.
const MAX_STORED: usize = 1 << 16;

/// Decodes datagrams that start like a frame.
#[derive(Debug, Default)]
pub struct FrameDecoder {
    decoded: DecodedCapture<FieldRow>,
    /// Addresses that sent requests.
    clients: HashSet<SocketAddr>,
    /// By client and controller.
    conversations: HashMap<(SocketAddr, SocketAddr), Conversation>,
    /// Number of requests in all conversations.
    requests: usize,
}

/// Frames between a client and a controller.
#[derive(Debug)]
struct Conversation {
    link: Arc<(String, String)>,
    /// Last request with each id, and the number of its packet.
    requests: HashMap<u8, (u64, Request)>,
}

impl CaptureDecoder for FrameDecoder {
    type Field = FieldRow;

    fn take(&mut self, message: &Message<'_>) {
        let Carrier::Datagram { from, to } = message.carrier else { return };
        let bytes = message.bytes;
        if !bytes.starts_with(IDENTIFIER) {
            return;
        }
        self.decoded.packets += 1;
        // During a file transfer, the frames of both sides have the same form.
        let sender = match Sender::guess(bytes) {
            _ if self.clients.contains(&from) => Sender::Client,
            _ if self.clients.contains(&to) => Sender::Controller,
            guess => guess,
        };
        let id = bytes.get(ID_AT).copied().unwrap_or_default();
        let (direction, client, controller) = match sender {
            Sender::Client => (Direction::Sent, from, to),
            Sender::Controller => (Direction::Received, to, from),
        };
        let request = RequestFrame::parse(bytes).ok().filter(|frame| sender == Sender::Client && !frame.ack);
        if self.requests >= MAX_STORED && request.is_some() || self.conversations.len() >= MAX_STORED {
            // Later frames are decoded without their requests.
            self.conversations.clear();
            self.clients.clear();
            self.requests = 0;
        }
        let conversation = self.conversations.entry((client, controller)).or_insert_with(|| Conversation {
            link: Arc::new((client.to_string(), controller.to_string())),
            requests: HashMap::new(),
        });
        if let Some(frame) = request {
            self.clients.insert(client);
            let is_new = conversation.requests.insert(id, (message.number, request_of(&frame))).is_none();
            self.requests += usize::from(is_new);
        }
        let request_entry = conversation.requests.get(&id).filter(|_| sender == Sender::Controller);
        let request = request_entry.map(|(_, request)| request);
        let detail = self.decoded.detail;
        let (section, fields, problem) = if detail == Detail::Fields {
            let Description { section, fields, problem, .. } = describe(bytes, sender, request);
            (section, fields, problem)
        } else {
            let (row, problem) = outline(bytes, sender, request);
            (row.filter(|_| detail >= Detail::Raw).map(Row::citation), Vec::new(), problem)
        };
        self.decoded.messages.push(DecodedMessage {
            number: message.number,
            time: message.time,
            direction,
            link: Arc::clone(&conversation.link),
            text: summary(bytes, sender, request),
            answers: request_entry.map(|(number, _)| *number),
            section,
            raw: if detail >= Detail::Raw { hex(bytes) } else { String::new() },
            fields: fields.into_iter().map(FieldRow).collect(),
            problem: if message.is_cut { Some(cut()) } else { problem },
        });
    }

    fn decoded(&mut self) -> &mut DecodedCapture<FieldRow> {
        &mut self.decoded
    }

    fn finish(&mut self) {}

    fn restart(self) -> Self {
        Self::default()
    }
}
