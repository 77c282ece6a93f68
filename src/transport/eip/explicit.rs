//! Messages to objects of a device, and what it answers.

use super::error::EipError;
use super::wire::{Path, Reply, Request, RrData, Status, service};

/// Most data of a request: with the rest it fits a frame. Devices take less.
const MOST_DATA: usize = 60_000;
/// Most bytes of a path: its length has a byte, in words.
const MOST_PATH: usize = 510;

/// A request to an object.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// What is to be done; see [`service`].
    pub service: u8,
    /// The object.
    pub path: Path,
    /// What the service takes.
    pub data: Vec<u8>,
}

impl Message {
    /// Reads an attribute.
    pub fn get(class: u32, instance: u32, attribute: u32) -> Self {
        let path = Path::attribute(class, instance, attribute);
        Self { service: service::ATTRIBUTE_SINGLE, path, data: Vec::new() }
    }

    /// Reads all attributes of an instance.
    pub fn get_all(class: u32, instance: u32) -> Self {
        Self { service: service::ATTRIBUTES_ALL, path: Path::object(class, instance), data: Vec::new() }
    }

    /// Changes an attribute.
    pub fn set(class: u32, instance: u32, attribute: u32, value: &[u8]) -> Self {
        let path = Path::attribute(class, instance, attribute);
        Self { service: service::SET_ATTRIBUTE_SINGLE, path, data: value.to_vec() }
    }

    /// The data of the frame that carries it.
    ///
    /// # Errors
    /// If it takes more than a message can hold.
    pub fn emit(&self) -> Result<Vec<u8>, EipError> {
        if self.data.len() > MOST_DATA || self.path.emit().len() > MOST_PATH {
            let text = format!("a message has {MOST_DATA} bytes of data and {MOST_PATH} of path at most");
            return Err(EipError::Impossible(text));
        }
        Ok(RrData::new(&self.request()).emit())
    }

    /// The message itself: service, path, data.
    pub fn request(&self) -> Vec<u8> {
        Request { service: self.service, path: self.path.clone(), data: &self.data }.emit()
    }
}

/// What a device answered; a refusal is an answer, too.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answer {
    /// How it went.
    pub status: Status,
    /// What the service gives, or more about a refusal.
    pub data: Vec<u8>,
}

impl Answer {
    /// Reads the data of a frame that answers `what`.
    pub fn parse(what: &'static str, data: &[u8]) -> Result<Self, EipError> {
        let malformed = |error| EipError::Malformed { what, error };
        let message = RrData::parse_answer(data).map_err(malformed)?.message;
        let reply = Reply::parse(message).map_err(malformed)?;
        Ok(Self { status: reply.status, data: reply.data.to_vec() })
    }

    /// What the service gives; a refusal is a trouble.
    pub fn done(self, what: &'static str) -> Result<Vec<u8>, EipError> {
        if self.status.is_ok() { Ok(self.data) } else { Err(EipError::Refused { what, status: self.status }) }
    }
}
