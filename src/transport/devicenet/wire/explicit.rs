//! Codec for explicit messages: header, service, path, data.

use super::Mac;

/// Service codes. In answers, the bit `ANSWER` is added.
pub mod service {
    /// Restart the node.
    pub const RESET: u8 = 0x05;
    /// Read an attribute.
    pub const GET: u8 = 0x0E;
    /// Change an attribute.
    pub const SET: u8 = 0x10;
    /// Error response. It is not a service of a request.
    pub const ERROR: u8 = 0x14;
    /// Allocate connections of the predefined set.
    pub const ALLOCATE: u8 = 0x4B;
    /// Release connections of the predefined set.
    pub const RELEASE: u8 = 0x4C;
    /// Heartbeat of a node.
    pub const HEARTBEAT: u8 = 0x4D;
    /// Report that a node goes off line.
    pub const SHUTDOWN: u8 = 0x4E;
    /// Bit that is set in the service code of an answer.
    pub const ANSWER: u8 = 0x80;
}

/// Class codes.
pub mod class {
    /// Identity object.
    pub const IDENTITY: u8 = 1;
    /// DeviceNet object: MAC, bit rate, allocation.
    pub const DEVICENET: u8 = 3;
    /// Assembly object.
    pub const ASSEMBLY: u8 = 4;
    /// Connection object.
    pub const CONNECTION: u8 = 5;
}

/// Bits of the allocation choice, and instances of the predefined connections.
pub mod connection {
    /// Explicit messages.
    pub const EXPLICIT: u8 = 0x01;
    /// Polls.
    pub const POLL: u8 = 0x02;
    /// Instance of the explicit connection.
    pub const EXPLICIT_INSTANCE: u8 = 1;
    /// Instance of the poll connection.
    pub const POLL_INSTANCE: u8 = 2;
}

/// General error codes.
pub mod general {
    /// The slave has no free resource.
    pub const NO_RESOURCE: u8 = 0x02;
    /// The object does not exist.
    pub const NO_PATH: u8 = 0x05;
    /// The object does not have this service.
    pub const NO_SERVICE: u8 = 0x08;
    /// Invalid attribute value.
    pub const INVALID_VALUE: u8 = 0x09;
    /// The object is already in the requested state.
    pub const ALREADY: u8 = 0x0B;
    /// The request is not possible in the current state.
    pub const CONFLICT: u8 = 0x0C;
    /// The attribute is read-only.
    pub const NOT_SETTABLE: u8 = 0x0E;
    /// The request contains too little data.
    pub const TOO_SHORT: u8 = 0x13;
    /// The object does not have this attribute.
    pub const NO_ATTRIBUTE: u8 = 0x14;
    /// The request contains too much data.
    pub const TOO_LONG: u8 = 0x15;
    /// The instance does not exist.
    pub const NO_INSTANCE: u8 = 0x16;
    /// A parameter is invalid.
    pub const INVALID_PARAMETER: u8 = 0x20;

    /// Text of a general error code.
    pub const fn meaning(code: u8) -> &'static str {
        match code {
            NO_RESOURCE => "no resource left",
            0x04 | NO_PATH => "the device has no such object",
            NO_SERVICE => "no such service",
            INVALID_VALUE => "invalid value",
            ALREADY => "it is already in that state",
            CONFLICT => "not possible in its present state",
            NOT_SETTABLE => "not settable",
            0x0F => "no permission",
            0x10 => "its state does not allow this",
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

/// Additional error codes in answers to allocate and release.
pub mod owner {
    /// Another master owns the connections.
    pub const ANOTHER_MASTER: u8 = 0x01;
    /// The choice is not valid.
    pub const INVALID_CHOICE: u8 = 0x02;
    /// The slave is a group 2 only server. It accepts no other unconnected service than allocate and release.
    pub const UNCONNECTED: u8 = 0x03;
    /// There is no additional code.
    pub const NONE: u8 = 0xFF;
}

/// Widths of the class number and the instance number in requests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Format {
    /// 8-bit class, 8-bit instance.
    Byte8Byte8,
    /// 8-bit class, 16-bit instance.
    Byte8Word16,
    /// 16-bit class, 16-bit instance.
    Word16Word16,
    /// 16-bit class, 8-bit instance.
    Word16Byte8,
}

impl Format {
    /// Decodes the message body format in the answer to an allocation. `None` for code 4, which means a path, and for
    /// higher codes, which are not defined.
    pub const fn from_code(code: u8) -> Option<Self> {
        Some(match code {
            0 => Self::Byte8Byte8,
            1 => Self::Byte8Word16,
            2 => Self::Word16Word16,
            3 => Self::Word16Byte8,
            _ => return None,
        })
    }

    /// Code of the format.
    pub const fn code(self) -> u8 {
        match self {
            Self::Byte8Byte8 => 0,
            Self::Byte8Word16 => 1,
            Self::Word16Word16 => 2,
            Self::Word16Byte8 => 3,
        }
    }
}

/// Header byte of an explicit message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Header {
    /// Whether a fragment byte follows.
    pub is_fragment: bool,
    /// Transaction id. The answer has the same transaction id as the request.
    pub xid: bool,
    /// MAC of the other node.
    pub mac: Mac,
}

impl Header {
    const FRAGMENT: u8 = 0x80;
    const XID: u8 = 0x40;

    /// Decodes the byte.
    pub const fn parse(byte: u8) -> Self {
        Self {
            is_fragment: byte & Self::FRAGMENT != 0,
            xid: byte & Self::XID != 0,
            mac: Mac::from_bits(u16::from_le_bytes([byte, 0])),
        }
    }

    /// Encodes the byte.
    pub const fn emit(self) -> u8 {
        let fragment = if self.is_fragment { Self::FRAGMENT } else { 0 };
        let xid = if self.xid { Self::XID } else { 0 };
        fragment | xid | self.mac.number()
    }
}

/// A request without its header.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Request {
    /// Service code.
    pub service: u8,
    /// Class of the object.
    pub class: u16,
    /// Instance number; 0 means the class itself.
    pub instance: u16,
    /// Service data.
    pub data: Vec<u8>,
}

impl Request {
    /// Creates a Get_Attribute_Single request.
    pub fn get(class: u8, instance: u16, attribute: u8) -> Self {
        Self { service: service::GET, class: class.into(), instance, data: vec![attribute] }
    }

    /// Creates a Set_Attribute_Single request.
    pub fn set(class: u8, instance: u16, attribute: u8, value: &[u8]) -> Self {
        let data = [&[attribute], value].concat();
        Self { service: service::SET, class: class.into(), instance, data }
    }

    /// Creates a request that allocates connections for this master.
    pub fn allocate(choice: u8, master: Mac) -> Self {
        let data = vec![choice, master.number()];
        Self { service: service::ALLOCATE, class: class::DEVICENET.into(), instance: 1, data }
    }

    /// Creates a request that releases connections.
    pub fn release(choice: u8) -> Self {
        Self { service: service::RELEASE, class: class::DEVICENET.into(), instance: 1, data: vec![choice] }
    }

    /// Encodes the request. Returns `None` if the class or the instance does not fit the format.
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

    /// Decodes a request; `None` if the message is too short or is an answer.
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

/// An answer without its header.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Answer {
    /// Success.
    Done {
        /// Service code of the request.
        service: u8,
        /// Service data.
        data: Vec<u8>,
    },
    /// Error response.
    Refused {
        /// General error code.
        general: u8,
        /// Additional error code; `FF` means that there is none.
        additional: u8,
    },
}

impl Answer {
    /// Decodes an answer; `None` if the message is not an answer.
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

    /// Encodes the answer.
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

    /// Master 1 opens a connection to slave 5. The header byte is 01.
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
        // Heartbeat and shutdown are not answers.
        for service in [service::HEARTBEAT, service::SHUTDOWN] {
            assert_eq!(Answer::parse(&[service, 1, 0, 0]), None);
        }
        assert_eq!(Answer::parse(&[]), None);
        assert_eq!(Answer::parse(&[0x94]), None);
    }

    proptest! {
        #[test]
        fn requests_round_trip_in_every_format(
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
        fn headers_round_trip(byte: u8) {
            prop_assert_eq!(Header::parse(byte).emit(), byte);
        }
    }
}
