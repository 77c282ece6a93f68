//! The byte that fragments begin with.

/// Which part of a message a fragment is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// The first.
    First,
    /// One between.
    Middle,
    /// The last.
    Last,
    /// None: what the receiver of explicit fragments says to each.
    Acknowledge,
}

/// Kind and count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Fragment {
    /// Which part it is.
    pub kind: Kind,
    /// Its number, from 0, modulo 64.
    pub count: u8,
}

impl Fragment {
    /// The count of a first fragment of cyclic data that is the last one, too.
    pub const ONLY: u8 = 0x3F;

    /// Reads the byte.
    pub const fn parse(byte: u8) -> Self {
        let kind = match byte >> 6 {
            0 => Kind::First,
            1 => Kind::Middle,
            2 => Kind::Last,
            _ => Kind::Acknowledge,
        };
        Self { kind, count: byte & 0x3F }
    }

    /// The byte.
    pub const fn emit(self) -> u8 {
        let kind = match self.kind {
            Kind::First => 0,
            Kind::Middle => 1,
            Kind::Last => 2,
            Kind::Acknowledge => 3,
        };
        kind << 6 | self.count & 0x3F
    }

    /// Of the pieces of a message: which one this is.
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
    fn every_byte_is_read_and_written() {
        for byte in 0..=u8::MAX {
            assert_eq!(Fragment::parse(byte).emit(), byte);
        }
        assert_eq!(Fragment::parse(0xC1), Fragment { kind: Kind::Acknowledge, count: 1 });
        assert_eq!(Fragment::of(64, 70), Fragment { kind: Kind::Middle, count: 0 });
    }
}
