//! Writer for pcapng recordings. Wireshark can open them.
//!
//! Datagrams and TCP bytes get synthetic IP and UDP or TCP headers (link type RAW). If the real addresses are known,
//! the headers contain them, so that Wireshark finds the dissector of the port. TCP sequence numbers start with the
//! first recorded byte. The recording does not contain the opening and the close of a connection.
//!
//! A serial line has no headers. Bytes that were sent or received together form one packet of link type USER0: a
//! direction byte (0 to the controller, 1 from the controller), then the bytes. Wireshark shows raw bytes.
//! Alternatively, it uses the dissector that is set for USER0 under Preferences, Protocols, DLT_USER, with a header
//! size of 1.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::net::{IpAddr, SocketAddr};
use std::path::Path;
use std::time::Duration;

use etherparse::{IpHeaders, PacketBuilder, PacketBuilderStep};

/// Direction of bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// To the controller.
    Sent,
    /// From the controller.
    Received,
}

impl Direction {
    /// Arrow that stands for the direction in texts.
    pub const fn arrow(self) -> &'static str {
        match self {
            Self::Sent => "->",
            Self::Received => "<-",
        }
    }
}

/// `LINKTYPE_RAW`: packets start with an IP header.
pub const LINKTYPE_RAW: u16 = 101;
/// `LINKTYPE_PROFIBUS_DL`: PROFIBUS telegrams, from start to end delimiter.
pub const LINKTYPE_PROFIBUS_DL: u16 = 257;
/// `LINKTYPE_USER0`: reserved for private use.
const LINKTYPE_USER0: u16 = 147;
/// Interface number of network packets. The numbers follow the order of the interface blocks.
const NETWORK: u32 = 0;
const LINE: u32 = 1;
/// Maximum number of bytes per TCP segment.
const MAX_SEGMENT_LEN: usize = 32 * 1024;
const SECTION_HEADER: u32 = 0x0A0D_0D0A;
const INTERFACE: u32 = 1;
const ENHANCED_PACKET: u32 = 6;
const BYTE_ORDER_MAGIC: u32 = 0x1A2B_3C4D;

/// An open recording. Each block is written with one system call, so that several connections can share a file and a
/// crash loses no recorded packet.
#[derive(Debug)]
pub struct CaptureWriter<W: Write = File> {
    out: W,
    /// Next sequence number of each direction of a TCP stream.
    sequence: HashMap<(SocketAddr, SocketAddr), u32>,
}

impl CaptureWriter {
    /// Starts a section at the end of a file, and creates the file if necessary. A file can have several sections.
    pub fn append(path: &Path) -> io::Result<Self> {
        Self::new(open(path)?)
    }

    /// Starts a section with this link type: either [`LINKTYPE_RAW`], like [`append`](Self::append), or the link type
    /// of whole frames.
    pub fn append_packets(path: &Path, link_type: u16) -> io::Result<Self> {
        Self::start(open(path)?, &[link_type])
    }

    /// Starts a section for byte streams: TCP and serial lines. The section has two link types, so Wireshark can read
    /// the file but tcpdump cannot.
    pub fn append_streams(path: &Path) -> io::Result<Self> {
        Self::streams(open(path)?)
    }
}

fn open(path: &Path) -> io::Result<File> {
    OpenOptions::new().append(true).create(true).open(path)
}

impl<W: Write> CaptureWriter<W> {
    /// Starts a recording of datagrams on any writer.
    pub fn new(out: W) -> io::Result<Self> {
        Self::start(out, &[LINKTYPE_RAW])
    }

    /// Starts a recording of byte streams on any writer.
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
        let mut packet = Vec::with_capacity(payload.len() + 48);
        let headers = ip(from, to).udp(from.port(), to.port());
        headers.write(&mut packet, payload).map_err(io::Error::other)?;
        self.packet(NETWORK, time, &packet)
    }

    /// Records bytes of a TCP stream. `time` counts from 1970.
    pub fn segment(&mut self, time: Duration, from: SocketAddr, to: SocketAddr, bytes: &[u8]) -> io::Result<()> {
        for piece in bytes.chunks(MAX_SEGMENT_LEN) {
            let expected = self.sequence.get(&(to, from)).copied().unwrap_or(FIRST);
            let sent = self.sequence.entry((from, to)).or_insert(FIRST);
            let mut packet = Vec::with_capacity(piece.len() + 60);
            let headers = ip(from, to).tcp(from.port(), to.port(), *sent, u16::MAX).psh().ack(expected);
            headers.write(&mut packet, piece).map_err(io::Error::other)?;
            *sent = sent.wrapping_add(length(piece.len()));
            self.packet(NETWORK, time, &packet)?;
        }
        Ok(())
    }

    /// Records a whole frame. The frame has the link type of the section. `time` counts from 1970.
    pub fn frame(&mut self, time: Duration, frame: &[u8]) -> io::Result<()> {
        self.packet(NETWORK, time, frame)
    }

    /// Records bytes of a serial line. The recording must have been created with [`streams`](Self::streams). `time`
    /// counts from 1970.
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
        // The upper half of the time comes first; both halves are little-endian.
        body.extend(&micros[4..]);
        body.extend(&micros[..4]);
        body.extend(len);
        body.extend(len);
        body.extend(packet);
        self.out.write_all(&block(ENHANCED_PACKET, body))
    }
}

/// Sequence number of the first byte of a stream.
const FIRST: u32 = 1;

/// Returns a pcapng block: type, length, body padded to a multiple of four bytes, and the length again.
fn block(kind: u32, mut body: Vec<u8>) -> Vec<u8> {
    body.resize(body.len().next_multiple_of(4), 0);
    let len = length(body.len() + 12).to_le_bytes();
    let mut block = kind.to_le_bytes().to_vec();
    block.extend(len);
    block.append(&mut body);
    block.extend(len);
    block
}

/// Starts a packet with an IP header. If the two addresses have different IP versions, the header is IPv6.
fn ip(from: SocketAddr, to: SocketAddr) -> PacketBuilderStep<IpHeaders> {
    const IP_TTL: u8 = 64;

    let v6 = |address: IpAddr| match address {
        IpAddr::V4(address) => address.to_ipv6_mapped().octets(),
        IpAddr::V6(address) => address.octets(),
    };
    match (from.ip(), to.ip()) {
        (IpAddr::V4(from), IpAddr::V4(to)) => PacketBuilder::ipv4(from.octets(), to.octets(), IP_TTL),
        (from, to) => PacketBuilder::ipv6(v6(from), v6(to), IP_TTL),
    }
}

fn length(len: usize) -> u32 {
    u32::try_from(len).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns type and body of every block.
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

    /// Returns interface and content of a packet block.
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

    /// Whether the Internet checksum (RFC 1071) is correct. The checksum of data that includes its own checksum is 0.
    fn checks_out(bytes: &[u8]) -> bool {
        let words = bytes.chunks(2).map(|pair| u32::from(pair[0]) << 8 | pair.get(1).map_or(0, |low| u32::from(*low)));
        let sum: u32 = words.sum();
        sum > 0 && sum.is_multiple_of(0xFFFF)
    }

    #[test]
    fn checksums_of_headers_are_correct() {
        let mut out = Vec::new();
        let (from, to) = addresses();
        CaptureWriter::new(&mut out).unwrap().datagram(Duration::ZERO, from, to, b"YERC").unwrap();
        let (_, packet) = content(blocks(&out)[2]);
        assert_eq!(packet[..10], [0x45, 0, 0, 32, 0, 0, 0x40, 0, 64, 17]);
        assert!(checks_out(&packet[..20]));
        assert_eq!(packet[12..26], [10, 0, 0, 1, 10, 0, 0, 2, 0x9C, 0x40, 0x27, 0x38, 0, 12]);
        assert!(checks_out(&[&packet[12..], &[0, 17, 0, 12]].concat()), "with the pseudo header");
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
            capture.segment(Duration::ZERO, from, to, &vec![b'x'; MAX_SEGMENT_LEN + 1]).unwrap();
            let blocks = blocks(&out);
            let mut numbers = Vec::new();
            for (block, (from, to)) in blocks[3..].iter().zip([(from, to), (to, from), (from, to), (from, to)]) {
                let (interface, packet) = content(*block);
                assert_eq!(interface, NETWORK);
                let tcp = &packet[header..];
                let len = u32::try_from(tcp.len()).unwrap().to_be_bytes();
                let addresses = if header == 20 { 12..20 } else { 8..40 };
                assert!(checks_out(&[&packet[addresses], &len, &[0, 0, 0, 6], tcp].concat()));
                assert_eq!(tcp[..4], [from.port().to_be_bytes(), to.port().to_be_bytes()].concat());
                assert_eq!(tcp[12..14], [0x50, 0x18]);
                let word = |at: usize| u32::from_be_bytes(tcp[at..at + 4].try_into().unwrap());
                numbers.push((word(4), word(8), tcp.len() - 20));
            }
            assert_eq!(numbers, [(1, 1, 7), (1, 8, 5), (8, 6, MAX_SEGMENT_LEN), (8 + 32 * 1024, 6, 1)]);
        }
    }
}
