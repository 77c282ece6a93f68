//! Read queries.

use super::{Query, QueryError, checked, in_range, known_group, known_task, read_all, reading};
use crate::yerc::Model;
use crate::yerc::group::Group;
use crate::yerc::payload::{
    Alarm, Axes, AxisNames, ControllerStatus, JobInfo, ManagementTime, PayloadError, Position, SystemInfo,
};
use crate::yerc::request::Request;
use crate::yerc::table::{Row, service, total};

macro_rules! read_all {
    ($(#[$doc:meta])* $name:ident, $command:literal, $answer:ty) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub struct $name {
            instance: u16,
        }

        impl Query for $name {
            type Answer = $answer;

            fn request(&self) -> Request {
                read_all($command, self.instance)
            }

            fn decode(&self, data: &[u8]) -> Result<$answer, PayloadError> {
                <$answer>::parse(data)
            }
        }
    };
}

/// Reads both status words (0x72).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ReadStatus;

impl Query for ReadStatus {
    type Answer = ControllerStatus;

    fn request(&self) -> Request {
        read_all(0x72, 1)
    }

    fn decode(&self, data: &[u8]) -> Result<ControllerStatus, PayloadError> {
        ControllerStatus::parse(data)
    }
}

/// Reads one of up to four active alarms (0x70; with texts 0x30A).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ReadAlarm {
    slot: u8,
    texts: bool,
}

impl ReadAlarm {
    /// Accepts alarm slots 1 to 4. Slot 1 is the latest alarm, slot 4 the fourth latest. Texts need a DX200 or FS1.14.
    pub fn new(slot: u8, texts: bool) -> Result<Self, QueryError> {
        in_range("alarm slot", slot.into(), 1, 4)?;
        Ok(Self { slot, texts })
    }
}

impl Query for ReadAlarm {
    type Answer = Alarm;

    fn request(&self) -> Request {
        read_all(if self.texts { 0x30A } else { 0x70 }, self.slot.into())
    }

    fn decode(&self, data: &[u8]) -> Result<Alarm, PayloadError> {
        if self.texts { Alarm::parse_with_texts(data) } else { Alarm::parse(data) }
    }
}

/// Lists of past alarms (3.3.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum AlarmClass {
    /// Major failures.
    Major,
    /// Monitor alarms.
    Monitor,
    /// User alarms that the system defines.
    UserSystem,
    /// User alarms that the user defines.
    User,
    /// Off-line alarms.
    OffLine,
}

impl AlarmClass {
    /// All classes with their names in commands, in the order of the manual.
    pub const ALL: [(Self, &'static str); 5] = [
        (Self::Major, "major"),
        (Self::Monitor, "monitor"),
        (Self::UserSystem, "user-system"),
        (Self::User, "user"),
        (Self::OffLine, "off-line"),
    ];

    const fn base(self) -> u16 {
        match self {
            Self::Major => 0,
            Self::Monitor => 1000,
            Self::UserSystem => 2000,
            Self::User => 3000,
            Self::OffLine => 4000,
        }
    }
}

/// Reads a past alarm (0x71; with texts 0x30B).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ReadAlarmHistory {
    class: AlarmClass,
    number: u8,
    texts: bool,
}

impl ReadAlarmHistory {
    /// Accepts entries 1 to 100 of the history. Texts need a DX200 or FS1.14.
    pub fn new(class: AlarmClass, number: u8, texts: bool) -> Result<Self, QueryError> {
        in_range("alarm number", number.into(), 1, 100)?;
        Ok(Self { class, number, texts })
    }
}

impl Query for ReadAlarmHistory {
    type Answer = Alarm;

    fn request(&self) -> Request {
        read_all(if self.texts { 0x30B } else { 0x71 }, self.class.base() + u16::from(self.number))
    }

    fn decode(&self, data: &[u8]) -> Result<Alarm, PayloadError> {
        if self.texts { Alarm::parse_with_texts(data) } else { Alarm::parse(data) }
    }
}

read_all! {
    /// Reads the current job of a task (0x73).
    ReadJob, 0x73, JobInfo
}

impl ReadJob {
    /// Accepts a task of the model. Task 0 is the master task. Sub tasks are 1 to 5 on FS100, 1 to 15 on DX200.
    pub fn new(model: Model, task: u8) -> Result<Self, QueryError> {
        Ok(Self { instance: u16::from(known_task(model, task)?) + 1 })
    }
}

/// Coordinates of a position: pulses or cartesian.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Coordinates {
    /// Pulses of each axis.
    Pulse,
    /// X, Y, Z, Rx, Ry and Rz in base coordinates.
    Base,
}

/// Instance of a group in these coordinates.
fn instance(model: Model, group: Group, coordinates: Coordinates) -> Result<u16, QueryError> {
    known_group(model, group)?;
    match coordinates {
        Coordinates::Pulse => Ok(group.instance()),
        Coordinates::Base => {
            group.cartesian_instance().ok_or(QueryError::GroupKind { group, reason: "a station has only pulses" })
        }
    }
}

read_all! {
    /// Reads the axis names of a group (0x74).
    ReadAxes, 0x74, AxisNames
}

impl ReadAxes {
    /// Accepts a robot or base in pulses or base coordinates, and a station in pulses.
    pub fn new(model: Model, group: Group, coordinates: Coordinates) -> Result<Self, QueryError> {
        Ok(Self { instance: instance(model, group, coordinates)? })
    }
}

read_all! {
    /// Reads the current position of a group (0x75).
    ReadPosition, 0x75, Position
}

impl ReadPosition {
    /// Accepts any group in pulses, and a robot in base coordinates.
    pub fn new(model: Model, group: Group, coordinates: Coordinates) -> Result<Self, QueryError> {
        let instance = instance(model, group, coordinates)?;
        match (group, coordinates) {
            (Group::Base(_), Coordinates::Base) => {
                Err(QueryError::GroupKind { group, reason: "a base has only pulses" })
            }
            _ => Ok(Self { instance }),
        }
    }
}

read_all! {
    /// Reads the position error (deviation) of each axis in pulses (0x76).
    ReadPositionError, 0x76, Axes
}

impl ReadPositionError {
    /// Accepts any group of the model.
    pub fn new(model: Model, group: Group) -> Result<Self, QueryError> {
        Ok(Self { instance: known_group(model, group)?.instance() })
    }
}

read_all! {
    /// Reads the torque of each axis (0x77); the manuals do not specify the unit.
    ReadTorque, 0x77, Axes
}

impl ReadTorque {
    /// Accepts any group of the model.
    pub fn new(model: Model, group: Group) -> Result<Self, QueryError> {
        Ok(Self { instance: known_group(model, group)?.instance() })
    }
}

/// Subject of an operating-time counter (3.3.25).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TimeCounter {
    /// Time with control power on.
    ControlPower,
    /// Time with servo power on: of a robot or station, or in total.
    Servo(Option<Group>),
    /// Time of playback: of a robot or station, or in total.
    Playback(Option<Group>),
    /// Time of motion: of a robot or station, or in total.
    Motion(Option<Group>),
    /// Operating time of an application, 1 to 8.
    Application(u8),
}

read_all! {
    /// Reads an operating-time counter (0x88).
    ReadManagementTime, 0x88, ManagementTime
}

impl ReadManagementTime {
    /// Accepts any counter except those of bases, because bases have no counters.
    pub fn new(model: Model, counter: TimeCounter) -> Result<Self, QueryError> {
        let of = |base: u16, group: Option<Group>| match group {
            None => Ok(base + 10),
            Some(group @ Group::Base(_)) => {
                Err(QueryError::GroupKind { group, reason: "bases have no running-time counters" })
            }
            Some(group) => Ok(base + counter_offset(known_group(model, group)?)),
        };
        let instance = match counter {
            TimeCounter::ControlPower => 1,
            TimeCounter::Servo(group) => of(0, group)?,
            TimeCounter::Playback(group) => of(100, group)?,
            TimeCounter::Motion(group) => of(200, group)?,
            TimeCounter::Application(number) => {
                in_range("application", number.into(), 1, 8)?;
                300 + u16::from(number)
            }
        };
        checked(model, Self { instance })
    }
}

/// Subject of system information (3.3.26).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SystemPart {
    /// A robot or station.
    Group(Group),
    /// An application, from 1. An FS100 has one application, a DX200 has eight.
    Application(u8),
}

read_all! {
    /// Reads versions and names (0x89).
    ReadSystemInfo, 0x89, SystemInfo
}

impl ReadSystemInfo {
    /// Information of the first robot, which every model has.
    pub const FIRST_ROBOT: Self = Self { instance: counter_offset(Group::R1) };

    /// Accepts any part except bases, because bases have no system information.
    pub fn new(model: Model, part: SystemPart) -> Result<Self, QueryError> {
        let instance = match part {
            SystemPart::Group(group @ Group::Base(_)) => {
                return Err(QueryError::GroupKind { group, reason: "bases have no information" });
            }
            SystemPart::Group(group) => counter_offset(known_group(model, group)?),
            SystemPart::Application(number) => 100 + u16::from(number),
        };
        checked(model, Self { instance })
    }
}

/// Number of a group in counters and system information: robots count from 11, stations from 21.
const fn counter_offset(group: Group) -> u16 {
    match group {
        Group::Robot(number) => 10 + number as u16,
        _ => group.instance(),
    }
}

/// Reads one field of an instance, as bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ReadField {
    command: u16,
    instance: u16,
    attribute: u8,
    size: usize,
}

impl ReadField {
    /// Accepts an attribute number from 1. The number selects a field of the table row.
    pub fn new(model: Model, command: u16, instance: u16, attribute: u8) -> Result<Self, QueryError> {
        let request = reading(command, instance, attribute, service::GET_SINGLE);
        request.check(model)?;
        let size = Row::from_number(command)
            .and_then(|row| Some(total(row.fields_of(row.service(service::GET_SINGLE)?, attribute))))
            .unwrap_or_default();
        Ok(Self { command, instance, attribute, size })
    }
}

impl Query for ReadField {
    type Answer = Vec<u8>;

    fn request(&self) -> Request {
        reading(self.command, self.instance, self.attribute, service::GET_SINGLE)
    }

    fn decode(&self, data: &[u8]) -> Result<Vec<u8>, PayloadError> {
        let short = PayloadError::Short { what: "field", needed: self.size, found: data.len() };
        Ok(data.get(..self.size).ok_or(short)?.to_vec())
    }
}
