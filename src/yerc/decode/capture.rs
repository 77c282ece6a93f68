//! Frames of the high-speed Ethernet server in a capture.

use std::collections::{HashMap, HashSet};
use std::net::SocketAddr;

use super::FieldRow;
use super::{ID_AT, IDENTIFIER};
use armctl_controller::text::hex;
use armctl_controller::yerc::describe::{Sender, describe, summary};
use armctl_controller::yerc::request::Request;
use armctl_controller::yerc::wire::RequestFrame;
use armctl_frame::decode::capture::{CaptureDecoder, DecodedCapture, DecodedMessage, cut};
use armctl_transport::capture::{Carrier, Message};
use armctl_transport::tap::Direction;

/// Maximum number of pending requests. No plant has so many requests at the same time.
const MAX_REQUESTS: usize = 1 << 16;

/// Decodes datagrams that start like a frame.
#[derive(Debug, Default)]
pub struct FrameDecoder {
    decoded: DecodedCapture<FieldRow>,
    /// Addresses that sent requests.
    clients: HashSet<SocketAddr>,
    /// Last request with each id, and the number of its packet.
    requests: HashMap<(SocketAddr, SocketAddr, u8), (u64, Request)>,
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
        let key = (client, controller, id);
        if sender == Sender::Client
            && let Ok(frame) = RequestFrame::parse(bytes)
            && !frame.ack
        {
            if self.requests.len() >= MAX_REQUESTS {
                // No plant has this many pending requests. Later frames are decoded without their requests.
                self.requests.clear();
                self.clients.clear();
            }
            self.clients.insert(client);
            self.requests.insert(key, (message.number, Request::from(frame)));
        }
        let request_key = self.requests.get(&key).filter(|_| sender == Sender::Controller);
        let request = request_key.map(|(_, request)| request);
        let description = describe(bytes, sender, request);
        self.decoded.messages.push(DecodedMessage {
            number: message.number,
            time: message.time,
            direction,
            link: (client.to_string(), controller.to_string()),
            text: summary(bytes, sender, request),
            answers: request_key.map(|(number, _)| *number),
            section: description.section,
            raw: hex(bytes),
            fields: description.fields.into_iter().map(FieldRow).collect(),
            problem: if message.is_cut { Some(cut()) } else { description.problem },
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
