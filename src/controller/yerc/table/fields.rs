//! Fields of the data of each command.

use super::bits::{Bit, DATA_1_BITS, DATA_2_BITS, EXTENDED_FORM_BITS, FORM_BITS};
use crate::units::{self, Unit};

/// Content and size of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Unsigned byte.
    U8,
    /// Eight signals, lowest bit first.
    Signals,
    /// Unsigned 16 bits.
    U16,
    /// Signed 16 bits.
    I16,
    /// Unsigned 32 bits.
    U32,
    /// Signed 32 bits.
    I32,
    /// IEEE 754 single.
    F32,
    /// Text of this size in the encoding of the pendant, padded with NUL.
    Text(usize),
    /// 32 bits, of which some have names.
    Bits(&'static [Bit]),
    /// 32 bits that must have one of these values. Each value has a name.
    Choice(&'static [(u32, &'static str)]),
    /// A 32-bit number in this unit.
    Scaled(Unit),
    /// An axis of a robot position, counted from 0. The data type of the position determines the unit.
    Axis(usize),
    /// An axis of a base position. The data type of the position determines the unit.
    BaseAxis,
    /// A 32-bit speed, in the unit of the speed class.
    Speed,
    /// 32 reserved bits, always 0.
    Reserved,
    /// The name of a file, 1 to 479 bytes.
    FileName,
    /// A filter of file names, 0 to 479 bytes.
    Filter,
}

/// A named field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// Readable name.
    pub name: &'static str,
    /// Content.
    pub kind: Kind,
}

impl Field {
    /// Size in bytes; 0 for a variable size.
    pub const fn size(&self) -> usize {
        match self.kind {
            Kind::U8 | Kind::Signals => 1,
            Kind::U16 | Kind::I16 => 2,
            Kind::Text(size) => size,
            Kind::FileName | Kind::Filter => 0,
            _ => 4,
        }
    }
}

const fn f(name: &'static str, kind: Kind) -> Field {
    Field { name, kind }
}

/// Numbered fields of the same kind.
macro_rules! numbered {
    ($name:literal, $axis:pat => $kind:expr; $($number:literal)+) => {
        [$(f(concat!($name, " ", $number), {
            let $axis = $number;
            $kind
        })),+]
    };
}

/// Joins lists of fields into one array of `N` fields.
const fn join<const N: usize>(parts: &[&[Field]]) -> [Field; N] {
    let mut out = [f("", Kind::Reserved); N];
    let (mut part, mut from) = (0, 0);
    while part < parts.len() {
        let fields = parts[part];
        let mut i = 0;
        while i < fields.len() {
            out[from + i] = fields[i];
            i += 1;
        }
        from += fields.len();
        part += 1;
    }
    assert!(from == N, "as many fields as are announced");
    out
}

/// Pulses of eight axes.
const PULSES: [Field; 8] = numbered!("axis", _ => Kind::Scaled(units::PULSE); 1 2 3 4 5 6 7 8);

/// Formats of alarm sub-codes (FS and DX 3.3.1). Types 7, 13 to 19 and 26 are not defined.
pub const ALARM_KINDS: &[(u32, &str)] = &[
    (0, "no sub-code"),
    (1, "unsigned decimal, 16 bits"),
    (2, "bit pattern, 8 bits"),
    (3, "user axes (SLURBT)"),
    (4, "spatial axes (XYZ)"),
    (5, "robot coordinate axes (XYZRxRyRz)"),
    (6, "conveyor characteristic file"),
    (8, "control groups: robots and stations"),
    (9, "signed decimal, 16 bits"),
    (10, "bit pattern, 16 bits"),
    (11, "control group: robots"),
    (12, "control groups: robots, stations, bases"),
    (20, "group with low and high logical axes"),
    (21, "group with min and max logical axes"),
    (22, "group with min and max spatial axes"),
    (23, "logical axes of two groups"),
    (24, "two sets of logical axes of a group"),
    (25, "logical axes of a group and a number"),
    (27, "group and a number"),
];

const POSITION_KINDS: &[(u32, &str)] = &[
    (0, "pulse"),
    (16, "base coordinates"),
    (17, "robot coordinates"),
    (18, "user coordinates"),
    (19, "tool coordinates"),
];
const BASE_KINDS: &[(u32, &str)] = &[(0, "pulse"), (16, "base coordinates")];
const PULSE_KIND: &[(u32, &str)] = &[(0, "pulse")];
const EXECUTE: &[(u32, &str)] = &[(1, "execute")];
const SWITCH: &[(u32, &str)] = &[(1, "on"), (2, "off")];
const CYCLE: &[(u32, &str)] = &[(1, "step"), (2, "one cycle"), (3, "continuous")];
const SPEED_CLASS: &[(u32, &str)] =
    &[(0, "percent (link)"), (1, "V, translation (straight)"), (2, "VR, rotation (straight)")];
const COORDINATE: &[(u32, &str)] =
    &[(16, "base coordinates"), (17, "robot coordinates"), (18, "user coordinates"), (19, "tool coordinates")];

pub(super) const ALARM: &[Field] = &[
    f("alarm code", Kind::U32),
    f("alarm data (sub-code)", Kind::U32),
    f("alarm type", Kind::Choice(ALARM_KINDS)),
    f("time of occurrence", Kind::Text(16)),
    f("alarm name", Kind::Text(32)),
];
pub(super) const ALARM_WITH_TEXTS: &[Field] = &join::<8>(&[
    ALARM,
    &[
        f("sub-code source", Kind::Text(16)),
        f("sub-code text", Kind::Text(96)),
        f("sub-code reverse-video map", Kind::Text(96)),
    ],
]);
pub(super) const STATUS: &[Field] = &[f("data 1", Kind::Bits(&DATA_1_BITS)), f("data 2", Kind::Bits(&DATA_2_BITS))];
pub(super) const JOB: &[Field] = &[
    f("job name", Kind::Text(32)),
    f("line number", Kind::U32),
    f("step number", Kind::U32),
    f("speed override", Kind::Scaled(units::PERCENT)),
];
pub(super) const AXIS_NAMES: &[Field] = &numbered!("axis name", _ => Kind::Text(4); 1 2 3 4 5 6 7 8);
pub(super) const POSITION: &[Field] = &join::<13>(&[
    &[
        f("data type", Kind::Choice(POSITION_KINDS)),
        f("form", Kind::Bits(&FORM_BITS)),
        f("tool number", Kind::U32),
        f("user coordinate number", Kind::U32),
        f("extended form", Kind::Bits(&EXTENDED_FORM_BITS)),
    ],
    &numbered!("axis", axis => Kind::Axis(axis - 1); 1 2 3 4 5 6 7 8),
]);
pub(super) const BASE_POSITION: &[Field] = &join::<9>(&[
    &[f("data type", Kind::Choice(BASE_KINDS))],
    &numbered!("axis", _ => Kind::BaseAxis; 1 2 3 4 5 6 7 8),
]);
pub(super) const EXTERNAL_POSITION: &[Field] = &join::<9>(&[&[f("data type", Kind::Choice(PULSE_KIND))], &PULSES]);
pub(super) const POSITION_ERROR: &[Field] = &PULSES;
/// The manuals do not specify the unit of torque.
pub(super) const TORQUE: &[Field] = &numbered!("axis", _ => Kind::I32; 1 2 3 4 5 6 7 8);
pub(super) const IO: &[Field] = &[f("signals", Kind::Signals)];
pub(super) const REGISTER: &[Field] = &[f("register", Kind::U16)];
pub(super) const B: &[Field] = &[f("value", Kind::U8)];
pub(super) const I: &[Field] = &[f("value", Kind::I16)];
pub(super) const D: &[Field] = &[f("value", Kind::I32)];
pub(super) const R: &[Field] = &[f("value", Kind::F32)];
pub(super) const S16: &[Field] = &[f("value", Kind::Text(16))];
pub(super) const S32: &[Field] = &[f("value", Kind::Text(32))];
pub(super) const RUN: &[Field] = &[f("execute", Kind::Choice(EXECUTE))];
pub(super) const ON_OFF: &[Field] = &[f("switch", Kind::Choice(SWITCH))];
pub(super) const CYCLE_MODE: &[Field] = &[f("cycle mode", Kind::Choice(CYCLE))];
pub(super) const MESSAGE: &[Field] = &[f("message", Kind::Text(32))];
pub(super) const SELECTION: &[Field] = &[f("job name", Kind::Text(32)), f("line number", Kind::U32)];
pub(super) const TIMES: &[Field] = &[f("start", Kind::Text(16)), f("elapsed time", Kind::Text(12))];
pub(super) const SYSTEM: &[Field] = &[
    f("system software version", Kind::Text(24)),
    f("model or application name", Kind::Text(16)),
    f("parameter version", Kind::Text(8)),
];
pub(super) const FILE_NAME: &[Field] = &[f("file name", Kind::FileName)];
pub(super) const FILE_FILTER: &[Field] = &[f("filter", Kind::Filter)];

const SPEED: [Field; 4] = [
    f("control group (robot)", Kind::U32),
    f("control group (station)", Kind::U32),
    f("speed class", Kind::Choice(SPEED_CLASS)),
    f("speed", Kind::Speed),
];
const TARGET: [Field; 7] = [
    f("coordinate", Kind::Choice(COORDINATE)),
    f("X", Kind::Scaled(units::MILLIMETRE)),
    f("Y", Kind::Scaled(units::MILLIMETRE)),
    f("Z", Kind::Scaled(units::MILLIMETRE)),
    f("Tx", Kind::Scaled(units::DEGREE)),
    f("Ty", Kind::Scaled(units::DEGREE)),
    f("Tz", Kind::Scaled(units::DEGREE)),
];
const FORM: [Field; 4] = [
    f("form", Kind::Bits(&FORM_BITS)),
    f("extended form", Kind::Bits(&EXTENDED_FORM_BITS)),
    f("tool number", Kind::U32),
    f("user coordinate number", Kind::U32),
];
const BASE_MM: [Field; 3] = numbered!("base axis", _ => Kind::Scaled(units::MILLIMETRE); 1 2 3);
const BASE_PULSES: [Field; 3] = numbered!("base axis", _ => Kind::Scaled(units::PULSE); 1 2 3);
const STATION: [Field; 6] = numbered!("station axis", _ => Kind::Scaled(units::PULSE); 1 2 3 4 5 6);
const RESERVED: Field = f("reserved", Kind::Reserved);

/// Layout with 26 words: two words are reserved (DX 3.3.39).
pub(super) const MOVE_26: &[Field] = &join::<26>(&[&SPEED, &TARGET, &[RESERVED, RESERVED], &FORM, &BASE_MM, &STATION]);
/// Layout with 25 words: one word is reserved (FS 3.3.39).
pub(super) const MOVE_25: &[Field] = &join::<25>(&[&SPEED, &TARGET, &[RESERVED], &FORM, &BASE_MM, &STATION]);
pub(super) const PULSE_MOVE: &[Field] = &join::<22>(&[
    &SPEED,
    &numbered!("robot axis", _ => Kind::Scaled(units::PULSE); 1 2 3 4 5 6 7 8),
    &[f("tool number", Kind::U32)],
    &BASE_PULSES,
    &STATION,
]);
