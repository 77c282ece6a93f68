//! Positions of robots, bases and external axes (FS and DX 3.3.6, 3.3.16 to 3.3.18).

use super::axes::{Axes, MAX_AXES};
use super::reader::{PayloadError, Reader, push_u32s};
use crate::units::{self, Degrees, Millimetres, Pulses, Unit};
use crate::yerc::table::{EXTENDED_FORM_BITS, FORM_BITS};

/// Coordinate system of a position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PositionKind {
    /// Encoder pulses by axis.
    Pulse,
    /// Base coordinates.
    Base,
    /// Robot coordinates.
    Robot,
    /// User coordinates.
    User,
    /// Tool coordinates.
    Tool,
    /// A number that is not in the manuals.
    Other(u32),
}

impl PositionKind {
    /// All defined kinds with number and name.
    pub const ALL: [(Self, u32, &'static str); 5] = [
        (Self::Pulse, 0, "pulse"),
        (Self::Base, 16, "base"),
        (Self::Robot, 17, "robot"),
        (Self::User, 18, "user"),
        (Self::Tool, 19, "tool"),
    ];

    /// The kind for a protocol word.
    pub fn from_word(word: u32) -> Self {
        Self::ALL.iter().find(|row| row.1 == word).map_or(Self::Other(word), |row| row.0)
    }

    /// Protocol word of the kind.
    pub fn word(self) -> u32 {
        match self {
            Self::Pulse => 0,
            Self::Base => 16,
            Self::Robot => 17,
            Self::User => 18,
            Self::Tool => 19,
            Self::Other(word) => word,
        }
    }

    /// Whether the axes are the cartesian coordinates X, Y, Z, Rx, Ry and Rz.
    pub fn is_cartesian(self) -> bool {
        matches!(self, Self::Base | Self::Robot | Self::User | Self::Tool)
    }

    /// Unit of an axis of a robot position, counted from 0. If the kind is undefined, the unit is a raw number.
    pub fn unit(self, axis: usize) -> Unit {
        match axis {
            0..=2 if self.is_cartesian() => units::MILLIMETRE,
            3..=6 if self.is_cartesian() => units::DEGREE,
            _ => units::PULSE,
        }
    }
}

macro_rules! flag_word {
    ($(#[$doc:meta])* $name:ident, $bits:ident) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
        pub struct $name(pub u32);

        impl $name {
            /// Names of the current states of all defined bits.
            pub fn words(self) -> impl Iterator<Item = &'static str> {
                $bits.iter().map(move |bit| bit.word(self.0))
            }

            /// Bits that have no defined meaning.
            pub fn reserved(self) -> u32 {
                self.0 & !$bits.iter().fold(0, |mask, bit| mask | 1 << bit.bit)
            }
        }
    };
}

flag_word! {
    /// Form of the arm at a position. Reserved bits are kept.
    Form, FORM_BITS
}
flag_word! {
    /// Extended form, for the axes L, U, B, E and W.
    ExtendedForm, EXTENDED_FORM_BITS
}

/// Position and rotation of a tool.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Pose {
    /// X.
    pub x: Millimetres,
    /// Y.
    pub y: Millimetres,
    /// Z.
    pub z: Millimetres,
    /// Rotation Tx, which the pendant shows as Rx.
    pub tx: Degrees,
    /// Rotation Ty.
    pub ty: Degrees,
    /// Rotation Tz.
    pub tz: Degrees,
}

impl Pose {
    /// Protocol words: X, Y, Z, Tx, Ty, Tz.
    pub(super) fn steps(self) -> [i32; 6] {
        let ([x, y, z], [tx, ty, tz]) = ([self.x, self.y, self.z], [self.tx, self.ty, self.tz]);
        let [x, y, z] = [x, y, z].map(Millimetres::steps);
        let [tx, ty, tz] = [tx, ty, tz].map(Degrees::steps);
        [x, y, z, tx, ty, tz]
    }
}

/// A robot position: 13 words, or fewer words if the controller omits missing axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Position {
    /// Coordinate system of `axes`.
    pub kind: PositionKind,
    /// Form of the arm.
    pub form: Form,
    /// Tool number, 0 to 63.
    pub tool: u32,
    /// User coordinate number. Used only with [`PositionKind::User`].
    pub user: u32,
    /// Extended form.
    pub extended: ExtendedForm,
    /// Values of the axes: pulses, or 0.001 mm for the first three axes and 0.0001 degree for the next four.
    pub axes: Axes,
}

impl Position {
    /// Size of all 13 words in bytes.
    pub const SIZE: usize = 52;

    /// Pulses of the existing axes; `None` for a position in coordinates.
    pub fn pulses(&self) -> Option<Vec<Pulses>> {
        let axes = self.axes.as_slice().iter().copied().map(Pulses::from_steps);
        (self.kind == PositionKind::Pulse).then(|| axes.collect())
    }

    /// Position and rotation; `None` for a position in pulses, or with fewer than six axes.
    pub fn pose(&self) -> Option<Pose> {
        let [x, y, z, tx, ty, tz] = *self.axes.as_slice().first_chunk()?;
        let [x, y, z] = [x, y, z].map(Millimetres::from_steps);
        let [tx, ty, tz] = [tx, ty, tz].map(Degrees::from_steps);
        self.kind.is_cartesian().then_some(Pose { x, y, z, tx, ty, tz })
    }

    /// Parses five words and all following axes.
    pub fn parse(data: &[u8]) -> Result<Self, PayloadError> {
        let mut reader = Reader::new("position", data);
        Ok(Self {
            kind: PositionKind::from_word(reader.u32()?),
            form: Form(reader.u32()?),
            tool: reader.u32()?,
            user: reader.u32()?,
            extended: ExtendedForm(reader.u32()?),
            axes: Axes::take(reader.rest()),
        })
    }

    /// Encodes all 13 words, because a variable always has all words.
    pub fn emit(&self) -> Vec<u8> {
        let full = Self { axes: Axes::full(self.axes.padded()), ..*self };
        full.emit_fitted()
    }

    /// Encodes five words and the words of the existing axes. A controller answers in this form.
    pub fn emit_fitted(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(Self::SIZE);
        push_u32s(&mut out, [self.kind.word(), self.form.0, self.tool, self.user, self.extended.0]);
        out.extend_from_slice(&self.axes.emit());
        out
    }
}

/// A base position: type and eight axes (FS and DX 3.3.17).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct BasePosition {
    /// Coordinate system of `axes`: pulse or base.
    pub kind: PositionKind,
    /// Values of the axes: pulses, or 0.001 mm.
    pub axes: Axes,
}

/// An external axis position: type and eight axes (FS and DX 3.3.18).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ExternalPosition {
    /// Coordinate system of `axes`, which is always pulse.
    pub kind: PositionKind,
    /// Values of the axes in pulses.
    pub axes: Axes,
}

macro_rules! nine_words {
    ($name:ident, $what:literal) => {
        impl $name {
            /// Size of all 9 words in bytes.
            pub const SIZE: usize = 4 + 4 * MAX_AXES;

            /// Parses the type and all following axes.
            pub fn parse(data: &[u8]) -> Result<Self, PayloadError> {
                let mut reader = Reader::new($what, data);
                Ok(Self { kind: PositionKind::from_word(reader.u32()?), axes: Axes::take(reader.rest()) })
            }

            /// Encodes all 9 words.
            pub fn emit(&self) -> Vec<u8> {
                let mut out = Vec::with_capacity(Self::SIZE);
                push_u32s(&mut out, [self.kind.word()]);
                out.extend_from_slice(&Axes::full(self.axes.padded()).emit());
                out
            }
        }
    };
}

nine_words!(BasePosition, "base position");
nine_words!(ExternalPosition, "external axis position");
