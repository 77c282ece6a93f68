//! Codec for ARP probes and answers (RFC 826, RFC 5227).

use std::net::Ipv4Addr;

use super::{Mac, Reader, Writer};

/// EtherType of ARP.
pub const ETHER_TYPE: u16 = 0x0806;
/// Start of the ARP header: Ethernet, IPv4, and the lengths of both addresses.
const KIND: [u8; 6] = [0, 1, 8, 0, 6, 4];
/// Minimum frame length without the checksum.
const MIN_LEN: usize = 60;

/// Returns an ARP probe. The probe asks which station uses an IP address. It contains no sender IP address, so no host
/// updates its ARP table because of the probe.
pub fn probe(source: Mac, address: Ipv4Addr) -> Vec<u8> {
    let mut out = Writer::default();
    out.put(&[0xFF; 6]);
    out.put(&source.0);
    out.u16(ETHER_TYPE);
    out.put(&KIND);
    out.u16(1);
    out.put(&source.0);
    out.zeros(4 + 6);
    out.put(&address.octets());
    out.zeros(MIN_LEN - out.bytes.len());
    out.bytes
}

/// Returns the MAC and IP address of the sender of an ARP frame. The frame can be an answer, or a probe of a host that
/// uses the address.
pub fn holder(frame: &[u8]) -> Option<(Mac, Ipv4Addr)> {
    let mut reader = Reader::big(frame);
    reader.take(12, "addresses of cards").ok()?;
    if reader.u16("type").ok()? != ETHER_TYPE || reader.take(KIND.len(), "kinds of addresses").ok()? != KIND {
        return None;
    }
    reader.u16("operation").ok()?;
    let mac = reader.mac("sender's card").ok()?;
    let address = Ipv4Addr::from(reader.array::<4>("sender's address").ok()?);
    (!address.is_unspecified()).then_some((mac, address))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::hex;

    const OUR_ADDRESS: Mac = Mac([2, 0, 0, 0, 0, 1]);
    const ADDRESS: Ipv4Addr = Ipv4Addr::new(192, 168, 78, 2);

    /// RFC 5227, 2.1.1: the sender address is zero, so no host changes its ARP table because of the probe.
    #[test]
    fn a_probe_claims_nothing() {
        let mut bytes = hex("FFFFFFFFFFFF 020000000001 0806 0001 0800 06 04 0001 020000000001 00000000");
        bytes.extend(hex("000000000000 C0A84E02"));
        bytes.resize(60, 0);
        assert_eq!(probe(OUR_ADDRESS, ADDRESS), bytes);
        assert_eq!(holder(&bytes), None);
    }

    /// An answer according to RFC 826, and frames that are not ARP answers.
    #[test]
    fn an_answer_names_its_sender() {
        let mut bytes = hex("020000000001 020000000002 0806 0001 0800 06 04 0002 020000000002 C0A84E02");
        bytes.extend(hex("020000000001 00000000"));
        let there = Mac([2, 0, 0, 0, 0, 2]);
        assert_eq!(holder(&bytes), Some((there, ADDRESS)));
        for cut in 0..32 {
            assert_eq!(holder(&bytes[..cut]), None);
        }
        for at in [12, 15, 17, 19] {
            let mut other = bytes.clone();
            other[at] ^= 0x20;
            assert_eq!(holder(&other), None, "{at}");
        }
    }
}
