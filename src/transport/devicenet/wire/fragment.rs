//! Codec for the fragment byte.

/// Fragment type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// First fragment.
    First,
    /// Middle fragment.
    Middle,
    /// Last fragment.
    Last,
    /// Acknowledgement of an explicit fragment.
    Acknowledge,
}

/// Fragment type and count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Fragment {
    /// Fragment type.
    pub kind: Kind,
    /// Count of the fragment, from 0, modulo 64.
    pub count: u8,
}

impl Fragment {
    /// Count of the fragment if a cyclic image has only one fragment.
    pub const ONLY: u8 = 0x3F;

    /// Decodes the byte.
    pub const fn parse(byte: u8) -> Self {
        let kind = match byte >> 6 {
            0 => Kind::First,
            1 => Kind::Middle,
            2 => Kind::Last,
            _ => Kind::Acknowledge,
        };
        Self { kind, count: byte & 0x3F }
    }

    /// Encodes the byte.
    pub const fn emit(self) -> u8 {
        let kind = match self.kind {
            Kind::First => 0,
            Kind::Middle => 1,
            Kind::Last => 2,
            Kind::Acknowledge => 3,
        };
        kind << 6 | self.count & 0x3F
    }

    /// Returns the fragment byte of piece number `index` of `pieces` pieces.
    pub fn of(index: usize, pieces: usize) -> Self {
        let kind = match index {
            0 => Kind::First,
            _ if index + 1 == pieces => Kind::Last,
            _ => Kind::Middle,
        };
        Self { kind, count: (index % 64).to_le_bytes()[0] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fragment_byte_round_trips() {
        for byte in 0..=u8::MAX {
            assert_eq!(Fragment::parse(byte).emit(), byte);
        }
        assert_eq!(Fragment::parse(0xC1), Fragment { kind: Kind::Acknowledge, count: 1 });
        assert_eq!(Fragment::of(64, 70), Fragment { kind: Kind::Middle, count: 0 });
    }
}
