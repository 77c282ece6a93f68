//! PROFIBUS decoder for captures: images and other telegrams.

use crate::decode::images::{BusDecoder, Images, decoded};
use armctl_controller::text::hex;
use armctl_controller::yrcx::image::Image;
use armctl_frame::decode::capture::DecodedMessage;
use armctl_transport::capture::{Carrier, Message};
use armctl_transport::profibus::wire::{
    Configuration, Control, Diagnosis, Frame, GlobalControl, Lock, Parameters, Parsed, START, Service, Telegram,
    WireError, sap,
};
use armctl_transport::tap::{Direction, LINKTYPE_PROFIBUS_DL};

/// State of the decoder.
#[derive(Debug, Default)]
pub struct Decoder {
    tokens: u64,
    /// Number of bytes that do not start a telegram.
    noise: usize,
    /// Pending request: packet number, master, slave.
    pending_requests: Option<(u64, u8, u8)>,
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
                let decoded = decoded(message, Direction::Received, self.link(), "acknowledged".to_owned());
                let answers = self.pending_requests.take().map(|(number, ..)| number);
                images.message(DecodedMessage { answers, raw: hex(message.bytes), ..decoded });
            }
            Ok(Parsed::Whole(Telegram::Frame(frame), _)) => self.frame(message, &frame, images),
            Ok(Parsed::Part(needed)) => {
                self.damaged(message, &format!("needs {needed} bytes, has {}", message.bytes.len()), images);
            }
            Err(error) if error.field == START => self.noise += message.bytes.len(),
            Err(error) => self.damaged(message, &error.to_string(), images),
        }
    }

    fn finish(&mut self, images: &mut Images) {
        if self.tokens > 0 {
            images.note(format!("tokens: {}", self.tokens));
        }
        if self.noise > 0 {
            images.note(format!("bytes outside of telegrams: {}", self.noise));
        }
    }
}

impl Decoder {
    /// Handles a telegram with a function code.
    fn frame(&mut self, message: &Message<'_>, frame: &Frame, images: &mut Images) {
        let is_answer = matches!(frame.control, Control::Answer(..));
        let (direction, master, slave) = if is_answer {
            (Direction::Received, frame.to, frame.from)
        } else {
            (Direction::Sent, frame.from, frame.to)
        };
        let pending_requests = if is_answer {
            self.pending_requests.take()
        } else {
            self.pending_requests.replace((message.number, master, slave))
        };
        let pending_requests = pending_requests
            .filter(|pending_requests| is_answer && (pending_requests.1, pending_requests.2) == (master, slave));
        let link = link(master, slave);
        let service = if is_answer { frame.from_sap } else { frame.to_sap };
        let is_exchange = service.is_none() && !frame.data.is_empty();
        if is_exchange && let Some(image) = Image::from_link(&frame.data) {
            return images.image(message, direction, &link, &image);
        }
        let mut text = match frame.control {
            Control::Request(Service::FdlStatus, _) => "FDL status request".to_owned(),
            Control::Request(..) => sap::name(service).to_owned(),
            Control::Answer(_, status) if service.is_none() => format!("answer: {}", status.text()),
            Control::Answer(_, status) => format!("answer to {}: {}", sap::name(service), status.text()),
        };
        if let Some(about) = about(frame, service) {
            text = format!("{text}: {about}");
        }
        let answers = pending_requests.map(|(number, ..)| number);
        let decoded = decoded(message, direction, link, text);
        images.message(DecodedMessage { answers, raw: hex(message.bytes), ..decoded });
    }

    /// Handles a damaged telegram. Its sender is not certain.
    fn damaged(&mut self, message: &Message<'_>, problem: &str, images: &mut Images) {
        let direction = if self.pending_requests.is_some() { Direction::Received } else { Direction::Sent };
        let decoded = decoded(message, direction, self.link(), "a damaged telegram".to_owned());
        let problem = Some(problem.to_owned());
        images.message(DecodedMessage { problem, raw: hex(message.bytes), ..decoded });
    }

    /// Master and slave of the pending request.
    fn link(&self) -> (String, String) {
        let unknown = || ("master".to_owned(), "slave".to_owned());
        self.pending_requests.map_or_else(unknown, |(_, master, slave)| link(master, slave))
    }
}

/// Names of master and slave in the table of links.
fn link(master: u8, slave: u8) -> (String, String) {
    (format!("station {master}"), format!("station {slave}"))
}

/// Describes the data of a telegram.
fn about(frame: &Frame, service: Option<u8>) -> Option<String> {
    if frame.data.is_empty() {
        return None;
    }
    let unread = |error: WireError| format!("invalid: {error}");
    Some(match service? {
        sap::SLAVE_DIAG => Diagnosis::parse(&frame.data).map_or_else(unread, |diagnosis| diagnosis.to_string()),
        sap::GLOBAL_CONTROL => GlobalControl::parse(&frame.data).map_or_else(unread, |control| control.to_string()),
        sap::GET_CFG | sap::CHK_CFG => Configuration::parse(&frame.data).map_or_else(unread, |configuration| {
            let (input, output) = (configuration.input(), configuration.output());
            format!("{}, {input} bytes from the slave, {output} bytes to the slave", hex(configuration.bytes()))
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
