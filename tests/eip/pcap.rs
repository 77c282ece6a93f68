//! A capture file of the exchanged packets. Their IP, UDP and TCP headers are synthetic (link type RAW).

use armctl_transport::eip::tap::TappedPacket;
use std::collections::HashMap;
use std::net::SocketAddrV4;

#[derive(Debug, Default)]
pub struct Capture {
    packets: Vec<u8>,
    count: u32,
    /// Number of bytes sent so far, by stream and direction.
    sent: HashMap<(SocketAddrV4, SocketAddrV4), u32>,
}

impl Capture {
    pub fn add(&mut self, passed: &TappedPacket<'_>) {
        let mut segment = [passed.from.port().to_be_bytes(), passed.to.port().to_be_bytes()].concat();
        let len = u16::try_from(passed.bytes.len()).unwrap();
        if passed.is_tcp {
            let next = self.sent.entry((passed.from, passed.to)).or_insert(1);
            segment.extend(next.to_be_bytes());
            *next += u32::from(len);
            segment.extend(self.sent.get(&(passed.to, passed.from)).unwrap_or(&1).to_be_bytes());
            // A header of 5 words, the flags PSH and ACK, and the window. Checksum and urgent pointer are 0.
            segment.extend([0x50, 0x18, 0xFF, 0xFF, 0, 0, 0, 0]);
        } else {
            segment.extend((len + 8).to_be_bytes());
            segment.extend([0, 0]);
        }
        segment.extend(passed.bytes);
        let mut packet = vec![0x45, 0];
        packet.extend(u16::try_from(segment.len() + 20).unwrap().to_be_bytes());
        packet.extend([0, 0, 0x40, 0, 64, if passed.is_tcp { 6 } else { 17 }, 0, 0]);
        packet.extend(passed.from.ip().octets());
        packet.extend(passed.to.ip().octets());
        packet.extend(segment);
        let len = u32::try_from(packet.len()).unwrap().to_le_bytes();
        self.count += 1;
        // Each packet is one second later than the previous packet. Only their order matters.
        self.packets.extend([self.count.to_le_bytes(), [0; 4], len, len].concat());
        self.packets.extend(packet);
    }

    pub fn bytes(&self) -> Vec<u8> {
        let mut file = 0xA1B2_C3D4u32.to_le_bytes().to_vec();
        file.extend([2, 0, 4, 0]);
        file.extend([0; 8]);
        file.extend(65_535u32.to_le_bytes());
        // LINKTYPE_RAW
        file.extend(101u32.to_le_bytes());
        file.extend(&self.packets);
        file
    }
}
