//! The 83 parameters and tables (TO 2-4).
//!
//! Groups: `M` mode, `P` parameter 1, `E` parameter 2 (a change needs a power cycle), `U` parameter 3 (not for normal
//! use), `T` tables.

use super::fields::{
    AIM, AXIS, BIT, CC_LINK_RATES, COUNTER, GROUP, POINT, PORT, R, SIDE, STATION, VALID, X, Y, Z, axes, digits, fixed,
    place, plain, word, words,
};
use super::{ALL_MODELS, FROM_3_36, KCA, KCA20, KCA25, Models};
use crate::toyo::field::{Field, Form, Number, Word};
use crate::toyo::layout::Layout;

/// Parameter group.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Group {
    /// `M`: operating mode.
    Mode,
    /// `P`, parameter 1: axes.
    Axis,
    /// `E`, parameter 2: machine. After a change, only communication works until a power cycle.
    Machine,
    /// `U`, parameter 3: not for normal use.
    Special,
    /// `T`: tables, with a row number.
    Table,
}

impl Group {
    /// Readable name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mode => "mode",
            Self::Axis => "axis",
            Self::Machine => "machine",
            Self::Special => "special",
            Self::Table => "table",
        }
    }
}

/// A parameter, or a table with numbered rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Parameter {
    /// Id of the manual, for example `P01` or `T1`. A sheet of the MVM table has an id such as `T4.S1`.
    pub id: &'static str,
    /// Name for user input, for example `soft-limit-plus`.
    pub name: &'static str,
    /// Description of the content.
    pub about: &'static str,
    /// Text of a write, after `WPAR`.
    pub layout: Layout,
    /// Text of a read, after `RPAR`: the id and, for a table, the row.
    pub key: Layout,
    /// Controllers that support the parameter; empty for all controllers.
    pub only_on: Models,
}

impl Parameter {
    /// The parameter with this id or name, in any case.
    pub fn named(name: &str) -> Option<&'static Self> {
        let is = |other: &str| other.eq_ignore_ascii_case(name);
        PARAMETERS.iter().find(|row| is(row.id) || is(row.name))
    }

    /// Returns the parameter whose id is in a text after `RPAR` or `WPAR`.
    pub fn from_text(text: &str) -> Option<&'static Self> {
        // A quick comparison of the first letter leaves out most of the table.
        let letter = text.trim_start_matches(' ').chars().next()?;
        PARAMETERS.iter().filter(|row| row.key.text.starts_with(letter)).find(|row| {
            let id = row.key.text.split('{').next().unwrap_or_default().trim_end();
            let mut words = text.split(' ').filter(|word| !word.is_empty());
            // An id such as `T2 V` ends in letters. A number or a key follows directly after these letters.
            id.split(' ').all(|word| words.next().is_some_and(|words| words == word || is_key(word, words)))
        })
    }

    /// Group of the parameter.
    pub fn group(&self) -> Group {
        match self.id.as_bytes()[0] {
            b'M' => Group::Mode,
            b'P' => Group::Axis,
            b'E' => Group::Machine,
            b'U' => Group::Special,
            _ => Group::Table,
        }
    }

    /// Field of the row number; `None` for a parameter without rows.
    pub const fn row(&self) -> Option<&'static Field> {
        self.key.fields.first()
    }

    /// Fields of the values, without the row number.
    pub fn fields(&self) -> &'static [Field] {
        &self.layout.fields[self.key.fields.len()..]
    }

    /// Layout of the values without the id, for dumps and messages, for example `AX1=… AX2=…`.
    pub fn body(&self) -> Layout {
        let text = self.layout.text.strip_prefix(self.key.text).unwrap_or(self.layout.text);
        Layout { text: text.trim_start_matches([' ', '=']), fields: self.fields() }
    }
}

fn is_key(word: &str, text: &str) -> bool {
    (word.ends_with('=') || matches!(word, "V" | "A" | "LIM")) && text.starts_with(word)
}

type Text = &'static str;

const fn single(id: Text, name: Text, text: Text, fields: &'static [Field], about: Text) -> Parameter {
    Parameter { id, name, about, layout: Layout::new(text, fields), key: Layout::words(id), only_on: ALL_MODELS }
}

const fn table(id: Text, name: Text, key: Layout, layout: Layout, about: Text) -> Parameter {
    Parameter { id, name, about, layout, key, only_on: ALL_MODELS }
}

impl Parameter {
    const fn on(self, only_on: Models) -> Self {
        Self { only_on, ..self }
    }
}

/// A bit of a port, for example `0/01/0`.
const PORT_BIT: &[Field] = &[STATION, PORT, BIT];
/// A bit of a port. Only ports of the controller itself are valid (ambiguity R12).
const OWN_PORT_BIT: &[Field] = &[digits("station", 1, 0, 0, "I/O station"), PORT, BIT];
/// A port number. Only ports up to 13 are valid (ambiguity R12).
const DIRECT: Field = digits("port", 2, 1, 13, "port");
const DIRECT_BITS: &[Field] = &four_bits(DIRECT);
const TASK_BITS: &[Field] = &four_bits(PORT);

/// Four bits, for example one for each task.
const fn four_bits(port: Field) -> [Field; 12] {
    [
        STATION.named("station1"),
        port.named("port1"),
        BIT.named("bit1"),
        STATION.named("station2"),
        port.named("port2"),
        BIT.named("bit2"),
        STATION.named("station3"),
        port.named("port3"),
        BIT.named("bit3"),
        STATION.named("station4"),
        port.named("port4"),
        BIT.named("bit4"),
    ]
}

/// The sample of the manual also has 156K, but this rate belongs to CC-Link (ambiguity R10).
const DEVICENET_RATES: &[Word] = &[plain("125K"), plain("250K"), plain("500K")];
const OPTIONS: Field = digits("options", 4, 0, 9999, "option flags");

const PLACE: Form = Form::Number(Number::signed(4, 2, -800_000, 800_000));
const PLACES: &[Field] = &axes(PLACE, "mm", "coordinate");
const OFFSETS: &[Field] = &axes(PLACE, "mm", "offset");
const GAINS: &[Field] = &axes(Form::Number(Number::digits(2, 0, 15)), "", "gain");
/// The manual gives neither a range nor a unit (ambiguity R13).
const PASS_AREAS: &[Field] = &axes(Form::Number(Number::digits(4, 0, 9999)), "", "pass area");
const RANKS: &[Field] = &axes(Form::Number(Number::digits(1, 1, 4)), "", "rank in the sequence");
const JOG_SPEEDS: &[Field] = &[speed("low", "low speed"), speed("high", "high speed")];
const ORIGIN_SPEEDS: &[Field] =
    &[speed("low", "low speed"), speed("middle", "middle speed"), speed("high", "high speed")];
const INCHES: &[Field] = &axes(Form::Number(Number::fixed(2, 2, 0, 6500)), "mm", "distance");
const AREA: &[Field] = &[SIDE, place("place", "coordinate"), STATION, PORT, BIT];
/// The template of the manual has two decimals, but the range has three (ambiguity R8).
const SYNC_OFFSETS: &[Field] = &axes(Form::Number(Number::signed(3, 2, -99_990, 99_990).with_spare(1)), "mm", "offset");
const SYNC_ERRORS: &[Field] = &axes(Form::Number(Number::fixed(2, 2, 100, 9999)), "mm", "allowed error");
const LETTERS: &[Field] = &axes(Form::Word(AXIS), "", "letter of the axis");
const IN_POSITION: &[Field] = &axes(Form::Number(Number::fixed(2, 2, 1, 6500)), "mm", "width");
const PULSES: &[Field] = &axes(Form::Number(Number::digits(5, 1, 65_535)), "pulse", "pulses");
const DIRECTIONS: &[Field] =
    &axes(Form::Word(&[word("0", "clockwise"), word("1", "counterclockwise")]), "", "direction");
const TOP_SPEEDS: &[Field] = &axes(Form::Number(Number::digits(4, 1, 1000)), "mm/s", "speed");
const METHODS: &[Field] = &axes(Form::Word(&[word("0", "Z phase"), word("1", "origin sensor")]), "", "method");
const LOGICS: &[Field] =
    &axes(Form::Word(&[word("0", "on when detected"), word("1", "off when detected")]), "", "logic");
const LEADS: &[Field] = &axes(Form::Number(Number::fixed(2, 3, 1000, 99_999)), "mm", "lead");
const DIVISIONS: &[Field] = &axes(Form::Number(Number::digits(4, 1, 9999)), "pulse/rev", "pulses of a turn");
const MULTIPLIERS: &[Field] = &axes(Form::Number(Number::digits(1, 1, 4)), "", "multiplier");
const TASK_RANKS: &[Field] = &per_task(digits("task1", 1, 0, 4, "priority"));
const TASK_POINTS: &[Field] = &per_task(digits("task1", 3, 999, 999, "rows"));
const TASK_STEPS: &[Field] = &per_task(digits("task1", 4, 0, 5000, "steps"));

const fn per_task(task: Field) -> [Field; 4] {
    [task, task.named("task2"), task.named("task3"), task.named("task4")]
}

/// Number of axes per task, as one digit for each task: 0 to 2 is the number of axes, 3 is three axes in a plane, 4 is
/// three axes in space, 5 is four axes.
#[rustfmt::skip] // One line per number would hide the list.
const COMBINATIONS: &[Word] = &[
    plain("1000"), plain("1100"), plain("1110"), plain("1111"), plain("1120"), plain("1200"),
    plain("1210"), plain("1300"), plain("1400"), plain("2000"), plain("2100"), plain("2110"),
    plain("2200"), plain("3000"), plain("3100"), plain("4000"), plain("4100"), plain("5000"),
];
const SIGNS: &[Field] = &axes(Form::Word(&[word("0", "minus"), word("1", "plus")]), "", "direction");
const BRAKES: &[Field] = &axes(Form::Word(&[word("0", "invalid"), word("1", "valid")]), "", "dynamic brake");
const ROLES: &[Field] = &axes(Form::Word(&[word("M", "drive"), word("S", "driven"), word("0", "normal")]), "", "role");
const TORQUE_ROWS: &[Field] = &axes(Form::Number(Number::digits(2, 0, 8)), "", "row of the torque limit table");
const LENGTHS: &[Field] = &axes(Form::Number(Number::digits(3, 1, 120)), "m", "length");
const RESISTANCES: &[Field] = &axes(Form::Number(Number::fixed(3, 1, 0, 1000)), "ohm", "resistance");
const RATINGS: &[Field] = &axes(Form::Number(Number::fixed(3, 2, 0, 32_767)), "kW", "capacity");
const ROW_20: Field = digits("row", 2, 1, 20, "row");

const fn speed(name: &'static str, about: &'static str) -> Field {
    fixed(name, (3, 1), 1, 9999, about).unit("mm/s")
}

const fn corner(name: &'static str, least: i32) -> Field {
    digits(name, 3, least, 999, "row of the coordinate table")
}

const fn pieces(name: &'static str) -> Field {
    digits(name, 4, 0, 9999, "pieces in this direction")
}

const LIMIT_ROW: Field = digits("row", 2, 1, 8, "row");

/// All parameters, in the order of the manual.
#[rustfmt::skip] // Six lines per row would hide the table.
pub static PARAMETERS: [Parameter; 83] = [
    single("M01", "single-operation-input", "M01 {}/{}/{}", PORT_BIT, "input bit for single operation"),
    single("M02", "continuous-start-input", "M02 {}/{}/{}", OWN_PORT_BIT, "input bit for continuous start"),
    single("M03", "escape-input", "M03 {}/{}/{}", PORT_BIT, "input bit for escape"),
    single("M04", "pause-input", "M04 {}/{}/{}", PORT_BIT, "input bit for pause"),
    single("M05", "program-selection-input", "M05 {}/{}/{}", PORT_BIT, "input bit for program selection"),
    single("M06", "palletizing-input", "M06 {}/{}/{}", PORT_BIT, "input bit for palletizing"),
    single("M07", "pause-output", "M07 {}/{}/{}", PORT_BIT, "output bit: paused"),
    single("M08", "input-wait-output", "M08 {}/{}/{}", PORT_BIT, "output bit: waits for input"),
    single("M09", "pendant-language", "M09 {}",
        &[words("language", &[word("J", "Japanese"), word("E", "English")], "language")],
        "language of the teach pendant"),
    single("M10", "easy-or-external-point", "M10 {}",
        &[words("mode", &[word("I", "invalid"), word("E", "easy"), word("P", "external point")], "mode")],
        "easy or external point mode"),
    single("M11", "clear-outputs-on-reset", "M11 {}", &[words("use", VALID, "whether the outputs are cleared")],
        "whether a reset clears general-purpose outputs"),
    single("M12", "direct-outputs", "M12 PN1={}/{}/{} PN2={}/{}/{} PN3={}/{}/{} PN4={}/{}/{}", DIRECT_BITS,
        "the four bits of direct output"),
    single("M13", "ready-output", "M13 {}/{}/{}", PORT_BIT, "output bit: ready"),
    single("M14", "positioning-complete-outputs", "M14 TA1={}/{}/{} TA2={}/{}/{} TA3={}/{}/{} TA4={}/{}/{}", TASK_BITS,
        "output bit of each task: positioning complete"),
    single("M15", "origin-complete-outputs", "M15 TA1={}/{}/{} TA2={}/{}/{} TA3={}/{}/{} TA4={}/{}/{}", TASK_BITS,
        "output bit of each task: return to origin complete"),
    single("M16", "fiber-cable-length", "M16 {}", &[digits("length", 2, 1, 20, "length").unit("m")],
        "fiber-optic cable to the BS amplifier"),
    single("M17", "cc-link", "M17 STN={} BRT={} OPT={}",
        &[digits("station", 2, 1, 61, "station"), words("rate", CC_LINK_RATES, "baud rate"), OPTIONS],
        "CC-Link").on(KCA),
    single("M18", "devicenet", "M18 STN={} BRT={} OPT={}",
        &[digits("station", 2, 1, 63, "station"), words("rate", DEVICENET_RATES, "baud rate"), OPTIONS],
        "DeviceNet").on(KCA),
    single("M19", "battery-alarm-output", "M19 {}/{}/{}", PORT_BIT, "output bit: battery alarm").on(KCA),
    single("M20", "external-point-number-output", "M20 {}", &[words("use", VALID, "whether the row number is output")],
        "whether external point mode outputs the number of its target row").on(KCA),
    single("M21", "servo-on-input", "M21 {}/{}/{}", PORT_BIT, "input bit for servo on").on(KCA),
    single("M22", "torque-limit-input", "M22 {}/{}/{}", PORT_BIT, "input bit for torque limit").on(KCA25),
    single("M23", "external-point-base", "M23 {}",
        &[digits("base", 1, 0, 4, "base; the manual does not explain the values")],
        "base of the coordinate table in external point mode").on(KCA25),
    single("M24", "load-outputs", "M24 TA1={}/{}/{} TA2={}/{}/{} TA3={}/{}/{} TA4={}/{}/{}", TASK_BITS,
        "output bit of each task: load").on(KCA25),
    single("M25", "torque-limit-outputs", "M25 TA1={}/{}/{} TA2={}/{}/{} TA3={}/{}/{} TA4={}/{}/{}", TASK_BITS,
        "output bit of each task: torque limit").on(KCA25),
    single("M26", "lock-outputs", "M26 TA1={}/{}/{} TA2={}/{}/{} TA3={}/{}/{} TA4={}/{}/{}", TASK_BITS,
        "output bit of each task: locked").on(KCA25),
    single("P01", "soft-limit-plus", "P01 AX1={} AX2={} AX3={} AX4={}", PLACES, "soft limit in plus direction"),
    single("P02", "soft-limit-minus", "P02 AX1={} AX2={} AX3={} AX4={}", PLACES, "soft limit in minus direction"),
    single("P03", "position-gain", "P03 AX1={} AX2={} AX3={} AX4={}", GAINS, "servo gain of the position loop"),
    single("P04", "speed-gain", "P04 AX1={} AX2={} AX3={} AX4={}", GAINS, "servo gain of the speed loop"),
    single("P05", "pass-area", "P05 AX1={} AX2={} AX3={} AX4={}", PASS_AREAS, "how close the axes pass pass points"),
    single("P06", "origin-offset", "P06 AX1={} AX2={} AX3={} AX4={}", OFFSETS, "offset of the origin"),
    single("P07", "origin-sequence", "P07 AX1={} AX2={} AX3={} AX4={}", RANKS,
        "order in which axes return to the origin"),
    single("P08", "jog-speed-1", "P08 L={} H={}", JOG_SPEEDS, "JOG speeds of axis 1"),
    single("P09", "jog-speed-2", "P09 L={} H={}", JOG_SPEEDS, "JOG speeds of axis 2"),
    single("P10", "jog-speed-3", "P10 L={} H={}", JOG_SPEEDS, "JOG speeds of axis 3"),
    single("P11", "jog-speed-4", "P11 L={} H={}", JOG_SPEEDS, "JOG speeds of axis 4"),
    single("P12", "inching-distance", "P12 AX1={} AX2={} AX3={} AX4={}", INCHES, "distance of an inching JOG"),
    single("P13", "area-output-1", "P13 AX1{}{} {}/{}/{}", AREA, "output bit that depends on the position of axis 1"),
    single("P14", "area-output-2", "P14 AX2{}{} {}/{}/{}", AREA, "output bit that depends on the position of axis 2"),
    single("P15", "area-output-3", "P15 AX3{}{} {}/{}/{}", AREA, "output bit that depends on the position of axis 3"),
    single("P16", "area-output-4", "P16 AX4{}{} {}/{}/{}", AREA, "output bit that depends on the position of axis 4"),
    single("P17", "sync-offset", "P17 AX1={} AX2={} AX3={} AX4={}", SYNC_OFFSETS, "offset of synchronized axes")
        .on(KCA20),
    single("P18", "sync-error", "P18 AX1={} AX2={} AX3={} AX4={}", SYNC_ERRORS, "allowed error of synchronized axes")
        .on(KCA20),
    single("E01", "axis-letters", "E01 AX1={} AX2={} AX3={} AX4={}", LETTERS, "letters that the teach pendant shows"),
    single("E02", "in-position", "E02 AX1={} AX2={} AX3={} AX4={}", IN_POSITION,
        "distance to the target that counts as in position"),
    single("E03", "overflow", "E03 AX1={} AX2={} AX3={} AX4={}", PULSES, "position error that counts as overflow"),
    single("E04", "feed-forward", "E04 AX1={} AX2={} AX3={} AX4={}", PULSES, "feed forward"),
    single("E05", "motor-direction", "E05 AX1={} AX2={} AX3={} AX4={}", DIRECTIONS, "direction of the motor"),
    single("E06", "max-speed", "E06 AX1={} AX2={} AX3={} AX4={}", TOP_SPEEDS, "maximum speed of the axis"),
    single("E07", "origin-speed-1", "E07 L={} M={} H={}", ORIGIN_SPEEDS, "speeds of the return to origin of axis 1"),
    single("E08", "origin-speed-2", "E08 L={} M={} H={}", ORIGIN_SPEEDS, "speeds of the return to origin of axis 2"),
    single("E09", "origin-speed-3", "E09 L={} M={} H={}", ORIGIN_SPEEDS, "speeds of the return to origin of axis 3"),
    single("E10", "origin-speed-4", "E10 L={} M={} H={}", ORIGIN_SPEEDS, "speeds of the return to origin of axis 4"),
    single("E11", "origin-method", "E11 AX1={} AX2={} AX3={} AX4={}", METHODS, "method of the return to origin"),
    single("E12", "origin-sensor-logic", "E12 AX1={} AX2={} AX3={} AX4={}", LOGICS, "logic of the origin sensor"),
    single("E13", "fast-origin-position", "E13 AX1={} AX2={} AX3={} AX4={}", PLACES,
        "target of a fast return to origin"),
    single("E14", "lead", "E14 AX1={} AX2={} AX3={} AX4={}", LEADS, "pulse rate: lead"),
    single("E15", "pulses-per-turn", "E15 AX1={} AX2={} AX3={} AX4={}", DIVISIONS, "pulse rate: division"),
    single("E16", "pulse-multiplier", "E16 AX1={} AX2={} AX3={} AX4={}", MULTIPLIERS, "pulse rate: multiplier"),
    single("E17", "encoder-type", "E17 E={}",
        &[words("encoder", &[word("i", "incremental"), word("a", "absolute")], "encoder")], "type of the encoders"),
    single("E18", "acceleration-ratio", "E18 TW={}", &[digits("ratio", 3, 90, 90, "always 90")],
        "T2 ratio of the acceleration"),
    single("E19", "task-axes", "E19 {}",
        &[words(
            "axes",
            COMBINATIONS,
            "one digit per task: 0 no axes, 1 one axis, 2 two axes, 3 three axes in a plane, 4 three axes in space, 5 \
             four axes",
        )],
        "axes of each task"),
    single("E20", "task-priority", "E20 TASK01={} TASK02={} TASK03={} TASK04={}", TASK_RANKS, "priority of tasks"),
    single("E21", "task-points", "E21 TASK01={} TASK02={} TASK03={} TASK04={}", TASK_POINTS,
        "rows of each task's coordinate table"),
    single("E22", "task-steps", "E22 TASK01={} TASK02={} TASK03={} TASK04={}", TASK_STEPS,
        "steps of each task's program"),
    single("E23", "ba-io-mode", "E23 {}", &[words("use", VALID, "whether the mode is on")],
        "BA I/O compatibility mode").on(FROM_3_36),
    single("E24", "origin-direction", "E24 AX1={} AX2={} AX3={} AX4={}", SIGNS, "direction of the return to origin")
        .on(KCA),
    single("E25", "dynamic-brake", "E25 AX1={} AX2={} AX3={} AX4={}", BRAKES, "dynamic brake, which stays invalid")
        .on(KCA20),
    single("E26", "sync-axes", "E26 AX1={} AX2={} AX3={} AX4={}", ROLES, "which axes are synchronized").on(KCA20),
    single("E27", "origin-torque-limit", "E27 AX1={} AX2={} AX3={} AX4={}", TORQUE_ROWS,
        "torque limit of the return to origin").on(KCA25),
    single("U03", "resolver-cable-length", "U03 AX1={} AX2={} AX3={} AX4={}", LENGTHS, "length of the resolver cables"),
    single("U21", "regeneration-resistance", "U21 AX1={} AX2={} AX3={} AX4={}", RESISTANCES,
        "external resistor for regeneration: resistance"),
    single("U22", "regeneration-capacity", "U22 AX1={} AX2={} AX3={} AX4={}", RATINGS,
        "external resistor for regeneration: capacity"),
    table("T1", "point", Layout::new("T1 PT={}", &[POINT.named("row")]),
        Layout::new("T1 PT={} X={} Y={} Z={} R={}", &[POINT.named("row"), X, Y, Z, R]),
        "coordinate table of the current task"),
    table("T2", "speed-table", Layout::new("T2 V{}", &[ROW_20]),
        Layout::new("T2 V{}={}", &[ROW_20, fixed("speed", (4, 1), 10, 99_999, "speed").unit("mm/s")]), "speed table"),
    table("T3", "accel-table", Layout::new("T3 A{}", &[ROW_20]),
        Layout::new(
            "T3 A{}={}",
            &[ROW_20, fixed("time", (1, 2), 1, 999, "time from standstill to full speed").unit("s")],
        ),
        "acceleration and deceleration table"),
    table("T4.S1", "mvm-points", Layout::new("T4 S1 GRP={}", &[GROUP.named("row")]),
        Layout::new(
            "T4 S1 GRP={} ORG={} P1={} P2={} P3={}",
            &[GROUP.named("row"), corner("origin", 1), corner("p1", 0), corner("p2", 0), corner("p3", 0)],
        ),
        "MVM table: corners"),
    table("T4.S2", "mvm-pieces", Layout::new("T4 S2 GRP={}", &[GROUP.named("row")]),
        Layout::new("T4 S2 GRP={} P1={} P2={} P3={}", &[GROUP.named("row"), pieces("p1"), pieces("p2"), pieces("p3")]),
        "MVM table: pieces in each direction"),
    table("T4.S3", "mvm-counters", Layout::new("T4 S3 GRP={}", &[GROUP.named("row")]),
        Layout::new(
            "T4 S3 GRP={} P1={} P2={} P3={}",
            &[GROUP.named("row"), COUNTER.named("p1"), COUNTER.named("p2"), COUNTER.named("p3")],
        ),
        "MVM table: counter of each direction"),
    table("T4.S4", "mvm-approach", Layout::new("T4 S4 GRP={}", &[GROUP.named("row")]),
        Layout::new("T4 S4 GRP={} {} Z={} R={}", &[GROUP.named("row"), AIM, Z, R]), "MVM table: approach point"),
    table("T4.S5", "mvm-destination", Layout::new("T4 S5 GRP={}", &[GROUP.named("row")]),
        Layout::new("T4 S5 GRP={} R={}", &[GROUP.named("row"), R]), "MVM table: destination"),
    table("T5", "torque-table", Layout::new("T5 LIM{}", &[LIMIT_ROW]),
        Layout::new(
            "T5 LIM{} T={} L={}",
            &[
                LIMIT_ROW,
                fixed("limit", (1, 2), 1, 999, "torque limit"),
                fixed("load", (1, 2), 1, 999, "torque at which the load output switches on"),
            ],
        ),
        "torque limit table").on(KCA25),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_and_names_are_unique() {
        for row in &PARAMETERS {
            assert_eq!(Parameter::named(row.id), Some(row));
            assert_eq!(Parameter::named(&row.name.to_uppercase()), Some(row));
        }
    }

    #[test]
    fn a_text_identifies_its_parameter() {
        for row in &PARAMETERS {
            let values: Vec<_> = row.key.fields.iter().map(|_| crate::toyo::field::Value::Number(1)).collect();
            let key = row.key.emit(&values).unwrap();
            assert_eq!(Parameter::from_text(&key).map(|row| row.id), Some(row.id), "{key}");
        }
        assert_eq!(Parameter::from_text("T2 V01=0001.0").unwrap().id, "T2");
        assert_eq!(Parameter::from_text("P19 AX1=1"), None);
        assert_eq!(Parameter::from_text("T4 S6 GRP=01"), None);
        assert_eq!(Parameter::from_text(""), None);
    }

    #[test]
    fn the_body_is_the_text_after_the_key() {
        let body = |id| Parameter::named(id).unwrap().body().text;
        assert_eq!(body("T2"), "{}");
        assert_eq!(body("T1"), "X={} Y={} Z={} R={}");
        assert_eq!(body("P13"), "AX1{}{} {}/{}/{}");
        assert_eq!(body("E19"), "{}");
    }
}
