//! Answer of a controller in WO0 to WO15.

use std::fmt;

use super::alarm::{Alarm, STOP_INPUT};
use super::codec::{self, Side, WordError};
use super::image::Words;
use super::order::Order;
use super::table::{DurationClass, Field};
use super::value::{Value, Values};

/// Status of a remote command in WO0 (chapter 2, 1.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Status {
    /// 0x0000: the controller is ready for a command.
    Ready,
    /// 0x0100: a command runs. The controller may skip this status for a short command.
    Running,
    /// 0x0200: the command was carried out. For the start of a program, only the start was accepted.
    NormalEnd,
    /// 0x4000: the command was refused or aborted, with an alarm.
    AbnormalEnd,
    /// A value that is not in the manual.
    Other(u16),
}

impl Status {
    /// Decodes WO0.
    pub const fn from_word(word: u16) -> Self {
        match word {
            0x0000 => Self::Ready,
            0x0100 => Self::Running,
            0x0200 => Self::NormalEnd,
            0x4000 => Self::AbnormalEnd,
            other => Self::Other(other),
        }
    }

    /// Value of WO0.
    pub const fn word(self) -> u16 {
        match self {
            Self::Ready => 0x0000,
            Self::Running => 0x0100,
            Self::NormalEnd => 0x0200,
            Self::AbnormalEnd => 0x4000,
            Self::Other(word) => word,
        }
    }

    /// Whether the command has ended.
    pub const fn is_end(self) -> bool {
        matches!(self, Self::NormalEnd | Self::AbnormalEnd)
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ready => f.write_str("ready"),
            Self::Running => f.write_str("running"),
            Self::NormalEnd => f.write_str("normal end"),
            Self::AbnormalEnd => f.write_str("abnormal end"),
            Self::Other(word) => write!(f, "undocumented status {word:#06X}"),
        }
    }
}

/// Answer to an order. A refusal is also an answer.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// The command still runs. Only continuous output has values.
    Running(Values),
    /// The command was carried out.
    Done(Values),
    /// The command was refused or aborted.
    Refused {
        /// Alarm that gives the reason.
        alarm: Alarm,
        /// Final position, if the command is a jog that was stopped (4.2.6).
        positions: Values,
    },
}

impl Answer {
    /// Decodes the answer to `order`; `None` if WO0 contains no answer. Accepts any words, and keeps unknown numbers.
    pub fn parse(order: &Order, words: &Words) -> Option<Self> {
        let collect = || fields(order, words).map(|(field, value)| (field.key, value)).collect();
        let none = Values::default;
        match Status::from_word(words[0]) {
            Status::Running if order.is_continuous() => Some(Self::Running(collect())),
            Status::Running => Some(Self::Running(none())),
            Status::NormalEnd => Some(Self::Done(collect())),
            Status::AbnormalEnd => {
                let alarm = Alarm::new(words[1], words[2]);
                let positions = if is_stopped_jog(order, alarm) { collect() } else { none() };
                Some(Self::Refused { alarm, positions })
            }
            Status::Ready | Status::Other(_) => None,
        }
    }

    /// Encodes the answer to `order` as a controller does.
    pub fn words(&self, order: &Order) -> Result<Words, WordError> {
        let encode = |values| codec::encode(Side::Answer, order.row().answer(), values, Some(order.values()));
        let (status, mut words) = match self {
            Self::Running(values) if order.is_continuous() => (Status::Running, encode(values)?),
            Self::Running(_) => (Status::Running, [0; 16]),
            Self::Done(values) => (Status::NormalEnd, encode(values)?),
            Self::Refused { alarm, positions } => {
                let mut words = if is_stopped_jog(order, *alarm) { encode(positions)? } else { [0; 16] };
                words[1] = alarm.group;
                words[2] = alarm.category;
                (Status::AbnormalEnd, words)
            }
        };
        words[0] = status.word();
        Ok(words)
    }
}

/// Whether an abnormal end contains positions.
pub(super) fn is_stopped_jog(order: &Order, alarm: Alarm) -> bool {
    order.row().pace == DurationClass::Jog && alarm == STOP_INPUT
}

/// The fields and values of an answer to `order`. The words can have any content.
pub fn fields<'a>(order: &'a Order, words: &'a Words) -> impl Iterator<Item = (&'static Field, Value)> + 'a {
    codec::read(order.row().answer(), words, Some(order.values()))
}
