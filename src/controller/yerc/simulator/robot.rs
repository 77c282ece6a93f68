//! Robot server: decodes requests with the command table, and reads or writes.
//!
//! Checks run in this order: command, service, instance, attribute, fitted axes and groups, size, state, value.

use super::memory::Kind;
use super::world::{Refusal, World, code};
use crate::refuse_if;
use crate::yerc::Model;
use crate::yerc::table::{Action, Attribute, Availability, Plural, Row, Service, service, total};
use crate::yerc::wire::RequestFrame;

/// Answer data, or a refusal.
pub(super) type Answer = Result<Vec<u8>, Refusal>;

/// Software version (major, minor) from which on an FS100 has the newer commands.
const FS_FULL_SOFTWARE: (u32, u32) = (1, 14);

pub(super) fn answer(world: &mut World, frame: &RequestFrame<'_>) -> Answer {
    let row = Row::from_number(frame.command).filter(|row| has(world, row.availability)).ok_or(Refusal::Command)?;
    let service = row.service(frame.service).ok_or(Refusal::Command)?;
    let instance = frame.instance;
    let span = row.instances.find(world.model, instance).ok_or(Refusal::Instance)?;
    if span.extended {
        // This controller has no parameter that adds variables.
        return Err(Refusal::Instance);
    }
    check_attribute(row, service, frame.attribute)?;
    match (row.plural, service.action) {
        (Some(plural), Action::Read) => read_several(world, row, plural, instance, span.last, frame.data),
        (Some(plural), Action::Write) => write_several(world, row, plural, instance, span.last, frame.data),
        (None, Action::Read) => {
            let payload = world.read(row, instance)?;
            Ok(field(row, service, frame.attribute, &payload)?.to_vec())
        }
        (None, Action::Write) => write_one(world, row, service, frame),
    }
}

/// Whether this controller supports a feature that only some controllers have.
pub(super) fn has(world: &World, availability: Availability) -> bool {
    match (availability, world.model) {
        (Availability::Fs114, Model::Fs100) => software(&world.software) >= FS_FULL_SOFTWARE,
        (availability, model) => availability.on(model),
    }
}

/// Returns the major and minor version of a software version, for example 1 and 14 for `FS1.14.00A(JP/US)-00`.
fn software(version: &str) -> (u32, u32) {
    let mut numbers =
        version.trim_start_matches(|c: char| !c.is_ascii_digit()).split('.').map(|part| part.parse().ok());
    let mut next = || numbers.next().flatten().unwrap_or(0);
    (next(), next())
}

fn check_attribute(row: &Row, service: &Service, attribute: u8) -> Result<(), Refusal> {
    // The manuals require attribute 1 for a variable. Real clients send 0, with the single services and with the
    // services for all fields.
    let lenient = row.services.iter().any(|service| service.attribute == Attribute::OneOrZero);
    let known = match service.attribute {
        Attribute::Zero => attribute == 0,
        Attribute::One if !lenient => attribute == 1,
        Attribute::One | Attribute::OneOrZero => attribute <= 1,
        // With attribute 0, the single services read and write a whole position variable. One client is known to use
        // this.
        Attribute::Field => {
            usize::from(attribute) <= row.fields.len() && (attribute != 0 || row.service(service::SET_ALL).is_some())
        }
    };
    match known {
        true => Ok(()),
        // A controller was observed to refuse a job selection with an attribute with the added status A002.
        false if row.number == command::SELECT => Err(Refusal::Added(code::ATTRIBUTE)),
        false => Err(Refusal::Attribute),
    }
}

/// The part of a payload that the request selects. A missing axis has no bytes in the payload, so a request for its
/// field is refused.
fn field<'a>(row: &Row, service: &Service, attribute: u8, payload: &'a [u8]) -> Result<&'a [u8], Refusal> {
    let Some(index) = field_index(service, attribute) else { return Ok(payload) };
    let from = total(row.fields.get(..index).unwrap_or_default());
    let size = total(row.fields.get(index..=index).unwrap_or_default());
    payload.get(from..from + size).ok_or(Refusal::Added(code::ATTRIBUTE))
}

/// Index of the field of a single read or write; `None` for all fields.
fn field_index(service: &Service, attribute: u8) -> Option<usize> {
    match service.attribute {
        Attribute::Field => usize::from(attribute).checked_sub(1),
        _ => None,
    }
}

/// Command numbers that the code uses by name. The table has all other numbers.
pub(super) mod command {
    pub(in super::super) const ALARM: u16 = 0x70;
    pub(in super::super) const HISTORY: u16 = 0x71;
    pub(in super::super) const STATUS: u16 = 0x72;
    pub(in super::super) const JOB: u16 = 0x73;
    pub(in super::super) const AXES: u16 = 0x74;
    pub(in super::super) const POSITION: u16 = 0x75;
    pub(in super::super) const POSITION_ERROR: u16 = 0x76;
    pub(in super::super) const TORQUE: u16 = 0x77;
    pub(in super::super) const IO: u16 = 0x78;
    pub(in super::super) const REGISTER: u16 = 0x79;
    pub(in super::super) const RESET: u16 = 0x82;
    pub(in super::super) const SWITCH: u16 = 0x83;
    pub(in super::super) const CYCLE: u16 = 0x84;
    pub(in super::super) const MESSAGE: u16 = 0x85;
    pub(in super::super) const START: u16 = 0x86;
    pub(in super::super) const SELECT: u16 = 0x87;
    pub(in super::super) const TIMES: u16 = 0x88;
    pub(in super::super) const SYSTEM: u16 = 0x89;
    pub(in super::super) const MOVE: u16 = 0x8A;
    pub(in super::super) const MOVE_PULSE: u16 = 0x8B;
    pub(in super::super) const ALARM_TEXTS: u16 = 0x30A;
    pub(in super::super) const HISTORY_TEXTS: u16 = 0x30B;
}

/// Memory area of a variable, I/O or register command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Store {
    Variable(Kind),
    Io,
    Register,
}

impl Store {
    pub(super) fn from_number(command: u16) -> Option<Self> {
        let variable = |index: u16| Kind::ALL.get(usize::from(index)).map(|kind| Self::Variable(*kind));
        match command {
            command::IO | 0x300 => Some(Self::Io),
            command::REGISTER | 0x301 => Some(Self::Register),
            0x7A..=0x81 => variable(command - 0x7A),
            0x302..=0x309 => variable(command - 0x302),
            0x8C | 0x30C => Some(Self::Variable(Kind::S)),
            _ => None,
        }
    }
}

impl World {
    /// The bytes of an element in the size of the command: all bytes, or the first 16 bytes of a long string.
    pub(super) fn read_element(&self, store: Store, instance: u16, size: usize) -> Answer {
        let bytes = match store {
            Store::Io => vec![self.io(instance)],
            Store::Register => self.memory.register(instance).ok_or(Refusal::Instance)?.to_le_bytes().to_vec(),
            Store::Variable(kind) => self
                .memory
                .element(kind, usize::from(instance))
                .ok_or(Refusal::Added(code::UNDEFINED_DATA))?
                .iter()
                .copied()
                .take(size)
                .collect(),
        };
        Ok(bytes)
    }

    /// Stores a validated element.
    pub(super) fn write_element(&mut self, store: Store, instance: u16, bytes: &[u8]) {
        match (store, bytes) {
            (Store::Io, &[byte]) => self.memory.set_io(instance, byte),
            (Store::Register, &[low, high]) => {
                self.memory.write_register(instance, u16::from_le_bytes([low, high]));
            }
            (Store::Variable(kind), bytes) => self.memory.store(kind, usize::from(instance), bytes),
            (Store::Io | Store::Register, _) => {}
        }
    }
}

/// Reads the elements of a plural request. The answer contains the count and the elements.
fn read_several(world: &World, row: &Row, plural: Plural, first: u16, last: u16, data: &[u8]) -> Answer {
    let store = Store::from_number(row.number).ok_or(Refusal::Command)?;
    let Ok(count) = <[u8; 4]>::try_from(data) else { return Err(Refusal::Added(code::REQUEST_SIZE)) };
    let count = u32::from_le_bytes(count);
    let range = plural_range(plural, count, first, last, code::ANSWER_SIZE)?;
    let mut out = count.to_le_bytes().to_vec();
    for instance in range {
        out.extend(world.read_element(store, instance, row.size())?);
    }
    Ok(out)
}

/// Writes all elements, or none.
fn write_several(world: &mut World, row: &Row, plural: Plural, first: u16, last: u16, data: &[u8]) -> Answer {
    let store = Store::from_number(row.number).ok_or(Refusal::Command)?;
    let Some((count, elements)) = data.split_first_chunk::<4>() else {
        return Err(Refusal::Added(code::REQUEST_SIZE));
    };
    let count = u32::from_le_bytes(*count);
    let range = plural_range(plural, count, first, last, code::REQUEST_SIZE)?;
    refuse_if(elements.len() != range.len() * row.size(), Refusal::Added(code::REQUEST_SIZE))?;
    world.may_write()?;
    check_writable(world, row, *range.start())?;
    check_writable(world, row, *range.end())?;
    for element in elements.chunks_exact(row.size()) {
        check_value(store, element)?;
    }
    for (instance, element) in range.zip(elements.chunks_exact(row.size())) {
        world.write_element(store, instance, element);
    }
    Ok(Vec::new())
}

/// Instances of a plural request. All of them must be in the range of the first instance.
fn plural_range(
    plural: Plural,
    count: u32,
    first: u16,
    last: u16,
    too_many: u16,
) -> Result<std::ops::RangeInclusive<u16>, Refusal> {
    let Ok(count) = u16::try_from(count) else { return Err(Refusal::Added(too_many)) };
    refuse_if(count > plural.max, Refusal::Added(too_many))?;
    refuse_if(count == 0 || plural.even && count % 2 == 1, Refusal::Added(code::OPERAND_RANGE))?;
    match first.checked_add(count - 1).filter(|&end| end <= last) {
        Some(end) => Ok(first..=end),
        None => Err(Refusal::Instance),
    }
}

fn write_one(world: &mut World, row: &Row, service: &Service, frame: &RequestFrame<'_>) -> Answer {
    let Some(store) = Store::from_number(row.number) else { return world.operate(row, frame.instance, frame.data) };
    let (instance, data) = (frame.instance, frame.data);
    let element = match field_index(service, frame.attribute) {
        None => whole_element(row, data)?,
        // The request writes one word of a position. The other words exist only if the position is defined.
        Some(index) => {
            let Ok(value) = <[u8; 4]>::try_from(data) else { return Err(Refusal::Added(code::REQUEST_SIZE)) };
            let mut element = world.read_element(store, instance, row.size())?;
            element[4 * index..][..4].copy_from_slice(&value);
            element
        }
    };
    world.may_write()?;
    check_writable(world, row, instance)?;
    check_value(store, &element)?;
    world.write_element(store, instance, &element);
    Ok(Vec::new())
}

/// The bytes of an element from the data of a request. The data has the size of the element, or four bytes whose value
/// is in range.
fn whole_element(row: &Row, data: &[u8]) -> Answer {
    let size = row.size();
    if data.len() == size {
        return Ok(data.to_vec());
    }
    refuse_if(size > 4 || data.len() != 4, Refusal::Added(code::REQUEST_SIZE))?;
    let (value, fill) = data.split_at(size);
    let negative = value.last().is_some_and(|byte| byte & 0x80 != 0) && row.number == INTEGER;
    let fits = fill.iter().all(|&byte| byte == 0 || negative && byte == 0xFF);
    if fits { Ok(value.to_vec()) } else { Err(Refusal::Added(code::RANGE)) }
}

/// The command of the only signed variables with fewer than four bytes.
const INTEGER: u16 = 0x7B;

fn check_writable(world: &World, row: &Row, instance: u16) -> Result<(), Refusal> {
    match row.instances.find(world.model, instance) {
        Some(span) if span.writable => Ok(()),
        _ => Err(Refusal::Added(code::NO_ACCESS)),
    }
}

/// Validates a position: type, tool, frame and forms must be valid (DX 3.3.16 to 3.3.18). Other elements may have any
/// value.
fn check_value(store: Store, element: &[u8]) -> Result<(), Refusal> {
    let word = |index: usize| {
        let bytes = element.get(4 * index..4 * index + 4).and_then(|bytes| <[u8; 4]>::try_from(bytes).ok());
        bytes.map_or(0, u32::from_le_bytes)
    };
    let valid = match store {
        Store::Variable(Kind::P) => {
            matches!(word(0), 0 | 16..=19) && word(1) <= 0xFF && word(2) <= 63 && word(3) <= 63 && word(4) <= 0x1F
        }
        Store::Variable(Kind::Bp) => matches!(word(0), 0 | 16),
        Store::Variable(Kind::Ex) => word(0) == 0,
        Store::Variable(_) | Store::Io | Store::Register => true,
    };
    if valid { Ok(()) } else { Err(Refusal::Added(code::RANGE)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn software_versions_compare_by_number() {
        assert_eq!(software("FS1.14.00A(JP/US)-00"), (1, 14));
        assert!(software("FS1.3.00A(JP/US)-00") < FS_FULL_SOFTWARE);
        assert_eq!(software("nonsense"), (0, 0));
    }
}
