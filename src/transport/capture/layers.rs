//! What a packet carries: from its link type through IP to UDP, TCP, or the bytes of a serial line.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};

use crate::tap::Direction;

/// What is in a packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PacketContent<'a> {
    /// UDP or TCP.
    Packet {
        /// Sender.
        from: SocketAddr,
        /// Receiver.
        to: SocketAddr,
        /// What it brings.
        payload: Payload<'a>,
        /// It says to be longer than it is.
        is_cut: bool,
    },
    /// Bytes of a serial line.
    Serial {
        /// Which way.
        direction: Direction,
        /// The bytes.
        bytes: &'a [u8],
    },
    /// A part of an IP packet.
    Fragment,
    /// Anything else.
    Other,
}

/// What an IP packet brings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Payload<'a> {
    /// UDP.
    Datagram(&'a [u8]),
    /// TCP.
    Segment(Segment<'a>),
}

/// A segment of a TCP stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Segment<'a> {
    /// Number of its first byte.
    pub sequence: u32,
    /// Opens the stream.
    pub opens: bool,
    /// Its bytes.
    pub bytes: &'a [u8],
}

const UDP: u8 = 17;
const TCP: u8 = 6;
const IPV4: u16 = 0x0800;
const IPV6: u16 = 0x86DD;
/// VLAN tags: 802.1Q, 802.1ad, and what was used before it.
const TAGS: [u16; 3] = [0x8100, 0x88A8, 0x9100];
/// Extension headers of IPv6 that say their length: hop by hop, routing, destination.
const EXTENSIONS: [u8; 3] = [0, 43, 60];
const FRAGMENT: u8 = 44;
/// A length has 16 bits.
const LONGEST_IP: usize = 0xFFFF;

/// Looks into a packet of a link type.
pub fn content_of(link_type: u16, packet: &[u8]) -> PacketContent<'_> {
    let content = match link_type {
        // Loopback of BSD: the address family, in the byte order of the host. IP tells itself which it is.
        0 | 108 => packet.get(4..).and_then(ip),
        1 => ethernet(packet, 12),
        // Raw IP, as numbered by several systems.
        12 | 14 | 101 | 228 | 229 => ip(packet),
        // Linux cooked, both versions.
        113 => ethernet(packet, 14),
        276 => of_type(short(packet, 0), packet.get(20..)),
        147 => serial(packet),
        _ => None,
    };
    content.unwrap_or(PacketContent::Other)
}

/// A serial line as [`tap`](crate::tap) records it.
fn serial(packet: &[u8]) -> Option<PacketContent<'_>> {
    let (direction, bytes) = packet.split_first()?;
    let direction = match direction {
        0 => Direction::Sent,
        1 => Direction::Received,
        _ => return None,
    };
    Some(PacketContent::Serial { direction, bytes })
}

/// A frame with its type at an offset, behind any VLAN tags.
fn ethernet(frame: &[u8], mut at: usize) -> Option<PacketContent<'_>> {
    while TAGS.contains(&short(frame, at)?) {
        at += 4;
    }
    of_type(short(frame, at), frame.get(at + 2..))
}

fn of_type(kind: Option<u16>, content: Option<&[u8]>) -> Option<PacketContent<'_>> {
    matches!(kind?, IPV4 | IPV6).then(|| ip(content?)).flatten()
}

fn ip(packet: &[u8]) -> Option<PacketContent<'_>> {
    match packet.first()? >> 4 {
        4 => ipv4(packet),
        6 => ipv6(packet),
        _ => None,
    }
}

fn ipv4(packet: &[u8]) -> Option<PacketContent<'_>> {
    let header = usize::from(packet.first()? & 0x0F) * 4;
    // A length of 0 is left to the card to fill in, which sends no packet that is longer than any.
    let len = match usize::from(short(packet, 2)?) {
        0 => packet.len().min(LONGEST_IP),
        len => len,
    };
    let address = |at: usize| Some(IpAddr::V4(Ipv4Addr::from(*packet.get(at..)?.first_chunk::<4>()?)));
    let (from, to) = (address(12)?, address(16)?);
    // All but "don't fragment".
    if short(packet, 6)? & 0x3FFF != 0 {
        return Some(PacketContent::Fragment);
    }
    let content = packet.get(..len).unwrap_or(packet).get(header.max(20)..)?;
    transport(*packet.get(9)?, (from, to), content, len > packet.len())
}

fn ipv6(packet: &[u8]) -> Option<PacketContent<'_>> {
    let len = match usize::from(short(packet, 4)?) {
        0 => packet.len().min(LONGEST_IP),
        len => len + 40,
    };
    let address = |at: usize| Some(IpAddr::V6(Ipv6Addr::from(*packet.get(at..)?.first_chunk::<16>()?)));
    let (from, to) = (address(8)?, address(24)?);
    let (mut next, mut content) = (*packet.get(6)?, packet.get(..len).unwrap_or(packet).get(40..)?);
    while EXTENSIONS.contains(&next) {
        next = *content.first()?;
        content = content.get(usize::from(*content.get(1)?) * 8 + 8..)?;
    }
    if next == FRAGMENT {
        return Some(PacketContent::Fragment);
    }
    transport(next, (from, to), content, len > packet.len())
}

fn transport(protocol: u8, ends: (IpAddr, IpAddr), content: &[u8], is_cut: bool) -> Option<PacketContent<'_>> {
    let from = SocketAddr::new(ends.0, short(content, 0)?);
    let to = SocketAddr::new(ends.1, short(content, 2)?);
    let (payload, is_cut) = match protocol {
        UDP => {
            let len = usize::from(short(content, 4)?);
            let bytes = content.get(8..len).or_else(|| content.get(8..))?;
            (Payload::Datagram(bytes), is_cut || len > content.len())
        }
        TCP => {
            let sequence = u32::from_be_bytes(*content.get(4..)?.first_chunk()?);
            let header = usize::from(content.get(12)? >> 4) * 4;
            let opens = content.get(13)? & 0x02 != 0;
            let segment = Segment { sequence, opens, bytes: content.get(header.max(20)..)? };
            (Payload::Segment(segment), is_cut)
        }
        _ => return None,
    };
    Some(PacketContent::Packet { from, to, payload, is_cut })
}

fn short(bytes: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_be_bytes(*bytes.get(at..)?.first_chunk()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// UDP from 10.0.0.1:1000 to 10.0.0.2:10040 with "hi", and two bytes of padding.
    const IP: [u8; 32] = [
        0x45, 0, 0, 30, 0, 0, 0x40, 0, 64, 17, 0, 0, 10, 0, 0, 1, 10, 0, 0, 2, 0x03, 0xE8, 0x27, 0x38, 0, 10, 0, 0,
        b'h', b'i', 0, 0,
    ];

    fn with_head(link_type: u16, head: &[u8]) -> PacketContent<'static> {
        content_of(link_type, Box::leak([head, &IP].concat().into_boxed_slice()))
    }

    #[test]
    fn every_link_type_leads_to_the_datagram() {
        let mut expected = content_of(101, &IP);
        assert!(matches!(expected, PacketContent::Packet { payload: Payload::Datagram(b"hi"), is_cut: false, .. }));
        let macs = [0; 12];
        let tagged = [&macs[..], &[0x88, 0xA8, 0, 5, 0x81, 0, 0, 7, 0x08, 0]].concat();
        let heads: [(u16, &[u8]); 7] = [
            (0, &[2, 0, 0, 0]),
            (0, &[0, 0, 0, 2]),
            (1, &[&macs[..], &[0x08, 0]].concat()),
            (1, &tagged),
            (113, &[&[0; 14][..], &[0x08, 0]].concat()),
            (113, &[&[0; 14][..], &[0x81, 0, 0, 7, 0x08, 0]].concat()),
            (276, &[&[0x08, 0][..], &[0; 18]].concat()),
        ];
        for (link_type, head) in heads {
            assert_eq!(with_head(link_type, head), expected, "link type {link_type}");
        }
        let cut = &IP[..29];
        expected = content_of(101, cut);
        assert!(matches!(expected, PacketContent::Packet { payload: Payload::Datagram(b"h"), is_cut: true, .. }));
    }

    #[test]
    fn a_packet_whose_length_the_card_fills_in_is_no_longer_than_any() {
        let mut packet = IP.to_vec();
        (packet[2], packet[3], packet[9]) = (0, 0, TCP);
        packet.resize(200_000, 0);
        let PacketContent::Packet { payload: Payload::Segment(segment), is_cut: false, .. } = content_of(101, &packet)
        else {
            panic!("no segment");
        };
        assert_eq!(segment.bytes.len(), LONGEST_IP - 40);
    }

    #[test]
    fn the_rest_is_other() {
        let mut fragment = IP;
        fragment[6] = 0x20;
        assert_eq!(content_of(101, &fragment), PacketContent::Fragment);
        assert_eq!(with_head(1, &[0; 14]), PacketContent::Other);
        assert_eq!(with_head(105, &[]), PacketContent::Other);
        assert_eq!(content_of(147, &[2, 0]), PacketContent::Other);
        for link_type in [0, 1, 101, 113, 147, 276] {
            for len in 0..20 {
                assert!(!matches!(content_of(link_type, &IP[..len]), PacketContent::Packet { .. }));
            }
        }
    }
}
