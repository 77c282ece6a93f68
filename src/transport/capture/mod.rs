//! Reader for capture files: pcap and pcapng from `tap`(super::tap), tcpdump and Wireshark, candump logs, PROFIBUS
//! dumps.
//!
//! `file` reads packets, `layers` decodes them (with `etherparse`), `stream` reassembles TCP, `dump` finds PROFIBUS
//! telegrams. No input causes a panic.
//!
//! armctl has its own packet reader, because the crate `pcap-file` has two faults. It stops at harmless packets:
//! packets with a comment that is not UTF-8, or with an original length of 0. It also interprets an impossible block
//! length as the end of the file.

mod dump;
mod file;
mod layers;
mod stream;

use std::cell::Cell;
use std::io::{BufRead, BufReader, Read};
use std::net::SocketAddr;
use std::time::Duration;

use self::dump::Form;
use self::file::{Packets, is_capture};
use self::layers::{PacketContent, Payload, content_of};
use self::stream::{StreamPiece, Streams};
use super::devicenet::can::Frame;
use super::tap::Direction;

pub use self::dump::{holds_telegram, parse_hex};
pub use self::file::{Damage, OpenError};

/// Received bytes with their origin and time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message<'a> {
    /// Number of the packet that completed the message, from 1, as in Wireshark.
    pub number: u64,
    /// Time since 1970, from the file.
    pub time: Duration,
    /// Transport and endpoints.
    pub carrier: Carrier,
    /// Bytes of the message; never empty.
    pub bytes: &'a [u8],
    /// Whether only a part of the packet was recorded.
    pub is_cut: bool,
}

/// Transport of a message, with its endpoints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Carrier {
    /// UDP: a complete message.
    Datagram {
        /// Sender.
        from: SocketAddr,
        /// Receiver.
        to: SocketAddr,
    },
    /// TCP: the next bytes of the stream.
    Stream {
        /// Sender.
        from: SocketAddr,
        /// Receiver.
        to: SocketAddr,
        /// Whether these are the first bytes of a connection whose opening is in the file.
        begins: bool,
        /// Number of bytes that are missing before these bytes.
        lost: u32,
    },
    /// A serial line or in-process simulator, recorded by armctl.
    Line {
        /// Direction of the bytes.
        direction: Direction,
        /// Number of the section in the file. Each recorded command has one section.
        section: usize,
    },
    /// A whole frame whose link type has its own frame format.
    Frame {
        /// Link type of the frame, for example [`LINKTYPE_CAN`].
        link_type: u16,
    },
}

/// `LINKTYPE_CAN_SOCKETCAN`: CAN frames.
pub const LINKTYPE_CAN: u16 = 227;

/// `LINKTYPE_ETHERNET`: Ethernet frames. Only PROFINET frames are delivered as whole frames.
pub const LINKTYPE_ETHERNET: u16 = 1;

impl Carrier {
    /// Sender and receiver, if they have addresses.
    pub const fn ends(&self) -> Option<(SocketAddr, SocketAddr)> {
        match *self {
            Self::Datagram { from, to } | Self::Stream { from, to, .. } => Some((from, to)),
            Self::Line { .. } | Self::Frame { .. } => None,
        }
    }
}

/// Summary of a file.
#[derive(Debug, Default, Clone, PartialEq, Eq)]
pub struct Summary {
    /// Number of packets.
    pub packets: u64,
    /// Time of the first packet, counted from 1970.
    pub first: Duration,
    /// Number of IP fragments. The reader skips them.
    pub fragments: u64,
    /// Number of repeated TCP segments.
    pub repeated: u64,
    /// Position of the damage; `None` if the file is not damaged. The reader has read everything before this position.
    pub damage: Option<Damage>,
}

/// Reads a file in pieces and delivers its messages. The bytes of a TCP stream are delivered in order. Bytes of
/// segments that arrived out of order can therefore be delivered after later messages of other streams.
pub fn read(mut file: impl Read, mut each: impl FnMut(&Message<'_>)) -> Result<Summary, OpenError> {
    read_while(&mut file, &mut |message| {
        each(message);
        true
    })
}

/// Reads a file like [`read`], but only as long as `each` returns true. The summary describes the part that was read.
///
/// The arguments are not generic, so that this is compiled once, with the optimization of this crate.
pub fn read_while(file: &mut dyn Read, each: &mut dyn FnMut(&Message<'_>) -> bool) -> Result<Summary, OpenError> {
    let is_wanted = Cell::new(true);
    let mut each = |message: &Message<'_>| is_wanted.set(is_wanted.get() && each(message));
    let mut summary = Summary::default();
    let mut streams = Streams::default();
    let mut file = BufReader::new(file);
    let beginning = file.fill_buf().unwrap_or_default();
    if beginning.starts_with(b"(") {
        return Ok(candump(file, each));
    }
    // The capture formats are checked before the PROFIBUS dumps, because a packet capture can contain PROFIBUS
    // telegrams.
    if let Some(form) = Form::of(beginning).filter(|_| !is_capture(beginning)) {
        return Ok(dump::read(file, form, each));
    }
    let mut packets = Packets::open(file)?;
    while is_wanted.get()
        && let Some(packet) = packets.next()
    {
        let packet = match packet {
            Ok(packet) => packet,
            Err(damage) => {
                summary.damage = Some(damage);
                break;
            }
        };
        if summary.packets == 0 {
            summary.first = packet.time;
        }
        summary.packets = packet.number;
        let (number, time) = (packet.number, packet.time);
        let mut say = |carrier, bytes, is_cut| each(&Message { number, time, carrier, bytes, is_cut });
        match content_of(packet.link_type, packet.bytes) {
            PacketContent::Serial { direction, bytes } => {
                let carrier = Carrier::Line { direction, section: packet.section };
                if !bytes.is_empty() {
                    say(carrier, bytes, packet.is_cut);
                }
            }
            PacketContent::Packet { from, to, payload: Payload::Datagram(bytes), is_cut } if !bytes.is_empty() => {
                say(Carrier::Datagram { from, to }, bytes, is_cut || packet.is_cut);
            }
            PacketContent::Packet { from, to, payload: Payload::Segment(segment), is_cut } => {
                let key = (packet.section, from, to);
                let is_cut = is_cut || packet.is_cut;
                streams.take(key, &segment, (number, time, is_cut), &mut |ordered| deliver(ordered, &mut each));
            }
            PacketContent::Frame if !packet.bytes.is_empty() => {
                say(Carrier::Frame { link_type: packet.link_type }, packet.bytes, packet.is_cut);
            }
            PacketContent::Packet { .. } | PacketContent::Frame | PacketContent::Other => {}
            PacketContent::Fragment => summary.fragments += 1,
        }
    }
    streams.finish(&mut |ordered| deliver(ordered, &mut each));
    summary.repeated = streams.repeated();
    Ok(summary)
}

/// Longest line of a candump log.
const MAX_LINE_LEN: u64 = 4096;

fn candump(mut file: impl BufRead, mut each: impl FnMut(&Message<'_>)) -> Summary {
    let mut summary = Summary::default();
    let mut line = Vec::new();
    let mut offset = 0;
    loop {
        line.clear();
        let len = match file.by_ref().take(MAX_LINE_LEN).read_until(b'\n', &mut line) {
            Ok(0) => return summary,
            Ok(len) => len,
            Err(_) => {
                summary.damage = Some(Damage { offset, problem: "cannot read more of the file" });
                return summary;
            }
        };
        offset += len;
        summary.packets += 1;
        // Extended and remote frames are valid in a log, but this reader does not decode them.
        let Some((time, frame)) = Frame::from_candump(&String::from_utf8_lossy(&line)) else { continue };
        let time = time.unwrap_or_default();
        if summary.first.is_zero() {
            summary.first = time;
        }
        let (bytes, carrier) = (frame.to_capture(), Carrier::Frame { link_type: LINKTYPE_CAN });
        each(&Message { number: summary.packets, time, carrier, bytes: &bytes, is_cut: false });
    }
}

fn deliver(ordered: &StreamPiece<'_>, each: &mut impl FnMut(&Message<'_>)) {
    let StreamPiece { key: (_, from, to), origin: (number, time, is_cut), begins, lost, bytes } = *ordered;
    let carrier = Carrier::Stream { from, to, begins, lost };
    each(&Message { number, time, carrier, bytes, is_cut });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tap::CaptureWriter;

    fn ends() -> (SocketAddr, SocketAddr) {
        ("10.0.0.1:40000".parse().unwrap(), "[fe80::2]:10040".parse().unwrap())
    }

    /// Returns a file that `tap` wrote, with every record type.
    fn recorded() -> Vec<u8> {
        let mut file = Vec::new();
        let (from, to) = ends();
        let mut capture = CaptureWriter::streams(&mut file).unwrap();
        capture.datagram(Duration::from_millis(1500), from, to, b"YERC").unwrap();
        capture.segment(Duration::from_secs(2), from, to, b"@HSON\r\n").unwrap();
        capture.segment(Duration::from_secs(3), to, from, b"@OK\r\n").unwrap();
        capture.line(Duration::from_secs(4), Direction::Received, b"@NG\r\n").unwrap();
        CaptureWriter::new(&mut file).unwrap().datagram(Duration::from_secs(5), to, from, b"last").unwrap();
        file
    }

    type OwnedMessage = (u64, Duration, Carrier, Vec<u8>);

    fn messages_of(file: &[u8]) -> (Vec<OwnedMessage>, Summary) {
        let mut all = Vec::new();
        let summary = read(file, |message| {
            assert!(!message.bytes.is_empty() && !message.is_cut);
            all.push((message.number, message.time, message.carrier, message.bytes.to_vec()));
        });
        (all, summary.unwrap())
    }

    #[test]
    fn reads_captures_of_the_tap() {
        let (from, to) = ends();
        let from = SocketAddr::new(std::net::IpAddr::V6("::ffff:10.0.0.1".parse().unwrap()), from.port());
        let (all, summary) = messages_of(&recorded());
        let stream = |from, to| Carrier::Stream { from, to, begins: false, lost: 0 };
        let line = Carrier::Line { direction: Direction::Received, section: 1 };
        let secs = Duration::from_secs;
        let expected: [(u64, Duration, Carrier, &[u8]); 5] = [
            (1, Duration::from_millis(1500), Carrier::Datagram { from, to }, b"YERC"),
            (2, secs(2), stream(from, to), b"@HSON\r\n"),
            (3, secs(3), stream(to, from), b"@OK\r\n"),
            (4, secs(4), line, b"@NG\r\n"),
            (5, secs(5), Carrier::Datagram { from: to, to: from }, b"last"),
        ];
        let expected: Vec<_> = expected.into_iter().map(|(n, time, by, bytes)| (n, time, by, bytes.to_vec())).collect();
        assert_eq!(all, expected);
        assert_eq!(summary, Summary { packets: 5, first: Duration::from_millis(1500), ..Summary::default() });
    }

    #[test]
    fn telegrams_in_a_capture_keep_their_times() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("line.pcapng");
        let mut capture = CaptureWriter::append_packets(&path, crate::tap::LINKTYPE_PROFIBUS_DL).unwrap();
        let telegrams: [&[u8]; 2] = [b"\x10\x05\x02\x49\x50\x16", b"\x10\x02\x05\x00\x07\x16"];
        for (second, telegram) in (7..).zip(telegrams) {
            capture.frame(Duration::from_secs(second), telegram).unwrap();
        }
        drop(capture);
        let (all, summary) = messages_of(&std::fs::read(&path).unwrap());
        let read: Vec<_> = all.iter().map(|(number, time, _, bytes)| (*number, time.as_secs(), &bytes[..])).collect();
        assert_eq!(read, [(1, 7, telegrams[0]), (2, 8, telegrams[1])]);
        assert_eq!((summary.packets, summary.first.as_secs()), (2, 7));
    }

    #[test]
    fn truncated_file_yields_earlier_messages() {
        let file = recorded();
        let (all, _) = messages_of(&file);
        for end in 12..file.len() {
            let Ok(summary) = read(&file[..end], |_| ()) else { continue };
            let (part, _) = messages_of(&file[..end]);
            assert_eq!(part, all[..part.len()], "cut at {end}");
            assert_eq!(summary.packets, u64::try_from(part.len()).unwrap());
            if let Some(damage) = summary.damage {
                assert!(damage.offset <= end, "{damage} in {end} bytes");
            }
        }
    }
}
