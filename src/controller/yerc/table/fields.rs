//! The data of each command, field by field.

use crate::units::{self, Unit};
use crate::yerc::payload::{DATA_1_BITS, DATA_2_BITS, EXTENDED_FORM_BITS, FORM_BITS};

/// A bit and its words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bit {
    /// Counted from the least significant.
    pub bit: u8,
    /// When 0; empty when nothing is to be said.
    pub clear: &'static str,
    /// When 1.
    pub set: &'static str,
}

impl Bit {
    /// The word for its state in `value`.
    pub const fn word(&self, value: u32) -> &'static str {
        if value >> self.bit & 1 == 1 { self.set } else { self.clear }
    }
}

/// What a field holds; fixes its size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Unsigned byte.
    U8,
    /// A byte of eight signals, lowest first.
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
    /// Text of so many bytes in the pendant's language, zero filled.
    Text(usize),
    /// 32 bits with meanings.
    Bits(&'static [Bit]),
    /// 32 bits, one of these.
    Choice(&'static [(u32, &'static str)]),
    /// 32 bits in a unit.
    Scaled(Unit),
    /// An axis of a robot position, counted from 0; its unit follows from the data type.
    Axis(usize),
    /// An axis of a base position; its unit follows from the data type.
    BaseAxis,
    /// 32 bits in the unit of the speed class.
    Speed,
    /// 32 bits, 0.
    Reserved,
    /// The name of a file, 1 to 479 bytes.
    FileName,
    /// A pattern of file names, 0 to 479 bytes.
    Filter,
}

/// A named piece of data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// In words.
    pub name: &'static str,
    /// What it holds.
    pub kind: Kind,
}

impl Field {
    /// Bytes; 0 for those whose size is free.
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

/// How to read the sub-code of an alarm (FS and DX 3.3.1); 7, 13 to 19 and 26 are not defined.
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
pub(super) const ALARM_WITH_TEXTS: &[Field] = &[
    f("alarm code", Kind::U32),
    f("alarm data (sub-code)", Kind::U32),
    f("alarm type", Kind::Choice(ALARM_KINDS)),
    f("time of occurrence", Kind::Text(16)),
    f("alarm name", Kind::Text(32)),
    f("sub-code source", Kind::Text(16)),
    f("sub-code text", Kind::Text(96)),
    f("sub-code reverse-video map", Kind::Text(96)),
];
pub(super) const STATUS: &[Field] = &[f("data 1", Kind::Bits(&DATA_1_BITS)), f("data 2", Kind::Bits(&DATA_2_BITS))];
pub(super) const JOB: &[Field] = &[
    f("job name", Kind::Text(32)),
    f("line number", Kind::U32),
    f("step number", Kind::U32),
    f("speed override", Kind::Scaled(units::PERCENT)),
];
pub(super) const AXIS_NAMES: &[Field] = &[
    f("axis name 1", Kind::Text(4)),
    f("axis name 2", Kind::Text(4)),
    f("axis name 3", Kind::Text(4)),
    f("axis name 4", Kind::Text(4)),
    f("axis name 5", Kind::Text(4)),
    f("axis name 6", Kind::Text(4)),
    f("axis name 7", Kind::Text(4)),
    f("axis name 8", Kind::Text(4)),
];
pub(super) const POSITION: &[Field] = &[
    f("data type", Kind::Choice(POSITION_KINDS)),
    f("form", Kind::Bits(&FORM_BITS)),
    f("tool number", Kind::U32),
    f("user coordinate number", Kind::U32),
    f("extended form", Kind::Bits(&EXTENDED_FORM_BITS)),
    f("axis 1", Kind::Axis(0)),
    f("axis 2", Kind::Axis(1)),
    f("axis 3", Kind::Axis(2)),
    f("axis 4", Kind::Axis(3)),
    f("axis 5", Kind::Axis(4)),
    f("axis 6", Kind::Axis(5)),
    f("axis 7", Kind::Axis(6)),
    f("axis 8", Kind::Axis(7)),
];
pub(super) const BASE_POSITION: &[Field] = &[
    f("data type", Kind::Choice(BASE_KINDS)),
    f("axis 1", Kind::BaseAxis),
    f("axis 2", Kind::BaseAxis),
    f("axis 3", Kind::BaseAxis),
    f("axis 4", Kind::BaseAxis),
    f("axis 5", Kind::BaseAxis),
    f("axis 6", Kind::BaseAxis),
    f("axis 7", Kind::BaseAxis),
    f("axis 8", Kind::BaseAxis),
];
pub(super) const EXTERNAL_POSITION: &[Field] = &[
    f("data type", Kind::Choice(PULSE_KIND)),
    f("axis 1", Kind::Scaled(units::PULSE)),
    f("axis 2", Kind::Scaled(units::PULSE)),
    f("axis 3", Kind::Scaled(units::PULSE)),
    f("axis 4", Kind::Scaled(units::PULSE)),
    f("axis 5", Kind::Scaled(units::PULSE)),
    f("axis 6", Kind::Scaled(units::PULSE)),
    f("axis 7", Kind::Scaled(units::PULSE)),
    f("axis 8", Kind::Scaled(units::PULSE)),
];
pub(super) const POSITION_ERROR: &[Field] = &[
    f("axis 1", Kind::Scaled(units::PULSE)),
    f("axis 2", Kind::Scaled(units::PULSE)),
    f("axis 3", Kind::Scaled(units::PULSE)),
    f("axis 4", Kind::Scaled(units::PULSE)),
    f("axis 5", Kind::Scaled(units::PULSE)),
    f("axis 6", Kind::Scaled(units::PULSE)),
    f("axis 7", Kind::Scaled(units::PULSE)),
    f("axis 8", Kind::Scaled(units::PULSE)),
];
/// The unit of torque is not printed.
pub(super) const TORQUE: &[Field] = &[
    f("axis 1", Kind::I32),
    f("axis 2", Kind::I32),
    f("axis 3", Kind::I32),
    f("axis 4", Kind::I32),
    f("axis 5", Kind::I32),
    f("axis 6", Kind::I32),
    f("axis 7", Kind::I32),
    f("axis 8", Kind::I32),
];
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

const MOVE_HEAD: [Field; 11] = [
    f("control group (robot)", Kind::U32),
    f("control group (station)", Kind::U32),
    f("speed class", Kind::Choice(SPEED_CLASS)),
    f("speed", Kind::Speed),
    f("coordinate", Kind::Choice(COORDINATE)),
    f("X", Kind::Scaled(units::MILLIMETRE)),
    f("Y", Kind::Scaled(units::MILLIMETRE)),
    f("Z", Kind::Scaled(units::MILLIMETRE)),
    f("Tx", Kind::Scaled(units::DEGREE)),
    f("Ty", Kind::Scaled(units::DEGREE)),
    f("Tz", Kind::Scaled(units::DEGREE)),
];
const MOVE_TAIL: [Field; 13] = [
    f("form", Kind::Bits(&FORM_BITS)),
    f("extended form", Kind::Bits(&EXTENDED_FORM_BITS)),
    f("tool number", Kind::U32),
    f("user coordinate number", Kind::U32),
    f("base axis 1", Kind::Scaled(units::MILLIMETRE)),
    f("base axis 2", Kind::Scaled(units::MILLIMETRE)),
    f("base axis 3", Kind::Scaled(units::MILLIMETRE)),
    f("station axis 1", Kind::Scaled(units::PULSE)),
    f("station axis 2", Kind::Scaled(units::PULSE)),
    f("station axis 3", Kind::Scaled(units::PULSE)),
    f("station axis 4", Kind::Scaled(units::PULSE)),
    f("station axis 5", Kind::Scaled(units::PULSE)),
    f("station axis 6", Kind::Scaled(units::PULSE)),
];

/// Head, reserved words, tail.
const fn move_fields<const N: usize>() -> [Field; N] {
    let mut out = [f("reserved", Kind::Reserved); N];
    let mut i = 0;
    while i < MOVE_HEAD.len() {
        out[i] = MOVE_HEAD[i];
        i += 1;
    }
    i = 0;
    while i < MOVE_TAIL.len() {
        out[N - MOVE_TAIL.len() + i] = MOVE_TAIL[i];
        i += 1;
    }
    out
}

/// DX 3.3.39: two reserved words.
pub(super) const MOVE_26: &[Field] = &move_fields::<26>();
/// FS 3.3.39: one reserved word.
pub(super) const MOVE_25: &[Field] = &move_fields::<25>();
pub(super) const PULSE_MOVE: &[Field] = &[
    f("control group (robot)", Kind::U32),
    f("control group (station)", Kind::U32),
    f("speed class", Kind::Choice(SPEED_CLASS)),
    f("speed", Kind::Speed),
    f("robot axis 1", Kind::Scaled(units::PULSE)),
    f("robot axis 2", Kind::Scaled(units::PULSE)),
    f("robot axis 3", Kind::Scaled(units::PULSE)),
    f("robot axis 4", Kind::Scaled(units::PULSE)),
    f("robot axis 5", Kind::Scaled(units::PULSE)),
    f("robot axis 6", Kind::Scaled(units::PULSE)),
    f("robot axis 7", Kind::Scaled(units::PULSE)),
    f("robot axis 8", Kind::Scaled(units::PULSE)),
    f("tool number", Kind::U32),
    f("base axis 1", Kind::Scaled(units::PULSE)),
    f("base axis 2", Kind::Scaled(units::PULSE)),
    f("base axis 3", Kind::Scaled(units::PULSE)),
    f("station axis 1", Kind::Scaled(units::PULSE)),
    f("station axis 2", Kind::Scaled(units::PULSE)),
    f("station axis 3", Kind::Scaled(units::PULSE)),
    f("station axis 4", Kind::Scaled(units::PULSE)),
    f("station axis 5", Kind::Scaled(units::PULSE)),
    f("station axis 6", Kind::Scaled(units::PULSE)),
];
