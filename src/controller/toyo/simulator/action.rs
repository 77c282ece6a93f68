//! Compiled steps: an instruction is converted to a typed action once, when it is written.

use std::time::Duration;

use super::io::Port;
use super::memory::index;
use super::motion::{AXES, Coordinates};
use crate::toyo::field::Mask;
use crate::toyo::layout::Record;
use crate::toyo::table::{Instruction, Op};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Action {
    // NOP and TAG.
    Nothing,
    End,
    Stop,
    Return,
    Home,
    // PSEL: jumps to the tag whose number is at the selection inputs.
    Select,
    Jump { tag: usize, when: Test },
    Call { tag: usize, when: Test },
    // BRAC: jumps to the tag whose number is the sum of a counter and a number.
    Branch { counter: usize, offset: usize },
    Wait(Test),
    Delay(Duration),
    Count { counter: usize, change: Change },
    ClearCounters,
    // TIMP: the timer counts up from this value in tenths of a second.
    StartTimer { timer: usize, tenths: u32 },
    Choose(Choice),
    Output { port: Port, mask: Mask, time: Option<Duration> },
    OutputCounter { port: Port, counter: usize },
    InputCounter { port: Port, counter: usize },
    Internal { port: usize, mask: Mask },
    OutputAt { task: usize, port: Port, mask: Mask, axis: usize, at_least: bool, place: f64 },
    // CANS: cancels the outputs of a task. Task 0 is the task that executes the instruction.
    CancelOutputs { task: usize },
    Move(Move),
    // MVC, MVCP: this step and the next step define an arc. The arc goes from the current position through the first
    // point to the second point.
    Arc(Move),
    BeginGroup { group: i32 },
    Loop { group: i32, more: usize, done: usize },
    Offset(Target),
    // Switches servo power of one axis, or of all axes of the task.
    Servo { axis: Option<usize>, on: bool },
    Torque(Torque),
    Task { task: usize, order: TaskOrder },
}

/// Condition of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Test {
    Always,
    Counter { counter: usize, compare: Compare, count: u16 },
    Timer { timer: usize, compare: Compare, tenths: u32 },
    Input { port: Port, mask: Mask, any: bool },
    Internal { port: usize, mask: Mask, any: bool },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Compare {
    Equal,
    Less,
    More,
    AtMost,
    AtLeast,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Change {
    Set(u16),
    Add(i32),
}

/// Setting for later moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Choice {
    /// Row of the speed table.
    Speed(i32),
    /// Row of the acceleration table, for both ramps.
    Ramps(i32),
    /// Row of the acceleration table, for the deceleration.
    LastRamp(i32),
    /// Share of the deceleration during which the next move already runs.
    Pass(f64),
}

/// A move to one position.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a field of the instruction, or its kind")]
pub(super) struct Move {
    pub(super) to: Target,
    pub(super) incremental: bool,
    /// Whether the speed is the path speed. Otherwise it is the speed of the axis with the longest distance.
    pub(super) line: bool,
    /// Row of the speed table; 0 means the row of the last SPD.
    pub(super) speed: i32,
    pub(super) pass: bool,
    /// Whether the escape input ends the move.
    pub(super) escape: bool,
}

/// Target of a move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Target {
    Coordinates(Coordinates),
    // A row of the coordinate table, with a counter added to its number (ambiguity R7).
    Row { point: i32, counter: usize },
    // Start of the last move.
    Back,
    // Position of an MVM group, or its approach point.
    Group { group: i32, approach: bool },
    // Coordinates from the host.
    Host,
}

/// TLMV: torque limit for the next move of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a field of the instruction")]
pub(super) struct Torque {
    pub(super) axis: usize,
    /// Row of the torque limit table.
    pub(super) table: i32,
    pub(super) judge: Duration,
    pub(super) torque_end: bool,
    pub(super) lock_end: bool,
    pub(super) arrival_end: bool,
    pub(super) overflow: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TaskOrder {
    Start,
    Stop,
    GoOn,
    Cancel,
}

impl Compare {
    pub(super) fn holds<T: PartialOrd>(self, left: &T, right: &T) -> bool {
        match self {
            Self::Equal => left == right,
            Self::Less => left < right,
            Self::More => left > right,
            Self::AtMost => left <= right,
            Self::AtLeast => left >= right,
        }
    }

    fn named(word: &str) -> Self {
        match word.trim_end() {
            "<" => Self::Less,
            ">" => Self::More,
            "<=" => Self::AtMost,
            ">=" => Self::AtLeast,
            _ => Self::Equal,
        }
    }
}

/// Converts an instruction, whose values must be in range.
pub(super) fn action(row: &Instruction, record: &Record) -> Action {
    let fields = Fields(record);
    match row.op {
        Op::Nop | Op::Tag => Action::Nothing,
        Op::End => Action::End,
        Op::Stop => Action::Stop,
        Op::Ret => Action::Return,
        Op::Home => Action::Home,
        Op::Psel => Action::Select,
        Op::Jmp | Op::Jmpc | Op::Jmpi | Op::Jmpt => Action::Jump { tag: fields.index("tag"), when: fields.test() },
        Op::Cal | Op::Calc | Op::Cali | Op::Calt => Action::Call { tag: fields.index("tag"), when: fields.test() },
        Op::Brac => Action::Branch { counter: fields.index("counter"), offset: fields.index("offset") },
        Op::In | Op::Insp | Op::Cwit => Action::Wait(fields.test()),
        Op::Tim => Action::Delay(tenths(fields.number("time"))),
        Op::Cnt => fields.count(Change::Set(fields.small("count"))),
        Op::CntPlus => fields.count(Change::Add(fields.number("count"))),
        Op::CntMinus => fields.count(Change::Add(-fields.number("count"))),
        Op::Cntc => Action::ClearCounters,
        Op::Timp => Action::StartTimer { timer: fields.index("timer"), tenths: fields.number("time").unsigned_abs() },
        Op::Spd => Action::Choose(Choice::Speed(fields.number("speed"))),
        Op::Acc => Action::Choose(Choice::Ramps(fields.number("ramp"))),
        Op::Dec => Action::Choose(Choice::LastRamp(fields.number("ramp"))),
        Op::Pass => Action::Choose(Choice::Pass(f64::from(fields.number("percent")) / 1000.0)),
        Op::Out => Action::Output { port: fields.port(), mask: fields.mask(), time: None },
        Op::Outp => {
            Action::Output { port: fields.port(), mask: fields.mask(), time: Some(tenths(fields.number("time"))) }
        }
        Op::Outc => Action::OutputCounter { port: fields.port(), counter: fields.index("counter") },
        Op::Inpc => Action::InputCounter { port: fields.port(), counter: fields.index("counter") },
        Op::Iout => Action::Internal { port: fields.index("port"), mask: fields.mask() },
        Op::Outs => Action::OutputAt {
            task: fields.index("task"),
            port: fields.port(),
            mask: fields.mask(),
            axis: fields.axis("axis").unwrap_or_default(),
            at_least: fields.is("compare", ">="),
            place: fields.millimetres("place"),
        },
        Op::Cans => Action::CancelOutputs { task: fields.index("task") },
        Op::Mov => Action::Move(fields.motion(fields.coordinates())),
        Op::Movp | Op::Mve => Action::Move(Move { escape: row.op == Op::Mve, ..fields.motion(fields.row()) }),
        Op::Mvb => Action::Move(fields.motion(Target::Back)),
        // RSMV always passes its point (ambiguity R4).
        Op::Rsmv => Action::Move(Move { pass: true, ..fields.motion(Target::Host) }),
        Op::Mvm => {
            let group = Target::Group { group: fields.number("group"), approach: fields.is("target", "APPR") };
            Action::Move(fields.motion(group))
        }
        Op::Mvc => Action::Arc(fields.motion(fields.coordinates())),
        Op::Mvcp => Action::Arc(fields.motion(fields.row())),
        Op::Mini => Action::BeginGroup { group: fields.number("group") },
        Op::Loop => {
            Action::Loop { group: fields.number("group"), more: fields.index("then"), done: fields.index("else") }
        }
        Op::Ofs => Action::Offset(fields.coordinates()),
        Op::Ofsp => Action::Offset(fields.row()),
        Op::Svon => Action::Servo { axis: fields.axis("axes"), on: true },
        Op::Svof => Action::Servo { axis: fields.axis("axes"), on: false },
        Op::Tlmv => Action::Torque(Torque {
            axis: fields.axis("axis").unwrap_or_default(),
            table: fields.number("table"),
            judge: tenths(fields.number("time")),
            torque_end: fields.is("torque_end", "ON"),
            lock_end: fields.is("lock_end", "ON"),
            arrival_end: fields.is("arrival_end", "ON"),
            overflow: fields.is("overflow", "ON"),
        }),
        Op::Tstr => fields.task(TaskOrder::Start),
        Op::Tsto => fields.task(TaskOrder::Stop),
        Op::Trsa => fields.task(TaskOrder::GoOn),
        Op::Tcan => fields.task(TaskOrder::Cancel),
    }
}

/// Index of an axis by its letter in the protocol: X is the first axis.
pub(super) fn axis(letter: &str) -> Option<usize> {
    ["X", "Y", "Z", "R"].iter().position(|other| *other == letter)
}

/// Converts 0.01 mm to mm.
pub(super) fn place(hundredths: [i32; AXES]) -> Coordinates {
    hundredths.map(|value| f64::from(value) / 100.0)
}

struct Fields<'a>(&'a Record);

impl Fields<'_> {
    fn number(&self, name: &str) -> i32 {
        self.0.number(name).unwrap_or_default()
    }

    fn index(&self, name: &str) -> usize {
        index(self.number(name))
    }

    fn small(&self, name: &str) -> u16 {
        u16::try_from(self.number(name)).unwrap_or_default()
    }

    fn is(&self, name: &str, word: &str) -> bool {
        self.0.word(name) == Some(word)
    }

    fn mask(&self) -> Mask {
        self.0.mask("data").unwrap_or_default()
    }

    fn port(&self) -> Port {
        Port { station: self.index("station"), port: self.index("port") }
    }

    fn axis(&self, name: &str) -> Option<usize> {
        axis(self.0.word(name)?)
    }

    fn millimetres(&self, name: &str) -> f64 {
        f64::from(self.number(name)) / 100.0
    }

    fn coordinates(&self) -> Target {
        Target::Coordinates(["x", "y", "z", "r"].map(|name| self.millimetres(name)))
    }

    fn row(&self) -> Target {
        Target::Row { point: self.number("point"), counter: self.index("counter") }
    }

    fn count(&self, change: Change) -> Action {
        Action::Count { counter: self.index("counter"), change }
    }

    fn task(&self, order: TaskOrder) -> Action {
        Action::Task { task: self.index("task") - 1, order }
    }

    fn motion(&self, to: Target) -> Move {
        Move {
            to,
            incremental: self.is("aim", "i"),
            line: self.is("course", "T"),
            speed: self.number("speed"),
            pass: self.is("arrival", "PASS"),
            escape: false,
        }
    }

    /// Returns the condition that the fields define: a comparison tests a counter or a timer, a mask tests a port.
    fn test(&self) -> Test {
        let any = self.is("logic", "OR");
        if let Some(word) = self.0.word("compare") {
            let compare = Compare::named(word);
            return match self.0.number("timer") {
                Some(timer) => Test::Timer { timer: index(timer), compare, tenths: self.number("time").unsigned_abs() },
                None => Test::Counter { counter: self.index("counter"), compare, count: self.small("count") },
            };
        }
        match (self.0.mask("data"), self.0.number("station")) {
            (Some(mask), Some(_)) => Test::Input { port: self.port(), mask, any },
            (Some(mask), None) => Test::Internal { port: self.index("port"), mask, any },
            _ => Test::Always,
        }
    }
}

fn tenths(tenths: i32) -> Duration {
    Duration::from_millis(100 * u64::from(tenths.unsigned_abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::toyo::request::instruction;

    fn of(text: &str) -> Action {
        let record = instruction(text).unwrap();
        action(Instruction::named(text.split(' ').next().unwrap()).unwrap(), &record)
    }

    #[test]
    fn steps_become_actions() {
        let port = Port { station: 0, port: 1 };
        let bit = Mask { care: 1, bits: 1 };
        assert_eq!(of("OUT STN=0 PN01=.......1"), Action::Output { port, mask: bit, time: None });
        assert_eq!(
            of("JMPC TAG=005 CN02<=0010"),
            Action::Jump { tag: 5, when: Test::Counter { counter: 2, compare: Compare::AtMost, count: 10 } }
        );
        assert_eq!(
            of("CALT TAG=001 TN3> 001.5"),
            Action::Call { tag: 1, when: Test::Timer { timer: 3, compare: Compare::More, tenths: 15 } }
        );
        assert_eq!(of("IN STN=0 PN01=.......1 OR"), Action::Wait(Test::Input { port, mask: bit, any: true }));
        assert_eq!(of("INSP PN1=.......1 AND"), Action::Wait(Test::Internal { port: 1, mask: bit, any: false }));
        assert_eq!(of("CNT- CN01=0003"), Action::Count { counter: 1, change: Change::Add(-3) });
        assert_eq!(of("SVOF R"), Action::Servo { axis: Some(3), on: false });
        assert_eq!(of("SVON ALL"), Action::Servo { axis: None, on: true });
        let back = Move { to: Target::Back, incremental: false, line: true, speed: 3, pass: true, escape: false };
        assert_eq!(of("MVB T V=03 PASS"), Action::Move(back));
        assert_eq!(of("TCAN TASK=03"), Action::Task { task: 2, order: TaskOrder::Cancel });
    }
}
