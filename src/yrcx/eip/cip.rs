//! Descriptions of the EtherNet/IP messages before, during and after a connection.

use armctl_controller::yrcx::describe::FieldNote;
use armctl_transport::eip::status::{describe, encapsulation};
use armctl_transport::eip::wire::{
    Close, Command, Flow, Frame, HEADER_LEN, Identity, Net, Open, Opened, Path, Reply, Request, RrData, Segment,
    WireError, service,
};

/// A decoded message.
#[derive(Debug)]
pub struct EncapsulatedMessage {
    /// Description in one line.
    pub text: String,
    /// Fields of the message.
    pub fields: Vec<FieldNote>,
    /// Problem in the message, if any.
    pub problem: Option<String>,
    /// Whether the message is an answer.
    pub is_answer: bool,
    /// Ids of the connection that the message opened: to the controller, from the controller.
    pub opened: Option<(u32, u32)>,
}

const COMMANDS: [(Command, &str); 7] = [
    (Command::NOP, "NOP"),
    (Command::LIST_SERVICES, "ListServices"),
    (Command::LIST_IDENTITY, "ListIdentity"),
    (Command::LIST_INTERFACES, "ListInterfaces"),
    (Command::REGISTER_SESSION, "RegisterSession"),
    (Command::UNREGISTER_SESSION, "UnRegisterSession"),
    (Command::SEND_RR_DATA, "SendRRData"),
];

const SERVICES: [(u8, &str); 6] = [
    (service::ATTRIBUTES_ALL, "read all attributes"),
    (service::ATTRIBUTE_SINGLE, "read an attribute"),
    (service::SET_ATTRIBUTE_SINGLE, "write an attribute"),
    (service::FORWARD_CLOSE, "ForwardClose"),
    (service::FORWARD_OPEN, "ForwardOpen"),
    (service::LARGE_FORWARD_OPEN, "large ForwardOpen"),
];

fn command_name(command: Command) -> Option<&'static str> {
    COMMANDS.iter().find(|(known, _)| *known == command).map(|(_, name)| *name)
}

fn service_name(service: u8) -> String {
    let known = SERVICES.iter().find(|(known, _)| *known == service);
    known.map_or_else(|| format!("service {service:#04x}"), |(_, name)| (*name).to_owned())
}

/// Whether the bytes can be the start of a message.
pub fn may_be_message(bytes: &[u8]) -> bool {
    let Some(command) = bytes.first_chunk::<2>() else { return true };
    let command = Command(u16::from_le_bytes(*command));
    let is_known = command_name(command).is_some() || command == Command::SEND_UNIT_DATA;
    // The options field of a valid message is always 0.
    is_known && bytes.get(20..HEADER_LEN).is_none_or(|options| options == [0; 4])
}

/// Decodes a message. If the message has an error, the result contains the problem.
pub fn explain(bytes: &[u8]) -> EncapsulatedMessage {
    let frame = match Frame::parse(bytes) {
        Ok(frame) => frame,
        Err(error) => return broken("incomplete message", false, &error),
    };
    let name = command_name(frame.command).unwrap_or("SendUnitData");
    let head = vec![
        field("command", format!("{:#06x}", frame.command.0), name),
        field("session", format!("{:#010x}", frame.session), ""),
        field(
            "status",
            format!("{:#x}", frame.status),
            encapsulation(frame.status).map_or("unknown", |code| code.name),
        ),
    ];
    let mut message = match frame.command {
        Command::SEND_RR_DATA if frame.status == 0 => unconnected(&frame),
        Command::LIST_IDENTITY if !frame.data.is_empty() => identity(&frame),
        command => {
            let is_request = match command {
                Command::REGISTER_SESSION => frame.session == 0 && frame.status == 0,
                Command::UNREGISTER_SESSION | Command::NOP => true,
                _ => frame.data.is_empty() && frame.status == 0,
            };
            plain(if is_request { name.to_owned() } else { format!("answer to {name}") }, !is_request)
        }
    };
    if frame.status != 0 {
        let why = encapsulation(frame.status).map_or("an unknown status", |code| code.name);
        message.text = format!("{}: refused, {why} ({:#x})", message.text, frame.status);
    }
    message.fields = head.into_iter().chain(message.fields).collect();
    message
}

fn plain(text: String, is_answer: bool) -> EncapsulatedMessage {
    EncapsulatedMessage { text, fields: Vec::new(), problem: None, is_answer, opened: None }
}

fn broken(text: &str, is_answer: bool, error: &WireError) -> EncapsulatedMessage {
    EncapsulatedMessage { problem: Some(error.to_string()), ..plain(text.to_owned(), is_answer) }
}

fn field(name: &str, raw: impl Into<String>, meaning: impl Into<String>) -> FieldNote {
    FieldNote::of_message("-", name, raw.into(), &meaning.into())
}

/// Decodes a ListIdentity answer.
fn identity(frame: &Frame<'_>) -> EncapsulatedMessage {
    let message = plain("answer to ListIdentity".to_owned(), true);
    match Identity::parse(frame.data) {
        Ok(Some(found)) => EncapsulatedMessage {
            text: format!("{}: {} at {}", message.text, found.name, found.address.ip()),
            fields: vec![
                field("product name", found.name.clone(), ""),
                field("address", found.address.to_string(), ""),
                field("vendor", found.vendor.to_string(), ""),
                field("product code", found.product.to_string(), ""),
                field("revision", format!("{}.{}", found.revision.major, found.revision.minor), ""),
                field("serial number", format!("{:#010x}", found.serial), ""),
            ],
            ..message
        },
        Ok(None) => message,
        Err(error) => EncapsulatedMessage { problem: Some(error.to_string()), ..message },
    }
}

/// Decodes an unconnected CIP message.
fn unconnected(frame: &Frame<'_>) -> EncapsulatedMessage {
    let message = match RrData::parse_answer(frame.data) {
        Ok(data) => data.message,
        Err(error) => return broken("SendRRData", false, &error),
    };
    if message.first().is_some_and(|first| first & service::REPLY != 0) {
        match Reply::parse(message) {
            Ok(reply) => reply_in_words(&reply),
            Err(error) => broken("answer to SendRRData", true, &error),
        }
    } else {
        match Request::parse(message) {
            Ok(request) => request_in_words(&request),
            Err(error) => broken("SendRRData", false, &error),
        }
    }
}

fn request_in_words(request: &Request<'_>) -> EncapsulatedMessage {
    let name = service_name(request.service);
    let path = path_text(&request.path);
    let asked = |text: String, fields: Vec<FieldNote>| EncapsulatedMessage { fields, ..plain(text, false) };
    match request.service {
        service::FORWARD_OPEN | service::LARGE_FORWARD_OPEN => {
            match Open::parse(request.data, request.service == service::LARGE_FORWARD_OPEN) {
                Ok(open) => {
                    let text = format!(
                        "{name}: connection {:#06x}, {} to the controller, {} back",
                        open.triad.serial,
                        flow_text(&open.o_t),
                        flow_text(&open.t_o)
                    );
                    let timeout = 4u32 << open.multiplier.min(7);
                    asked(
                        text,
                        vec![
                            field("connection", format!("{:#06x}", open.triad.serial), ""),
                            field("id back", format!("{:#010x}", open.t_o_id), ""),
                            field("to the controller", format!("{} bytes", open.o_t.size), flow_text(&open.o_t)),
                            field("back", format!("{} bytes", open.t_o.size), flow_text(&open.t_o)),
                            field("time-out", open.multiplier.to_string(), format!("{timeout} intervals")),
                            field(
                                "transport",
                                format!("{:#04x}", open.transport),
                                format!("class {}", open.transport & 15),
                            ),
                            field("path", "", path_text(&open.path)),
                        ],
                    )
                }
                Err(error) => broken(&name, false, &error),
            }
        }
        service::FORWARD_CLOSE => match Close::parse(request.data) {
            Ok(close) => asked(
                format!("{name}: connection {:#06x}", close.triad.serial),
                vec![
                    field("connection", format!("{:#06x}", close.triad.serial), ""),
                    field("path", "", path_text(&close.path)),
                ],
            ),
            Err(error) => broken(&name, false, &error),
        },
        _ => asked(format!("{name} of {path}"), vec![field("service", format!("{:#04x}", request.service), path)]),
    }
}

fn reply_in_words(reply: &Reply<'_>) -> EncapsulatedMessage {
    let name = service_name(reply.service);
    let status = field("general status", format!("{:#04x}", reply.status.general), describe(&reply.status));
    if !reply.status.is_ok() {
        let text = format!("answer to {name}: refused, {}", describe(&reply.status));
        return EncapsulatedMessage { fields: vec![status], ..plain(text, true) };
    }
    let done = EncapsulatedMessage { fields: vec![status], ..plain(format!("answer to {name}: done"), true) };
    if !matches!(reply.service, service::FORWARD_OPEN | service::LARGE_FORWARD_OPEN) {
        return done;
    }
    match Opened::parse(reply.data) {
        Ok(opened) => {
            let Opened { o_t_id, t_o_id, o_t_api_us, t_o_api_us, .. } = opened;
            let mut fields = done.fields;
            fields.push(field("id to the controller", format!("{o_t_id:#010x}"), interval(o_t_api_us)));
            fields.push(field("id back", format!("{t_o_id:#010x}"), interval(t_o_api_us)));
            EncapsulatedMessage {
                text: format!("answer to {name}: opened, {o_t_id:#010x} to the controller, {t_o_id:#010x} back"),
                fields,
                opened: Some((o_t_id, t_o_id)),
                ..plain(String::new(), true)
            }
        }
        Err(error) => EncapsulatedMessage { problem: Some(error.to_string()), ..done },
    }
}

fn interval(micros: u32) -> String {
    format!("every {}.{:03} ms", micros / 1000, micros % 1000)
}

fn flow_text(flow: &Flow) -> String {
    let net = match flow.net {
        Net::Null => ", no connection",
        Net::Multicast => ", multicast",
        Net::PointToPoint => "",
        Net::Reserved => ", reserved type",
    };
    format!("{} bytes {}{net}", flow.size, interval(flow.rpi_us))
}

fn path_text(path: &Path) -> String {
    let segment = |segment: &Segment| match segment {
        Segment::Class(class) => format!("class {class:#04x}"),
        Segment::Instance(instance) => format!("instance {instance}"),
        Segment::Attribute(attribute) => format!("attribute {attribute}"),
        Segment::Point(point) => format!("assembly {point}"),
        Segment::Key(key) => format!("key {}/{}/{}", key.vendor, key.device_type, key.product),
        Segment::Data(data) => format!("{} bytes of configuration", data.len()),
        Segment::Port { port, .. } => format!("port {port}"),
    };
    path.0.iter().map(segment).collect::<Vec<_>>().join(", ")
}
