//! The current error, and the error history.

use std::collections::VecDeque;
use std::time::Duration;

/// Number of entries of the history (TO 2-8, EHTR).
const ENTRIES: usize = 99;

/// Error codes of the simulator (TO 4-1).
pub(super) mod code {
    use crate::toyo::simulator::motion::AXES;

    pub(in super::super) const EMERGENCY_STOP: u8 = 0x13;
    pub(in super::super) const ORIGIN_INCOMPLETE: u8 = 0x61;
    pub(in super::super) const UNEXECUTABLE: u8 = 0x62;
    pub(in super::super) const TASK_START: u8 = 0x63;
    pub(in super::super) const NOT_SYNCHRONIZED: u8 = 0x64;
    pub(in super::super) const SYNC_PARAMETER: u8 = 0x66;
    pub(in super::super) const COMMAND: u8 = 0xA0;
    pub(in super::super) const TAG_UNDEFINED: u8 = 0xA1;
    pub(in super::super) const TAG_TWICE: u8 = 0xA2;
    pub(in super::super) const STACK_FULL: u8 = 0xA3;
    pub(in super::super) const STACK_EMPTY: u8 = 0xA4;
    pub(in super::super) const ARC_DATA: u8 = 0xA5;
    pub(in super::super) const ARC_RADIUS: u8 = 0xA6;
    pub(in super::super) const CALCULATION: u8 = 0xA7;
    pub(in super::super) const PARAMETER: u8 = 0xA8;
    pub(in super::super) const STEP: u8 = 0xB0;
    pub(in super::super) const TAG_NUMBER: u8 = 0xB1;
    pub(in super::super) const PALLET: u8 = 0xB2;
    pub(in super::super) const PORT: u8 = 0xB5;
    pub(in super::super) const TABLE: u8 = 0xB6;
    pub(in super::super) const EASY: u8 = 0xB9;
    pub(in super::super) const TASK: u8 = 0xBA;
    pub(in super::super) const CARD: u8 = 0xE0;

    /// Whether an error switches servo power off and stops everything at once. Errors of the machine and of the axes do
    /// this, except soft limit errors.
    pub(in super::super) const fn takes_power(code: u8) -> bool {
        code < 0x20 || (code < 0x60 && !matches!(code & 0xF, 0x8 | 0x9))
    }

    /// Code of the error of an axis. `digit` is the second digit of the code; the axis gives the first.
    fn of_axis(axis: usize, digit: u8) -> u8 {
        0x20 + 0x10 * u8::try_from(axis.min(AXES)).unwrap_or_default() + digit
    }

    pub(in super::super) fn overload(axis: usize) -> u8 {
        of_axis(axis, 3)
    }

    pub(in super::super) fn overflow(axis: usize) -> u8 {
        of_axis(axis, 4)
    }

    pub(in super::super) fn homing(axis: usize) -> u8 {
        of_axis(axis, 7)
    }

    /// Code of the error that an axis is beyond a soft limit during a move.
    pub(in super::super) fn beyond(axis: usize, upwards: bool) -> u8 {
        of_axis(axis, if upwards { 8 } else { 9 })
    }

    /// Code of the error that a target is beyond a soft limit.
    pub(in super::super) fn target(axis: usize, upwards: bool) -> u8 {
        0xC0 + 2 * u8::try_from(axis.min(AXES)).unwrap_or_default() + u8::from(!upwards)
    }

    /// The axis whose origin is lost because of an encoder error. `None` for other errors.
    pub(in super::super) fn loses_origin(code: u8) -> Option<usize> {
        let axis = usize::from(code >> 4).checked_sub(2).filter(|axis| *axis < AXES)?;
        matches!(code & 0xF, 0x6 | 0xC | 0xD).then_some(axis)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Entry {
    /// An error and the power-on time of its occurrence.
    Error { code: u8, at: Duration },
    /// An entry for the time when power was switched off.
    PowerCut,
}

#[derive(Debug, Clone, Default)]
pub(super) struct Errors {
    pub(super) current: Option<u8>,
    /// History entries, newest first.
    history: VecDeque<Entry>,
}

impl Errors {
    /// Raises an error. The first error stays the current error until it is cancelled. The history contains all errors.
    pub(super) fn raise(&mut self, code: u8, at: Duration) {
        self.current = self.current.or(Some(code));
        self.record(Entry::Error { code, at });
    }

    pub(super) fn cancel(&mut self) {
        self.current = None;
    }

    pub(super) fn power_cut(&mut self) {
        self.current = None;
        self.record(Entry::PowerCut);
    }

    pub(super) fn record(&mut self, entry: Entry) {
        self.history.push_front(entry);
        self.history.truncate(ENTRIES);
    }

    /// An entry by its number; 1 is the newest.
    pub(super) fn entry(&self, number: usize) -> Option<Entry> {
        self.history.get(number.checked_sub(1)?).copied()
    }
}
