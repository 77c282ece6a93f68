//! PROFIBUS in a capture: images, and the telegrams around them.

use crate::command::decode::capture::DecodedMessage;
use crate::command::yrcx::decode::images::{BusDecoder, Images, decoded};
use crate::controller::text::hex;
use crate::controller::yrcx::image::Image;
use crate::transport::capture::{Carrier, Message};
use crate::transport::profibus::wire::{
    Configuration, Control, Diagnosis, Frame, GlobalControl, Lock, Parameters, Parsed, Service, Telegram, WireError,
    sap,
};
use crate::transport::tap::{Direction, LINKTYPE_PROFIBUS_DL};

/// What is known of the line.
#[derive(Debug, Default)]
pub struct Decoder {
    tokens: u64,
    damaged: u64,
}

impl BusDecoder for Decoder {
    fn take(&mut self, message: &Message<'_>, images: &mut Images) {
        if message.carrier != (Carrier::Frame { link_type: LINKTYPE_PROFIBUS_DL }) {
            return;
        }
        images.count();
        match Telegram::parse(message.bytes) {
            Ok(Parsed::Whole(Telegram::Token { .. }, _)) => self.tokens += 1,
            Ok(Parsed::Whole(Telegram::ShortAcknowledge, _)) => {
                let link = ("master".to_owned(), "slave".to_owned());
                images.message(decoded(message, Direction::Received, link, "acknowledged".to_owned()));
            }
            Ok(Parsed::Whole(Telegram::Frame(frame), _)) => self::frame(message, &frame, images),
            Ok(Parsed::Part(_)) | Err(_) => self.damaged += 1,
        }
    }

    fn finish(&mut self, images: &mut Images) {
        if self.tokens > 0 {
            images.note(format!("{} tokens", self.tokens));
        }
        if self.damaged > 0 {
            images.note(format!("{} pieces are no telegram, or a damaged one", self.damaged));
        }
    }
}

/// A telegram with a function code.
fn frame(message: &Message<'_>, frame: &Frame, images: &mut Images) {
    let is_answer = matches!(frame.control, Control::Answer(..));
    let (direction, master, slave) =
        if is_answer { (Direction::Received, frame.to, frame.from) } else { (Direction::Sent, frame.from, frame.to) };
    let link = (format!("station {master}"), format!("station {slave}"));
    let service = if is_answer { frame.from_sap } else { frame.to_sap };
    let is_exchange = service.is_none() && !frame.data.is_empty();
    if is_exchange && let Some(image) = Image::from_link(&frame.data) {
        return images.image(message, direction, &link, &image);
    }
    let mut text = match frame.control {
        Control::Request(Service::FdlStatus, _) => "are you there?".to_owned(),
        Control::Request(..) => sap::name(service).to_owned(),
        Control::Answer(_, status) if service.is_none() => format!("answer: {}", status.text()),
        Control::Answer(_, status) => format!("answer to {}: {}", sap::name(service), status.text()),
    };
    if let Some(about) = about(frame, service) {
        text = format!("{text}: {about}");
    }
    images.message(DecodedMessage { raw: hex(message.bytes), ..decoded(message, direction, link, text) });
}

/// What the data of a telegram say.
fn about(frame: &Frame, service: Option<u8>) -> Option<String> {
    if frame.data.is_empty() {
        return None;
    }
    let unread = |error: WireError| format!("cannot be read: {error}");
    Some(match service? {
        sap::SLAVE_DIAG => Diagnosis::parse(&frame.data).map_or_else(unread, |diagnosis| diagnosis.to_string()),
        sap::GLOBAL_CONTROL => GlobalControl::parse(&frame.data).map_or_else(unread, |control| control.to_string()),
        sap::GET_CFG | sap::CHK_CFG => Configuration::parse(&frame.data).map_or_else(unread, |configuration| {
            let (input, output) = (configuration.input(), configuration.output());
            format!("{}, {input} bytes from the slave, {output} to it", hex(configuration.bytes()))
        }),
        sap::SET_PRM => Parameters::parse(&frame.data).map_or_else(unread, |parameters| {
            let lock = match parameters.lock {
                Lock::Lock => "lock",
                Lock::Unlock => "unlock",
                Lock::Unchanged => "times only",
            };
            let watchdog = parameters.watchdog.map_or_else(
                || "no watchdog".to_owned(),
                |watchdog| format!("watchdog {} ms", watchdog.time().as_millis()),
            );
            format!("{lock}, {watchdog}, ident {:#06x}, user parameters '{}'", parameters.ident, hex(&parameters.user))
        }),
        _ => hex(&frame.data),
    })
}
