//! Duplicate MAC check: a node sends two requests before it goes on line, and a node with the same MAC answers.

/// A request or answer of the check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DuplicateCheck {
    /// Whether the message is an answer.
    pub is_answer: bool,
    /// Physical port number; 0 on DeviceNet.
    pub port: u8,
    /// Vendor id of the sender.
    pub vendor: u16,
    /// Serial number of the sender.
    pub serial: u32,
}

const ANSWER: u8 = 0x80;

impl DuplicateCheck {
    /// Length of the message in bytes.
    pub const LEN: usize = 7;

    /// Decodes exactly [`LEN`](Self::LEN) bytes.
    pub fn parse(bytes: &[u8]) -> Option<Self> {
        let bytes: &[u8; Self::LEN] = bytes.try_into().ok()?;
        Some(Self {
            is_answer: bytes[0] & ANSWER != 0,
            port: bytes[0] & !ANSWER,
            vendor: u16::from_le_bytes([bytes[1], bytes[2]]),
            serial: u32::from_le_bytes([bytes[3], bytes[4], bytes[5], bytes[6]]),
        })
    }

    /// Encodes the message.
    pub fn emit(self) -> [u8; Self::LEN] {
        let mut bytes = [0; Self::LEN];
        bytes[0] = self.port & !ANSWER | if self.is_answer { ANSWER } else { 0 };
        bytes[1..3].copy_from_slice(&self.vendor.to_le_bytes());
        bytes[3..].copy_from_slice(&self.serial.to_le_bytes());
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_match_tshark() {
        let check = DuplicateCheck { is_answer: false, port: 0, vendor: 636, serial: 0x00C0_FFEE };
        assert_eq!(check.emit(), [0x00, 0x7C, 0x02, 0xEE, 0xFF, 0xC0, 0x00]);
        let answer = DuplicateCheck { is_answer: true, ..check };
        assert_eq!(answer.emit()[0], 0x80);
        for check in [check, answer] {
            assert_eq!(DuplicateCheck::parse(&check.emit()), Some(check));
        }
        assert_eq!(DuplicateCheck::parse(&[0; 6]), None);
        assert_eq!(DuplicateCheck::parse(&[0; 8]), None);
    }
}
