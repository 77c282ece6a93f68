//! Control commands: reset, hold, servo, cycle, message, job, move (3.3.19 to 3.3.24, 3.3.39, 3.3.40).

use super::{QueryError, WriteQuery, checked, in_range, known_task, write_one};
use crate::refuse_if;
use crate::yerc::Model;
use crate::yerc::group::Group;
use crate::yerc::payload::{CartesianMove, CycleMode, PulseMove, SpeedClass, Text};
use crate::yerc::request::Request;
use crate::yerc::table::service;

/// Maximum speed of a link move, in 0.01 %.
const FULL_SPEED: u32 = 10_000;
/// Maximum tool and user coordinate number.
const LAST_FRAME: u32 = 63;
/// Maximum length of a message in bytes. The field has two more bytes, which the pendant does not display.
const MAX_MESSAGE: usize = 30;
/// Maximum line number.
const LAST_LINE: u32 = 9999;
/// Form bits that a move uses; bits 6 and 7 are reserved.
const MOVE_FORM: u32 = 0b11_1111;
const MOVE_EXTENDED_FORM: u32 = 0b1_1111;

macro_rules! order {
    ($(#[$doc:meta])* $name:ident $(($field:ty))?, |$this:ident| $request:expr) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub struct $name $((
            /// The requested state or mode.
            pub $field,
        ))?;

        impl WriteQuery for $name {
            fn write_request(&self) -> Request {
                let $this = self;
                $request
            }
        }
    };
}

/// Builds a request of command 0x83. The data word is 1 for on and 2 for off.
fn switch(instance: u16, on: bool) -> Request {
    let word: u32 = if on { 1 } else { 2 };
    write_one(0x83, instance, word.to_le_bytes())
}

fn execute(command: u16, instance: u16) -> Request {
    write_one(command, instance, 1_u32.to_le_bytes())
}

order! {
    /// Resets an alarm (0x82).
    ResetAlarm, |_this| execute(0x82, 1)
}
order! {
    /// Cancels an error (0x82).
    CancelError, |_this| execute(0x82, 2)
}
order! {
    /// Applies or releases HOLD (0x83).
    Hold(bool), |this| switch(1, this.0)
}
order! {
    /// Switches servo power (0x83).
    Servo(bool), |this| switch(2, this.0)
}
order! {
    /// Locks or unlocks the pendant and the I/O operation signals (0x83).
    Hlock(bool), |this| switch(3, this.0)
}
order! {
    /// Sets the cycle mode (0x84).
    SetCycle(CycleMode), |this| write_one(0x84, 2, this.0.word().to_le_bytes())
}
order! {
    /// Starts the selected job (0x86).
    StartJob, |_this| execute(0x86, 1)
}

/// Displays a message on the pendant (0x85).
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Say {
    text: Text<32>,
}

impl Say {
    /// A message of at most 30 bytes in the pendant encoding. An empty message clears the display.
    pub fn new(text: &[u8]) -> Result<Self, QueryError> {
        Text::<MAX_MESSAGE>::new(text).map_err(|error| QueryError::Text { what: "the message", error })?;
        Ok(Self { text: Text::cut(text) })
    }
}

impl WriteQuery for Say {
    fn write_request(&self) -> Request {
        write_one(0x85, 1, self.text.emit())
    }
}

/// Purpose for which a job is selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Selection {
    /// The job is executed from a line on.
    Execute {
        /// Line number, 0 to 9999.
        line: u32,
    },
    /// The job becomes the master job of a task, 0 to 5 on FS100, 0 to 15 on DX200.
    Master {
        /// Task number.
        task: u8,
    },
}

/// Selects a job (0x87).
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct SelectJob {
    name: Text<32>,
    instance: u16,
    line: u32,
}

impl SelectJob {
    /// Selects a job by its name of 1 to 32 bytes in the pendant encoding, without `.JBI`.
    pub fn new(model: Model, name: &[u8], selection: Selection) -> Result<Self, QueryError> {
        refuse_if(name.is_empty(), QueryError::Empty { what: "the job name" })?;
        let name = Text::new(name).map_err(|error| QueryError::Text { what: "the job name", error })?;
        let (instance, line) = match selection {
            Selection::Execute { line } => (1, in_range("the line number", line, 0, LAST_LINE)?),
            Selection::Master { task } => (10 + u16::from(known_task(model, task)?), 0),
        };
        checked(model, Self { name, instance, line })
    }
}

impl WriteQuery for SelectJob {
    fn write_request(&self) -> Request {
        let mut data = self.name.emit().to_vec();
        data.extend_from_slice(&self.line.to_le_bytes());
        Request { command: 0x87, instance: self.instance, attribute: 0, service: service::SET_ALL, data }
    }
}

/// Kind of move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MoveKind {
    /// Joint interpolation to a position.
    Link,
    /// Straight line to a position.
    Straight,
    /// Straight line by a distance. Only possible in cartesian coordinates.
    Incremental,
}

impl MoveKind {
    const fn instance(self) -> u16 {
        match self {
            Self::Link => 1,
            Self::Straight => 2,
            Self::Incremental => 3,
        }
    }
}

/// Moves to cartesian coordinates (0x8A).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct MoveCartesian {
    kind: MoveKind,
    target: CartesianMove,
}

impl MoveCartesian {
    /// Checks groups, speed, coordinate system, form, tool and user coordinate.
    pub fn new(model: Model, kind: MoveKind, target: CartesianMove) -> Result<Self, QueryError> {
        check_group(model, target.robot, target.station)?;
        check_speed(kind, target.class, target.speed)?;
        refuse_if(!target.coordinate.is_cartesian(), QueryError::Coordinate)?;
        check_bits("the form", target.form.0, MOVE_FORM)?;
        check_bits("the extended form", target.extended.0, MOVE_EXTENDED_FORM)?;
        in_range("the tool number", target.tool, 0, LAST_FRAME)?;
        in_range("the user coordinate number", target.user, 0, LAST_FRAME)?;
        checked(model, Self { kind, target })
    }
}

impl WriteQuery for MoveCartesian {
    fn write_request(&self) -> Request {
        moving(0x8A, self.kind, self.target.emit())
    }
}

/// Moves to a position in pulses (0x8B).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct MovePulse {
    kind: MoveKind,
    target: PulseMove,
}

impl MovePulse {
    /// Checks groups, speed and tool. A pulse move cannot be incremental.
    pub fn new(model: Model, kind: MoveKind, target: PulseMove) -> Result<Self, QueryError> {
        check_group(model, target.robot, target.station)?;
        check_speed(kind, target.class, target.speed)?;
        in_range("the tool number", target.tool, 0, LAST_FRAME)?;
        checked(model, Self { kind, target })
    }
}

impl WriteQuery for MovePulse {
    fn write_request(&self) -> Request {
        moving(0x8B, self.kind, self.target.emit())
    }
}

fn moving(command: u16, kind: MoveKind, data: Vec<u8>) -> Request {
    Request { command, instance: kind.instance(), attribute: 1, service: service::SET_ALL, data }
}

/// Requires either a robot or a station. Controllers refuse a move with both (added status B008).
fn check_group(model: Model, robot: u32, station: u32) -> Result<(), QueryError> {
    let (robots, _, stations) = Group::counts(model);
    match (robot, station) {
        (robot, 0) => in_range("the robot number", robot, 1, robots.into()).map(drop),
        (0, station) => in_range("the station number", station, 1, stations.into()).map(drop),
        (_, station) => in_range("the station number in addition to a robot number", station, 0, 0).map(drop),
    }
}

fn check_speed(kind: MoveKind, class: SpeedClass, speed: u32) -> Result<(), QueryError> {
    match (kind, class) {
        (MoveKind::Link, SpeedClass::Percent) => in_range("the speed (0.01 %)", speed, 1, FULL_SPEED).map(drop),
        (MoveKind::Straight | MoveKind::Incremental, SpeedClass::Linear) => {
            in_range("the speed (0.1 mm/s)", speed, 1, i32::MAX.unsigned_abs()).map(drop)
        }
        (MoveKind::Straight | MoveKind::Incremental, SpeedClass::Angular) => {
            in_range("the speed (0.1 deg/s)", speed, 1, i32::MAX.unsigned_abs()).map(drop)
        }
        (MoveKind::Link, _) => Err(QueryError::SpeedClass { motion: "link", expected: "percent" }),
        _ => Err(QueryError::SpeedClass { motion: "straight", expected: "mm/s or deg/s" }),
    }
}

fn check_bits(what: &'static str, word: u32, defined: u32) -> Result<(), QueryError> {
    match word & !defined {
        0 => Ok(()),
        bits => Err(QueryError::Reserved { what, bits }),
    }
}
