//! Codec for the common packet format: typed items with lengths (volume 2, 2-6).

use crate::refuse_if;
use std::net::{Ipv4Addr, SocketAddrV4};

use super::{Reader, WireError, len16};

/// Item types.
pub mod kind {
    /// Null address of an unconnected message.
    pub const NULL: u16 = 0x0000;
    /// Connected message.
    pub const CONNECTED_DATA: u16 = 0x00B1;
    /// Unconnected message.
    pub const UNCONNECTED_DATA: u16 = 0x00B2;
    /// Socket address for cyclic data to the target.
    pub const SOCKADDR_O_T: u16 = 0x8000;
    /// Socket address for cyclic data to the originator.
    pub const SOCKADDR_T_O: u16 = 0x8001;
    /// Connection id and sequence number.
    pub const SEQUENCED_ADDRESS: u16 = 0x8002;
}

/// Maximum number of items in a packet. No message has more than four.
const MAX_ITEMS: u16 = 16;
/// Address family of IPv4 in a socket address.
const AF_INET: u16 = 2;

/// An item.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Item<'a> {
    /// Item type; see [`kind`].
    pub kind: u16,
    /// Item data, at most 65,535 bytes.
    pub data: &'a [u8],
}

impl<'a> Item<'a> {
    /// Creates an item.
    pub const fn new(kind: u16, data: &'a [u8]) -> Self {
        Self { kind, data }
    }

    /// Decodes the item count and the items. Fails if bytes follow after the items.
    pub fn parse_all(bytes: &'a [u8]) -> Result<Vec<Self>, WireError> {
        Self::read_all(&mut Reader::little(bytes))
    }

    fn read_all(reader: &mut Reader<'a>) -> Result<Vec<Self>, WireError> {
        let items = Self::read_counted(reader)?;
        reader.end("end of the items")?;
        Ok(items)
    }

    /// Decodes the item count and the items. More bytes may follow after the items.
    fn read_counted(reader: &mut Reader<'a>) -> Result<Vec<Self>, WireError> {
        let count = reader.u16("item count")?;
        refuse_if(count > MAX_ITEMS, reader.wrong("item count", 2, count))?;
        let mut items = Vec::with_capacity(usize::from(count));
        for _ in 0..count {
            items.push(Self::read(reader)?);
        }
        Ok(items)
    }

    fn read(reader: &mut Reader<'a>) -> Result<Self, WireError> {
        let kind = reader.u16("item type")?;
        let len = reader.u16("item length")?;
        Ok(Self { kind, data: reader.take(usize::from(len), "item")? })
    }

    /// Encodes the item count and the items.
    pub fn emit_all(items: &[Self]) -> Vec<u8> {
        let mut out = Vec::with_capacity(2 + items.iter().map(|item| 4 + item.data.len()).sum::<usize>());
        out.extend(len16(items.len()));
        for item in items {
            out.extend(item.kind.to_le_bytes());
            out.extend(len16(item.data.len()));
            out.extend(item.data);
        }
        out
    }
}

/// Data of SendRRData: an unconnected message, with optional socket addresses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RrData<'a> {
    /// Timeout in seconds; 0 means that the message contains its own timeout.
    pub timeout: u16,
    /// The CIP message.
    pub message: &'a [u8],
    /// Socket address for cyclic data to the target.
    pub o_t: Option<SocketAddrV4>,
    /// Socket address for cyclic data to the originator.
    pub t_o: Option<SocketAddrV4>,
}

impl<'a> RrData<'a> {
    /// Creates data with a message and without socket addresses.
    pub const fn new(message: &'a [u8]) -> Self {
        Self { timeout: 0, message, o_t: None, t_o: None }
    }

    /// Decodes the data of a frame. Fails if bytes follow after the counted items.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, WireError> {
        let mut reader = Reader::little(bytes);
        let timeout = Self::head(&mut reader)?;
        let items = Item::read_all(&mut reader)?;
        let address = |kind| items.iter().find(|item| item.kind == kind).map(|item| sockaddr(item.data)).transpose();
        let (o_t, t_o) = (address(kind::SOCKADDR_O_T)?, address(kind::SOCKADDR_T_O)?);
        Ok(Self { timeout, message: Self::message(&items, &reader)?, o_t, t_o })
    }

    /// Decodes the data of an answer. Some devices append items that the count does not include, for example a socket
    /// address after a refusal. Such items are used if they can be decoded. Otherwise they are ignored.
    pub fn parse_answer(bytes: &'a [u8]) -> Result<Self, WireError> {
        let mut reader = Reader::little(bytes);
        let timeout = Self::head(&mut reader)?;
        let mut items = Item::read_counted(&mut reader)?;
        let room = usize::from(MAX_ITEMS).saturating_sub(items.len());
        items.extend(std::iter::from_fn(|| Item::read(&mut reader).ok()).take(room));
        let address = |kind| items.iter().filter(|item| item.kind == kind).find_map(|item| sockaddr(item.data).ok());
        let (o_t, t_o) = (address(kind::SOCKADDR_O_T), address(kind::SOCKADDR_T_O));
        Ok(Self { timeout, message: Self::message(&items, &reader)?, o_t, t_o })
    }

    /// Decodes the fields before the items. Returns the timeout.
    fn head(reader: &mut Reader<'a>) -> Result<u16, WireError> {
        let interface = reader.u32("interface handle")?;
        refuse_if(interface != 0, reader.wrong("interface handle", 4, interface))?;
        reader.u16("timeout")
    }

    fn message(items: &[Item<'a>], reader: &Reader<'_>) -> Result<&'a [u8], WireError> {
        let message = items.iter().find(|item| item.kind == kind::UNCONNECTED_DATA);
        Ok(message.ok_or_else(|| reader.wrong("unconnected data item", 0, 0u8))?.data)
    }

    /// Encodes the data of a frame.
    pub fn emit(&self) -> Vec<u8> {
        let addresses = [(kind::SOCKADDR_O_T, self.o_t), (kind::SOCKADDR_T_O, self.t_o)];
        let addresses: Vec<(u16, [u8; 16])> =
            addresses.into_iter().filter_map(|(kind, address)| Some((kind, sockaddr_bytes(address?)))).collect();
        let mut items = vec![Item::new(kind::NULL, &[]), Item::new(kind::UNCONNECTED_DATA, self.message)];
        items.extend(addresses.iter().map(|(kind, bytes)| Item::new(*kind, bytes)));
        let mut out = vec![0; 4];
        out.extend(self.timeout.to_le_bytes());
        out.extend(Item::emit_all(&items));
        out
    }
}

/// Decodes a socket address. It is big-endian (volume 2, 2-6.3.3).
pub(super) fn sockaddr(bytes: &[u8]) -> Result<SocketAddrV4, WireError> {
    let mut reader = Reader::little(bytes);
    let family = u16::from_be_bytes(reader.array("address family")?);
    refuse_if(family != AF_INET, reader.wrong("address family", 2, family))?;
    let port = u16::from_be_bytes(reader.array("port")?);
    let address = Ipv4Addr::from(reader.array::<4>("address")?);
    reader.take(8, "padding of the address")?;
    reader.end("end of the address")?;
    Ok(SocketAddrV4::new(address, port))
}

pub(super) fn sockaddr_bytes(address: SocketAddrV4) -> [u8; 16] {
    let mut out = [0; 16];
    out[0..2].copy_from_slice(&AF_INET.to_be_bytes());
    out[2..4].copy_from_slice(&address.port().to_be_bytes());
    out[4..8].copy_from_slice(&address.ip().octets());
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::hex;

    #[test]
    fn parses_addresses_next_to_the_message() {
        let data = RrData { t_o: Some("0.0.0.0:2222".parse().unwrap()), ..RrData::new(&[0x0E, 0]) };
        let bytes = hex("00000000 0000 0300 0000 0000 B200 0200 0E00 0180 1000 0002 08AE 00000000 0000000000000000");
        assert_eq!(data.emit(), bytes);
        assert_eq!(RrData::parse(&bytes), Ok(data));
    }

    /// First a refusal with two counted items and a socket address after them, then a refusal with bytes after the
    /// items that are not an item.
    #[test]
    fn ignores_bytes_after_an_answer() {
        let counted = "00000000 0000 0200 0000 0000 B200 0600 D400 0101 0601";
        let address = "0080 1000 0002 08AE 0A000001 0000000000000000";
        let bytes = hex(&format!("{counted} {address}"));
        assert_eq!(RrData::parse(&bytes).unwrap_err().field, "end of the items");
        let answer = RrData::parse_answer(&bytes).unwrap();
        assert_eq!(answer.message, hex("D400 0101 0601"));
        assert_eq!(answer.o_t, Some("10.0.0.1:2222".parse().unwrap()));
        for junk in ["00", "0180 1000 0002", "FFFF FFFF FF", "0080 0200 FFFF"] {
            let bytes = hex(&format!("{counted} {junk}"));
            let answer = RrData::parse_answer(&bytes).unwrap();
            assert_eq!((answer.message.len(), answer.o_t, answer.t_o), (6, None, None), "{junk}");
        }
        assert!(RrData::parse_answer(&hex(&counted.replace("0601", "06"))).is_err(), "what is counted must be there");
    }

    #[test]
    fn reports_a_packet_without_a_message() {
        let error = RrData::parse(&hex("00000000 0000 0100 0000 0000")).unwrap_err();
        assert_eq!(error.field, "unconnected data item");
    }

    #[test]
    fn counts_are_bounded() {
        assert_eq!(Item::parse_all(&hex("FFFF")).unwrap_err().field, "item count");
    }
}
