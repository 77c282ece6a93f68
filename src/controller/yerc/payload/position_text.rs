//! Text format of positions, for example
//! `base:x=100.000,y=0.000,z=0.000,rx=180.0000,ry=0.0000,rz=0.0000,tool=1,user=0,form=back+upper+flip` and
//! `pulse:s=0,l=0,u=0,r=0,b=0,t=0`. The text needs no quotes in a shell.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use super::axes::{Axes, MAX_AXES};
use super::position::{BasePosition, ExtendedForm, ExternalPosition, Form, Position, PositionKind};
use crate::refuse_if;
use crate::units::{self, Unit, UnitError};
use crate::user_input::unsigned;
use crate::yerc::table::{Bit, EXTENDED_FORM_BITS, FORM_BITS};

const PULSE_AXES: [&str; MAX_AXES] = ["s", "l", "u", "r", "b", "t", "e", "8"];
const CARTESIAN_AXES: [&str; MAX_AXES] = ["x", "y", "z", "rx", "ry", "rz", "re", "8"];
const NUMBERED_AXES: [&str; MAX_AXES] = ["1", "2", "3", "4", "5", "6", "7", "8"];
/// Number of axes that the text of a robot position must have. Otherwise, a forgotten axis would become 0.
const REQUIRED_AXES: usize = 6;

/// An axis in the text format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NamedAxis {
    /// Name of the axis, for example `x` or `s`. A number for an axis without a letter.
    pub key: &'static str,
    /// Unit of `value`.
    pub unit: Unit,
    /// Protocol value.
    pub value: i32,
}

/// Why a position text is invalid.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum PositionTextError {
    /// The text does not begin with a kind and a colon.
    #[error("a position must begin with its type and a colon, for example 'base:x=...' or 'pulse:s=...'")]
    NoKind,
    /// The variable does not have this kind.
    #[error("'{found}' is not a valid position type here; use {allowed}")]
    Kind {
        /// The kind in the text.
        found: String,
        /// Valid kinds.
        allowed: String,
    },
    /// A part of the text is not `key=value`.
    #[error("'{0}' must be key=value")]
    Pair(String),
    /// The kind does not have this key.
    #[error("'{found}' is not a part of this position; use {allowed}")]
    Key {
        /// The key in the text.
        found: String,
        /// Valid keys.
        allowed: String,
    },
    /// A key occurs twice.
    #[error("'{0}' appears twice")]
    Twice(String),
    /// The text has no value for this axis.
    #[error("axis '{0}' is missing")]
    Missing(&'static str),
    /// The value of an axis is invalid.
    #[error("{key}: {error}")]
    Axis {
        /// The key.
        key: String,
        /// The problem.
        error: UnitError,
    },
    /// The value of tool, user coordinate or form is invalid.
    #[error("{key}: '{found}' is not {expected}")]
    Value {
        /// The key.
        key: &'static str,
        /// The invalid text.
        found: String,
        /// Valid values.
        expected: String,
    },
}

impl FromStr for Position {
    type Err = PositionTextError;

    fn from_str(text: &str) -> Result<Self, PositionTextError> {
        let (kind, rest) = split_kind(text, &PositionKind::ALL)?;
        let mut parts = Parts::new(axis_names(kind), &["tool", "user", "form", "ext"]);
        parts.read(rest, |axis| kind.unit(axis))?;
        let axes = parts.axes(REQUIRED_AXES)?;
        Ok(Self {
            kind,
            form: Form(flags("form", parts.other("form"), &FORM_BITS)?),
            tool: number("tool", parts.other("tool"))?,
            user: number("user", parts.other("user"))?,
            extended: ExtendedForm(flags("ext", parts.other("ext"), &EXTENDED_FORM_BITS)?),
            axes,
        })
    }
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (names, axes) = (axis_names(self.kind), self.axes.padded());
        let shown = self.shown_axes();
        write_kind(f, self.kind, &PositionKind::ALL)?;
        write_axes(f, &names, &axes[..shown], |axis| self.kind.unit(axis))?;
        write!(f, ",tool={},user={}", self.tool, self.user)?;
        if self.kind != PositionKind::Pulse || self.form.0 != 0 {
            write_flags(f, "form", self.form.0, &FORM_BITS, 3)?;
        }
        if self.extended.0 != 0 {
            write_flags(f, "ext", self.extended.0, &EXTENDED_FORM_BITS, 0)?;
        }
        Ok(())
    }
}

impl Position {
    /// All eight axes, with 0 for missing axes.
    pub fn named_axes(&self) -> [NamedAxis; MAX_AXES] {
        named(axis_names(self.kind), self.axes, |axis| self.kind.unit(axis))
    }

    /// Number of axes that the text shows: up to the last axis that is not 0, but at least six.
    pub fn shown_axes(&self) -> usize {
        shown_axes(&self.axes.padded(), REQUIRED_AXES)
    }
}

macro_rules! nine_word_text {
    ($name:ident, $kinds:expr, $units:expr) => {
        impl $name {
            /// All eight axes, with 0 for missing axes.
            pub fn named_axes(&self) -> [NamedAxis; MAX_AXES] {
                named(group_axis_names(self.kind), self.axes, |_| $units(self.kind))
            }

            /// Number of axes that the text shows: up to the last axis that is not 0. In base coordinates, at least x,
            /// y and z.
            pub fn shown_axes(&self) -> usize {
                shown_axes(&self.axes.padded(), if self.kind == PositionKind::Base { 3 } else { 1 })
            }
        }

        impl FromStr for $name {
            type Err = PositionTextError;

            fn from_str(text: &str) -> Result<Self, PositionTextError> {
                let (kind, rest) = split_kind(text, $kinds)?;
                let mut parts = Parts::new(group_axis_names(kind), &[]);
                parts.read(rest, |_| $units(kind))?;
                Ok(Self { kind, axes: parts.axes(1)? })
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                let (names, axes) = (group_axis_names(self.kind), self.axes.padded());
                let shown = self.shown_axes();
                write_kind(f, self.kind, $kinds)?;
                write_axes(f, &names, &axes[..shown], |_| $units(self.kind))
            }
        }
    };
}

nine_word_text!(BasePosition, &[PositionKind::ALL[0], PositionKind::ALL[1]], base_unit);
nine_word_text!(ExternalPosition, &[PositionKind::ALL[0]], pulse_unit);

fn base_unit(kind: PositionKind) -> Unit {
    if kind == PositionKind::Base { units::MILLIMETRE } else { units::PULSE }
}

const fn pulse_unit(_: PositionKind) -> Unit {
    units::PULSE
}

fn axis_names(kind: PositionKind) -> [&'static str; MAX_AXES] {
    match kind {
        PositionKind::Pulse => PULSE_AXES,
        PositionKind::Other(_) => NUMBERED_AXES,
        _ => CARTESIAN_AXES,
    }
}

/// Bases and external axes have no S, L, U letters. In base coordinates, a base has X, Y, Z.
fn group_axis_names(kind: PositionKind) -> [&'static str; MAX_AXES] {
    match kind {
        PositionKind::Base => ["x", "y", "z", "4", "5", "6", "7", "8"],
        _ => NUMBERED_AXES,
    }
}

/// Splits the kind from the rest of the text. A kind without a name is written with its number, for example `type7:`.
fn split_kind<'a>(
    text: &'a str,
    kinds: &[(PositionKind, u32, &str)],
) -> Result<(PositionKind, &'a str), PositionTextError> {
    let (name, rest) = text.split_once(':').ok_or(PositionTextError::NoKind)?;
    let name = name.trim();
    if let Some(row) = kinds.iter().find(|row| row.2.eq_ignore_ascii_case(name)) {
        return Ok((row.0, rest));
    }
    let number = name.strip_prefix("type").filter(|digits| digits.bytes().all(|byte| byte.is_ascii_digit()));
    match number.and_then(|digits| digits.parse().ok()).map(PositionKind::from_word) {
        Some(kind) if kinds.iter().all(|row| row.0 != kind) => Ok((kind, rest)),
        _ => Err(PositionTextError::Kind {
            found: name.to_owned(),
            allowed: kinds.iter().map(|row| row.2).collect::<Vec<_>>().join(", "),
        }),
    }
}

/// The `key=value` parts that were parsed so far.
struct Parts<'a> {
    names: [&'static str; MAX_AXES],
    axes: [Option<i32>; MAX_AXES],
    others: Vec<(&'static str, Option<&'a str>)>,
}

impl<'a> Parts<'a> {
    fn new(names: [&'static str; MAX_AXES], others: &[&'static str]) -> Self {
        Self { names, axes: [None; MAX_AXES], others: others.iter().map(|&key| (key, None)).collect() }
    }

    fn read(&mut self, text: &'a str, unit: impl Fn(usize) -> Unit) -> Result<(), PositionTextError> {
        for pair in text.split(',').map(str::trim) {
            let (key, value) = pair.split_once('=').ok_or_else(|| PositionTextError::Pair(pair.to_owned()))?;
            let (key, value) = (key.trim().to_ascii_lowercase(), value.trim());
            let by_number = key.parse::<usize>().ok().filter(|number| (1..=MAX_AXES).contains(number));
            let axis = self.names.iter().position(|name| *name == key).or(by_number.map(|number| number - 1));
            if let Some(axis) = axis {
                let parsed = unit(axis)
                    .parse_steps(value)
                    .map_err(|error| PositionTextError::Axis { key: key.clone(), error })?;
                refuse_if(self.axes[axis].replace(parsed).is_some(), PositionTextError::Twice(key))?;
            } else if let Some(slot) = self.others.iter_mut().find(|slot| slot.0 == key) {
                refuse_if(slot.1.replace(value).is_some(), PositionTextError::Twice(key))?;
            } else {
                let keys = self.names.into_iter().chain(self.others.iter().map(|slot| slot.0));
                let allowed = keys.collect::<Vec<_>>().join(", ");
                return Err(PositionTextError::Key { found: key, allowed });
            }
        }
        Ok(())
    }

    /// Values of all eight axes. The text must contain the first `required` axes, and no gap among the first six axes.
    fn axes(&self, required: usize) -> Result<Axes, PositionTextError> {
        let named = self.axes.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        let mut values = [0; MAX_AXES];
        for (axis, value) in self.axes.iter().enumerate() {
            match value {
                Some(value) => values[axis] = *value,
                // The axes after the sixth are optional and independent of each other.
                None if axis < required || axis < named.min(REQUIRED_AXES) => {
                    return Err(PositionTextError::Missing(self.names[axis]));
                }
                None => {}
            }
        }
        Ok(Axes::full(values))
    }

    fn other(&self, key: &str) -> Option<&'a str> {
        self.others.iter().find(|slot| slot.0 == key).and_then(|slot| slot.1)
    }
}

fn number(key: &'static str, text: Option<&str>) -> Result<u32, PositionTextError> {
    let Some(text) = text else { return Ok(0) };
    unsigned(text).ok_or_else(|| PositionTextError::Value {
        key,
        found: text.to_owned(),
        expected: "a whole number".to_owned(),
    })
}

/// Parses words joined by `+`. Bits without a name are written as one hexadecimal number.
fn flags(key: &'static str, text: Option<&str>, bits: &[Bit]) -> Result<u32, PositionTextError> {
    let (mut value, mut given) = (0_u32, 0_u32);
    for word in text.into_iter().flat_map(|text| text.split('+')).map(str::trim) {
        let wrong = || PositionTextError::Value {
            key,
            found: word.to_owned(),
            expected: bits.iter().map(|bit| format!("{}|{}", bit.clear, bit.set)).collect::<Vec<_>>().join(" + "),
        };
        let (mask, set) = if let Some(digits) = word.strip_prefix("0x") {
            let mask = u32::from_str_radix(digits, 16).map_err(|_| wrong())?;
            (mask, mask)
        } else {
            let bit = bits
                .iter()
                .find(|bit| bit.set.eq_ignore_ascii_case(word) || bit.clear.eq_ignore_ascii_case(word))
                .ok_or_else(wrong)?;
            let mask = 1 << bit.bit;
            (mask, if bit.set.eq_ignore_ascii_case(word) { mask } else { 0 })
        };
        if given & mask != 0 {
            return Err(PositionTextError::Twice(word.to_owned()));
        }
        given |= mask;
        value |= set;
    }
    Ok(value)
}

fn named(keys: [&'static str; MAX_AXES], axes: Axes, unit: impl Fn(usize) -> Unit) -> [NamedAxis; MAX_AXES] {
    let values = axes.padded();
    std::array::from_fn(|axis| NamedAxis { key: keys[axis], unit: unit(axis), value: values[axis] })
}

/// Number of axes to show: up to the last axis that is not 0, but at least `least`.
fn shown_axes(axes: &[i32; MAX_AXES], least: usize) -> usize {
    axes.iter().rposition(|&value| value != 0).map_or(0, |last| last + 1).max(least)
}

fn write_kind(f: &mut fmt::Formatter<'_>, kind: PositionKind, kinds: &[(PositionKind, u32, &str)]) -> fmt::Result {
    match kinds.iter().find(|row| row.0 == kind) {
        Some(row) => write!(f, "{}:", row.2),
        None => write!(f, "type{}:", kind.word()),
    }
}

fn write_axes(
    f: &mut fmt::Formatter<'_>,
    names: &[&str; MAX_AXES],
    axes: &[i32],
    unit: impl Fn(usize) -> Unit,
) -> fmt::Result {
    for (axis, (name, value)) in names.iter().zip(axes).enumerate() {
        let comma = if axis == 0 { "" } else { "," };
        write!(f, "{comma}{name}={}", unit(axis).show(*value))?;
    }
    Ok(())
}

/// Formats a word of flags. The first `always` bits appear in both states, and the other bits only if they are set.
fn write_flags(f: &mut fmt::Formatter<'_>, key: &str, value: u32, bits: &[Bit], always: usize) -> fmt::Result {
    let known = bits.iter().fold(0, |mask, bit| mask | 1 << bit.bit);
    let mut words: Vec<String> = bits
        .iter()
        .enumerate()
        .filter(|(index, bit)| *index < always || value >> bit.bit & 1 == 1)
        .map(|(_, bit)| bit.word(value).to_owned())
        .collect();
    if value & !known != 0 {
        words.push(format!("{:#x}", value & !known));
    }
    write!(f, ",{key}={}", words.join("+"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base_positions_round_trip() {
        let text =
            "base:x=100.000,y=-0.001,z=0.000,rx=180.0000,ry=0.0000,rz=-90.0000,tool=1,user=0,form=back+upper+flip";
        let position: Position = text.parse().unwrap();
        assert_eq!(position.axes.padded(), [100_000, -1, 0, 1_800_000, 0, -900_000, 0, 0]);
        assert_eq!((position.form, position.tool), (Form(1), 1));
        assert_eq!(position.to_string(), text);
    }

    #[test]
    fn parses_pulses_by_letter_or_number() {
        let position: Position = "pulse:s=1,l=2,3=3,r=4,b=5,t=6".parse().unwrap();
        assert_eq!(position.axes.padded(), [1, 2, 3, 4, 5, 6, 0, 0]);
        assert_eq!(position.to_string(), "pulse:s=1,l=2,u=3,r=4,b=5,t=6,tool=0,user=0");
        let hexadecimal: Position = "pulse:s=0x1,l=2,u=3,r=4,b=5,t=-0x6,tool=0x10".parse().unwrap();
        assert_eq!((hexadecimal.axes.padded()[5], hexadecimal.tool), (-6, 16));
    }

    #[test]
    fn rejects_ambiguous_positions() {
        let error = |text: &str| text.parse::<Position>().unwrap_err();
        assert_eq!(error("base:x=1,y=2"), PositionTextError::Missing("z"));
        assert_eq!(error("x=1"), PositionTextError::NoKind);
        assert!(matches!(error("best:x=1"), PositionTextError::Kind { .. }));
        assert!(matches!(error("pulse:s=1,s=2"), PositionTextError::Twice(_)));
        assert!(matches!(error("pulse:s=1,1=2"), PositionTextError::Twice(_)));
        assert!(matches!(error("pulse:s=1.5"), PositionTextError::Axis { .. }));
        assert!(matches!(error("pulse:x=1"), PositionTextError::Key { .. }));
        assert!(matches!(error("pulse:s"), PositionTextError::Pair(_)));
        let full = "base:x=1,y=1,z=1,rx=1,ry=1,rz=1";
        assert!(matches!(error(&format!("{full},form=back+front")), PositionTextError::Twice(_)));
        assert!(matches!(error(&format!("{full},form=up")), PositionTextError::Value { key: "form", .. }));
        assert!(matches!(error(&format!("{full},tool=-1")), PositionTextError::Value { key: "tool", .. }));
    }

    #[test]
    fn parses_bases_and_external_axes() {
        let base: BasePosition = "base:x=1.500,y=-2.500,z=3.500".parse().unwrap();
        assert_eq!(base.axes.padded(), [1500, -2500, 3500, 0, 0, 0, 0, 0]);
        assert_eq!(base.to_string(), "base:x=1.500,y=-2.500,z=3.500");
        let external: ExternalPosition = "pulse:1=100,2=200".parse().unwrap();
        assert_eq!(external.to_string(), "pulse:1=100,2=200");
        assert!("base:x=1".parse::<ExternalPosition>().is_err());
    }
}
