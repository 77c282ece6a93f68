//! Codec for ListIdentity and ListServices answers (volume 2, 2-4.2 and 2-4.6).

use std::fmt;
use std::net::SocketAddrV4;

use super::items::{sockaddr, sockaddr_bytes};
use super::{Item, Reader, WireError};

/// Item type of an identity.
pub const IDENTITY_ITEM: u16 = 0x000C;
/// Item type of the services.
pub const SERVICES_ITEM: u16 = 0x0100;
/// Version of the encapsulation protocol.
const VERSION: u16 = 1;
/// Maximum length of a product name (volume 1, 5-2.2).
const MAX_NAME_LEN: usize = 32;

/// Revision of a product.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Revision {
    /// Number before the dot.
    pub major: u8,
    /// Number after the dot.
    pub minor: u8,
}

impl fmt::Display for Revision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{:03}", self.major, self.minor)
    }
}

/// Identity of a device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Identity {
    /// Socket address that the device reports about itself. It can differ from the real address.
    pub address: SocketAddrV4,
    /// Vendor id.
    pub vendor: u16,
    /// Device type.
    pub device_type: u16,
    /// Product code.
    pub product: u16,
    /// Revision of the product.
    pub revision: Revision,
    /// Status bits: owned (bit 0), configured (bit 2), extended status (bits 7 to 4), faults (bits 11 to 8).
    pub status: u16,
    /// Serial number, unique for the vendor.
    pub serial: u32,
    /// Product name without trailing blanks and zeros. Bytes that are not ASCII are replaced. The name is untrusted
    /// data.
    pub name: String,
    /// State: 0 nonexistent, 1 self test, 2 standby, 3 operational, 4 and 5 faults, 255 unknown. `None` if the device
    /// omits it.
    pub state: Option<u8>,
}

impl Identity {
    /// Decodes the data of a ListIdentity answer; `None` if the data contains no identity item.
    pub fn parse(data: &[u8]) -> Result<Option<Self>, WireError> {
        let items = Item::parse_all(data)?;
        items.iter().find(|item| item.kind == IDENTITY_ITEM).map(|item| Self::parse_item(item.data)).transpose()
    }

    fn parse_item(bytes: &[u8]) -> Result<Self, WireError> {
        let mut reader = Reader::little(bytes);
        reader.u16("protocol version")?;
        let address = sockaddr(reader.take(16, "socket address")?)?;
        let mut identity = Self::read(&mut reader)?;
        identity.address = address;
        identity.state = reader.u8("state").ok();
        Ok(identity)
    }

    /// Decodes all attributes of the identity object. They contain no address and no state, so the result has the given
    /// `address`, and `None` as state.
    pub fn parse_attributes(bytes: &[u8], address: SocketAddrV4) -> Result<Self, WireError> {
        Ok(Self { address, ..Self::read(&mut Reader::little(bytes))? })
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, WireError> {
        let vendor = reader.u16("vendor")?;
        let device_type = reader.u16("device type")?;
        let product = reader.u16("product code")?;
        let revision = Revision { major: reader.u8("major revision")?, minor: reader.u8("minor revision")? };
        let status = reader.u16("status")?;
        let serial = reader.u32("serial number")?;
        let len = reader.u8("length of the product name")?;
        let name = reader.take(usize::from(len), "product name")?;
        let address = SocketAddrV4::new([0; 4].into(), 0);
        Ok(Self { address, vendor, device_type, product, revision, status, serial, name: text(name), state: None })
    }

    /// Encodes the data of a ListIdentity answer.
    pub fn emit(&self) -> Vec<u8> {
        let mut item = VERSION.to_le_bytes().to_vec();
        item.extend(sockaddr_bytes(self.address));
        item.extend(self.attributes());
        item.extend(self.state);
        Item::emit_all(&[Item::new(IDENTITY_ITEM, &item)])
    }

    /// Encodes attributes 1 to 7 of the identity object.
    pub fn attributes(&self) -> Vec<u8> {
        let mut out = Vec::new();
        out.extend(self.vendor.to_le_bytes());
        out.extend(self.device_type.to_le_bytes());
        out.extend(self.product.to_le_bytes());
        out.extend([self.revision.major, self.revision.minor]);
        out.extend(self.status.to_le_bytes());
        out.extend(self.serial.to_le_bytes());
        out.extend(self.name_attribute());
        out
    }

    /// Encodes the product name attribute: a length byte, then the characters.
    pub fn name_attribute(&self) -> Vec<u8> {
        let name: Vec<u8> = self.name.bytes().take(MAX_NAME_LEN).collect();
        [vec![u8::try_from(name.len()).unwrap_or_default()], name].concat()
    }
}

/// Communication services of a device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Services {
    /// Flags of the service. Bit 5: CIP over TCP; bit 8: cyclic data over UDP.
    pub flags: u16,
    /// Name of the service, normally "Communications". The name is untrusted data.
    pub name: String,
}

impl Services {
    /// Services of a device with cyclic data.
    pub fn cyclic() -> Self {
        Self { flags: 1 << 5 | 1 << 8, name: "Communications".to_owned() }
    }

    /// Decodes the data of a ListServices answer.
    pub fn parse(data: &[u8]) -> Result<Option<Self>, WireError> {
        let items = Item::parse_all(data)?;
        let Some(item) = items.iter().find(|item| item.kind == SERVICES_ITEM) else { return Ok(None) };
        let mut reader = Reader::little(item.data);
        reader.u16("protocol version")?;
        let flags = reader.u16("capability flags")?;
        Ok(Some(Self { flags, name: text(reader.rest()) }))
    }

    /// Encodes the data of a ListServices answer.
    pub fn emit(&self) -> Vec<u8> {
        let mut name: Vec<u8> = self.name.bytes().take(15).collect();
        name.resize(16, 0);
        let item = [&VERSION.to_le_bytes()[..], &self.flags.to_le_bytes(), &name].concat();
        Item::emit_all(&[Item::new(SERVICES_ITEM, &item)])
    }
}

/// Converts bytes to printable ASCII text; other bytes are replaced.
fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().rposition(|byte| !matches!(byte, 0 | b' ')).map_or(0, |last| last + 1);
    let shown = |byte: &u8| if (0x20..0x7F).contains(byte) { char::from(*byte) } else { char::REPLACEMENT_CHARACTER };
    bytes[..end].iter().map(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Command, Frame};
    use super::*;
    use crate::testing::hex;

    /// A PowerFlex 753, from cpppo's tests (enip_test.py, `listident_1_rpy`). The answer of the device contains two
    /// wrong lengths; this test corrects them.
    #[test]
    fn a_recorded_identity() {
        let bytes =
            hex("6300 4800 00000000 00000000 0000000000000000 00000000 0100 0C00 4200 0100 0002 AF12 0AA10105 \
             0000000000000000 0100 7B00 9004 0B 01 6105 151D4980 20 506F776572466C657820373533 \
             20202020202020202020202020202020202020 FF");
        let frame = Frame::parse(&bytes).unwrap();
        assert_eq!(frame.command, Command::LIST_IDENTITY);
        let identity = Identity::parse(frame.data).unwrap().unwrap();
        assert_eq!(identity.address, "10.161.1.5:44818".parse().unwrap());
        assert_eq!((identity.vendor, identity.device_type, identity.product), (1, 123, 1168));
        assert_eq!(identity.revision.to_string(), "11.001");
        assert_eq!((identity.status, identity.serial), (0x0561, 0x8049_1D15));
        assert_eq!((identity.name.as_str(), identity.state), ("PowerFlex 753", Some(255)));
        // In the name, only the blanks at the end are lost.
        let padded = Identity { name: format!("{:32}", identity.name), ..identity };
        assert_eq!(padded.emit(), frame.data);
    }

    /// The answer of a PowerFlex 525 (EIPScanner, TestDiscoveryManager.cpp). The original has a second, equal item.
    #[test]
    fn another_recorded_identity() {
        let bytes =
            hex("0100 0C00 4200 0100 0002 AF12 C0A8010F 0000000000000000 0100 9600 0900 05 01 3000 92E18D80 1D \
             506F776572466C6578203532352031502031313056202020 2E35304850 000000 FF");
        let identity = Identity::parse(&bytes);
        // The name is three bytes longer than its length field says. These bytes and the state are skipped.
        let identity = identity.unwrap().unwrap();
        assert_eq!(identity.name, "PowerFlex 525 1P 110V   .50HP");
        assert_eq!(identity.serial, 0x808D_E192);
    }

    #[test]
    fn attributes_read_back() {
        let identity = Identity {
            address: "10.0.0.1:44818".parse().unwrap(),
            vendor: 636,
            device_type: 43,
            product: 5,
            revision: Revision { major: 1, minor: 2 },
            status: 0x30,
            serial: 0x0102_0304,
            name: "RCX".to_owned(),
            state: None,
        };
        assert_eq!(Identity::parse_attributes(&identity.attributes(), identity.address), Ok(identity.clone()));
        assert_eq!(identity.name_attribute(), b"\x03RCX");
    }

    #[test]
    fn services_have_the_printed_layout() {
        let bytes = hex("0100 0001 1400 0100 2001 436F6D6D756E69636174696F6E73 0000");
        assert_eq!(Services::cyclic().emit(), bytes);
        assert_eq!(Services::parse(&bytes), Ok(Some(Services::cyclic())));
    }

    #[test]
    fn removes_control_characters_from_names() {
        assert_eq!(text(b"a\x1B[2Jb\0 \0"), "a\u{FFFD}[2Jb");
    }
}
