//! CAN identifiers of DeviceNet.

use std::fmt;
use std::str::FromStr;

/// Node address (MAC ID): 0 to 63.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Mac(u8);

impl Mac {
    /// Highest MAC.
    pub const LAST: u8 = 63;

    /// Creates a MAC; `None` if the number is above 63.
    pub const fn new(number: u8) -> Option<Self> {
        if number <= Self::LAST { Some(Self(number)) } else { None }
    }

    /// Creates a MAC from the lower six bits.
    pub const fn from_bits(bits: u16) -> Self {
        Self(bits.to_le_bytes()[0] & Self::LAST)
    }

    /// MAC as a number.
    pub const fn number(self) -> u8 {
        self.0
    }

    /// All MACs.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..=Self::LAST).map(Self)
    }

    fn bits(self) -> u16 {
        u16::from(self.0)
    }
}

impl fmt::Display for Mac {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)
    }
}

impl FromStr for Mac {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = text.parse().ok().and_then(Self::new);
        number.ok_or_else(|| format!("a MAC ID must be a number from 0 to {}, not '{text}'", Self::LAST))
    }
}

/// Meaning of an 11-bit identifier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Id {
    /// Another message of group 1, with its number 0 to 11. The predefined master/slave connection set does not use it.
    Group1(u8, Mac),
    /// Slave's multicast poll response.
    MulticastAnswer(Mac),
    /// Slave's change of state or cyclic message.
    Change(Mac),
    /// Slave's bit strobe response.
    StrobeAnswer(Mac),
    /// Slave's poll response, or its acknowledgement of a change of state.
    PollAnswer(Mac),
    /// Master's bit strobe command, with the MAC of the master.
    Strobe(Mac),
    /// Master's multicast poll command, with the MAC of the group.
    MulticastPoll(Mac),
    /// Master's acknowledgement of change of state or cyclic data.
    ChangeAck(Mac),
    /// Slave's explicit responses, connected or unconnected.
    Answer(Mac),
    /// Master's explicit request on a connection.
    Request(Mac),
    /// Master's poll command, change of state or cyclic message.
    Poll(Mac),
    /// Unconnected explicit request to a group 2 only server.
    Unconnected(Mac),
    /// Duplicate MAC check, with the MAC that is checked.
    Duplicate(Mac),
    /// Connected explicit message of group 3, with its number 0 to 4.
    Group3(u8, Mac),
    /// Unconnected explicit response (group 3).
    UnconnectedAnswer(Mac),
    /// Unconnected explicit request (group 3).
    UnconnectedRequest(Mac),
    /// Message of group 4, with its number 00 to 2F.
    Group4(u8),
}

impl Id {
    /// Decodes an identifier; `None` if DeviceNet does not use it.
    pub fn parse(id: u16) -> Option<Self> {
        let low = Mac::from_bits(id);
        let high = Mac::from_bits(id >> 3);
        Some(match id {
            0x000..0x300 => Self::Group1((id >> 6).to_le_bytes()[0], low),
            0x300..0x340 => Self::MulticastAnswer(low),
            0x340..0x380 => Self::Change(low),
            0x380..0x3C0 => Self::StrobeAnswer(low),
            0x3C0..0x400 => Self::PollAnswer(low),
            0x400..0x600 => match id & 7 {
                0 => Self::Strobe(high),
                1 => Self::MulticastPoll(high),
                2 => Self::ChangeAck(high),
                3 => Self::Answer(high),
                4 => Self::Request(high),
                5 => Self::Poll(high),
                6 => Self::Unconnected(high),
                _ => Self::Duplicate(high),
            },
            0x600..0x740 => Self::Group3(((id - 0x600) >> 6).to_le_bytes()[0], low),
            0x740..0x780 => Self::UnconnectedAnswer(low),
            0x780..0x7C0 => Self::UnconnectedRequest(low),
            0x7C0..0x7F0 => Self::Group4((id & 0x3F).to_le_bytes()[0]),
            _ => return None,
        })
    }

    /// Encodes the identifier. A message number that is too high for its group becomes the highest number of the group.
    pub fn emit(self) -> u16 {
        let group2 = |mac: Mac, message: u16| 0x400 | mac.bits() << 3 | message;
        match self {
            Self::Group1(message, mac) => u16::from(message.min(11)) << 6 | mac.bits(),
            Self::MulticastAnswer(mac) => 0x300 | mac.bits(),
            Self::Change(mac) => 0x340 | mac.bits(),
            Self::StrobeAnswer(mac) => 0x380 | mac.bits(),
            Self::PollAnswer(mac) => 0x3C0 | mac.bits(),
            Self::Strobe(mac) => group2(mac, 0),
            Self::MulticastPoll(mac) => group2(mac, 1),
            Self::ChangeAck(mac) => group2(mac, 2),
            Self::Answer(mac) => group2(mac, 3),
            Self::Request(mac) => group2(mac, 4),
            Self::Poll(mac) => group2(mac, 5),
            Self::Unconnected(mac) => group2(mac, 6),
            Self::Duplicate(mac) => group2(mac, 7),
            Self::Group3(message, mac) => 0x600 | u16::from(message.min(4)) << 6 | mac.bits(),
            Self::UnconnectedAnswer(mac) => 0x740 | mac.bits(),
            Self::UnconnectedRequest(mac) => 0x780 | mac.bits(),
            Self::Group4(message) => 0x7C0 | u16::from(message.min(0x2F)),
        }
    }

    /// MAC of the sender, if the identifier contains it.
    pub const fn sender(self) -> Option<Mac> {
        match self {
            Self::Group1(_, mac)
            | Self::MulticastAnswer(mac)
            | Self::Change(mac)
            | Self::StrobeAnswer(mac)
            | Self::PollAnswer(mac)
            | Self::Strobe(mac)
            | Self::Answer(mac)
            | Self::Group3(_, mac)
            | Self::UnconnectedAnswer(mac)
            | Self::UnconnectedRequest(mac) => Some(mac),
            _ => None,
        }
    }

    /// Message group.
    pub const fn group(self) -> u8 {
        match self {
            Self::Group1(..)
            | Self::MulticastAnswer(_)
            | Self::Change(_)
            | Self::StrobeAnswer(_)
            | Self::PollAnswer(_) => 1,
            Self::Strobe(_)
            | Self::MulticastPoll(_)
            | Self::ChangeAck(_)
            | Self::Answer(_)
            | Self::Request(_)
            | Self::Poll(_)
            | Self::Unconnected(_)
            | Self::Duplicate(_) => 2,
            Self::Group3(..) | Self::UnconnectedAnswer(_) | Self::UnconnectedRequest(_) => 3,
            Self::Group4(_) => 4,
        }
    }
}

/// Text for traces, for example `MAC 5: answer to a poll`.
impl fmt::Display for Id {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (mac, what) = match *self {
            Self::Group1(message, mac) => return write!(f, "MAC {mac}: group 1 message {message}"),
            Self::Group3(message, mac) => return write!(f, "MAC {mac}: group 3 message {message}"),
            Self::Group4(0x2C) => return f.write_str("group 4: answer of a faulted node"),
            Self::Group4(0x2D) => return f.write_str("group 4: request to a faulted node"),
            Self::Group4(0x2E) => return f.write_str("group 4: answer of offline ownership"),
            Self::Group4(0x2F) => return f.write_str("group 4: request for offline ownership"),
            Self::Group4(message) => return write!(f, "group 4 message {message:#04x}"),
            Self::MulticastAnswer(mac) => (mac, "answer to a multicast poll"),
            Self::Change(mac) => (mac, "change of state"),
            Self::StrobeAnswer(mac) => (mac, "answer to a bit strobe"),
            Self::PollAnswer(mac) => (mac, "answer to a poll"),
            Self::Strobe(mac) => (mac, "bit strobe of this master"),
            Self::MulticastPoll(mac) => (mac, "multicast poll"),
            Self::ChangeAck(mac) => (mac, "change of state acknowledged by the master"),
            Self::Answer(mac) => (mac, "explicit answer"),
            Self::Request(mac) => (mac, "explicit request"),
            Self::Poll(mac) => (mac, "poll by the master"),
            Self::Unconnected(mac) => (mac, "unconnected request"),
            Self::Duplicate(mac) => (mac, "duplicate MAC check"),
            Self::UnconnectedAnswer(mac) => (mac, "unconnected answer"),
            Self::UnconnectedRequest(mac) => (mac, "unconnected request of this node"),
        };
        write!(f, "MAC {mac}: {what}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_identifier_round_trips() {
        for id in 0..0x7F0 {
            assert_eq!(Id::parse(id).unwrap().emit(), id);
        }
        for id in (0x7F0..=0x7FF).chain([0x800, u16::MAX]) {
            assert_eq!(Id::parse(id), None, "{id:x}");
        }
    }

    /// Predefined master/slave connection set of slave 5.
    #[test]
    fn the_predefined_set_has_its_identifiers() {
        let mac = Mac::new(5).unwrap();
        for (id, number, group) in [
            (Id::PollAnswer(mac), 0x3C5, 1),
            (Id::StrobeAnswer(mac), 0x385, 1),
            (Id::Change(mac), 0x345, 1),
            (Id::MulticastAnswer(mac), 0x305, 1),
            (Id::ChangeAck(mac), 0x42A, 2),
            (Id::Answer(mac), 0x42B, 2),
            (Id::Request(mac), 0x42C, 2),
            (Id::Poll(mac), 0x42D, 2),
            (Id::Unconnected(mac), 0x42E, 2),
            (Id::Duplicate(mac), 0x42F, 2),
            (Id::UnconnectedAnswer(mac), 0x745, 3),
            (Id::UnconnectedRequest(Mac::new(1).unwrap()), 0x781, 3),
            (Id::Group4(0x2C), 0x7EC, 4),
        ] {
            assert_eq!((id.emit(), id.group()), (number, group), "{id}");
            assert_eq!(Id::parse(number), Some(id));
        }
    }

    #[test]
    fn macs_are_0_to_63() {
        assert_eq!("63".parse::<Mac>().unwrap().number(), 63);
        for wrong in ["64", "-1", "x", ""] {
            assert!(wrong.parse::<Mac>().unwrap_err().contains("0 to 63"), "{wrong}");
        }
        assert_eq!(Mac::all().count(), 64);
    }
}
