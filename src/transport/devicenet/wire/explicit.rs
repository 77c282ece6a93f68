//! Explicit messages: a header byte, a service, and in requests which object is meant.

use super::Mac;

/// Codes of services; an answer has `ANSWER` added.
pub mod service {
    /// Restart the node.
    pub const RESET: u8 = 0x05;
    /// Read an attribute.
    pub const GET: u8 = 0x0E;
    /// Change an attribute.
    pub const SET: u8 = 0x10;
    /// In answers: no.
    pub const ERROR: u8 = 0x14;
    /// Allocate connections of the predefined set.
    pub const ALLOCATE: u8 = 0x4B;
    /// Release them.
    pub const RELEASE: u8 = 0x4C;
    /// A node says that it lives.
    pub const HEARTBEAT: u8 = 0x4D;
    /// A node says that it goes off line.
    pub const SHUTDOWN: u8 = 0x4E;
    /// Set in the service of answers.
    pub const ANSWER: u8 = 0x80;
}

/// Numbers of classes.
pub mod class {
    /// Who a node is.
    pub const IDENTITY: u8 = 1;
    /// Its MAC, bit rate, and who has its connections.
    pub const DEVICENET: u8 = 3;
    /// Data that are carried together.
    pub const ASSEMBLY: u8 = 4;
    /// A connection.
    pub const CONNECTION: u8 = 5;
}

/// Connections of the predefined set, as allocation names them, and their instances.
pub mod connection {
    /// For explicit messages.
    pub const EXPLICIT: u8 = 0x01;
    /// For polls.
    pub const POLL: u8 = 0x02;
    /// Instance of the explicit connection.
    pub const EXPLICIT_INSTANCE: u8 = 1;
    /// Instance of the poll connection.
    pub const POLL_INSTANCE: u8 = 2;
}

/// General codes of refusals.
pub mod general {
    /// No room for another.
    pub const NO_RESOURCE: u8 = 0x02;
    /// There is no such object.
    pub const NO_PATH: u8 = 0x05;
    /// The object has no such service.
    pub const NO_SERVICE: u8 = 0x08;
    /// The value is not one that the attribute can have.
    pub const INVALID_VALUE: u8 = 0x09;
    /// It is so already.
    pub const ALREADY: u8 = 0x0B;
    /// Not now.
    pub const CONFLICT: u8 = 0x0C;
    /// The attribute cannot be changed.
    pub const NOT_SETTABLE: u8 = 0x0E;
    /// Too few bytes.
    pub const TOO_SHORT: u8 = 0x13;
    /// There is no such attribute.
    pub const NO_ATTRIBUTE: u8 = 0x14;
    /// Too many bytes.
    pub const TOO_LONG: u8 = 0x15;
    /// There is no such instance.
    pub const NO_INSTANCE: u8 = 0x16;
    /// A parameter is wrong.
    pub const INVALID_PARAMETER: u8 = 0x20;

    /// What a general code means.
    pub const fn meaning(code: u8) -> &'static str {
        match code {
            NO_RESOURCE => "no resource left",
            0x04 | NO_PATH => "no such object",
            NO_SERVICE => "no such service",
            INVALID_VALUE => "invalid value",
            ALREADY => "it is in that state already",
            CONFLICT => "not in its present state",
            NOT_SETTABLE => "not settable",
            0x0F => "no permission",
            0x10 => "its state does not allow that",
            0x11 => "the answer is too long",
            TOO_SHORT => "not enough data",
            NO_ATTRIBUTE => "no such attribute",
            TOO_LONG => "too much data",
            NO_INSTANCE => "no such instance",
            INVALID_PARAMETER => "invalid parameter",
            _ => "refused",
        }
    }
}

/// Additional codes of refusals to allocate or release.
pub mod owner {
    /// Another master has the connections.
    pub const ANOTHER_MASTER: u8 = 0x01;
    /// The choice is not possible.
    pub const INVALID_CHOICE: u8 = 0x02;
    /// A node that knows group 2 only takes nothing else without a connection.
    pub const UNCONNECTED: u8 = 0x03;
    /// No room.
    pub const NO_RESOURCE: u8 = 0x04;
    /// None.
    pub const NONE: u8 = 0xFF;
}

/// How class and instance are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Format {
    /// Both in 8 bits.
    Byte8Byte8,
    /// Class in 8, instance in 16.
    Byte8Word16,
    /// Both in 16.
    Word16Word16,
    /// Class in 16, instance in 8.
    Word16Byte8,
}

impl Format {
    /// From its code in the answer to an allocation; 4 is a path, and above that nothing is defined.
    pub const fn from_code(code: u8) -> Option<Self> {
        Some(match code {
            0 => Self::Byte8Byte8,
            1 => Self::Byte8Word16,
            2 => Self::Word16Word16,
            3 => Self::Word16Byte8,
            _ => return None,
        })
    }

    /// Its code.
    pub const fn code(self) -> u8 {
        match self {
            Self::Byte8Byte8 => 0,
            Self::Byte8Word16 => 1,
            Self::Word16Word16 => 2,
            Self::Word16Byte8 => 3,
        }
    }
}

/// The first byte of an explicit message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Header {
    /// Whether a fragment follows.
    pub is_fragment: bool,
    /// Tells requests apart; an answer repeats it.
    pub xid: bool,
    /// The node at the other end.
    pub mac: Mac,
}

impl Header {
    const FRAGMENT: u8 = 0x80;
    const XID: u8 = 0x40;

    /// Reads the byte.
    pub const fn parse(byte: u8) -> Self {
        Self {
            is_fragment: byte & Self::FRAGMENT != 0,
            xid: byte & Self::XID != 0,
            mac: Mac::from_bits(u16::from_le_bytes([byte, 0])),
        }
    }

    /// The byte.
    pub const fn emit(self) -> u8 {
        let fragment = if self.is_fragment { Self::FRAGMENT } else { 0 };
        let xid = if self.xid { Self::XID } else { 0 };
        fragment | xid | self.mac.number()
    }
}

/// A request, behind its header.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Request {
    /// What is to be done.
    pub service: u8,
    /// The class of the object.
    pub class: u16,
    /// Which of them; 0 is the class itself.
    pub instance: u16,
    /// What else the service needs.
    pub data: Vec<u8>,
}

impl Request {
    /// Reads an attribute.
    pub fn get(class: u8, instance: u16, attribute: u8) -> Self {
        Self { service: service::GET, class: class.into(), instance, data: vec![attribute] }
    }

    /// Changes an attribute.
    pub fn set(class: u8, instance: u16, attribute: u8, value: &[u8]) -> Self {
        let data = [&[attribute], value].concat();
        Self { service: service::SET, class: class.into(), instance, data }
    }

    /// Allocates connections for this master.
    pub fn allocate(choice: u8, master: Mac) -> Self {
        let data = vec![choice, master.number()];
        Self { service: service::ALLOCATE, class: class::DEVICENET.into(), instance: 1, data }
    }

    /// Releases connections.
    pub fn release(choice: u8) -> Self {
        Self { service: service::RELEASE, class: class::DEVICENET.into(), instance: 1, data: vec![choice] }
    }

    /// The bytes; `None` if class or instance are too high for the format.
    pub fn emit(&self, format: Format) -> Option<Vec<u8>> {
        let mut bytes = vec![self.service];
        let byte = |value: u16| u8::try_from(value).ok().map(|value| vec![value]);
        let word = |value: u16| Some(value.to_le_bytes().to_vec());
        let (class, instance) = match format {
            Format::Byte8Byte8 => (byte(self.class)?, byte(self.instance)?),
            Format::Byte8Word16 => (byte(self.class)?, word(self.instance)?),
            Format::Word16Word16 => (word(self.class)?, word(self.instance)?),
            Format::Word16Byte8 => (word(self.class)?, byte(self.instance)?),
        };
        bytes.extend(class);
        bytes.extend(instance);
        bytes.extend(&self.data);
        Some(bytes)
    }

    /// Reads it; `None` if it is too short, or an answer.
    pub fn parse(format: Format, bytes: &[u8]) -> Option<Self> {
        let (service, rest) = bytes.split_first()?;
        if service & service::ANSWER != 0 {
            return None;
        }
        let (wide_class, wide_instance) = match format {
            Format::Byte8Byte8 => (false, false),
            Format::Byte8Word16 => (false, true),
            Format::Word16Word16 => (true, true),
            Format::Word16Byte8 => (true, false),
        };
        let (class, rest) = number(rest, wide_class)?;
        let (instance, data) = number(rest, wide_instance)?;
        Some(Self { service: *service, class, instance, data: data.to_vec() })
    }
}

fn number(bytes: &[u8], is_wide: bool) -> Option<(u16, &[u8])> {
    let (low, rest) = bytes.split_first()?;
    if !is_wide {
        return Some((u16::from(*low), rest));
    }
    let (high, rest) = rest.split_first()?;
    Some((u16::from_le_bytes([*low, *high]), rest))
}

/// An answer, behind its header.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Answer {
    /// Done, with what was asked for.
    Done {
        /// The service of the request.
        service: u8,
        /// What it answers.
        data: Vec<u8>,
    },
    /// No.
    Refused {
        /// The general code.
        general: u8,
        /// The additional one; `FF` is none.
        additional: u8,
    },
}

impl Answer {
    /// Reads it; `None` if it is none.
    pub fn parse(bytes: &[u8]) -> Option<Self> {
        let (service, data) = bytes.split_first()?;
        if service & service::ANSWER == 0 {
            return None;
        }
        match service & !service::ANSWER {
            service::ERROR => match data {
                [general, rest @ ..] => {
                    Some(Self::Refused { general: *general, additional: rest.first().copied().unwrap_or(owner::NONE) })
                }
                [] => None,
            },
            service => Some(Self::Done { service, data: data.to_vec() }),
        }
    }

    /// The bytes.
    pub fn emit(&self) -> Vec<u8> {
        match self {
            Self::Done { service, data } => {
                let mut bytes = vec![service | service::ANSWER];
                bytes.extend(data);
                bytes
            }
            Self::Refused { general, additional } => {
                vec![service::ERROR | service::ANSWER, *general, *additional]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const FORMATS: [Format; 4] = [Format::Byte8Byte8, Format::Byte8Word16, Format::Word16Word16, Format::Word16Byte8];

    fn mac(number: u8) -> Mac {
        Mac::new(number).unwrap()
    }

    /// The start of a connection of master 1 with slave 5, behind the header 01.
    #[test]
    fn requests_of_a_start_have_the_recorded_bytes() {
        for (request, bytes) in [
            (Request::allocate(connection::EXPLICIT | connection::POLL, mac(1)), vec![0x4B, 3, 1, 3, 1]),
            (Request::get(class::IDENTITY, 1, 1), vec![0x0E, 1, 1, 1]),
            (Request::get(class::CONNECTION, 2, 7), vec![0x0E, 5, 2, 7]),
            (Request::set(class::CONNECTION, 2, 9, &100u16.to_le_bytes()), vec![0x10, 5, 2, 9, 0x64, 0]),
            (Request::release(3), vec![0x4C, 3, 1, 3]),
        ] {
            assert_eq!(request.emit(Format::Byte8Byte8), Some(bytes.clone()));
            assert_eq!(Request::parse(Format::Byte8Byte8, &bytes), Some(request));
        }
        assert_eq!(Header { is_fragment: false, xid: false, mac: mac(1) }.emit(), 1);
        assert_eq!(Header { is_fragment: true, xid: true, mac: mac(5) }.emit(), 0xC5);
    }

    #[test]
    fn answers_and_refusals_have_the_recorded_bytes() {
        for (bytes, answer) in [
            (vec![0xCB, 0], Answer::Done { service: 0x4B, data: vec![0] }),
            (vec![0x8E, 0x30, 0], Answer::Done { service: 0x0E, data: vec![0x30, 0] }),
            (vec![0x94, 0x0B, 2], Answer::Refused { general: 0x0B, additional: 2 }),
            (vec![0x94, 0x0C, 1], Answer::Refused { general: general::CONFLICT, additional: owner::ANOTHER_MASTER }),
        ] {
            assert_eq!(Answer::parse(&bytes), Some(answer.clone()));
            assert_eq!(answer.emit(), bytes);
        }
        // A heartbeat and a shutdown are no answers.
        for service in [service::HEARTBEAT, service::SHUTDOWN] {
            assert_eq!(Answer::parse(&[service, 1, 0, 0]), None);
        }
        assert_eq!(Answer::parse(&[]), None);
        assert_eq!(Answer::parse(&[0x94]), None);
    }

    proptest! {
        #[test]
        fn requests_come_back_in_every_format(
            service in 0u8..0x80,
            class: u16,
            instance: u16,
            data in proptest::collection::vec(any::<u8>(), 0..40),
        ) {
            let request = Request { service, class, instance, data };
            for format in FORMATS {
                if let Some(bytes) = request.emit(format) {
                    prop_assert_eq!(Request::parse(format, &bytes), Some(request.clone()));
                }
                prop_assert_eq!(Format::from_code(format.code()), Some(format));
            }
            prop_assert!(request.emit(Format::Word16Word16).is_some());
        }

        #[test]
        fn no_bytes_panic(bytes in proptest::collection::vec(any::<u8>(), 0..20)) {
            for format in FORMATS {
                let _ = Request::parse(format, &bytes);
            }
            if let Some(answer) = Answer::parse(&bytes)
                && !matches!(answer, Answer::Refused { .. })
            {
                prop_assert_eq!(answer.emit(), bytes);
            }
        }

        #[test]
        fn headers_come_back(byte: u8) {
            prop_assert_eq!(Header::parse(byte).emit(), byte);
        }
    }
}
