//! A record of the traffic as a pcapng file that Wireshark opens.
//!
//! Datagrams are wrapped in made-up IPv4 or IPv6 and UDP headers (link type RAW), with the real addresses where they
//! are known, so that a dissector for the port finds them.

use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::net::{IpAddr, SocketAddr};
use std::path::Path;
use std::time::Duration;

/// Which way a datagram went.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// To the controller.
    Sent,
    /// From the controller.
    Received,
}

/// `LINKTYPE_RAW`: packets begin with an IP header.
const LINKTYPE_RAW: u16 = 101;
/// IP protocol number of UDP.
const UDP: u8 = 17;
const SECTION_HEADER: u32 = 0x0A0D_0D0A;
const INTERFACE: u32 = 1;
const ENHANCED_PACKET: u32 = 6;
const BYTE_ORDER_MAGIC: u32 = 0x1A2B_3C4D;

/// An open capture file. Every block is written at once and whole, so that several connections can share a file, and
/// that what was recorded is there however the process ends.
#[derive(Debug)]
pub struct Capture<W: Write = File> {
    out: W,
}

impl Capture {
    /// Starts a section at the end of a file, which is made if it is not there. A file may have any number of them.
    pub fn append(path: &Path) -> io::Result<Self> {
        Self::new(OpenOptions::new().append(true).create(true).open(path)?)
    }
}

impl<W: Write> Capture<W> {
    /// Starts a capture on any writer.
    pub fn new(mut out: W) -> io::Result<Self> {
        let mut section = Vec::new();
        section.extend(BYTE_ORDER_MAGIC.to_le_bytes());
        section.extend(1u16.to_le_bytes());
        section.extend(0u16.to_le_bytes());
        section.extend(u64::MAX.to_le_bytes());
        let mut head = block(SECTION_HEADER, section);
        let mut interface = Vec::new();
        interface.extend(LINKTYPE_RAW.to_le_bytes());
        interface.extend(0u16.to_le_bytes());
        interface.extend(0u32.to_le_bytes());
        head.extend(block(INTERFACE, interface));
        out.write_all(&head)?;
        Ok(Self { out })
    }

    /// Records a datagram. `time` counts from 1970.
    pub fn datagram(&mut self, time: Duration, from: SocketAddr, to: SocketAddr, payload: &[u8]) -> io::Result<()> {
        let packet = packet(from, to, payload);
        let micros = u64::try_from(time.as_micros()).unwrap_or(u64::MAX).to_le_bytes();
        let len = length(packet.len()).to_le_bytes();
        let mut body = Vec::with_capacity(packet.len() + 20);
        body.extend(0u32.to_le_bytes());
        // The upper half of the time comes first, each half little-endian.
        body.extend(&micros[4..]);
        body.extend(&micros[..4]);
        body.extend(len);
        body.extend(len);
        body.extend(&packet);
        self.out.write_all(&block(ENHANCED_PACKET, body))
    }
}

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

/// The datagram with IP and UDP headers. UDP's checksum is left out where the protocol allows it (IPv4).
fn packet(from: SocketAddr, to: SocketAddr, payload: &[u8]) -> Vec<u8> {
    let udp_len = short(payload.len() + 8);
    let mut udp = Vec::with_capacity(payload.len() + 8);
    udp.extend(from.port().to_be_bytes());
    udp.extend(to.port().to_be_bytes());
    udp.extend(udp_len.to_be_bytes());
    udp.extend([0, 0]);
    udp.extend(payload);
    let mut packet = Vec::with_capacity(udp.len() + 40);
    match (from.ip(), to.ip()) {
        (IpAddr::V4(from), IpAddr::V4(to)) => {
            packet.extend([0x45, 0]);
            packet.extend(short(udp.len() + 20).to_be_bytes());
            packet.extend([0, 0, 0x40, 0, 64, UDP, 0, 0]);
            packet.extend(from.octets());
            packet.extend(to.octets());
            let sum = checksum(&packet);
            packet[10..12].copy_from_slice(&sum.to_be_bytes());
        }
        (from, to) => {
            let (from, to) = (v6(from), v6(to));
            let mut pseudo = [from, to].concat();
            pseudo.extend(u32::from(udp_len).to_be_bytes());
            pseudo.extend([0, 0, 0, UDP]);
            pseudo.extend(&udp);
            let sum = checksum(&pseudo).to_be_bytes();
            udp[6..8].copy_from_slice(&sum);
            packet.extend([0x60, 0, 0, 0]);
            packet.extend(udp_len.to_be_bytes());
            packet.extend([UDP, 64]);
            packet.extend(from);
            packet.extend(to);
        }
    }
    packet.extend(udp);
    packet
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

    #[test]
    fn a_capture_has_the_blocks_of_the_format() {
        let mut out = Vec::new();
        let mut capture = Capture::new(&mut out).unwrap();
        let (from, to) = ("10.0.0.1:40000".parse().unwrap(), "10.0.0.2:10040".parse().unwrap());
        capture.datagram(Duration::from_secs(1), from, to, b"YERC!").unwrap();
        let kinds = {
            let mut kinds = Vec::new();
            let mut rest = &out[..];
            while !rest.is_empty() {
                let word = |at: usize| u32::from_le_bytes(rest[at..at + 4].try_into().unwrap());
                let len = usize::try_from(word(4)).unwrap();
                assert_eq!(word(len - 4), word(4), "both lengths of a block agree");
                kinds.push(word(0));
                rest = &rest[len..];
            }
            kinds
        };
        assert_eq!(kinds, [SECTION_HEADER, INTERFACE, ENHANCED_PACKET]);
    }

    #[test]
    fn the_ip_header_checks_out() {
        let packet = packet("10.0.0.1:40000".parse().unwrap(), "10.0.0.2:10040".parse().unwrap(), b"YERC");
        assert_eq!(checksum(&packet[..20]), 0);
        assert_eq!(packet[20..28], [0x9C, 0x40, 0x27, 0x38, 0, 12, 0, 0]);
    }
}
