//! Packet reader for pcap and pcapng files (draft-ietf-opsawg-pcap, draft-ietf-opsawg-pcapng).

use crate::refuse_if;
use std::io::Read;
use std::time::Duration;

use thiserror::Error;

/// A packet of a capture file, with its metadata.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Packet<'a> {
    /// Number of the packet, from 1.
    pub number: u64,
    /// Section of the pcapng file, from 1.
    pub section: usize,
    /// Time since 1970. A packet without a time gets the time of the previous packet.
    pub time: Duration,
    /// Link type number (`LINKTYPE_…`).
    pub link_type: u16,
    /// The recorded bytes.
    pub bytes: &'a [u8],
    /// Whether only a part of the packet was recorded.
    pub is_cut: bool,
}

/// The position where a file becomes unreadable.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{problem} at offset {offset}")]
pub struct Damage {
    /// Offset from the start of the file, in bytes.
    pub offset: usize,
    /// Description of the problem.
    pub problem: &'static str,
}

/// Reason why a file cannot be read as a capture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum OpenError {
    /// The file is compressed by gzip or zstd.
    #[error("the file is compressed")]
    Compressed,
    /// The file is not a pcap or pcapng file.
    #[error("the file is not pcap or pcapng")]
    Other,
    /// Reading the file failed.
    #[error("cannot read the file")]
    Unreadable,
}

const SECTION_HEADER: u32 = 0x0A0D_0D0A;
const BYTE_ORDER_MAGIC: u32 = 0x1A2B_3C4D;
const INTERFACE: u32 = 1;
/// Block type of the obsolete Packet Block. The Enhanced Packet Block replaced it.
const OLD_PACKET: u32 = 2;
const SIMPLE_PACKET: u32 = 3;
const ENHANCED_PACKET: u32 = 6;
/// Option code that ends the options of an Interface Description Block. The other option codes of this block follow.
const END_OF_OPTIONS: u16 = 0;
const TIME_RESOLUTION: u16 = 9;
const TIME_OFFSET: u16 = 14;
/// Length of the header of a pcap file. The constant below is the length of the header of each packet.
const FILE_HEADER: usize = 24;
const PACKET_HEADER: usize = 16;
/// Upper limit of a packet length. A larger value means a damaged file.
const MAX_PACKET_LEN: usize = 16 << 20;
/// Maximum number of interfaces per section. Each interface is kept in memory.
const MAX_INTERFACES: usize = 1 << 16;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ByteOrder {
    Big,
    Little,
}

impl ByteOrder {
    fn short(self, bytes: &[u8], at: usize) -> Option<u16> {
        let bytes = *bytes.get(at..)?.first_chunk()?;
        Some(if self == Self::Big { u16::from_be_bytes(bytes) } else { u16::from_le_bytes(bytes) })
    }

    fn word(self, bytes: &[u8], at: usize) -> Option<u32> {
        let bytes = *bytes.get(at..)?.first_chunk()?;
        Some(if self == Self::Big { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    }

    fn size(self, bytes: &[u8], at: usize) -> Option<usize> {
        usize::try_from(self.word(bytes, at)?).ok()
    }

    fn long(self, bytes: &[u8], at: usize) -> Option<u64> {
        let bytes = *bytes.get(at..)?.first_chunk()?;
        Some(if self == Self::Big { u64::from_be_bytes(bytes) } else { u64::from_le_bytes(bytes) })
    }
}

/// Time resolution and time offset of an interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Clock {
    /// Ticks per second.
    ticks: u128,
    /// Offset in seconds.
    offset: u64,
}

impl Clock {
    const MICROS: Self = Self { ticks: 1_000_000, offset: 0 };
    const NANOS: Self = Self { ticks: 1_000_000_000, offset: 0 };

    /// Creates a clock. `resolution` is an exponent of ten, or of two if its highest bit is set. An impossible value
    /// counts as microseconds.
    fn new(resolution: u8, offset: u64) -> Self {
        let exponent = u32::from(resolution & 0x7F);
        let base: u128 = if resolution & 0x80 == 0 { 10 } else { 2 };
        Self { ticks: base.checked_pow(exponent).unwrap_or(Self::MICROS.ticks), offset }
    }

    fn time(self, count: u64) -> Duration {
        let count = u128::from(count);
        let seconds = u64::try_from(count / self.ticks).unwrap_or(u64::MAX);
        let nanos = (count % self.ticks).saturating_mul(1_000_000_000) / self.ticks;
        let nanos = u32::try_from(nanos).unwrap_or_default().min(999_999_999);
        // The offset is signed, but the unsigned addition gives the same result, because the offset is in two's
        // complement.
        Duration::new(seconds.wrapping_add(self.offset), nanos)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Interface {
    link_type: u16,
    /// Maximum number of recorded bytes per packet (snapshot length). 0 means that there is no limit.
    snap_len: usize,
    clock: Clock,
}

/// File format, with the interfaces of the current section.
#[derive(Debug)]
enum Format {
    Classic(Interface),
    Blocks(Vec<Interface>),
}

/// Whether the beginning of a file identifies it as a packet capture.
pub fn is_capture(beginning: &[u8]) -> bool {
    matches!(Packets::open(beginning), Ok(_) | Err(OpenError::Compressed))
}

/// Number of bytes per read.
const READ_SIZE: usize = 1 << 16;

/// The part of a file that is in memory. It contains the bytes of only one packet.
#[derive(Debug)]
struct Window<R> {
    file: R,
    bytes: Vec<u8>,
    /// Start of the unread bytes.
    start: usize,
    /// File offset of the unread bytes.
    consumed: usize,
}

impl<R: Read> Window<R> {
    /// Returns the next `len` bytes without consuming them. Returns fewer bytes at the end of the file.
    fn peek(&mut self, len: usize) -> std::io::Result<&[u8]> {
        if self.bytes.len() - self.start < len {
            self.bytes.drain(..self.start);
            self.start = 0;
            let missing = (len - self.bytes.len()).max(READ_SIZE);
            let missing = u64::try_from(missing).unwrap_or(u64::MAX);
            (&mut self.file).take(missing).read_to_end(&mut self.bytes)?;
        }
        let rest = &self.bytes[self.start..];
        Ok(&rest[..rest.len().min(len)])
    }

    /// Bytes that the last `look` has loaded.
    fn loaded(&self) -> &[u8] {
        &self.bytes[self.start..]
    }

    fn skip(&mut self, len: usize) {
        self.start += len;
        self.consumed += len;
    }
}

/// Iterator over the packets of a file, up to its end or to the first damage.
#[derive(Debug)]
pub struct Packets<R> {
    file: Window<R>,
    byte_order: ByteOrder,
    format: Format,
    number: u64,
    section: usize,
    time: Duration,
    is_over: bool,
}

/// Metadata of a packet, and the range of its bytes in the record or block.
struct PacketSpan {
    interface: Interface,
    time: Option<Duration>,
    bytes: std::ops::Range<usize>,
    original: usize,
}

const UNREADABLE: &str = "cannot read more of the file";

impl<R: Read> Packets<R> {
    /// Reads the header of a file.
    pub fn open(file: R) -> Result<Self, OpenError> {
        let mut file = Window { file, bytes: Vec::new(), start: 0, consumed: 0 };
        let head = file.peek(FILE_HEADER).map_err(|_| OpenError::Unreadable)?;
        let magic = head.first_chunk::<4>().map(|bytes| u32::from_be_bytes(*bytes)).ok_or(OpenError::Other)?;
        let classic = |order: ByteOrder, clock| {
            let snap_len = order.size(head, 16)?;
            // The upper half of this word may contain the length of a frame checksum.
            let link_type = u16::try_from(order.word(head, 20)? & 0xFFFF).ok()?;
            Some((order, Format::Classic(Interface { link_type, snap_len, clock }), FILE_HEADER))
        };
        let opened = match magic {
            SECTION_HEADER => Some((ByteOrder::Little, Format::Blocks(Vec::new()), 0)),
            0xA1B2_C3D4 => classic(ByteOrder::Big, Clock::MICROS),
            0xD4C3_B2A1 => classic(ByteOrder::Little, Clock::MICROS),
            0xA1B2_3C4D => classic(ByteOrder::Big, Clock::NANOS),
            0x4D3C_B2A1 => classic(ByteOrder::Little, Clock::NANOS),
            0x1F8B_0000..=0x1F8B_FFFF | 0x28B5_2FFD => return Err(OpenError::Compressed),
            _ => None,
        };
        let (byte_order, format, at) = opened.ok_or(OpenError::Other)?;
        file.skip(at);
        Ok(Self { file, byte_order, format, number: 0, section: 0, time: Duration::ZERO, is_over: false })
    }

    /// Returns the next packet; `None` at the end or after damage.
    pub fn next(&mut self) -> Option<Result<Packet<'_>, Damage>> {
        // `len` is the length of the record or block that contains the packet.
        let (span, len) = loop {
            if self.is_over {
                return None;
            }
            let next = match self.format {
                _ if self.file.peek(1).is_ok_and(<[u8]>::is_empty) => return None,
                Format::Classic(interface) => self.record(interface).map(|(span, len)| (Some(span), len)),
                Format::Blocks(_) => self.block(),
            };
            match next {
                Ok((Some(span), len)) => break (span, len),
                Ok((None, len)) => self.file.skip(len),
                Err(problem) => {
                    self.is_over = true;
                    return Some(Err(Damage { offset: self.file.consumed, problem }));
                }
            }
        };
        let PacketSpan { interface, time, bytes, original } = span;
        self.number += 1;
        self.time = time.unwrap_or(self.time);
        let (number, section, time) = (self.number, self.section, self.time);
        let before = self.file.start;
        self.file.skip(len);
        // The bytes stay in the buffer until the next `look`, although they count as consumed.
        let bytes = self.file.bytes.get(before + bytes.start..before + bytes.end).unwrap_or_default();
        let is_cut = bytes.len() < original;
        Some(Ok(Packet { number, section, time, link_type: interface.link_type, bytes, is_cut }))
    }

    /// Returns the next packet of a pcap file and the length of its record.
    fn record(&mut self, interface: Interface) -> Result<(PacketSpan, usize), &'static str> {
        let order = self.byte_order;
        let head = self.file.peek(PACKET_HEADER).map_err(|_| UNREADABLE)?;
        let header = || {
            let seconds = u64::from(order.word(head, 0)?);
            let parts = u64::from(order.word(head, 4)?);
            Some((seconds, parts, order.size(head, 8)?, order.size(head, 12)?))
        };
        let (seconds, parts, len, original) = header().ok_or("the file ends inside the header of a packet")?;
        refuse_if(len > MAX_PACKET_LEN, "a packet with an invalid length")?;
        let whole = PACKET_HEADER + len;
        refuse_if(self.file.peek(whole).map_err(|_| UNREADABLE)?.len() < whole, "the file ends inside a packet")?;
        let time = Some(Clock { offset: seconds, ..interface.clock }.time(parts));
        Ok((PacketSpan { interface, time, bytes: PACKET_HEADER..whole, original }, whole))
    }

    /// Reads the next block of a pcapng file. Returns the packet in the block, if there is one, and the length of the
    /// block.
    fn block(&mut self) -> Result<(Option<PacketSpan>, usize), &'static str> {
        let short = "the file ends inside a block";
        let head = self.file.peek(12).map_err(|_| UNREADABLE)?;
        let kind = self.byte_order.word(head, 0).ok_or(short)?;
        if kind == SECTION_HEADER {
            // The type of this block is the same in both byte orders. The magic number in the block shows the byte
            // order.
            let magic = ByteOrder::Big.word(head, 8).ok_or(short)?;
            self.byte_order = match magic {
                BYTE_ORDER_MAGIC => ByteOrder::Big,
                _ if magic.swap_bytes() == BYTE_ORDER_MAGIC => ByteOrder::Little,
                _ => return Err("a section without a byte order"),
            };
        }
        let order = self.byte_order;
        let len = order.size(head, 4).ok_or(short)?;
        refuse_if(len < 12 || len % 4 != 0 || len > MAX_PACKET_LEN, "a block with an invalid length")?;
        let block = self.file.peek(len).map_err(|_| UNREADABLE)?;
        refuse_if(block.len() < len, short)?;
        refuse_if(order.size(block, len - 4) != Some(len), "a block with two different lengths")?;
        let body = &block[8..len - 4];
        match kind {
            SECTION_HEADER if order.short(body, 4) != Some(1) => return Err("a section with an unknown version"),
            SECTION_HEADER => {
                self.section += 1;
                self.format = Format::Blocks(Vec::new());
            }
            INTERFACE => {
                let interface = interface(order, body).ok_or("a truncated interface block")?;
                if let Format::Blocks(interfaces) = &mut self.format {
                    refuse_if(interfaces.len() >= MAX_INTERFACES, "too many interfaces")?;
                    interfaces.push(interface);
                }
            }
            ENHANCED_PACKET | OLD_PACKET | SIMPLE_PACKET => return Ok((Some(self.packet_of(kind, len)?), len)),
            _ => {}
        }
        Ok((None, len))
    }

    /// Decodes the packet in a block of `len` bytes. The caller has loaded the block with `look`.
    fn packet_of(&self, kind: u32, len: usize) -> Result<PacketSpan, &'static str> {
        let body = &self.file.loaded()[8..len - 4];
        let order = self.byte_order;
        let Format::Blocks(interfaces) = &self.format else { return Err("a block outside a section") };
        let number = match kind {
            ENHANCED_PACKET => order.size(body, 0),
            OLD_PACKET => order.short(body, 0).map(usize::from),
            _ => Some(0),
        };
        let interface = number.and_then(|number| interfaces.get(number).copied());
        let interface = interface.ok_or("a packet of an undefined interface")?;
        // Returns the time of the packet, its offset in the body, its recorded length and its original length.
        let parts = || {
            if kind == SIMPLE_PACKET {
                let original = order.size(body, 0)?;
                let snap_len = if interface.snap_len == 0 { usize::MAX } else { interface.snap_len };
                return Some((None, 4, original.min(snap_len).min(MAX_PACKET_LEN), original));
            }
            let count = u64::from(order.word(body, 4)?) << 32 | u64::from(order.word(body, 8)?);
            Some((
                Some(interface.clock.time(count)),
                20,
                order.size(body, 12)?.min(MAX_PACKET_LEN),
                order.size(body, 16)?,
            ))
        };
        let whole = parts().filter(|(_, start, len, _)| start + len <= body.len());
        let (time, start, len, original) = whole.ok_or("a packet longer than its block")?;
        Ok(PacketSpan { interface, time, bytes: 8 + start..8 + start + len, original })
    }
}

/// Decodes an Interface Description Block.
fn interface(order: ByteOrder, body: &[u8]) -> Option<Interface> {
    let (link_type, snap_len) = (order.short(body, 0)?, order.size(body, 4)?);
    let (mut resolution, mut offset, mut at) = (6, 0, 8);
    while let (Some(code), Some(len)) = (order.short(body, at), order.short(body, at + 2)) {
        let value = body.get(at + 4..).unwrap_or_default();
        match (code, len) {
            (END_OF_OPTIONS, _) => break,
            (TIME_RESOLUTION, 1) => resolution = *value.first()?,
            (TIME_OFFSET, 8) => offset = order.long(value, 0)?,
            _ => {}
        }
        at += 4 + usize::from(len).next_multiple_of(4);
    }
    Some(Interface { link_type, snap_len, clock: Clock::new(resolution, offset) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks_count_in_powers_of_ten_and_of_two() {
        assert_eq!(Clock::new(6, 0).time(1_500_000), Duration::from_millis(1500));
        assert_eq!(Clock::new(9, 10).time(1), Duration::new(10, 1));
        assert_eq!(Clock::new(0x8A, 0).time(1536), Duration::from_millis(1500));
        assert_eq!(Clock::new(0, u64::MAX).time(3), Duration::from_secs(2), "an offset may be negative");
        assert_eq!(Clock::new(0x7F, 0), Clock::MICROS);
        assert_eq!(Clock::new(0xFF, 0).time(u64::MAX).as_secs(), 0);
    }

    #[test]
    fn rejects_files_that_are_not_captures() {
        assert_eq!(Packets::open(&b""[..]).unwrap_err(), OpenError::Other);
        assert_eq!(Packets::open(&b"YERC"[..]).unwrap_err(), OpenError::Other);
        assert_eq!(
            Packets::open(&[0xA1, 0xB2, 0xC3, 0xD4, 0][..]).unwrap_err(),
            OpenError::Other,
            "a header that is cut"
        );
        assert_eq!(Packets::open(&[0x1F, 0x8B, 8, 0][..]).unwrap_err(), OpenError::Compressed);
    }

    /// A reader that returns a few bytes per call and cannot seek.
    struct PieceReader<'a>(&'a [u8]);

    impl Read for PieceReader<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            let len = buffer.len().min(7).min(self.0.len());
            let (now, later) = self.0.split_at(len);
            buffer[..len].copy_from_slice(now);
            self.0 = later;
            Ok(len)
        }
    }

    #[test]
    fn keeps_only_a_window_of_a_long_file_in_memory() {
        let header = [&0xA1B2_C3D4_u32.to_be_bytes()[..], &[0; 16], &[0, 0, 0, 101]].concat();
        let record = |byte: u8| [&[0; 8][..], &1000_u32.to_be_bytes(), &1000_u32.to_be_bytes(), &[byte; 1000]].concat();
        let file = [header, (0..=u8::MAX).cycle().take(1000).flat_map(record).collect()].concat();
        let mut packets = Packets::open(PieceReader(&file)).unwrap();
        for byte in (0..=u8::MAX).cycle().take(1000) {
            let packet = packets.next().unwrap().unwrap();
            assert_eq!((packet.bytes, packet.is_cut), (&[byte; 1000][..], false));
            assert!(packets.file.bytes.capacity() <= 4 * READ_SIZE);
        }
        assert_eq!(packets.next(), None);
    }

    #[test]
    fn impossible_lengths_are_damage() {
        let block =
            |len: u32| [&SECTION_HEADER.to_be_bytes()[..], &len.to_be_bytes(), &[0x1A, 0x2B, 0x3C, 0x4D]].concat();
        for (len, problem) in [
            (0, "a block with an invalid length"),
            (13, "a block with an invalid length"),
            (u32::MAX, "a block with an invalid length"),
            (28, "the file ends inside a block"),
        ] {
            let file = block(len);
            let mut packets = Packets::open(&file[..]).unwrap();
            assert_eq!(packets.next(), Some(Err(Damage { offset: 0, problem })));
            assert_eq!(packets.next(), None);
        }
    }
}
