//! Codec for class 1 datagrams: sequenced address, sequence count, data (volume 2, 3-2.2.1; volume 1, 3-4.5).

use super::{Item, Reader, WireError, kind};

/// Run bit of the 32-bit run/idle header (volume 1, 3-6.1.4).
pub const RUN: u32 = 1;

/// A class 1 datagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cyclic<'a> {
    /// Connection id.
    pub id: u32,
    /// Sequence number. It increases with every datagram.
    pub sequence: u32,
    /// Sequence count. According to the standard, it increases when the data is new. Here it increases with every
    /// datagram.
    pub count: u16,
    /// Data. If the connection has a run/idle header, the header comes before the data.
    pub body: &'a [u8],
}

impl<'a> Cyclic<'a> {
    /// Decodes a datagram.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, WireError> {
        let items = Item::parse_all(bytes)?;
        // Layout: 2 bytes with the number of items, then the type and length of each item.
        let [address, data] = items[..] else {
            let mut reader = Reader::little(bytes);
            let count = reader.u16("item count")?;
            return Err(reader.wrong("item count", 2, count));
        };
        for (item, wanted, field, offset) in [
            (address, kind::SEQUENCED_ADDRESS, "address item", 2),
            (data, kind::CONNECTED_DATA, "data item", 6 + address.data.len()),
        ] {
            if item.kind != wanted {
                return Err(WireError::value(field, offset, item.kind));
            }
        }
        let inside = |offset| move |error: WireError| WireError { offset: error.offset + offset, ..error };
        let mut reader = Reader::little(address.data);
        let id = reader.u32("connection id").map_err(inside(6))?;
        let sequence = reader.u32("sequence number").map_err(inside(6))?;
        reader.end("end of the address").map_err(inside(6))?;
        let mut reader = Reader::little(data.data);
        let count = reader.u16("sequence count").map_err(inside(10 + address.data.len()))?;
        Ok(Self { id, sequence, count, body: reader.rest() })
    }

    /// Encodes a datagram, with or without a run/idle header.
    pub fn emit(&self, header: Option<u32>) -> Vec<u8> {
        let mut address = [0; 8];
        address[..4].copy_from_slice(&self.id.to_le_bytes());
        address[4..].copy_from_slice(&self.sequence.to_le_bytes());
        let mut data = Vec::with_capacity(6 + self.body.len());
        data.extend(self.count.to_le_bytes());
        data.extend(header.into_iter().flat_map(u32::to_le_bytes));
        data.extend(self.body);
        Item::emit_all(&[Item::new(kind::SEQUENCED_ADDRESS, &address), Item::new(kind::CONNECTED_DATA, &data)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::hex;

    /// With a 48-byte image, the datagram to the target has 72 bytes, and the datagram to the originator has 68 bytes.
    #[test]
    fn parses_a_datagram_of_each_direction() {
        let image = [0xA5; 48];
        let out = Cyclic { id: 0x0403_0201, sequence: 7, count: 9, body: &image };
        let head = hex("0200 0280 0800 01020304 07000000 B100 3600 0900 01000000");
        let bytes = out.emit(Some(RUN));
        assert_eq!(bytes, [&head[..], &image].concat());
        assert_eq!(bytes.len(), 72);
        let parsed = Cyclic::parse(&bytes).unwrap();
        assert_eq!(parsed.body, [&[1, 0, 0, 0], &image[..]].concat());

        let bytes = out.emit(None);
        assert_eq!(bytes.len(), 68);
        assert_eq!(Cyclic::parse(&bytes), Ok(out));
    }

    #[test]
    fn reports_datagrams_that_are_not_cyclic() {
        let connected = hex("0200 A100 0400 01020304 B100 0200 0100");
        let error = Cyclic::parse(&connected).unwrap_err();
        assert_eq!((error.field, error.offset), ("address item", 2));
        let short = hex("0200 0280 0800 01020304 07000000 B100 0100 01");
        let error = Cyclic::parse(&short).unwrap_err();
        assert_eq!((error.field, error.offset), ("sequence count", 18));
    }
}
