//! Codec for padded paths: objects, connection points, electronic keys (volume 1, appendix C-1).

use super::{Reader, WireError, words8};

/// Segment of a path.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Segment {
    /// Class.
    Class(u32),
    /// Instance. In a connection path with the assembly class, this is the configuration instance.
    Instance(u32),
    /// Attribute.
    Attribute(u32),
    /// Connection point: an assembly that the connection uses.
    Point(u32),
    /// Electronic key.
    Key(Key),
    /// Configuration data.
    Data(Vec<u8>),
    /// Port segment: a port and a link address that lead to the next network.
    Port {
        /// Port number; 1 is the backplane.
        port: u16,
        /// Link address, for example a slot.
        link: Vec<u8>,
    },
}

/// Electronic key: the identity that the device of a connection must have. A value of 0 matches any device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Key {
    /// Vendor id.
    pub vendor: u16,
    /// Device type.
    pub device_type: u16,
    /// Product code.
    pub product: u16,
    /// Major revision.
    pub major: u8,
    /// Minor revision.
    pub minor: u8,
    /// Whether the key also accepts a later revision that is compatible.
    pub compatible: bool,
}

const KEY_FORMAT: u8 = 4;
const COMPATIBLE: u8 = 0x80;

/// First bytes of the segment types with an 8-bit value. For a 16-bit value, the first byte is 1 higher; for a 32-bit
/// value, it is 2 higher. In both cases, a padding byte follows.
const CLASS: u8 = 0x20;
const INSTANCE: u8 = 0x24;
const POINT: u8 = 0x2C;
const ATTRIBUTE: u8 = 0x30;
const KEY: u8 = 0x34;
const DATA: u8 = 0x80;
/// Flag in a port segment. If it is set, the length of the link address follows in one byte.
const LONG_LINK: u8 = 0x10;
/// Value in a port segment that means: a 16-bit port number follows.
const LONG_PORT: u8 = 0x0F;

/// A sequence of segments.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct Path(pub Vec<Segment>);

impl Path {
    /// Returns the path of an instance. Instance 0 is the class itself.
    pub fn object(class: u32, instance: u32) -> Self {
        Self(vec![Segment::Class(class), Segment::Instance(instance)])
    }

    /// Returns the path of an attribute.
    pub fn attribute(class: u32, instance: u32, attribute: u32) -> Self {
        Self(vec![Segment::Class(class), Segment::Instance(instance), Segment::Attribute(attribute)])
    }

    /// Class, instance and attribute of the path; `None` if the path has other segments.
    pub fn object_named(&self) -> Option<(u32, u32, Option<u32>)> {
        match self.0[..] {
            [Segment::Class(class)] => Some((class, 0, None)),
            [Segment::Class(class), Segment::Instance(instance)] => Some((class, instance, None)),
            [Segment::Class(class), Segment::Attribute(attribute)] => Some((class, 0, Some(attribute))),
            [Segment::Class(class), Segment::Instance(instance), Segment::Attribute(attribute)] => {
                Some((class, instance, Some(attribute)))
            }
            _ => None,
        }
    }

    /// Decodes a path. All bytes must belong to the path.
    pub fn parse(bytes: &[u8]) -> Result<Self, WireError> {
        let mut reader = Reader::little(bytes);
        let mut segments = Vec::new();
        while !reader.is_empty() {
            segments.push(segment(&mut reader)?);
        }
        Ok(Self(segments))
    }

    /// Encodes the path. The number of bytes is always even.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Vec::new();
        for segment in &self.0 {
            emit(segment, &mut out);
        }
        out
    }
}

fn segment(reader: &mut Reader<'_>) -> Result<Segment, WireError> {
    let first = reader.u8("path segment")?;
    let make: fn(u32) -> Segment = match first & !0b11 {
        CLASS => Segment::Class,
        INSTANCE => Segment::Instance,
        POINT => Segment::Point,
        ATTRIBUTE => Segment::Attribute,
        _ if first == KEY => return key(reader),
        _ if first == DATA => {
            let words = reader.u8("words of configuration data")?;
            return Ok(Segment::Data(reader.take(usize::from(words) * 2, "configuration data")?.to_vec()));
        }
        0x00..CLASS => return port(reader, first),
        _ => return Err(reader.wrong("path segment", 1, first)),
    };
    let value = match first & 0b11 {
        0 => u32::from(reader.u8("path segment value")?),
        1 => {
            reader.u8("path segment padding")?;
            u32::from(reader.u16("path segment value")?)
        }
        2 => {
            reader.u8("path segment padding")?;
            reader.u32("path segment value")?
        }
        _ => return Err(reader.wrong("path segment", 1, first)),
    };
    Ok(make(value))
}

fn key(reader: &mut Reader<'_>) -> Result<Segment, WireError> {
    let format = reader.u8("key format")?;
    if format != KEY_FORMAT {
        return Err(reader.wrong("key format", 1, format));
    }
    let vendor = reader.u16("key vendor")?;
    let device_type = reader.u16("key device type")?;
    let product = reader.u16("key product")?;
    let major = reader.u8("key major revision")?;
    let minor = reader.u8("key minor revision")?;
    let compatible = major & COMPATIBLE != 0;
    Ok(Segment::Key(Key { vendor, device_type, product, major: major & !COMPATIBLE, minor, compatible }))
}

fn port(reader: &mut Reader<'_>, first: u8) -> Result<Segment, WireError> {
    let start = reader.at - 1;
    let len = if first & LONG_LINK == 0 { 1 } else { usize::from(reader.u8("link address length")?) };
    let port = match first & 0x0F {
        LONG_PORT => reader.u16("port")?,
        port => u16::from(port),
    };
    let link = reader.take(len, "link address")?.to_vec();
    if (reader.at - start) % 2 == 1 {
        reader.u8("link address padding")?;
    }
    Ok(Segment::Port { port, link })
}

fn emit(segment: &Segment, out: &mut Vec<u8>) {
    match segment {
        Segment::Class(value) => logical(CLASS, *value, out),
        Segment::Instance(value) => logical(INSTANCE, *value, out),
        Segment::Point(value) => logical(POINT, *value, out),
        Segment::Attribute(value) => logical(ATTRIBUTE, *value, out),
        Segment::Key(key) => {
            out.extend([KEY, KEY_FORMAT]);
            out.extend(key.vendor.to_le_bytes());
            out.extend(key.device_type.to_le_bytes());
            out.extend(key.product.to_le_bytes());
            out.extend([key.major | if key.compatible { COMPATIBLE } else { 0 }, key.minor]);
        }
        Segment::Data(data) => {
            out.extend([DATA, words8(data.len())]);
            out.extend(data);
            pad(out);
        }
        Segment::Port { port, link } => {
            let long_link = link.len() != 1;
            let short = u8::try_from(*port).ok().filter(|port| *port < LONG_PORT);
            out.push(short.unwrap_or(LONG_PORT) | if long_link { LONG_LINK } else { 0 });
            if long_link {
                out.push(u8::try_from(link.len()).expect("link addresses are short"));
            }
            if short.is_none() {
                out.extend(port.to_le_bytes());
            }
            out.extend(link);
            pad(out);
        }
    }
}

/// Encodes a logical segment in the shortest form that fits the value.
fn logical(first: u8, value: u32, out: &mut Vec<u8>) {
    if let Ok(value) = u8::try_from(value) {
        out.extend([first, value]);
    } else if let Ok(value) = u16::try_from(value) {
        out.extend([first | 1, 0]);
        out.extend(value.to_le_bytes());
    } else {
        out.extend([first | 2, 0]);
        out.extend(value.to_le_bytes());
    }
}

/// Pads the path to an even length. All earlier segments have an even length, so the test of the total length is
/// sufficient.
fn pad(out: &mut Vec<u8>) {
    if out.len() % 2 == 1 {
        out.push(0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::hex;

    /// The expected bytes are from volume 1: C-1.4.2 for logical segments, C-1.4.5 for the electronic key.
    #[test]
    fn segments_have_the_printed_forms() {
        let cases = [
            ("20 05", Segment::Class(5)),
            ("21 00 34 12", Segment::Class(0x1234)),
            ("26 00 78 56 34 12", Segment::Instance(0x1234_5678)),
            ("2C 96", Segment::Point(150)),
            ("31 00 00 01", Segment::Attribute(256)),
            ("80 02 01 02 03 04", Segment::Data(vec![1, 2, 3, 4])),
            ("01 05", Segment::Port { port: 1, link: vec![5] }),
            ("12 03 31 2E 32 00", Segment::Port { port: 2, link: b"1.2".to_vec() }),
            (
                "34 04 7C 02 2B 00 05 00 82 01",
                Segment::Key(Key { vendor: 636, device_type: 43, product: 5, major: 2, minor: 1, compatible: true }),
            ),
        ];
        for (text, segment) in cases {
            let path = Path(vec![segment]);
            assert_eq!(path.emit(), hex(text), "{path:?}");
            assert_eq!(Path::parse(&hex(text)), Ok(path));
        }
    }

    #[test]
    fn reports_an_unknown_segment_with_its_offset() {
        let error = Path::parse(&hex("20 04 60 00")).unwrap_err();
        assert_eq!((error.field, error.offset), ("path segment", 2));
        assert_eq!(error.to_string(), "path segment at offset 2: is 0x60");
    }
}
