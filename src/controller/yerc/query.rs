//! Typed queries: each query builds its request and decodes its answer.
//!
//! A query cannot be built with numbers that the model does not have. Extended variables are an exception, because
//! their number is a parameter of the controller.

mod control;
mod read;
mod signals;
mod variable;

pub use control::{
    CancelError, Hlock, Hold, MoveCartesian, MoveKind, MovePulse, ResetAlarm, Say, SelectJob, Selection, Servo,
    SetCycle, StartJob,
};
pub use read::{
    AlarmClass, Coordinates, ReadAlarm, ReadAlarmHistory, ReadAxes, ReadField, ReadJob, ReadManagementTime,
    ReadPosition, ReadPositionError, ReadStatus, ReadSystemInfo, ReadTorque, SystemPart, TimeCounter,
};
pub use signals::{
    ReadIo, ReadIoGroups, ReadRegister, ReadRegisters, WriteIo, WriteIoGroups, WriteRegister, WriteRegisters,
};
pub use variable::{ReadVariable, ReadVariables, WriteField, WriteVariable, WriteVariables};

use thiserror::Error;

use super::Model;
use super::group::Group;
use super::payload::{PayloadError, Reader, TextError};
use super::request::{Request, RequestError};
use super::table::service;
use crate::Risk;

/// A request to the robot server and its answer.
pub trait Query {
    /// Content of the answer.
    type Answer;

    /// Builds the request. It passes [`Request::check`] for the model of the query.
    fn request(&self) -> Request;

    /// Decodes the data of an answer. The controller must have accepted the request.
    fn decode(&self, data: &[u8]) -> Result<Self::Answer, PayloadError>;

    /// Risk of the request.
    fn risk(&self) -> Risk {
        self.request().risk()
    }
}

/// A query whose answer contains only its status.
pub trait WriteQuery {
    /// Builds the request like [`Query::request`].
    fn write_request(&self) -> Request;
}

impl<W: WriteQuery> Query for W {
    type Answer = ();

    fn request(&self) -> Request {
        self.write_request()
    }

    fn decode(&self, _: &[u8]) -> Result<(), PayloadError> {
        Ok(())
    }
}

/// Why a query cannot be built.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum QueryError {
    /// A control group that does not exist.
    #[error("{group} does not exist on a {model}; it has R1-R{robots}, B1-B{bases}, S1-S{stations}",
        robots = Group::counts(*.model).0, bases = Group::counts(*.model).1, stations = Group::counts(*.model).2)]
    Group {
        /// The group in the query.
        group: Group,
        /// The model of the controller.
        model: Model,
    },
    /// A control group that this query does not support.
    #[error("{group} cannot be used here: {reason}")]
    GroupKind {
        /// The group in the query.
        group: Group,
        /// The reason.
        reason: &'static str,
    },
    /// A task that does not exist.
    #[error("task {task} does not exist on a {model}; it has tasks 0 (master) to {last}")]
    Task {
        /// The task in the query.
        task: u8,
        /// The model of the controller.
        model: Model,
        /// Last valid task.
        last: u8,
    },
    /// A number out of range.
    #[error("{what} is {found}; allowed: {first} to {last}")]
    Range {
        /// What the number is.
        what: &'static str,
        /// The number in the query.
        found: u32,
        /// Minimum.
        first: u32,
        /// Maximum.
        last: u32,
    },
    /// A text that does not fit its field.
    #[error("{what}: {error}")]
    Text {
        /// What the text is.
        what: &'static str,
        /// The reason.
        error: TextError,
    },
    /// A name that is missing.
    #[error("{what} is empty")]
    Empty {
        /// Which text is missing.
        what: &'static str,
    },
    /// A speed class that does not fit the kind of move.
    #[error("a {motion} move needs its speed in {expected}")]
    SpeedClass {
        /// Kind of move: link or straight.
        motion: &'static str,
        /// Valid classes.
        expected: &'static str,
    },
    /// Coordinates that are not valid for a move.
    #[error("a cartesian move needs base, robot, user or tool coordinates")]
    Coordinate,
    /// Bits that are reserved in the manuals.
    #[error("{what} has reserved bits set: {bits:#x}")]
    Reserved {
        /// Name of the word.
        what: &'static str,
        /// The bits.
        bits: u32,
    },
    /// Several values for one plural write have different kinds.
    #[error("a plural write needs at least one value, and all values must have the same type")]
    MixedKinds,
    /// The request violates the command table.
    #[error(transparent)]
    Request(#[from] RequestError),
}

/// A query whose request is valid for the model.
fn checked<Q: Query>(model: Model, query: Q) -> Result<Q, QueryError> {
    query.request().check(model)?;
    Ok(query)
}

/// Builds a request that reads. A read has no data.
fn reading(command: u16, instance: u16, attribute: u8, service: u8) -> Request {
    Request { command, instance, attribute, service, data: Vec::new() }
}

fn read_all(command: u16, instance: u16) -> Request {
    reading(command, instance, 0, service::GET_ALL)
}

/// A request that writes the only field of an instance.
fn write_one(command: u16, instance: u16, data: impl Into<Vec<u8>>) -> Request {
    Request { command, instance, attribute: 1, service: service::SET_SINGLE, data: data.into() }
}

fn read_plural(command: u16, first: u16, count: u16) -> Request {
    let data = u32::from(count).to_le_bytes().to_vec();
    Request { command, instance: first, attribute: 0, service: service::READ_PLURAL, data }
}

/// Builds a request that writes `count` consecutive elements.
fn write_plural(command: u16, first: u16, count: usize, elements: impl IntoIterator<Item = u8>) -> Request {
    // A count that does not fit 32 bits becomes the maximum. The check after the construction then refuses it.
    let mut data = u32::try_from(count).unwrap_or(u32::MAX).to_le_bytes().to_vec();
    data.extend(elements);
    Request { command, instance: first, attribute: 0, service: service::WRITE_PLURAL, data }
}

/// The elements of a plural answer. Their number must be the requested count.
fn elements<'a>(
    what: &'static str,
    data: &'a [u8],
    asked: u16,
    size: usize,
) -> Result<impl Iterator<Item = &'a [u8]>, PayloadError> {
    let mut reader = Reader::new(what, data);
    let answered = reader.u32()?;
    if answered != u32::from(asked) {
        return Err(PayloadError::Count { what, asked: asked.into(), answered });
    }
    Ok(reader.bytes(size.saturating_mul(usize::from(asked)))?.chunks_exact(size))
}

/// Refuses a group that the model does not have.
fn known_group(model: Model, group: Group) -> Result<Group, QueryError> {
    if group.exists_on(model) { Ok(group) } else { Err(QueryError::Group { group, model }) }
}

/// Number of the last task; task 0 is the master task.
const fn last_task(model: Model) -> u8 {
    match model {
        Model::Fs100 => 5,
        Model::Dx100 | Model::Dx200 | Model::Yrc1000 => 15,
    }
}

fn known_task(model: Model, task: u8) -> Result<u8, QueryError> {
    let last = last_task(model);
    if task <= last { Ok(task) } else { Err(QueryError::Task { task, model, last }) }
}

fn in_range(what: &'static str, found: u32, first: u32, last: u32) -> Result<u32, QueryError> {
    if (first..=last).contains(&found) { Ok(found) } else { Err(QueryError::Range { what, found, first, last }) }
}
