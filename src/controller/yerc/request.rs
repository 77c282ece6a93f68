//! Requests, and their validation with the command table.

use thiserror::Error;

use super::Model;
use super::files::{self, FileNameError};
use super::table::{Action, Field, Kind, Plural, RiskRule, Row, Service, service, total};
use super::wire::{Division, MAX_DATA, RequestFrame};
use crate::Risk;
use crate::refuse_if;

/// A request without a request id.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Request {
    /// Command number; 0 for files.
    pub command: u16,
    /// Instance of the command.
    pub instance: u16,
    /// Attribute: number of a field of the instance, or 0 for all fields.
    pub attribute: u8,
    /// Service.
    pub service: u8,
    /// Data, at most 479 bytes.
    pub data: Vec<u8>,
}

/// Why a request does not follow the manuals.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum RequestError {
    /// An unknown command.
    #[error("command {command:#06x} does not exist; known: 0x70 to 0x8c and 0x300 to 0x30c")]
    Command {
        /// The number in the request.
        command: u16,
    },
    /// An unknown file service.
    #[error("file service {found:#04x} does not exist; known: 0x09, 0x15, 0x16 and 0x32")]
    FileService {
        /// The number in the request.
        found: u8,
    },
    /// A command that the model does not have.
    #[error("command {command:#06x} ({name}) does not exist on a {model}")]
    Model {
        /// The number in the request.
        command: u16,
        /// Name of the command.
        name: &'static str,
        /// The model of the controller.
        model: Model,
    },
    /// A service that the command does not have.
    #[error("command {command:#06x} ({name}) has no service {found:#04x}; allowed: {allowed}")]
    Service {
        /// The command.
        command: u16,
        /// Name of the command.
        name: &'static str,
        /// The service in the request.
        found: u8,
        /// Valid services.
        allowed: String,
    },
    /// An instance that does not exist.
    #[error("instance {found} is outside {name} on a {model}; allowed: {allowed}")]
    Instance {
        /// Name of the command.
        name: &'static str,
        /// The instance in the request.
        found: u16,
        /// The model of the controller.
        model: Model,
        /// Valid ranges.
        allowed: String,
    },
    /// An instance that is read-only.
    #[error("instance {found} ({class}) can only be read on a {model}; writable: {allowed}")]
    ReadOnly {
        /// The instance in the request.
        found: u16,
        /// Description of the instance.
        class: &'static str,
        /// The model of the controller.
        model: Model,
        /// Writable ranges.
        allowed: String,
    },
    /// An attribute that does not exist.
    #[error("attribute {found} is not allowed for {name} with service {service:#04x}; allowed: {allowed}")]
    Attribute {
        /// Name of the command.
        name: &'static str,
        /// The attribute in the request.
        found: u8,
        /// The service in the request.
        service: u8,
        /// Valid attributes.
        allowed: String,
    },
    /// Wrong data size.
    #[error("{name} with service {service:#04x} must have {allowed} data bytes, not {found}")]
    DataSize {
        /// Name of the command.
        name: &'static str,
        /// The service in the request.
        service: u8,
        /// Size of the data in the request, in bytes.
        found: usize,
        /// Valid sizes in bytes.
        allowed: String,
    },
    /// An undefined value of a word.
    #[error("{field} of {name} is {found}; allowed: {allowed}")]
    Value {
        /// Name of the command.
        name: &'static str,
        /// Name of the field.
        field: &'static str,
        /// The value in the request.
        found: u32,
        /// Valid values.
        allowed: String,
    },
    /// Wrong number of elements.
    #[error("{name}: count {found} is outside 1 to {max}")]
    Count {
        /// Name of the command.
        name: &'static str,
        /// The count in the request.
        found: u32,
        /// Maximum count.
        max: u16,
    },
    /// An odd count, although only even counts are valid.
    #[error("{name}: count {found} is odd; allowed: even counts from 2 to {max}")]
    OddCount {
        /// Name of the command.
        name: &'static str,
        /// The count in the request.
        found: u32,
        /// Maximum count.
        max: u16,
    },
    /// The request goes beyond the end of the range that contains its first element.
    #[error("{name}: {count} elements from {first} end after the last element {last}")]
    Overrun {
        /// Name of the command.
        name: &'static str,
        /// First instance.
        first: u16,
        /// Number of requested elements.
        count: u32,
        /// Last instance of the range.
        last: u16,
    },
    /// An invalid file name or filter.
    #[error(transparent)]
    FileName(#[from] FileNameError),
}

impl From<RequestFrame<'_>> for Request {
    fn from(frame: RequestFrame<'_>) -> Self {
        let RequestFrame { command, instance, attribute, service, data, .. } = frame;
        Self { command, instance, attribute, service, data: data.to_vec() }
    }
}

/// Converts to a frame with request id 0. Sessions assign their own ids.
impl<'a> From<&'a Request> for RequestFrame<'a> {
    fn from(request: &'a Request) -> Self {
        Self {
            division: request.division(),
            ack: false,
            id: 0,
            block: 0,
            command: request.command,
            instance: request.instance,
            attribute: request.attribute,
            service: request.service,
            data: &request.data,
        }
    }
}

impl Request {
    /// A request to the file server.
    pub fn file(service: u8, data: impl Into<Vec<u8>>) -> Self {
        Self { command: 0, instance: 0, attribute: 0, service, data: data.into() }
    }

    /// The server that the request is for. Command 0 is not a robot command, so it is for the file server.
    pub const fn division(&self) -> Division {
        if self.command == 0 { Division::File } else { Division::Robot }
    }

    /// Encodes the datagram.
    ///
    /// # Panics
    /// If the data has more than 479 bytes. [`Request::check`] detects such a request.
    pub fn frame(&self, id: u8) -> Vec<u8> {
        RequestFrame { id, ..self.into() }.emit()
    }

    /// Row of the table.
    pub fn row(&self) -> Option<&'static Row> {
        match self.division() {
            Division::Robot => Row::from_number(self.command),
            Division::File => Row::of_file(self.service, &self.data),
        }
    }

    /// Risk of the request. An unknown request counts as a motion.
    pub fn risk(&self) -> Risk {
        let Some(service) = self.row().and_then(|row| row.service(self.service)) else { return Risk::Motion };
        match service.risk {
            RiskRule::Always(risk) => risk,
            RiskRule::Switches => match self.instance {
                1 | 3 => Risk::Write,
                _ => Risk::Motion,
            },
        }
    }

    /// Checks the request against the manuals for this model.
    pub fn check(&self, model: Model) -> Result<(), RequestError> {
        let row = self.row().ok_or(match self.division() {
            Division::Robot => RequestError::Command { command: self.command },
            Division::File => RequestError::FileService { found: self.service },
        })?;
        refuse_if(!row.availability.on(model), RequestError::Model { command: self.command, name: row.name, model })?;
        let service = row.service(self.service).ok_or_else(|| RequestError::Service {
            command: self.command,
            name: row.name,
            found: self.service,
            allowed: listed(row.services.iter().map(|service| format!("{:#04x}", service.number))),
        })?;
        let last = self.check_instance(row, service, model)?;
        if !service.takes(self.attribute, row.fields.len()) {
            return Err(RequestError::Attribute {
                name: row.name,
                found: self.attribute,
                service: self.service,
                allowed: service.attributes(row.fields.len()),
            });
        }
        match (row.division, row.plural) {
            (Division::File, _) => self.check_file(),
            (Division::Robot, Some(plural)) => self.check_plural(row, plural, last),
            (Division::Robot, None) => self.check_data(row, service, model),
        }
    }

    /// Checks the instance. Returns the last instance that a plural request can include if it begins there.
    fn check_instance(&self, row: &Row, service: &Service, model: Model) -> Result<u16, RequestError> {
        let span = row.instances.find(model, self.instance).ok_or_else(|| RequestError::Instance {
            name: row.name,
            found: self.instance,
            model,
            allowed: row.instances.ranges(model, false),
        })?;
        let writing = service.action == Action::Write;
        row.instances.reach(model, self.instance, writing).ok_or_else(|| RequestError::ReadOnly {
            found: self.instance,
            class: span.meaning,
            model,
            allowed: row.instances.ranges(model, true),
        })
    }

    fn check_file(&self) -> Result<(), RequestError> {
        match self.service {
            service::LIST => files::check_filter(&self.data)?,
            service::LOAD => files::check_load_name(&self.data)?,
            _ => files::check_name(&self.data)?,
        }
        Ok(())
    }

    fn check_plural(&self, row: &Row, plural: Plural, last: u16) -> Result<(), RequestError> {
        let Plural { max, even } = plural;
        let size_error = |allowed: String| RequestError::DataSize {
            name: row.name,
            service: self.service,
            found: self.data.len(),
            allowed,
        };
        let (count, elements) = self.data.split_first_chunk::<4>().ok_or_else(|| size_error("4 or more".to_owned()))?;
        let count = u32::from_le_bytes(*count);
        refuse_if(count == 0 || count > u32::from(max), RequestError::Count { name: row.name, found: count, max })?;
        refuse_if(even && count % 2 == 1, RequestError::OddCount { name: row.name, found: count, max })?;
        if u32::from(self.instance) + count - 1 > u32::from(last) {
            return Err(RequestError::Overrun { name: row.name, first: self.instance, count, last });
        }
        // An earlier check limits the count to at most 479, so the conversion and the product are in range.
        let expected = if self.service == service::WRITE_PLURAL {
            usize::try_from(count).unwrap_or(MAX_DATA).saturating_mul(row.size())
        } else {
            0
        };
        if elements.len() != expected {
            return Err(size_error((4 + expected).to_string()));
        }
        check_values(row, row.fields, elements)
    }

    fn check_data(&self, row: &Row, service: &Service, model: Model) -> Result<(), RequestError> {
        let wrong = |allowed: String| {
            Err(RequestError::DataSize { name: row.name, service: self.service, found: self.data.len(), allowed })
        };
        if service.action == Action::Read {
            return if self.data.is_empty() { Ok(()) } else { wrong("0".to_owned()) };
        }
        let fields = row.fields_of(service, self.attribute);
        let layouts = [Some(fields), row.alternative.filter(|_| model == Model::Fs100)];
        match layouts.into_iter().flatten().find(|fields| total(fields) == self.data.len()) {
            Some(fields) => check_values(row, fields, &self.data),
            None => wrong(listed(layouts.into_iter().flatten().map(|fields| total(fields).to_string()))),
        }
    }
}

/// Checks the words that have defined values. `data` can have any number of elements.
fn check_values(row: &Row, fields: &[Field], data: &[u8]) -> Result<(), RequestError> {
    let size = total(fields);
    if size == 0 {
        return Ok(());
    }
    for element in data.chunks_exact(size) {
        let mut rest = element;
        for field in fields {
            let Some((bytes, tail)) = rest.split_at_checked(field.size()) else { break };
            rest = tail;
            let (Kind::Choice(choices), Ok(word)) = (field.kind, bytes.try_into()) else { continue };
            let found = u32::from_le_bytes(word);
            if !choices.iter().any(|(number, _)| *number == found) {
                let allowed = listed(choices.iter().map(|(number, meaning)| format!("{number} ({meaning})")));
                return Err(RequestError::Value { name: row.name, field: field.name, found, allowed });
            }
        }
    }
    Ok(())
}

fn listed(items: impl Iterator<Item = String>) -> String {
    items.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(command: u16, instance: u16, attribute: u8, service: u8, data: &[u8]) -> Request {
        Request { command, instance, attribute, service, data: data.to_vec() }
    }

    #[test]
    fn risk_depends_on_the_data() {
        assert_eq!(request(0x83, 2, 1, 0x10, &[1, 0, 0, 0]).risk(), Risk::Motion);
        assert_eq!(request(0x83, 2, 1, 0x10, &[2, 0, 0, 0]).risk(), Risk::Motion);
        assert_eq!(request(0x83, 2, 1, 0x10, &[2]).risk(), Risk::Motion);
        assert_eq!(request(0x83, 1, 1, 0x10, &[1, 0, 0, 0]).risk(), Risk::Write);
        assert_eq!(request(0x83, 9, 1, 0x10, &[2, 0, 0, 0]).risk(), Risk::Motion);
        assert_eq!(request(0x72, 1, 0, 0x01, &[]).risk(), Risk::Read);
        assert_eq!(request(0x72, 1, 0, 0x10, &[]).risk(), Risk::Motion);
        assert_eq!(request(0x8D, 1, 0, 0x01, &[]).risk(), Risk::Motion);
        for position in [0x7F, 0x80, 0x81] {
            assert_eq!(request(position, 1, 0, 0x02, &[]).risk(), Risk::Destroy);
            assert_eq!(request(position, 1, 3, 0x10, &[0; 4]).risk(), Risk::Destroy);
        }
        for positions in 0x307..=0x309 {
            assert_eq!(request(positions, 1, 0, 0x34, &[]).risk(), Risk::Destroy);
            assert_eq!(request(positions, 1, 0, 0x33, &[]).risk(), Risk::Read);
        }
        assert_eq!(request(0x86, 1, 1, 0x10, &[1, 0, 0, 0]).risk(), Risk::Motion);
        assert_eq!(request(0x87, 1, 0, 0x02, &[0; 36]).risk(), Risk::Write);
        assert_eq!(Request::file(0x16, *b"A.JBI").risk(), Risk::Read);
        assert_eq!(Request::file(0x09, *b"A.JBI").risk(), Risk::Destroy);
        assert_eq!(Request::file(0x15, *b"A.JBI").risk(), Risk::Destroy);
        assert_eq!(Request::file(0x16, *b"/SPDRV/CMOSBK.BIN").risk(), Risk::Write);
        assert_eq!(Request::file(0x77, *b"").risk(), Risk::Motion);
    }

    #[test]
    fn the_error_names_field_value_and_range() {
        let text = |request: Request, model| request.check(model).unwrap_err().to_string();
        assert_eq!(
            text(request(0x78, 1001, 1, 0x10, &[1]), Model::Dx200),
            "instance 1001 (robot user output) can only be read on a dx200; writable: 2701-2956"
        );
        assert_eq!(
            text(request(0x73, 7, 0, 0x01, &[]), Model::Fs100),
            "instance 7 is outside executing job read on a fs100; allowed: 1-6"
        );
        assert_eq!(
            text(request(0x302, 0, 0, 0x33, &[3, 0, 0, 0]), Model::Fs100),
            "plural byte variable (B): count 3 is odd; allowed: even counts from 2 to 474"
        );
        assert_eq!(
            text(request(0x8C, 0, 1, 0x0E, &[]), Model::Fs100),
            "command 0x008c (string variable (S, 32 bytes) read and write) does not exist on a fs100"
        );
        assert_eq!(
            text(request(0x83, 2, 1, 0x10, &[3, 0, 0, 0]), Model::Fs100),
            "switch of hold, servo power and hlock is 3; allowed: 1 (on), 2 (off)"
        );
        assert_eq!(
            text(request(0x8A, 1, 1, 0x02, &[0; 99]), Model::Fs100),
            "cartesian move with service 0x02 must have 104, 100 data bytes, not 99"
        );
        assert_eq!(
            text(request(0x8A, 1, 1, 0x02, &[0; 100]), Model::Dx200),
            "cartesian move with service 0x02 must have 104 data bytes, not 100"
        );
    }

    #[test]
    fn plural_counts_stay_within_the_range() {
        assert_eq!(request(0x301, 990, 0, 0x33, &[10, 0, 0, 0]).check(Model::Dx200), Ok(()));
        assert!(matches!(
            request(0x301, 990, 0, 0x33, &[11, 0, 0, 0]).check(Model::Dx200),
            Err(RequestError::Overrun { last: 999, .. })
        ));
    }
}
