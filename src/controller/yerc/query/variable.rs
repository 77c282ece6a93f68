//! Queries that read or write one or several variables (0x7A to 0x81, 0x8C, 0x302 to 0x309, 0x30C).

use super::{
    Query, QueryError, WriteQuery, checked, elements, read_all, read_plural, reading, write_one, write_plural,
};
use crate::yerc::Model;
use crate::yerc::payload::PayloadError;
use crate::yerc::request::Request;
use crate::yerc::table::service;
use crate::yerc::variables::reference::VariableKind;
use crate::yerc::variables::value::Value;

/// Reads one variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ReadVariable {
    kind: VariableKind,
    number: u16,
}

impl ReadVariable {
    /// Accepts any number. Extended variables exist only if the parameters of the controller provide them.
    pub const fn new(kind: VariableKind, number: u16) -> Self {
        Self { kind, number }
    }
}

impl Query for ReadVariable {
    type Answer = Value;

    fn request(&self) -> Request {
        let command = self.kind.command();
        if self.kind.is_position() {
            read_all(command, self.number)
        } else {
            reading(command, self.number, 1, service::GET_SINGLE)
        }
    }

    fn decode(&self, data: &[u8]) -> Result<Value, PayloadError> {
        Value::parse(self.kind, data)
    }
}

/// Reads several consecutive variables of a kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ReadVariables {
    kind: VariableKind,
    first: u16,
    count: u16,
}

impl ReadVariables {
    /// Accepts a count that fits a frame; for B variables, the count must also be even. Standard and extended numbers
    /// may be combined. [`VariableKind::string_form`] selects the string form for the model.
    pub fn new(kind: VariableKind, first: u16, count: u16) -> Result<Self, QueryError> {
        checked(Model::Dx200, Self { kind, first, count })
    }
}

impl Query for ReadVariables {
    type Answer = Vec<Value>;

    fn request(&self) -> Request {
        read_plural(self.kind.plural_command(), self.first, self.count)
    }

    fn decode(&self, data: &[u8]) -> Result<Vec<Value>, PayloadError> {
        elements("variables", data, self.count, self.kind.size())?.map(|bytes| Value::parse(self.kind, bytes)).collect()
    }
}

/// Writes one variable.
#[derive(Debug, Clone, PartialEq)]
pub struct WriteVariable {
    number: u16,
    value: Value,
}

impl WriteVariable {
    /// Accepts any number. The kind of the value determines the kind of the variable.
    pub fn new(number: u16, value: Value) -> Result<Self, QueryError> {
        checked(Model::Dx200, Self { number, value })
    }
}

impl WriteQuery for WriteVariable {
    fn write_request(&self) -> Request {
        let (kind, data) = (self.value.kind(), self.value.emit());
        if kind.is_position() {
            Request { command: kind.command(), instance: self.number, attribute: 0, service: service::SET_ALL, data }
        } else {
            write_one(kind.command(), self.number, data)
        }
    }
}

/// Writes several consecutive variables of a kind.
#[derive(Debug, Clone, PartialEq)]
pub struct WriteVariables {
    kind: VariableKind,
    first: u16,
    values: Vec<Value>,
}

impl WriteVariables {
    /// Accepts a count that fits a frame; for B variables, the count must also be even.
    pub fn new(first: u16, values: Vec<Value>) -> Result<Self, QueryError> {
        let kind = values.first().map(Value::kind).ok_or(QueryError::MixedKinds)?;
        if values.iter().any(|value| value.kind() != kind) {
            return Err(QueryError::MixedKinds);
        }
        checked(Model::Dx200, Self { kind, first, values })
    }
}

impl WriteQuery for WriteVariables {
    fn write_request(&self) -> Request {
        let bytes = self.values.iter().flat_map(Value::emit);
        write_plural(self.kind.plural_command(), self.first, self.values.len(), bytes)
    }
}

/// Writes one word of a position variable (3.3.16 to 3.3.18, service 0x10).
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct WriteField {
    kind: VariableKind,
    number: u16,
    attribute: u8,
    word: [u8; 4],
}

impl WriteField {
    /// Accepts an attribute number from 1, as in the table. Attribute 1 is the data type.
    pub fn new(kind: VariableKind, number: u16, attribute: u8, word: [u8; 4]) -> Result<Self, QueryError> {
        checked(Model::Dx200, Self { kind, number, attribute, word })
    }
}

impl WriteQuery for WriteField {
    fn write_request(&self) -> Request {
        Request {
            command: self.kind.command(),
            instance: self.number,
            attribute: self.attribute,
            service: service::SET_SINGLE,
            data: self.word.to_vec(),
        }
    }
}
