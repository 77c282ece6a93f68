//! I/O groups, each of eight signals, and registers (0x78, 0x79, 0x300, 0x301).

use super::{Query, QueryError, WriteQuery, checked, elements, read_plural, reading, write_one, write_plural};
use crate::yerc::Model;
use crate::yerc::payload::{PayloadError, Reader};
use crate::yerc::request::Request;
use crate::yerc::table::service;

macro_rules! signals {
    ($what:literal, $value:ty, $single:literal, $plural:literal,
        $read:ident, $read_many:ident, $write:ident, $write_many:ident) => {
        #[doc = concat!("Reads one ", $what, ".")]
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub struct $read {
            number: u16,
        }

        impl $read {
            /// Accepts a number that exists on the model.
            pub fn new(model: Model, number: u16) -> Result<Self, QueryError> {
                checked(model, Self { number })
            }
        }

        impl Query for $read {
            type Answer = $value;

            fn request(&self) -> Request {
                reading($single, self.number, 1, service::GET_SINGLE)
            }

            fn decode(&self, data: &[u8]) -> Result<$value, PayloadError> {
                Reader::new($what, data).array().map(<$value>::from_le_bytes)
            }
        }

        #[doc = concat!("Reads several of ", $what, ", one after the other.")]
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub struct $read_many {
            first: u16,
            count: u16,
        }

        impl $read_many {
            /// Accepts a range that exists on the model and whose answer fits a frame.
            pub fn new(model: Model, first: u16, count: u16) -> Result<Self, QueryError> {
                checked(model, Self { first, count })
            }
        }

        impl Query for $read_many {
            type Answer = Vec<$value>;

            fn request(&self) -> Request {
                read_plural($plural, self.first, self.count)
            }

            fn decode(&self, data: &[u8]) -> Result<Vec<$value>, PayloadError> {
                elements($what, data, self.count, size_of::<$value>())?
                    .map(|bytes| Reader::new($what, bytes).array().map(<$value>::from_le_bytes))
                    .collect()
            }
        }

        #[doc = concat!("Writes one ", $what, ".")]
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub struct $write {
            number: u16,
            value: $value,
        }

        impl $write {
            /// Accepts a number that is writable on the model.
            pub fn new(model: Model, number: u16, value: $value) -> Result<Self, QueryError> {
                checked(model, Self { number, value })
            }
        }

        impl WriteQuery for $write {
            fn write_request(&self) -> Request {
                write_one($single, self.number, self.value.to_le_bytes())
            }
        }

        #[doc = concat!("Writes several of ", $what, ", one after the other.")]
        #[derive(Debug, Clone, PartialEq, Eq, Hash)]
        pub struct $write_many {
            first: u16,
            values: Vec<$value>,
        }

        impl $write_many {
            /// Accepts a range that is writable on the model and that fits a frame.
            pub fn new(model: Model, first: u16, values: Vec<$value>) -> Result<Self, QueryError> {
                checked(model, Self { first, values })
            }
        }

        impl WriteQuery for $write_many {
            fn write_request(&self) -> Request {
                let bytes = self.values.iter().flat_map(|value| value.to_le_bytes());
                write_plural($plural, self.first, self.values.len(), bytes)
            }
        }
    };
}

signals!("I/O group", u8, 0x78, 0x300, ReadIo, ReadIoGroups, WriteIo, WriteIoGroups);
signals!("register", u16, 0x79, 0x301, ReadRegister, ReadRegisters, WriteRegister, WriteRegisters);
