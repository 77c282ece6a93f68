//! Positions of robots, bases and external axes (FS and DX 3.3.6, 3.3.16 to 3.3.18).

use super::axes::{Axes, MAX_AXES};
use super::reader::{PayloadError, Reader, push_u32s};
use crate::units::{self, Unit};
use crate::yerc::table::{EXTENDED_FORM_BITS, FORM_BITS};

/// What the numbers of a position mean.
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
    /// A number that the manuals do not define.
    Other(u32),
}

impl PositionKind {
    /// Every defined kind with its number and name.
    pub const ALL: [(Self, u32, &'static str); 5] = [
        (Self::Pulse, 0, "pulse"),
        (Self::Base, 16, "base"),
        (Self::Robot, 17, "robot"),
        (Self::User, 18, "user"),
        (Self::Tool, 19, "tool"),
    ];

    /// Any word has a kind.
    pub fn from_word(word: u32) -> Self {
        Self::ALL.iter().find(|row| row.1 == word).map_or(Self::Other(word), |row| row.0)
    }

    /// The word on the wire.
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

    /// Whether the axes are X Y Z Rx Ry Rz.
    pub fn is_cartesian(self) -> bool {
        matches!(self, Self::Base | Self::Robot | Self::User | Self::Tool)
    }

    /// The unit of an axis of a robot position, counted from 0; raw numbers where none is defined.
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
            /// The word of every defined bit, set or clear.
            pub fn words(self) -> impl Iterator<Item = &'static str> {
                $bits.iter().map(move |bit| bit.word(self.0))
            }

            /// The bits that have no meaning.
            pub fn reserved(self) -> u32 {
                self.0 & !$bits.iter().fold(0, |mask, bit| mask | 1 << bit.bit)
            }
        }
    };
}

flag_word! {
    /// How the arm reaches a position; reserved bits are kept.
    Form, FORM_BITS
}
flag_word! {
    /// More of the same, for axes L U B E W.
    ExtendedForm, EXTENDED_FORM_BITS
}

/// A robot position: 13 words, or fewer where the controller leaves out axes it does not have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Position {
    /// What `axes` mean.
    pub kind: PositionKind,
    /// The arm's form.
    pub form: Form,
    /// Tool number, 0 to 63.
    pub tool: u32,
    /// User coordinate number; of use with [`PositionKind::User`].
    pub user: u32,
    /// The rest of the form.
    pub extended: ExtendedForm,
    /// Pulses; or 0.001 mm for the first three and 0.0001 degree for the next four.
    pub axes: Axes,
}

impl Position {
    /// Bytes of all 13 words.
    pub const SIZE: usize = 52;

    /// Reads five words and as many axes as there are.
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

    /// All 13 words, as variables are written.
    pub fn emit(&self) -> Vec<u8> {
        let full = Self { axes: Axes::full(self.axes.padded()), ..*self };
        full.emit_fitted()
    }

    /// The five words and only the axes there are, as controllers answer a position.
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
    /// Pulse or base.
    pub kind: PositionKind,
    /// Pulses, or 0.001 mm.
    pub axes: Axes,
}

/// An external axis position: type and eight axes (FS and DX 3.3.18).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ExternalPosition {
    /// Pulse.
    pub kind: PositionKind,
    /// Pulses.
    pub axes: Axes,
}

macro_rules! nine_words {
    ($name:ident, $what:literal) => {
        impl $name {
            /// Bytes of all 9 words.
            pub const SIZE: usize = 4 + 4 * MAX_AXES;

            /// Reads the type and as many axes as there are.
            pub fn parse(data: &[u8]) -> Result<Self, PayloadError> {
                let mut reader = Reader::new($what, data);
                Ok(Self { kind: PositionKind::from_word(reader.u32()?), axes: Axes::take(reader.rest()) })
            }

            /// All 9 words.
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
