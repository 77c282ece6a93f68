//! Objects of a slave, and its answers to explicit requests.

use super::super::Now;
use super::super::can::Bitrate;
use super::super::wire::{Answer, Format, Header, Id, Mac, Request, class, connection, general, owner, service};
use super::allocation::Refusal;
use super::fault::DeviceFault;
use super::messages::CompleteRequest;
use super::polled::Polled;
use super::{Application, Device};
use crate::refuse_if;

/// Instance of the assembly that the slave produces.
const ASSEMBLY: u16 = 100;
/// Packet rate of the explicit connection, in milliseconds.
const EXPLICIT_RATE: u16 = 2500;
const NO_ATTRIBUTE: Refusal = (general::NO_ATTRIBUTE, owner::NONE);
const NO_SERVICE: Refusal = (general::NO_SERVICE, owner::NONE);

impl<A: Application> Device<A> {
    /// Handles a frame that contains an explicit request or a fragment of a request.
    pub(super) fn request(&mut self, now: Now, bytes: &[u8], is_connected: bool) {
        let Some(first) = bytes.first() else { return };
        let from = Header::parse(*first).mac;
        // If no master owns the connections, the slave accepts any request on the explicit connection, because it may
        // be an allocation. Otherwise only the owning master may use the explicit connection.
        if is_connected && self.allocation.master().is_some() && !self.allocation.is_explicit_of(from) {
            return;
        }
        let acknowledges = self.fault != Some(DeviceFault::NoAcknowledge);
        let mut out = Vec::new();
        if let Some(whole) = self.messages.take(now, bytes, &mut out, acknowledges) {
            let is_explicit = is_connected && self.allocation.is_explicit_of(from);
            if let Some(answer) = self.answer(now, &whole, is_explicit) {
                let header = Header { is_fragment: false, ..whole.header };
                self.messages.give(now, header, &answer.emit(), &mut out);
            }
        }
        if is_connected && self.allocation.is_explicit_of(from) {
            self.allocation.refresh(now);
        }
        self.outbox.extend(out);
    }

    fn answer(&mut self, now: Now, whole: &CompleteRequest, is_explicit: bool) -> Option<Answer> {
        // This message is an answer and not a request, so the slave ignores it.
        if whole.body.first().is_none_or(|service| service & service::ANSWER != 0) {
            return None;
        }
        let done = match Request::parse(Format::Byte8Byte8, &whole.body) {
            None => Err((general::TOO_SHORT, owner::NONE)),
            Some(request) => {
                self.serve(now, whole.header.mac, &request, is_explicit).map(|data| (request.service, data))
            }
        };
        Some(match done {
            Ok((service, data)) => Answer::Done { service, data },
            Err((general, additional)) => Answer::Refused { general, additional },
        })
    }

    fn serve(&mut self, now: Now, from: Mac, request: &Request, is_explicit: bool) -> Result<Vec<u8>, Refusal> {
        let object = (u8::try_from(request.class).unwrap_or(u8::MAX), request.instance);
        match (object, request.service) {
            ((class::DEVICENET, 1), service::ALLOCATE) => return self.allocate(now, from, &request.data),
            ((class::DEVICENET, 1), service::RELEASE) => return self.release(now, from, &request.data),
            _ if !is_explicit => return Err((general::CONFLICT, owner::UNCONNECTED)),
            _ => {}
        }
        self.exists(object)?;
        match (request.service, request.data.as_slice()) {
            (service::GET, [attribute]) => self.attribute(now, object, *attribute),
            (service::SET, [attribute, value @ ..]) => self.set(now, object, *attribute, value),
            (service::GET | service::SET, []) => Err((general::TOO_SHORT, owner::NONE)),
            (service::GET, _) => Err((general::TOO_LONG, owner::NONE)),
            _ => Err(NO_SERVICE),
        }
    }

    fn exists(&self, (class, instance): (u8, u16)) -> Result<(), Refusal> {
        let has = match class {
            class::IDENTITY | class::DEVICENET => instance == 1,
            class::ASSEMBLY => instance == ASSEMBLY,
            class::CONNECTION if instance == u16::from(connection::EXPLICIT_INSTANCE) => true,
            class::CONNECTION => instance == u16::from(connection::POLL_INSTANCE) && self.polled.is_some(),
            _ => return Err((general::NO_PATH, owner::NONE)),
        };
        if has { Ok(()) } else { Err((general::NO_INSTANCE, owner::NONE)) }
    }

    fn allocate(&mut self, now: Now, from: Mac, data: &[u8]) -> Result<Vec<u8>, Refusal> {
        let [choice, master] = *data else { return Err(length(data, 2)) };
        refuse_if(self.fault == Some(DeviceFault::ForeignOwner), (general::CONFLICT, owner::ANOTHER_MASTER))?;
        self.allocation.allocate(now, choice, from, master)?;
        if choice & connection::POLL != 0 {
            self.polled = Some(Polled::new());
        }
        Ok(vec![Format::Byte8Byte8.code()])
    }

    fn release(&mut self, now: Now, from: Mac, data: &[u8]) -> Result<Vec<u8>, Refusal> {
        let [choice] = *data else { return Err(length(data, 1)) };
        self.allocation.release(choice, from)?;
        if choice & connection::POLL != 0 {
            self.forget_poll(now);
        }
        Ok(Vec::new())
    }

    fn attribute(&mut self, now: Now, (class, instance): (u8, u16), attribute: u8) -> Result<Vec<u8>, Refusal> {
        let setup = &self.setup;
        let word = |value: u16| value.to_le_bytes().to_vec();
        Ok(match (class, attribute) {
            (class::IDENTITY, 1) => word(setup.vendor),
            (class::IDENTITY, 2) => word(setup.device_type),
            (class::IDENTITY, 3) => word(setup.product),
            (class::IDENTITY, 4) => vec![setup.revision.0, setup.revision.1],
            (class::IDENTITY, 5) => word(u16::from(self.allocation.master().is_some())),
            (class::IDENTITY, 6) => setup.serial.to_le_bytes().to_vec(),
            (class::IDENTITY, 7) => {
                let name: Vec<u8> = setup.name.bytes().take(255).collect();
                [&[u8::try_from(name.len()).unwrap_or(u8::MAX)], name.as_slice()].concat()
            }
            (class::DEVICENET, 1) => vec![setup.mac.number()],
            (class::DEVICENET, 2) => {
                let index = Bitrate::ALL.iter().position(|bitrate| *bitrate == setup.bitrate);
                vec![index.and_then(|index| u8::try_from(index).ok()).unwrap_or_default()]
            }
            (class::DEVICENET, 3 | 4) => vec![0],
            (class::DEVICENET, 5) => {
                vec![self.allocation.choice(), self.allocation.master().map_or(owner::NONE, Mac::number)]
            }
            (class::ASSEMBLY, 3) => {
                self.application.image_in(now, &mut self.image_in);
                self.image_in.clone()
            }
            (class::CONNECTION, _) if instance == u16::from(connection::EXPLICIT_INSTANCE) => {
                self.explicit_attribute(attribute)?
            }
            (class::CONNECTION, _) => self.poll_attribute(attribute)?,
            _ => return Err(NO_ATTRIBUTE),
        })
    }

    fn explicit_attribute(&self, attribute: u8) -> Result<Vec<u8>, Refusal> {
        let mac = self.setup.mac;
        let word = |value: u16| value.to_le_bytes().to_vec();
        Ok(match attribute {
            1 => vec![3],
            2 => vec![0],
            3 => vec![0x83],
            4 => word(Id::Answer(mac).emit()),
            5 => word(Id::Request(mac).emit()),
            6 => vec![0x21],
            7 | 8 => word(64),
            9 => word(EXPLICIT_RATE),
            12 => vec![1],
            13 | 15 | 17 => word(0),
            14 | 16 => Vec::new(),
            _ => return Err(NO_ATTRIBUTE),
        })
    }

    fn poll_attribute(&self, attribute: u8) -> Result<Vec<u8>, Refusal> {
        let Some(polled) = &self.polled else { return Err((general::NO_INSTANCE, owner::NONE)) };
        let mac = self.setup.mac;
        let word = |value: u16| value.to_le_bytes().to_vec();
        let size = self.setup.size + if self.fault == Some(DeviceFault::OtherSize) { 2 } else { 0 };
        Ok(match attribute {
            1 => vec![polled.state as u8],
            2 | 6 => vec![1],
            3 => vec![0x82],
            4 => word(Id::PollAnswer(mac).emit()),
            5 => word(Id::Poll(mac).emit()),
            7 | 8 => word(size),
            9 => word(polled.rate),
            12 => vec![0],
            13 | 15 => word(6),
            14 | 16 => vec![0x20, class::ASSEMBLY, 0x24, 100, 0x30, 3],
            17 => word(0),
            _ => return Err(NO_ATTRIBUTE),
        })
    }

    fn set(&mut self, now: Now, (class, instance): (u8, u16), attribute: u8, value: &[u8]) -> Result<Vec<u8>, Refusal> {
        refuse_if((class, attribute) != (class::CONNECTION, 9), (general::NOT_SETTABLE, owner::NONE))?;
        let [low, high] = *value else { return Err(length(value, 2)) };
        let rate = u16::from_le_bytes([low, high]);
        match &mut self.polled {
            Some(polled) if instance == u16::from(connection::POLL_INSTANCE) => {
                Ok(polled.set_rate(now, rate).to_le_bytes().to_vec())
            }
            _ => Err((general::NOT_SETTABLE, owner::NONE)),
        }
    }
}

/// Returns the refusal of data with a wrong length.
const fn length(data: &[u8], wanted: usize) -> Refusal {
    (if data.len() < wanted { general::TOO_SHORT } else { general::TOO_LONG }, owner::NONE)
}
