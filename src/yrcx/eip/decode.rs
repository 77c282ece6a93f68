//! EtherNet/IP decoder for captures: cyclic images, and the messages that open and close connections.

use std::collections::{HashMap, HashSet};
use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;

use super::cip::{explain, may_be_message};
use crate::decode::images::{BusDecoder, Images, MAX_STORED, decoded};
use crate::field_row::FieldRow;
use armctl_controller::text::hex;
use armctl_controller::yrcx::image::Image;
use armctl_frame::decode::capture::DecodedMessage;
use armctl_transport::capture::{Carrier, Message};
use armctl_transport::eip::PORT;
use armctl_transport::eip::wire::{Cyclic, Frames, RUN};
use armctl_transport::tap::Direction;

/// State of the decoder.
#[derive(Debug, Default)]
pub struct Decoder {
    /// TCP streams, one entry per direction; `None` if the stream is not EtherNet/IP.
    streams: HashMap<(SocketAddr, SocketAddr), Option<Frames>>,
    /// Packet numbers of pending requests, by client, controller and sender context.
    pending_requests: HashMap<(SocketAddr, SocketAddr, [u8; 8]), u64>,
    /// Connections whose ForwardOpen was seen, by controller and connection id. For ids of data from the controller,
    /// the client is stored too, because that data can go to a multicast group. Both directions can have the same id.
    to_controller: HashSet<(IpAddr, u32)>,
    from_controller: HashMap<(IpAddr, u32), IpAddr>,
    flows: HashMap<(SocketAddr, SocketAddr, u32), Flow>,
}

/// One direction of a connection.
#[derive(Debug, Clone, Copy)]
struct Flow {
    /// Sequence number of the last datagram.
    sequence: u32,
    lost: u64,
    /// Run bit of the last run/idle header.
    run: Option<bool>,
}

/// Size of an image with its run/idle header.
const WITH_HEADER: usize = Image::BYTES + 4;

impl Decoder {
    fn stream(
        &mut self,
        message: &Message<'_>,
        ends: (SocketAddr, SocketAddr),
        (begins, lost): (bool, u32),
        images: &mut Images,
    ) {
        if begins || lost > 0 {
            self.streams.remove(&ends);
        }
        self.forget_if_many();
        if lost > 0 && self.streams.contains_key(&(ends.1, ends.0)) {
            images.note(format!("{lost} bytes before packet {} are not in the capture", message.number));
        }
        let fresh = || may_be_message(message.bytes).then(Frames::default);
        let Some(frames) = self.streams.entry(ends).or_insert_with(fresh) else { return };
        let mut frames = std::mem::take(frames);
        frames.push(message.bytes);
        images.count();
        while let Some(bytes) = frames.pop() {
            if !may_be_message(&bytes) {
                self.streams.insert(ends, None);
                return;
            }
            self.encapsulated(message, ends, &bytes, images);
        }
        self.streams.insert(ends, Some(frames));
    }

    /// Clears the state if it is too large. Decoding then continues without history.
    fn forget_if_many(&mut self) {
        let known = [
            self.streams.len(),
            self.pending_requests.len(),
            self.to_controller.len(),
            self.from_controller.len(),
            self.flows.len(),
        ];
        if known.iter().any(|known| *known >= MAX_STORED) {
            *self = Self::default();
        }
    }

    /// Handles an encapsulation message.
    fn encapsulated(
        &mut self,
        message: &Message<'_>,
        ends: (SocketAddr, SocketAddr),
        bytes: &[u8],
        images: &mut Images,
    ) {
        let described = explain(bytes);
        let (direction, client, controller) =
            if described.is_answer { (Direction::Received, ends.1, ends.0) } else { (Direction::Sent, ends.0, ends.1) };
        let context = bytes.get(12..20).and_then(|bytes| bytes.first_chunk().copied()).unwrap_or_default();
        let key = (client, controller, context);
        let answers = if described.is_answer { self.pending_requests.remove(&key) } else { None };
        if !described.is_answer {
            self.pending_requests.insert(key, message.number);
        }
        if let Some((o_t, t_o)) = described.opened {
            self.to_controller.insert((controller.ip(), o_t));
            self.from_controller.insert((controller.ip(), t_o), client.ip());
        }
        images.message(DecodedMessage {
            number: message.number,
            time: message.time,
            direction,
            link: Arc::new((client.ip().to_string(), controller.ip().to_string())),
            text: described.text,
            answers,
            section: None,
            raw: hex(bytes),
            fields: described.fields.into_iter().map(FieldRow).collect(),
            problem: described.problem,
        });
    }

    /// Adds the image of a datagram, if the datagram is cyclic data of a YRCX.
    fn cyclic(&mut self, message: &Message<'_>, from: SocketAddr, to: SocketAddr, images: &mut Images) {
        self.forget_if_many();
        let Ok(cyclic) = Cyclic::parse(message.bytes) else { return };
        let client = self.from_controller.get(&(from.ip(), cyclic.id)).copied();
        let is_forth = self.to_controller.contains(&(to.ip(), cyclic.id));
        let len = cyclic.body.len();
        let known = match (is_forth, client) {
            // If client and controller are on one computer, both directions can have the same id. Then the size shows
            // the direction, as for a connection whose ForwardOpen was not seen.
            (true, Some(_)) | (false, None) => None,
            (true, None) => Some(Direction::Sent),
            (false, Some(_)) => Some(Direction::Received),
        };
        let (direction, header, image) = match (known, cyclic.body.split_first_chunk::<4>()) {
            (known, Some((header, image))) if len == WITH_HEADER => {
                (known.unwrap_or(Direction::Sent), Some(u32::from_le_bytes(*header) & RUN == RUN), image)
            }
            (known, _) if len == Image::BYTES => (known.unwrap_or(Direction::Received), None, cyclic.body),
            // A known connection sends a heartbeat here. Other datagrams do not belong to a YRCX.
            (Some(_), _) => {
                images.count();
                return;
            }
            (None, _) => return,
        };
        let Some(image) = Image::from_bytes(image) else { return };
        images.count();
        let (client, controller) = match direction {
            Direction::Sent => (from.ip(), to.ip()),
            Direction::Received => (client.unwrap_or(to.ip()), from.ip()),
        };
        let link = (client.to_string(), controller.to_string());
        let flow = Flow { sequence: cyclic.sequence.wrapping_sub(1), lost: 0, run: None };
        let flow = self.flows.entry((from, to, cyclic.id)).or_insert(flow);
        let missing = cyclic.sequence.wrapping_sub(flow.sequence).wrapping_sub(1);
        if missing > u32::MAX / 2 {
            // The datagram is old or a duplicate.
            return;
        }
        flow.lost += u64::from(missing);
        flow.sequence = cyclic.sequence;
        let before = flow.run;
        flow.run = header.or(before);
        if let Some(run) = header
            && before != header
            && (before.is_some() || !run)
        {
            let text = if run { "run: outputs are valid" } else { "idle: outputs are ignored" };
            images.message(decoded(message, direction, link.clone(), text.to_owned()));
        }
        images.image(message, direction, &link, &image);
    }
}

impl BusDecoder for Decoder {
    fn take(&mut self, message: &Message<'_>, images: &mut Images) {
        match message.carrier {
            Carrier::Stream { from, to, begins, lost } => self.stream(message, (from, to), (begins, lost), images),
            Carrier::Datagram { from, to } if from.port() == PORT || to.port() == PORT => {
                if may_be_message(message.bytes) {
                    self.forget_if_many();
                    images.count();
                    self.encapsulated(message, (from, to), message.bytes, images);
                }
            }
            Carrier::Datagram { from, to } => self.cyclic(message, from, to, images),
            Carrier::Line { .. } | Carrier::Frame { .. } => {}
        }
    }

    fn finish(&mut self, images: &mut Images) {
        let mut lost: Vec<_> = std::mem::take(&mut self.flows).into_iter().filter(|(_, flow)| flow.lost > 0).collect();
        lost.sort_by_key(|(place, _)| *place);
        for ((from, to, _), flow) in lost {
            images.note(format!("{} cyclic packets from {from} to {to} are missing", flow.lost));
        }
    }
}
