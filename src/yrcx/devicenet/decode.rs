//! DeviceNet decoder for captures: images in polls, and explicit messages.

use std::collections::HashMap;

use crate::decode::images::{BusDecoder, Images, decoded};
use armctl_controller::yrcx::image::Image;
use armctl_frame::decode::capture::DecodedMessage;
use armctl_transport::capture::{Carrier, LINKTYPE_CAN, Message};
use armctl_transport::devicenet::can::Frame;
use armctl_transport::devicenet::monitor::{Monitor, describe};
use armctl_transport::devicenet::wire::{Answer, Format, Header, Id, Mac, Request, general, service};
use armctl_transport::tap::Direction;

/// State of the decoder.
#[derive(Debug, Default)]
pub struct Decoder {
    monitor: Monitor,
    /// Last request to each node: the packet number and the master that sent it.
    pending_requests: HashMap<Mac, (u64, Mac)>,
}

impl Decoder {
    fn frame(&mut self, message: &Message<'_>, frame: &Frame, images: &mut Images) {
        let Some(id) = Id::parse(frame.id()) else { return };
        images.count();
        match id {
            Id::Poll(mac) | Id::PollAnswer(mac) => {
                let direction = if id == Id::Poll(mac) { Direction::Sent } else { Direction::Received };
                if let Some((_, _, image)) = self.monitor.handle_frame(message.time, frame)
                    && let Some(image) = Image::from_link(&image)
                {
                    images.image(message, direction, &link(self.master(mac), mac), &image);
                }
            }
            Id::Request(mac) | Id::Unconnected(mac) => {
                let Some(header) = frame.data().first().map(|first| Header::parse(*first)) else { return };
                self.pending_requests.insert(mac, (message.number, header.mac));
                self.add_message(message, frame, Direction::Sent, mac, images);
            }
            Id::Answer(mac) => self.add_message(message, frame, Direction::Received, mac, images),
            Id::Duplicate(mac) => {
                let text = format!("{}: {}", describe(frame), if is_taken(frame) { "taken" } else { "free?" });
                images.message(decoded(message, Direction::Sent, link(None, mac), text));
            }
            _ => images.message(decoded(message, Direction::Received, link(None, Mac::default()), describe(frame))),
        }
    }

    /// Returns the master that sent the last request to a node.
    fn master(&self, mac: Mac) -> Option<Mac> {
        self.pending_requests.get(&mac).map(|(_, master)| *master)
    }

    /// Handles an explicit message.
    fn add_message(&self, message: &Message<'_>, frame: &Frame, direction: Direction, mac: Mac, images: &mut Images) {
        let Some((first, body)) = frame.data().split_first() else { return };
        let text = if Header::parse(*first).is_fragment {
            format!("{}, a fragment", describe(frame))
        } else {
            explicit(body).unwrap_or_else(|| describe(frame))
        };
        let link = link(self.master(mac), mac);
        let answered =
            self.pending_requests.get(&mac).map(|(number, _)| *number).filter(|_| direction == Direction::Received);
        images.message(DecodedMessage { answers: answered, ..decoded(message, direction, link, text) });
    }
}

impl BusDecoder for Decoder {
    fn take(&mut self, message: &Message<'_>, images: &mut Images) {
        if message.carrier == (Carrier::Frame { link_type: LINKTYPE_CAN })
            && let Some(frame) = Frame::from_capture(message.bytes)
        {
            self.frame(message, &frame, images);
        }
    }

    fn finish(&mut self, _images: &mut Images) {}
}

/// Names of master and slave in the table of links.
fn link(master: Option<Mac>, slave: Mac) -> (String, String) {
    (master.map_or_else(|| "master".to_owned(), |mac| format!("MAC {mac}")), format!("MAC {slave}"))
}

fn is_taken(frame: &Frame) -> bool {
    frame.data().first().is_some_and(|first| first & 0x80 != 0)
}

/// Describes an explicit message.
fn explicit(body: &[u8]) -> Option<String> {
    if let Some(request) = Request::parse(Format::Byte8Byte8, body) {
        let what = service_name(request.service);
        return Some(format!(
            "{what}, class {}, instance {}, {}",
            request.class,
            request.instance,
            data(&request.data)
        ));
    }
    Some(match Answer::parse(body)? {
        Answer::Done { service, data: done } => format!("answer to {}, {}", service_name(service), data(&done)),
        Answer::Refused { general, additional } => {
            format!("refused: {} (general {general:#04x}, additional {additional:#04x})", general::meaning(general))
        }
    })
}

fn data(bytes: &[u8]) -> String {
    if bytes.is_empty() { "no data".to_owned() } else { format!("data {}", armctl_controller::text::hex(bytes)) }
}

fn service_name(code: u8) -> String {
    match code {
        service::RESET => "Reset".to_owned(),
        service::GET => "Get_Attribute_Single".to_owned(),
        service::SET => "Set_Attribute_Single".to_owned(),
        service::ALLOCATE => "Allocate".to_owned(),
        service::RELEASE => "Release".to_owned(),
        service::HEARTBEAT => "Heartbeat".to_owned(),
        service::SHUTDOWN => "Shutdown".to_owned(),
        _ => format!("service {code:#04x}"),
    }
}
