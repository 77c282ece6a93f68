//! Explicit messages: requests to objects and their answers.

use super::error::EipError;
use super::wire::{Path, Reply, Request, RrData, Status, service};

/// Maximum length of the request data in bytes, so that the message fits into a frame. Most devices accept less.
const MAX_REQUEST_DATA: usize = 60_000;
/// Maximum length of a path in bytes: the length field of a path is one byte and counts words.
const MAX_PATH_LEN: usize = 510;

/// A request to an object.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// Service code; see [`service`].
    pub service: u8,
    /// Path of the object.
    pub path: Path,
    /// Service data.
    pub data: Vec<u8>,
}

impl Message {
    /// Creates a Get_Attribute_Single message.
    pub fn get(class: u32, instance: u32, attribute: u32) -> Self {
        let path = Path::attribute(class, instance, attribute);
        Self { service: service::ATTRIBUTE_SINGLE, path, data: Vec::new() }
    }

    /// Creates a Get_Attributes_All message.
    pub fn get_all(class: u32, instance: u32) -> Self {
        Self { service: service::ATTRIBUTES_ALL, path: Path::object(class, instance), data: Vec::new() }
    }

    /// Creates a Set_Attribute_Single message.
    pub fn set(class: u32, instance: u32, attribute: u32, value: &[u8]) -> Self {
        let path = Path::attribute(class, instance, attribute);
        Self { service: service::SET_ATTRIBUTE_SINGLE, path, data: value.to_vec() }
    }

    /// Encodes the message as the data of a frame.
    pub fn emit(&self) -> Result<Vec<u8>, EipError> {
        if self.data.len() > MAX_REQUEST_DATA || self.path.emit().len() > MAX_PATH_LEN {
            let text =
                format!("a message can have at most {MAX_REQUEST_DATA} bytes of data and {MAX_PATH_LEN} bytes of path");
            return Err(EipError::Impossible(text));
        }
        Ok(RrData::new(&self.request()).emit())
    }

    /// Encodes the message itself: service, path, data.
    pub fn request(&self) -> Vec<u8> {
        Request { service: self.service, path: self.path.clone(), data: &self.data }.emit()
    }
}

/// Answer of a device. It may be a refusal.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answer {
    /// CIP status.
    pub status: Status,
    /// Response data. If the device refuses, details of the refusal.
    pub data: Vec<u8>,
}

impl Answer {
    /// Decodes an answer from the data of a frame. `what` is the name of the request in errors.
    pub fn parse(what: &'static str, data: &[u8]) -> Result<Self, EipError> {
        let malformed = |error| EipError::Malformed { what, error };
        let message = RrData::parse_answer(data).map_err(malformed)?.message;
        let reply = Reply::parse(message).map_err(malformed)?;
        Ok(Self { status: reply.status, data: reply.data.to_vec() })
    }

    /// Returns the data. A refusal is returned as an error.
    pub fn done(self, what: &'static str) -> Result<Vec<u8>, EipError> {
        if self.status.is_ok() { Ok(self.data) } else { Err(EipError::Refused { what, status: self.status }) }
    }
}
