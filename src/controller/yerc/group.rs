//! Control groups: robots, bases, stations.

use std::fmt;
use std::str::FromStr;

use super::Model;

/// A control group, numbered from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Group {
    /// A robot: R1 to R2 on FS100, up to R8 on DX200.
    Robot(u8),
    /// A base: B1 to B2 on FS100, up to B8 on DX200.
    Base(u8),
    /// A station: S1 to S3 on FS100, up to S24 on DX200.
    Station(u8),
}

impl Group {
    /// The first robot.
    pub const R1: Self = Self::Robot(1);

    /// Instance for pulses, torque and position error: from 1 for robots, from 11 for bases, from 21 for stations.
    pub const fn instance(self) -> u16 {
        match self {
            Self::Robot(number) => number as u16,
            Self::Base(number) => 10 + number as u16,
            Self::Station(number) => 20 + number as u16,
        }
    }

    /// Instance for cartesian coordinates: from 101 for robots, from 111 for bases. `None` for stations.
    pub const fn cartesian_instance(self) -> Option<u16> {
        match self {
            Self::Robot(_) | Self::Base(_) => Some(100 + self.instance()),
            Self::Station(_) => None,
        }
    }

    /// Whether the group can exist on this model.
    pub const fn exists_on(self, model: Model) -> bool {
        let (robots, bases, stations) = Self::counts(model);
        match self {
            Self::Robot(number) => 1 <= number && number <= robots,
            Self::Base(number) => 1 <= number && number <= bases,
            Self::Station(number) => 1 <= number && number <= stations,
        }
    }

    /// Maximum numbers of robots, bases and stations.
    pub const fn counts(model: Model) -> (u8, u8, u8) {
        match model {
            Model::Fs100 => (2, 2, 3),
            Model::Dx100 | Model::Dx200 | Model::Yrc1000 => (8, 8, 24),
        }
    }
}

impl fmt::Display for Group {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Robot(number) => write!(f, "R{number}"),
            Self::Base(number) => write!(f, "B{number}"),
            Self::Station(number) => write!(f, "S{number}"),
        }
    }
}

impl FromStr for Group {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("'{text}' is not a valid control group; use R1 to R8, B1 to B8 or S1 to S24");
        let mut chars = text.chars();
        let letter = chars.next().ok_or_else(wrong)?;
        let digits = chars.as_str();
        if digits.is_empty() || digits.len() > 2 || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
            return Err(wrong());
        }
        let number = digits.parse().map_err(|_| wrong())?;
        let group = match letter {
            'R' | 'r' => Self::Robot(number),
            'B' | 'b' => Self::Base(number),
            'S' | 's' => Self::Station(number),
            _ => return Err(wrong()),
        };
        if group.exists_on(Model::Dx200) { Ok(group) } else { Err(wrong()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn converts_groups_to_text_and_instances() {
        assert_eq!("r1".parse(), Ok(Group::R1));
        assert_eq!("S24".parse(), Ok(Group::Station(24)));
        for junk in ["", "R", "R0", "R9", "S25", "X1", "R+1", "R01x", "B999"] {
            assert!(junk.parse::<Group>().is_err(), "{junk}");
        }
        assert_eq!(Group::Station(3).instance(), 23);
        assert_eq!(Group::Base(2).cartesian_instance(), Some(112));
        assert!(!Group::Station(4).exists_on(Model::Fs100));
    }
}
