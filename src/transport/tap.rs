//! A record of the traffic as a pcapng file that Wireshark opens.
//!
//! Datagrams and the bytes of TCP streams are wrapped in made-up IPv4 or IPv6 and UDP or TCP headers (link type RAW),
//! with the real addresses where they are known, so that a dissector for the port finds them. A stream's sequence
//! numbers run on from the first byte that is recorded; its opening and end are not in the file.
//!
//! What goes over a serial line has no headers. Each piece that was sent or received together is a packet of link type
//! USER0: one byte for the direction, 0 to the controller and 1 from it, and then the piece. Wireshark shows them as
//! bytes, or by a dissector that is named for USER0 under Preferences, Protocols, DLT_USER, with a header size of 1.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::net::{IpAddr, SocketAddr};
use std::path::Path;
use std::time::Duration;

/// Which way bytes went.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// To the controller.
    Sent,
    /// From the controller.
    Received,
}

impl Direction {
    /// As texts mark it.
    pub const fn arrow(self) -> &'static str {
        match self {
            Self::Sent => "->",
            Self::Received => "<-",
        }
    }
}

/// `LINKTYPE_RAW`: packets begin with an IP header.
pub const LINKTYPE_RAW: u16 = 101;
/// `LINKTYPE_USER0`: for private use.
const LINKTYPE_USER0: u16 = 147;
/// Numbers of the interfaces, in the order of their blocks.
const NETWORK: u32 = 0;
const LINE: u32 = 1;
/// IP protocol numbers.
const UDP: u8 = 17;
const TCP: u8 = 6;
/// Flags of a TCP segment: PSH and ACK, and a header of five words before them.
const TCP_FLAGS: [u8; 2] = [0x50, 0x18];
/// Most bytes of a stream in a segment.
const MOST_IN_SEGMENT: usize = 32 * 1024;
const SECTION_HEADER: u32 = 0x0A0D_0D0A;
const INTERFACE: u32 = 1;
const ENHANCED_PACKET: u32 = 6;
const BYTE_ORDER_MAGIC: u32 = 0x1A2B_3C4D;

/// An open capture file. Every block is written at once and whole, so that several connections can share a file, and
/// that what was recorded is there however the process ends.
#[derive(Debug)]
pub struct CaptureWriter<W: Write = File> {
    out: W,
    /// The number of the next byte of each direction of a TCP stream.
    sequence: HashMap<(SocketAddr, SocketAddr), u32>,
}

impl CaptureWriter {
    /// Starts a section at the end of a file, which is made if it is not there. A file may have any number of them.
    pub fn append(path: &Path) -> io::Result<Self> {
        Self::new(open(path)?)
    }

    /// Starts a section of packets of this kind: of [`LINKTYPE_RAW`] as [`append`](Self::append) does, or whole frames of a
    /// link.
    pub fn append_packets(path: &Path, link_type: u16) -> io::Result<Self> {
        Self::start(open(path)?, &[link_type])
    }

    /// Starts a section for byte streams: TCP and serial lines. tcpdump reads no file with such a section, because it
    /// has two link types; Wireshark does.
    pub fn append_streams(path: &Path) -> io::Result<Self> {
        Self::streams(open(path)?)
    }
}

fn open(path: &Path) -> io::Result<File> {
    OpenOptions::new().append(true).create(true).open(path)
}

impl<W: Write> CaptureWriter<W> {
    /// Starts a capture of datagrams on any writer.
    pub fn new(out: W) -> io::Result<Self> {
        Self::start(out, &[LINKTYPE_RAW])
    }

    /// Starts a capture of byte streams on any writer.
    pub fn streams(out: W) -> io::Result<Self> {
        Self::start(out, &[LINKTYPE_RAW, LINKTYPE_USER0])
    }

    fn start(mut out: W, link_types: &[u16]) -> io::Result<Self> {
        let mut section = Vec::new();
        section.extend(BYTE_ORDER_MAGIC.to_le_bytes());
        section.extend(1u16.to_le_bytes());
        section.extend(0u16.to_le_bytes());
        section.extend(u64::MAX.to_le_bytes());
        let mut head = block(SECTION_HEADER, section);
        for link_type in link_types {
            let mut interface = Vec::new();
            interface.extend(link_type.to_le_bytes());
            interface.extend(0u16.to_le_bytes());
            interface.extend(0u32.to_le_bytes());
            head.extend(block(INTERFACE, interface));
        }
        out.write_all(&head)?;
        Ok(Self { out, sequence: HashMap::new() })
    }

    /// Records a datagram. `time` counts from 1970.
    pub fn datagram(&mut self, time: Duration, from: SocketAddr, to: SocketAddr, payload: &[u8]) -> io::Result<()> {
        self.packet(NETWORK, time, &packet(from, to, UDP, udp(from, to, payload)))
    }

    /// Records bytes of a TCP stream, of a capture of [`streams`](Self::streams) or datagrams. `time` counts from 1970.
    pub fn segment(&mut self, time: Duration, from: SocketAddr, to: SocketAddr, bytes: &[u8]) -> io::Result<()> {
        for piece in bytes.chunks(MOST_IN_SEGMENT) {
            let expected = self.sequence.get(&(to, from)).copied().unwrap_or(FIRST);
            let sent = self.sequence.entry((from, to)).or_insert(FIRST);
            let segment = tcp(from, to, (*sent, expected), piece);
            *sent = sent.wrapping_add(length(piece.len()));
            self.packet(NETWORK, time, &packet(from, to, TCP, segment))?;
        }
        Ok(())
    }

    /// Records a whole frame of the link type that the section began with. `time` counts from 1970.
    pub fn frame(&mut self, time: Duration, frame: &[u8]) -> io::Result<()> {
        self.packet(NETWORK, time, frame)
    }

    /// Records bytes of a serial line, of a capture of [`streams`](Self::streams). `time` counts from 1970.
    pub fn line(&mut self, time: Duration, direction: Direction, bytes: &[u8]) -> io::Result<()> {
        let direction = match direction {
            Direction::Sent => 0,
            Direction::Received => 1,
        };
        self.packet(LINE, time, &[&[direction], bytes].concat())
    }

    fn packet(&mut self, interface: u32, time: Duration, packet: &[u8]) -> io::Result<()> {
        let micros = u64::try_from(time.as_micros()).unwrap_or(u64::MAX).to_le_bytes();
        let len = length(packet.len()).to_le_bytes();
        let mut body = Vec::with_capacity(packet.len() + 20);
        body.extend(interface.to_le_bytes());
        // The upper half of the time comes first, each half little-endian.
        body.extend(&micros[4..]);
        body.extend(&micros[..4]);
        body.extend(len);
        body.extend(len);
        body.extend(packet);
        self.out.write_all(&block(ENHANCED_PACKET, body))
    }
}

/// The number of the first byte of a stream; that of its opening is one less.
const FIRST: u32 = 1;

/// A pcapng block: type, length, body padded to four bytes, length again.
fn block(kind: u32, mut body: Vec<u8>) -> Vec<u8> {
    body.resize(body.len().next_multiple_of(4), 0);
    let len = length(body.len() + 12).to_le_bytes();
    let mut block = kind.to_le_bytes().to_vec();
    block.extend(len);
    block.append(&mut body);
    block.extend(len);
    block
}

/// A datagram with its UDP header. The checksum is left out where the protocol allows it (IPv4).
fn udp(from: SocketAddr, to: SocketAddr, payload: &[u8]) -> Vec<u8> {
    let mut udp = Vec::with_capacity(payload.len() + 8);
    udp.extend(from.port().to_be_bytes());
    udp.extend(to.port().to_be_bytes());
    udp.extend(short(payload.len() + 8).to_be_bytes());
    udp.extend([0, 0]);
    udp.extend(payload);
    if !(from.is_ipv4() && to.is_ipv4()) {
        let sum = transport_checksum(from, to, UDP, &udp);
        udp[6..8].copy_from_slice(&sum.to_be_bytes());
    }
    udp
}

/// Bytes of a stream with their TCP header; `numbers` are those of the first byte, and of the first that is expected.
fn tcp(from: SocketAddr, to: SocketAddr, numbers: (u32, u32), payload: &[u8]) -> Vec<u8> {
    let mut tcp = Vec::with_capacity(payload.len() + 20);
    tcp.extend(from.port().to_be_bytes());
    tcp.extend(to.port().to_be_bytes());
    tcp.extend(numbers.0.to_be_bytes());
    tcp.extend(numbers.1.to_be_bytes());
    tcp.extend(TCP_FLAGS);
    // The largest window, the checksum, and no urgent data.
    tcp.extend([0xFF, 0xFF, 0, 0, 0, 0]);
    tcp.extend(payload);
    let sum = transport_checksum(from, to, TCP, &tcp);
    tcp[16..18].copy_from_slice(&sum.to_be_bytes());
    tcp
}

/// The packet with its IP header.
fn packet(from: SocketAddr, to: SocketAddr, protocol: u8, content: Vec<u8>) -> Vec<u8> {
    let mut packet = Vec::with_capacity(content.len() + 40);
    match (from.ip(), to.ip()) {
        (IpAddr::V4(from), IpAddr::V4(to)) => {
            packet.extend([0x45, 0]);
            packet.extend(short(content.len() + 20).to_be_bytes());
            packet.extend([0, 0, 0x40, 0, 64, protocol, 0, 0]);
            packet.extend(from.octets());
            packet.extend(to.octets());
            let sum = checksum(&packet);
            packet[10..12].copy_from_slice(&sum.to_be_bytes());
        }
        (from, to) => {
            packet.extend([0x60, 0, 0, 0]);
            packet.extend(short(content.len()).to_be_bytes());
            packet.extend([protocol, 64]);
            packet.extend(v6(from));
            packet.extend(v6(to));
        }
    }
    packet.extend(content);
    packet
}

/// The checksum of a UDP or TCP header with its payload, and with the addresses of the IP header.
fn transport_checksum(from: SocketAddr, to: SocketAddr, protocol: u8, content: &[u8]) -> u16 {
    let mut pseudo = match (from.ip(), to.ip()) {
        (IpAddr::V4(from), IpAddr::V4(to)) => [from.octets(), to.octets()].concat(),
        (from, to) => [v6(from), v6(to)].concat(),
    };
    // That the length has two bytes in IPv4 and four in IPv6 makes no difference to the sum.
    pseudo.extend(length(content.len()).to_be_bytes());
    pseudo.extend([0, 0, 0, protocol]);
    pseudo.extend(content);
    checksum(&pseudo)
}

fn v6(address: IpAddr) -> [u8; 16] {
    match address {
        IpAddr::V4(address) => address.to_ipv6_mapped().octets(),
        IpAddr::V6(address) => address.octets(),
    }
}

/// The Internet checksum (RFC 1071).
fn checksum(bytes: &[u8]) -> u16 {
    let words = bytes.chunks(2).map(|pair| u32::from(pair[0]) << 8 | pair.get(1).map_or(0, |low| u32::from(*low)));
    let mut sum: u32 = words.sum();
    while sum > 0xFFFF {
        sum = (sum & 0xFFFF) + (sum >> 16);
    }
    !u16::try_from(sum).unwrap_or_default()
}

/// Datagrams have at most 64 KiB; longer ones are recorded with the length cut.
fn short(len: usize) -> u16 {
    u16::try_from(len).unwrap_or(u16::MAX)
}

fn length(len: usize) -> u32 {
    u32::try_from(len).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The type and body of every block.
    fn blocks(bytes: &[u8]) -> Vec<(u32, &[u8])> {
        let (mut blocks, mut rest) = (Vec::new(), bytes);
        while !rest.is_empty() {
            let word = |at: usize| u32::from_le_bytes(rest[at..at + 4].try_into().unwrap());
            let len = usize::try_from(word(4)).unwrap();
            assert_eq!(word(len - 4), word(4), "both lengths of a block agree");
            blocks.push((word(0), &rest[8..len - 4]));
            rest = &rest[len..];
        }
        blocks
    }

    /// The interface and content of a packet's block.
    fn content((kind, body): (u32, &[u8])) -> (u32, &[u8]) {
        assert_eq!(kind, ENHANCED_PACKET);
        let word = |at: usize| u32::from_le_bytes(body[at..at + 4].try_into().unwrap());
        assert_eq!(word(12), word(16), "nothing was cut");
        (word(0), &body[20..20 + usize::try_from(word(12)).unwrap()])
    }

    fn addresses() -> (SocketAddr, SocketAddr) {
        ("10.0.0.1:40000".parse().unwrap(), "10.0.0.2:10040".parse().unwrap())
    }

    #[test]
    fn frames_of_a_link_keep_its_type() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let mut capture = CaptureWriter::append_packets(file.path(), 227).unwrap();
        capture.frame(Duration::from_micros(7), &[0, 0, 4, 0x2C, 1, 0, 0, 0, 0x4B]).unwrap();
        drop(capture);
        let bytes = std::fs::read(file.path()).unwrap();
        let blocks = blocks(&bytes);
        assert_eq!((blocks[1].0, &blocks[1].1[..2]), (INTERFACE, &227u16.to_le_bytes()[..]));
        assert_eq!(content(blocks[2]), (0, &[0, 0, 4, 0x2C, 1, 0, 0, 0, 0x4B][..]));
    }

    #[test]
    fn a_capture_has_the_blocks_of_the_format() {
        let mut out = Vec::new();
        let mut capture = CaptureWriter::new(&mut out).unwrap();
        let (from, to) = addresses();
        capture.datagram(Duration::from_secs(1), from, to, b"YERC!").unwrap();
        let kinds: Vec<u32> = blocks(&out).iter().map(|(kind, _)| *kind).collect();
        assert_eq!(kinds, [SECTION_HEADER, INTERFACE, ENHANCED_PACKET]);
    }

    #[test]
    fn the_ip_header_checks_out() {
        let (from, to) = addresses();
        let packet = packet(from, to, UDP, udp(from, to, b"YERC"));
        assert_eq!(checksum(&packet[..20]), 0);
        assert_eq!(packet[20..28], [0x9C, 0x40, 0x27, 0x38, 0, 12, 0, 0]);
    }

    #[test]
    fn the_bytes_of_a_line_have_their_direction_in_front() {
        let mut out = Vec::new();
        let mut capture = CaptureWriter::streams(&mut out).unwrap();
        capture.line(Duration::from_micros(0x0001_0000_0002), Direction::Sent, b"@HSON\r\n").unwrap();
        capture.line(Duration::ZERO, Direction::Received, b"@OK\r\n").unwrap();
        let blocks = blocks(&out);
        assert_eq!(blocks[1], (INTERFACE, [101, 0, 0, 0, 0, 0, 0, 0].as_slice()));
        assert_eq!(blocks[2], (INTERFACE, [147, 0, 0, 0, 0, 0, 0, 0].as_slice()));
        assert_eq!(blocks[3].1[4..12], [1, 0, 0, 0, 2, 0, 0, 0], "the time, its upper half first");
        assert_eq!(content(blocks[3]), (LINE, b"\0@HSON\r\n".as_slice()));
        assert_eq!(content(blocks[4]), (LINE, b"\x01@OK\r\n".as_slice()));
    }

    #[test]
    fn the_segments_of_a_stream_follow_each_other() {
        for (from, to, header) in [
            ("10.0.0.1:40000", "10.0.0.2:4001", 20),
            ("[fe80::1]:40000", "[fe80::2]:4001", 40),
            ("10.0.0.1:40000", "[fe80::2]:4001", 40),
        ] {
            let (from, to) = (from.parse().unwrap(), to.parse().unwrap());
            let mut out = Vec::new();
            let mut capture = CaptureWriter::streams(&mut out).unwrap();
            capture.segment(Duration::ZERO, from, to, b"@HSON\r\n").unwrap();
            capture.segment(Duration::ZERO, to, from, b"@OK\r\n").unwrap();
            capture.segment(Duration::ZERO, from, to, &vec![b'x'; MOST_IN_SEGMENT + 1]).unwrap();
            let blocks = blocks(&out);
            let mut numbers = Vec::new();
            for (block, (from, to)) in blocks[3..].iter().zip([(from, to), (to, from), (from, to), (from, to)]) {
                let (interface, packet) = content(*block);
                assert_eq!(interface, NETWORK);
                let tcp = &packet[header..];
                assert_eq!(transport_checksum(from, to, TCP, tcp), 0);
                assert_eq!(tcp[..4], [from.port().to_be_bytes(), to.port().to_be_bytes()].concat());
                assert_eq!(tcp[12..14], [0x50, 0x18]);
                let word = |at: usize| u32::from_be_bytes(tcp[at..at + 4].try_into().unwrap());
                numbers.push((word(4), word(8), tcp.len() - 20));
            }
            assert_eq!(numbers, [(1, 1, 7), (1, 8, 5), (8, 6, MOST_IN_SEGMENT), (8 + 32 * 1024, 6, 1)]);
        }
    }
}
