//! Decoder for the layers of a packet: link type, IP, then UDP, TCP, or the bytes of a serial line.

use std::net::{IpAddr, SocketAddr};
use std::ops::Range;

use etherparse::{EtherType, LaxNetSlice, LaxSlicedPacket, TransportSlice};

use crate::profinet::wire::frame::Frame;
use crate::tap::{Direction, LINKTYPE_PROFIBUS_DL};

/// Content of a packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PacketContent<'a> {
    /// A UDP or TCP packet.
    Packet {
        /// Sender.
        from: SocketAddr,
        /// Receiver.
        to: SocketAddr,
        /// Payload.
        payload: Payload<'a>,
        /// Whether the headers state more bytes than were recorded.
        is_cut: bool,
    },
    /// Bytes of a serial line.
    Serial {
        /// Direction of the bytes.
        direction: Direction,
        /// The bytes.
        bytes: &'a [u8],
    },
    /// A frame whose link type has its own frame format, for example CAN.
    Frame,
    /// A fragment of an IP packet.
    Fragment,
    /// Any other packet.
    Other,
}

/// Payload of an IP packet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Payload<'a> {
    /// Payload of a UDP datagram.
    Datagram(&'a [u8]),
    /// Payload of a TCP segment.
    Segment(Segment<'a>),
}

/// A segment of a TCP stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Segment<'a> {
    /// Sequence number of the first byte.
    pub sequence: u32,
    /// Whether the segment opens the stream (SYN).
    pub opens: bool,
    /// Payload of the segment.
    pub bytes: &'a [u8],
}

/// Decodes a packet with this link type.
pub fn content_of(link_type: u16, packet: &[u8]) -> PacketContent<'_> {
    let content = match link_type {
        // BSD loopback: the packet starts with 4 bytes of address family, in the byte order of the host. They are
        // skipped, because the IP header contains the IP version.
        0 | 108 => packet.get(4..).and_then(ip),
        super::LINKTYPE_ETHERNET if Frame::parse(packet).is_ok() => Some(PacketContent::Frame),
        super::LINKTYPE_ETHERNET => ethernet(packet, 12..14),
        // Raw IP. Operating systems use different numbers for it.
        12 | 14 | 101 | 228 | 229 => ip(packet),
        // Linux cooked capture, versions 1 and 2.
        113 => ethernet(packet, 14..16),
        276 => of_type(packet.get(..2), packet.get(20..)),
        147 => serial(packet),
        super::LINKTYPE_CAN | LINKTYPE_PROFIBUS_DL => Some(PacketContent::Frame),
        _ => None,
    };
    content.unwrap_or(PacketContent::Other)
}

/// A serial line, as [`tap`](crate::tap) records it.
fn serial(packet: &[u8]) -> Option<PacketContent<'_>> {
    let (direction, bytes) = packet.split_first()?;
    let direction = match direction {
        0 => Direction::Sent,
        1 => Direction::Received,
        _ => return None,
    };
    Some(PacketContent::Serial { direction, bytes })
}

/// Decodes a frame whose EtherType is at the byte range `kind`.
fn ethernet(frame: &[u8], kind: Range<usize>) -> Option<PacketContent<'_>> {
    of_type(frame.get(kind.clone()), frame.get(kind.end..))
}

/// Decodes the content that follows an EtherType, with or without VLAN tags.
fn of_type<'a>(kind: Option<&[u8]>, content: Option<&'a [u8]>) -> Option<PacketContent<'a>> {
    let kind = u16::from_be_bytes(*kind?.first_chunk()?);
    transport(&LaxSlicedPacket::from_ether_type(EtherType(kind), bounded(content?)))
}

fn ip(packet: &[u8]) -> Option<PacketContent<'_>> {
    transport(&LaxSlicedPacket::from_ip(bounded(packet)).ok()?)
}

/// Cuts the packet to the length in its IP header. A length of 0 sets no limit: it is valid in a capture, because the
/// network card fills the length in later.
fn bounded(packet: &[u8]) -> &[u8] {
    const MAX_DATAGRAM_LEN: usize = 40 + 0xFFFF;

    packet.get(..MAX_DATAGRAM_LEN).unwrap_or(packet)
}

fn transport<'a>(packet: &LaxSlicedPacket<'a>) -> Option<PacketContent<'a>> {
    let (from, to): (IpAddr, IpAddr) = match packet.net.as_ref()? {
        LaxNetSlice::Ipv4(ip) => (ip.header().source_addr().into(), ip.header().destination_addr().into()),
        LaxNetSlice::Ipv6(ip) => (ip.header().source_addr().into(), ip.header().destination_addr().into()),
        LaxNetSlice::Arp(_) => return None,
    };
    let ip = packet.net.as_ref()?.ip_payload_ref()?;
    if ip.fragmented {
        return Some(PacketContent::Fragment);
    }
    let (from_port, to_port, payload, is_cut) = match packet.transport.as_ref()? {
        TransportSlice::Udp(udp) => {
            let is_cut = usize::from(udp.length()) > udp.slice().len();
            (udp.source_port(), udp.destination_port(), Payload::Datagram(udp.payload()), is_cut)
        }
        TransportSlice::Tcp(tcp) => {
            let segment = Segment { sequence: tcp.sequence_number(), opens: tcp.syn(), bytes: tcp.payload() };
            (tcp.source_port(), tcp.destination_port(), Payload::Segment(segment), false)
        }
        _ => return None,
    };
    let (from, to) = (SocketAddr::new(from, from_port), SocketAddr::new(to, to_port));
    Some(PacketContent::Packet { from, to, payload, is_cut: is_cut || ip.incomplete })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An IP packet with a UDP datagram from 10.0.0.1:1000 to 10.0.0.2:10040. The payload is "hi", and two bytes of
    /// padding follow.
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
    fn accepts_packets_without_an_ip_length() {
        let mut packet = IP.to_vec();
        (packet[2], packet[3], packet[9]) = (0, 0, 6);
        packet.resize(200_000, 0);
        packet[32] = 0x50;
        let PacketContent::Packet { payload: Payload::Segment(segment), is_cut: false, .. } = content_of(101, &packet)
        else {
            panic!("no segment");
        };
        assert_eq!(segment.bytes.len(), 0xFFFF);
    }

    #[test]
    fn other_packets_have_no_content() {
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
