//! Data of move instructions (FS and DX 3.3.39, 3.3.40).

use super::position::{ExtendedForm, Form, Pose, PositionKind};
use super::reader::{PayloadError, Reader, push_u32s, push_words};
use crate::units::{DegreesPerSecond, MillimetresPerSecond, Percent, Pulses};

/// Unit of the speed word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SpeedClass {
    /// 0.01 % of the maximum speed, for link moves.
    Percent,
    /// 0.1 mm/s, for straight moves.
    Linear,
    /// 0.1 degree/s, for straight moves whose speed is a rotation.
    Angular,
    /// A number that is not in the manuals.
    Other(u32),
}

impl SpeedClass {
    /// The speed class for a protocol word.
    pub const fn from_word(word: u32) -> Self {
        match word {
            0 => Self::Percent,
            1 => Self::Linear,
            2 => Self::Angular,
            other => Self::Other(other),
        }
    }

    /// Protocol word of the class.
    pub const fn word(self) -> u32 {
        match self {
            Self::Percent => 0,
            Self::Linear => 1,
            Self::Angular => 2,
            Self::Other(word) => word,
        }
    }
}

/// Speed of a move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Speed {
    /// Share of the maximum speed, for link moves.
    Percent(Percent),
    /// For straight moves.
    Linear(MillimetresPerSecond),
    /// For straight moves whose speed is a rotation.
    Angular(DegreesPerSecond),
}

impl Speed {
    /// Class and speed word. A negative speed becomes 0, which no move accepts.
    fn words(self) -> (SpeedClass, u32) {
        let (class, steps) = match self {
            Self::Percent(speed) => (SpeedClass::Percent, speed.steps()),
            Self::Linear(speed) => (SpeedClass::Linear, speed.steps()),
            Self::Angular(speed) => (SpeedClass::Angular, speed.steps()),
        };
        (class, u32::try_from(steps).unwrap_or_default())
    }
}

/// Layout of a cartesian move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum MoveLayout {
    /// 26 words, two of them reserved, as in the DX200 manual. FS100 controllers are known to use this layout too.
    #[default]
    Words26,
    /// 25 words, one of them reserved, as in the FS100 manual.
    Words25,
}

impl MoveLayout {
    /// Size in bytes.
    pub const fn size(self) -> usize {
        match self {
            Self::Words26 => 104,
            Self::Words25 => 100,
        }
    }
}

/// A move to cartesian coordinates, in protocol units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct CartesianMove {
    /// Layout: 25 or 26 words.
    pub layout: MoveLayout,
    /// Robot number from 1; 0 if a station moves.
    pub robot: u32,
    /// Station number from 1; 0 if a robot moves.
    pub station: u32,
    /// Unit of `speed`.
    pub class: SpeedClass,
    /// Speed in 0.01 %, 0.1 mm/s or 0.1 degree/s, depending on `class`.
    pub speed: u32,
    /// Coordinate system: base, robot, user or tool.
    pub coordinate: PositionKind,
    /// Target: X, Y, Z in 0.001 mm, then Tx, Ty, Tz in 0.0001 degree.
    pub target: [i32; 6],
    /// Reserved words, which are 0. The 25-word layout has only the first of them.
    pub reserved: [i32; 2],
    /// Form of the arm.
    pub form: Form,
    /// Extended form.
    pub extended: ExtendedForm,
    /// Tool number, 0 to 63.
    pub tool: u32,
    /// User coordinate number: 1 to 63 with user coordinates, 0 otherwise.
    pub user: u32,
    /// Base axes in 0.001 mm.
    pub base: [i32; 3],
    /// Station axes in pulses.
    pub station_axes: [i32; 6],
}

impl CartesianMove {
    /// A move of a robot, numbered from 1, with tool 0, user coordinate 0, form 0, and without base and station axes.
    /// Change the other fields as needed: `CartesianMove { tool: 2, ..CartesianMove::of_robot(..) }`.
    pub fn of_robot(robot: u32, coordinate: PositionKind, target: Pose, speed: Speed) -> Self {
        let (class, speed) = speed.words();
        Self {
            layout: MoveLayout::default(),
            robot,
            station: 0,
            class,
            speed,
            coordinate,
            target: target.steps(),
            reserved: [0; 2],
            form: Form(0),
            extended: ExtendedForm(0),
            tool: 0,
            user: 0,
            base: [0; 3],
            station_axes: [0; 6],
        }
    }

    /// Parses either layout. The size of the data distinguishes the layouts.
    pub fn parse(data: &[u8]) -> Result<Self, PayloadError> {
        let layout = if data.len() < MoveLayout::Words26.size() { MoveLayout::Words25 } else { MoveLayout::Words26 };
        let mut reader = Reader::new("cartesian move", data);
        Ok(Self {
            layout,
            robot: reader.u32()?,
            station: reader.u32()?,
            class: SpeedClass::from_word(reader.u32()?),
            speed: reader.u32()?,
            coordinate: PositionKind::from_word(reader.u32()?),
            target: reader.words()?,
            reserved: match layout {
                MoveLayout::Words26 => reader.words()?,
                MoveLayout::Words25 => [reader.i32()?, 0],
            },
            form: Form(reader.u32()?),
            extended: ExtendedForm(reader.u32()?),
            tool: reader.u32()?,
            user: reader.u32()?,
            base: reader.words()?,
            station_axes: reader.words()?,
        })
    }

    /// Encodes the data in 100 or 104 bytes, depending on the layout.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(self.layout.size());
        push_u32s(&mut out, [self.robot, self.station, self.class.word(), self.speed, self.coordinate.word()]);
        push_words(&mut out, self.target);
        let reserved = match self.layout {
            MoveLayout::Words26 => &self.reserved[..],
            MoveLayout::Words25 => &self.reserved[..1],
        };
        push_words(&mut out, reserved.iter().copied());
        push_u32s(&mut out, [self.form.0, self.extended.0, self.tool, self.user]);
        push_words(&mut out, self.base);
        push_words(&mut out, self.station_axes);
        out
    }
}

/// A move to a position in pulses, in protocol units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PulseMove {
    /// Robot number from 1; 0 if a station moves.
    pub robot: u32,
    /// Station number from 1; 0 if a robot moves.
    pub station: u32,
    /// Unit of `speed`.
    pub class: SpeedClass,
    /// Speed in 0.01 %, 0.1 mm/s or 0.1 degree/s, depending on `class`.
    pub speed: u32,
    /// Robot axes in pulses.
    pub axes: [i32; 8],
    /// Tool number, 0 to 63.
    pub tool: u32,
    /// Base axes in pulses.
    pub base: [i32; 3],
    /// Station axes in pulses.
    pub station_axes: [i32; 6],
}

impl PulseMove {
    /// Size in bytes: 22 words.
    pub const SIZE: usize = 88;

    /// A move of a robot, numbered from 1, with tool 0 and without base and station axes. Change the other fields as
    /// needed: `PulseMove { tool: 2, ..PulseMove::of_robot(..) }`.
    pub fn of_robot(robot: u32, axes: [Pulses; 8], speed: Speed) -> Self {
        let (class, speed) = speed.words();
        let axes = axes.map(Pulses::steps);
        Self { robot, station: 0, class, speed, axes, tool: 0, base: [0; 3], station_axes: [0; 6] }
    }

    /// Parses the data, which must have at least 88 bytes.
    pub fn parse(data: &[u8]) -> Result<Self, PayloadError> {
        let mut reader = Reader::new("pulse move", data);
        Ok(Self {
            robot: reader.u32()?,
            station: reader.u32()?,
            class: SpeedClass::from_word(reader.u32()?),
            speed: reader.u32()?,
            axes: reader.words()?,
            tool: reader.u32()?,
            base: reader.words()?,
            station_axes: reader.words()?,
        })
    }

    /// Encodes the data in 88 bytes.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(Self::SIZE);
        push_u32s(&mut out, [self.robot, self.station, self.class.word(), self.speed]);
        push_words(&mut out, self.axes);
        push_u32s(&mut out, [self.tool]);
        push_words(&mut out, self.base);
        push_words(&mut out, self.station_axes);
        out
    }
}
