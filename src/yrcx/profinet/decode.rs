//! PROFINET decoder for captures: images, calls, alarms and DCP.

use std::collections::HashMap;

use crate::decode::images::{BusDecoder, Images, MAX_STORED, decoded};
use armctl_controller::text::hex;
use armctl_controller::yrcx::image::Image;
use armctl_frame::decode::capture::DecodedMessage;
use armctl_transport::capture::{Carrier, LINKTYPE_ETHERNET, Message};
use armctl_transport::profinet::wire::alarm::{Acknowledgement, Notification, Pdu, Priority, Rta};
use armctl_transport::profinet::wire::block::Control;
use armctl_transport::profinet::wire::connect::{ExpectedModule, Iocr, Request, Response};
use armctl_transport::profinet::wire::cyclic::{Cyclic, GOOD, describe_status};
use armctl_transport::profinet::wire::dcp::{self, Dcp, IpSuite, Service, Setting};
use armctl_transport::profinet::wire::frame::{Frame, id};
use armctl_transport::profinet::wire::record::Record;
use armctl_transport::profinet::wire::rpc::{self, Call, Datagram, Header, Kind, PORT, Reply, operation};
use armctl_transport::profinet::wire::status::Status;
use armctl_transport::profinet::wire::{Mac, Uuid, block};
use armctl_transport::tap::Direction;

/// State of the decoder.
#[derive(Debug, Default)]
pub struct Decoder {
    /// Pending calls by activity and sequence number.
    calls: HashMap<(Uuid, u32), (u64, Vec<Request>)>,
    /// Cyclic data by MAC addresses and frame id.
    streams: HashMap<(Mac, Mac, u16), Stream>,
    /// Number of cyclic frames that cannot be decoded because the Connect call of their connection is not in the
    /// capture.
    unknown: u64,
    unreadable: u64,
}

/// Cyclic data of one direction.
#[derive(Debug)]
struct Stream {
    direction: Direction,
    /// Names of controller and device.
    link: (String, String),
    length: usize,
    /// Offset and length of each part of the image. A status byte follows each part.
    data_ranges: Vec<(usize, usize)>,
    /// Problem of the data that was reported last.
    last_error: Option<String>,
}

impl BusDecoder for Decoder {
    fn take(&mut self, message: &Message<'_>, images: &mut Images) {
        match message.carrier {
            Carrier::Frame { link_type: LINKTYPE_ETHERNET } => {
                let Ok(frame) = Frame::parse(message.bytes) else { return };
                images.count();
                self.frame(message, &frame, images);
            }
            Carrier::Datagram { from, to } if from.port() == PORT || to.port() == PORT => {
                let Ok(datagram) = Datagram::parse(message.bytes) else { return };
                images.count();
                self.call(message, (from.ip().to_string(), to.ip().to_string()), &datagram, images);
            }
            _ => {}
        }
    }

    fn finish(&mut self, images: &mut Images) {
        if self.unknown > 0 {
            images.note(format!(
                "{} cyclic frames cannot be decoded: the capture has no Connect answer before them",
                self.unknown
            ));
        }
        if self.unreadable > 0 {
            images.note(format!("{} PROFINET frames cannot be decoded", self.unreadable));
        }
    }
}

impl Decoder {
    fn frame(&mut self, message: &Message<'_>, frame: &Frame<'_>, images: &mut Images) {
        let link = |direction| match direction {
            Direction::Sent => (frame.source.to_string(), frame.destination.to_string()),
            Direction::Received => (frame.destination.to_string(), frame.source.to_string()),
        };
        if let Some(priority) = Priority::from_frame_id(frame.id) {
            let is_device = self.streams.iter().any(|((from, to, _), stream)| {
                (*from, *to) == (frame.source, frame.destination) && stream.direction == Direction::Received
            });
            let direction = if is_device { Direction::Received } else { Direction::Sent };
            match Rta::parse(frame.payload) {
                Ok(rta) => add_message(message, direction, link(direction), alarm(priority, &rta), images),
                Err(_) => self.unreadable += 1,
            }
            return;
        }
        match frame.id {
            id::DCP_HELLO..=id::DCP_IDENTIFIED => match Dcp::parse(frame.payload) {
                Ok(dcp) => {
                    let is_question = dcp.kind == dcp::Kind::Request && dcp.service != Service::Hello;
                    let direction = if is_question { Direction::Sent } else { Direction::Received };
                    add_message(message, direction, link(direction), station(&dcp), images);
                }
                Err(_) => self.unreadable += 1,
            },
            _ => match self.streams.get_mut(&(frame.source, frame.destination, frame.id)) {
                Some(stream) => stream.take(message, frame.payload, images),
                None => self.unknown += 1,
            },
        }
    }

    /// Adds a datagram of an RPC call. The controller calls the device. For ApplicationReady, the device calls the
    /// controller.
    fn call(&mut self, message: &Message<'_>, ends: (String, String), datagram: &Datagram<'_>, images: &mut Images) {
        let header = &datagram.header;
        let (key, name) = ((header.activity, header.sequence), name(header));
        let is_call = header.kind == Kind::REQUEST;
        let (text, answers) = match header.kind {
            Kind::REQUEST if header.is_fragment() => (format!("{name}, a fragment"), None),
            Kind::REQUEST => {
                let (about, requests) = request(header, datagram.body);
                if self.calls.len() >= MAX_STORED {
                    self.calls.clear();
                }
                self.calls.insert(key, (message.number, requests));
                (format!("{name}{about}"), None)
            }
            Kind::RESPONSE => {
                let asked = self.calls.remove(&key);
                let about = self.answered(header, datagram.body, asked.as_ref());
                (format!("{name} answered: {about}"), asked.map(|(number, _)| number))
            }
            Kind(kind) => (format!("{name}: RPC {}", kind_name(kind)), None),
        };
        let is_from_controller = is_call == (header.interface != rpc::CONTROLLER);
        let direction = if is_from_controller { Direction::Sent } else { Direction::Received };
        let (from, to) = ends;
        let link = if is_from_controller { (from, to) } else { (to, from) };
        images.message(DecodedMessage { answers, ..decoded(message, direction, link, text) });
    }

    /// Describes an answer. A Connect answer also defines the streams.
    fn answered(&mut self, header: &Header, body: &[u8], asked: Option<&(u64, Vec<Request>)>) -> String {
        let reply = match Reply::parse(body, header.order) {
            Ok(reply) => reply,
            Err(error) => return format!("invalid: {error}"),
        };
        if reply.status != 0 {
            return Status(reply.status).to_string();
        }
        match header.operation {
            operation::CONNECT => match (Response::parse_all(reply.blocks), asked) {
                (Ok(responses), Some((_, requests))) => {
                    self.connected(requests, &responses);
                    describe_connected(&responses)
                }
                (Ok(responses), None) => describe_connected(&responses),
                (Err(error), _) => format!("invalid: {error}"),
            },
            operation::READ | operation::READ_IMPLICIT => match Record::parse_answer(reply.blocks) {
                Ok((record, bytes)) => format!("record {:#06x}, {} bytes", record.index, bytes.len()),
                Err(error) => format!("invalid: {error}"),
            },
            _ => "done".to_owned(),
        }
    }

    fn connected(&mut self, requests: &[Request], responses: &[Response]) {
        let ar = requests.iter().find_map(|request| match request {
            Request::Ar(ar) => Some(ar),
            _ => None,
        });
        let device = responses.iter().find_map(|response| match response {
            Response::Ar { mac, .. } => Some(*mac),
            _ => None,
        });
        let (Some(ar), Some(device)) = (ar, device) else { return };
        let modules: Vec<&ExpectedModule> = requests
            .iter()
            .filter_map(|request| match request {
                Request::Expected(modules) => Some(modules),
                _ => None,
            })
            .flatten()
            .collect();
        for request in requests {
            let Request::Iocr(iocr) = request else { continue };
            let frame_id = responses.iter().find_map(|response| match response {
                Response::Iocr { reference, frame_id, .. } if *reference == iocr.reference => Some(*frame_id),
                _ => None,
            });
            let Some(frame_id) = frame_id else { continue };
            let direction = if iocr.kind == 1 { Direction::Received } else { Direction::Sent };
            let (from, to) = if iocr.kind == 1 { (device, ar.mac) } else { (ar.mac, device) };
            let stream = Stream {
                direction,
                link: (ar.mac.to_string(), device.to_string()),
                length: iocr.length.into(),
                data_ranges: data_ranges(iocr, &modules),
                last_error: None,
            };
            if self.streams.len() >= MAX_STORED {
                self.streams.clear();
            }
            self.streams.insert((from, to, frame_id), stream);
        }
    }
}

impl Stream {
    fn take(&mut self, message: &Message<'_>, payload: &[u8], images: &mut Images) {
        let (image, last_error) = match self.image(payload) {
            Ok(image) => (Some(image), None),
            Err(why) => (None, Some(why)),
        };
        if last_error != self.last_error {
            let text =
                last_error.as_ref().map_or("data is valid again".to_owned(), |why| format!("data ignored: {why}"));
            add_message(message, self.direction, self.link.clone(), text, images);
            self.last_error = last_error;
        }
        if let Some(image) = image.and_then(|bytes| Image::from_link(&bytes)) {
            images.image(message, self.direction, &self.link, &image);
        }
    }

    /// Returns the image in a frame, or the reason why the image is not valid.
    fn image(&self, payload: &[u8]) -> Result<Vec<u8>, String> {
        let cyclic = Cyclic::parse(payload, self.length).map_err(|error| error.to_string())?;
        if !cyclic.is_usable() {
            return Err(describe_status(cyclic.status, cyclic.transfer).to_owned());
        }
        let mut image = Vec::new();
        for (at, length) in &self.data_ranges {
            let end = at + length;
            if cyclic.data.get(end).is_none_or(|status| status & GOOD == 0) {
                return Err(format!("the sender marks the data from byte {at} as bad (IOPS)"));
            }
            image.extend_from_slice(&cyclic.data[*at..end]);
        }
        Ok(image)
    }
}

/// Returns offset and length of the data of each submodule, in the order of the slots.
fn data_ranges(iocr: &Iocr, modules: &[&ExpectedModule]) -> Vec<(usize, usize)> {
    let length = |slot: u16, subslot: u16| {
        let of_slot = modules.iter().filter(|module| module.slot == slot).flat_map(|module| &module.submodules);
        let data = of_slot.filter(|submodule| submodule.subslot == subslot).flat_map(|submodule| &submodule.data);
        data.filter(|data| data.direction == iocr.kind).map(|data| usize::from(data.length)).sum::<usize>()
    };
    let mut objects = iocr.objects.clone();
    objects.sort_by_key(|object| (object.slot, object.subslot));
    let data_ranges = objects.iter().map(|object| (usize::from(object.offset), length(object.slot, object.subslot)));
    data_ranges.filter(|(_, length)| *length > 0).collect()
}

fn add_message(message: &Message<'_>, direction: Direction, link: (String, String), text: String, images: &mut Images) {
    images.message(DecodedMessage { raw: hex(message.bytes), ..decoded(message, direction, link, text) });
}

fn name(header: &Header) -> &'static str {
    match header.operation {
        operation::CONNECT => "Connect",
        operation::RELEASE => "Release",
        operation::READ => "Read",
        operation::WRITE => "Write",
        operation::CONTROL => "Control",
        operation::READ_IMPLICIT => "ReadImplicit",
        _ => "a call",
    }
}

/// Returns the name of a packet type other than call and answer.
fn kind_name(kind: u8) -> &'static str {
    match Kind(kind) {
        Kind::PING => "ping",
        Kind::FAULT => "fault",
        Kind::WORKING => "working",
        Kind::NO_CALL => "no call",
        Kind::REJECT => "reject",
        Kind::ACK | Kind::FRAGMENT_ACK => "acknowledged",
        _ => "unknown type",
    }
}

/// Describes a call. Also returns its blocks, which are needed to decode the answer.
fn request(header: &Header, body: &[u8]) -> (String, Vec<Request>) {
    let unread = |error| (format!(": invalid: {error}"), Vec::new());
    let call = match Call::parse(body, header.order) {
        Ok(call) => call,
        Err(error) => return unread(error),
    };
    match header.operation {
        operation::CONNECT => match Request::parse_all(call.blocks) {
            Ok(requests) => (describe_connect(&requests), requests),
            Err(error) => unread(error),
        },
        operation::READ | operation::READ_IMPLICIT | operation::WRITE => {
            let kind =
                if header.operation == operation::WRITE { block::BlockType::WRITE } else { block::BlockType::READ };
            match Record::parse(call.blocks, kind) {
                Ok((record, _)) => {
                    let Record { slot, subslot, index, .. } = record;
                    (format!(" record {index:#06x} of slot {slot}, subslot {subslot:#x}"), Vec::new())
                }
                Err(error) => unread(error),
            }
        }
        operation::CONTROL => {
            let what = block::walk(call.blocks).ok().and_then(|blocks| {
                let control = Control::parse(blocks.first()?).ok()?;
                Some(match control.kind {
                    block::BlockType::PRM_END | block::BlockType::PLUG_PRM_END => " PrmEnd",
                    block::BlockType::APPLICATION_READY | block::BlockType::PLUG_APPLICATION_READY => {
                        " ApplicationReady"
                    }
                    _ => "",
                })
            });
            (what.unwrap_or_default().to_owned(), Vec::new())
        }
        _ => (String::new(), Vec::new()),
    }
}

fn describe_connect(requests: &[Request]) -> String {
    let mut parts = Vec::new();
    for request in requests {
        match request {
            Request::Ar(ar) => parts.push(format!("controller '{}'", ar.name)),
            Request::Iocr(iocr) if iocr.kind == 1 => {
                let cycle = u32::from(iocr.send_clock) * u32::from(iocr.ratio);
                // The unit is 31.25 us, which is 1/32 ms.
                let ms = f64::from(cycle) / 32.0;
                parts.push(format!("every {ms} ms, watchdog {} ms", ms * f64::from(iocr.watchdog)));
            }
            Request::Expected(modules) => {
                parts.extend(modules.iter().map(|module| format!("slot {} {:#x}", module.slot, module.ident)));
            }
            _ => {}
        }
    }
    format!(": {}", parts.join(", "))
}

fn describe_connected(responses: &[Response]) -> String {
    let differing = responses.iter().find_map(|response| match response {
        Response::ModuleDiff(modules) => Some(modules),
        _ => None,
    });
    let Some(modules) = differing else { return "done".to_owned() };
    let modules: Vec<String> =
        modules.iter().map(|module| format!("slot {} holds {:#x}", module.slot, module.ident)).collect();
    format!("done, but modules differ: {}", modules.join(", "))
}

fn alarm(priority: Priority, rta: &Rta) -> String {
    let level = if priority == Priority::High { "high" } else { "low" };
    match &rta.pdu {
        Pdu::Ack => format!("alarm ({level}): frame acknowledged"),
        Pdu::Nack => format!("alarm ({level}): frame rejected"),
        Pdu::Error(status) => format!("the connection ends: {}", Status(*status)),
        Pdu::Data(data) => match (Notification::parse(data), Acknowledgement::parse(data)) {
            (Ok(alarm), _) => format!("alarm ({level}): {}", alarm.describe()),
            (_, Ok(_)) => format!("alarm ({level}): noted"),
            _ => format!("alarm ({level}): {}", hex(data)),
        },
    }
}

/// Text of a DCP frame.
fn station(dcp: &Dcp) -> String {
    let service = match dcp.service {
        Service::Get => "DCP Get",
        Service::Set => "DCP Set",
        Service::Identify => "DCP Identify",
        Service::Hello => "DCP Hello",
    };
    if dcp.kind == dcp::Kind::Unsupported {
        return format!("{service}: not supported");
    }
    if dcp.kind == dcp::Kind::Response && dcp.service == Service::Set {
        let outcomes = dcp.outcomes();
        let said: Vec<String> = outcomes
            .iter()
            .map(|(setting, error)| format!("{} {}", setting_name(*setting), dcp::describe_error(*error)))
            .collect();
        return format!("{service} answered: {}", said.join(", "));
    }
    if dcp.kind == dcp::Kind::Response || dcp.service == Service::Hello {
        let Ok(station) = dcp.station() else { return format!("{service} answered") };
        let address = station.address().map_or_else(|| "no address".to_owned(), |address| address.to_string());
        return format!("{service} answered: '{}', {}, {address}", station.name, station.kind);
    }
    let asked: Vec<String> = dcp.blocks.iter().map(|block| request_block_text(dcp.service, block)).collect();
    format!("{service}: {}", asked.join(", "))
}

/// Text of a block in a request.
fn request_block_text(service: Service, block: &dcp::Block) -> String {
    let name = setting_name(block.setting);
    // In a Set request, a qualifier of two bytes precedes the value.
    let value = if service == Service::Set { block.data.get(2..).unwrap_or_default() } else { &block.data[..] };
    match block.setting {
        Setting::NAME | Setting::ALIAS | Setting::STATION_TYPE if !value.is_empty() => {
            format!("{name} '{}'", value.escape_ascii())
        }
        Setting::IP => match IpSuite::parse(value) {
            Ok(suite) => format!("{name} {} mask {}", suite.address, suite.mask),
            Err(_) => name.to_owned(),
        },
        _ => name.to_owned(),
    }
}

fn setting_name(setting: Setting) -> &'static str {
    match setting {
        Setting::MAC => "card",
        Setting::IP => "address",
        Setting::STATION_TYPE => "type",
        Setting::NAME => "name",
        Setting::DEVICE_ID => "vendor and device",
        Setting::ROLE => "role",
        Setting::OPTIONS => "settings",
        Setting::ALIAS => "alias",
        Setting::SIGNAL => "blink",
        Setting::RESET => "reset",
        Setting::ALL => "all stations",
        _ => "a setting",
    }
}
