//! Alarms: sources, active alarms, history.
//!
//! The remote I/O manual has the numbers of a few alarms, and refers to the controller manual for the others. If the
//! number of an alarm is not known, its group is right, but its category is specific to this simulator: 900 and above.

use std::collections::VecDeque;
use std::fmt;

use crate::yrcx::alarm::Alarm;

pub(super) use crate::yrcx::alarm::{INPUT_FORMAT, STOP_INPUT};

/// Alarm numbers from the manual, or known from these controllers.
pub(super) const SOFT_LIMIT: Alarm = Alarm::new(2, 334);
pub(super) const UNKNOWN_COMMAND: Alarm = Alarm::new(12, 75);
pub(super) const NOT_ENABLED: Alarm = Alarm::new(12, 76);
/// The alarm for a lost link of EtherNet/IP.
pub(super) const LINK: Alarm = Alarm::new(12, 551);
pub(super) const EMERGENCY_STOP: Alarm = Alarm::new(12, 600);

/// Alarm numbers that are specific to this simulator.
pub(super) const NO_POWER: Alarm = Alarm::new(2, 901);
pub(super) const NO_ORIGIN: Alarm = Alarm::new(2, 902);
pub(super) const MOVING: Alarm = Alarm::new(2, 903);
pub(super) const NO_POINT: Alarm = Alarm::new(2, 904);
pub(super) const OUT_OF_REACH: Alarm = Alarm::new(2, 905);
pub(super) const NO_PATH: Alarm = Alarm::new(2, 906);
pub(super) const NO_ABSOLUTE_RESET: Alarm = Alarm::new(2, 907);
pub(super) const NO_PROGRAM: Alarm = Alarm::new(3, 901);
pub(super) const NO_ROBOT: Alarm = Alarm::new(4, 901);
pub(super) const NO_AXIS: Alarm = Alarm::new(4, 902);
pub(super) const NO_PALLET: Alarm = Alarm::new(4, 903);
pub(super) const NO_HAND: Alarm = Alarm::new(4, 904);
pub(super) const POINT_UNIT: Alarm = Alarm::new(4, 905);
pub(super) const NO_CONTROLLER: Alarm = Alarm::new(4, 906);
pub(super) const PAYLOAD: Alarm = Alarm::new(4, 907);
pub(super) const ARITHMETIC: Alarm = Alarm::new(6, 901);
pub(super) const NOT_AUTO: Alarm = Alarm::new(6, 902);
pub(super) const NO_TASK: Alarm = Alarm::new(6, 903);
pub(super) const RUNNING: Alarm = Alarm::new(6, 904);
pub(super) const CALLS: Alarm = Alarm::new(6, 905);

/// Number of entries of the history (4.7.7).
pub(super) const HISTORY: usize = 500;

/// Source of an alarm (4.7.7).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum AlarmSource {
    /// The whole controller.
    Controller,
    /// The option slot of the fieldbus.
    Slot,
    /// A robot, counted from 0.
    Robot(usize),
    /// An axis of a robot, both counted from 0.
    Axis(usize, usize),
    /// A task, 1 to 16.
    Task(u8),
}

impl AlarmSource {
    /// The two words with additional information about the source.
    pub(super) fn words(self) -> [u16; 2] {
        let small = |number: usize| u16::try_from(number).unwrap_or_default() & 0xFF;
        match self {
            Self::Controller => [0x0101, 0x0000],
            Self::Slot => [0x0101, 0x0301],
            Self::Robot(robot) => [small(robot + 1), 0x0000],
            Self::Axis(robot, axis) => [small(robot + 1), 0x0100 | small(axis + 1)],
            Self::Task(task) => [0x0200, 0x0400 | u16::from(task)],
        }
    }
}

impl fmt::Display for AlarmSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Controller => f.write_str("C1"),
            Self::Slot => f.write_str("C1O1"),
            Self::Robot(robot) => write!(f, "R{}", robot + 1),
            Self::Axis(robot, axis) => write!(f, "R{}A{}", robot + 1, axis + 1),
            Self::Task(task) => write!(f, "T{task}"),
        }
    }
}

/// Reason of a refusal or an abort.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fault {
    pub(super) alarm: Alarm,
    pub(super) place: AlarmSource,
    /// Details for the console.
    pub(super) why: String,
}

impl Fault {
    pub(super) fn new(alarm: Alarm, place: AlarmSource, why: impl Into<String>) -> Self {
        Self { alarm, place, why: why.into() }
    }

    pub(super) fn of_words(why: impl Into<String>) -> Self {
        Self::new(INPUT_FORMAT, AlarmSource::Slot, why)
    }

    pub(super) fn stopped() -> Self {
        Self::new(STOP_INPUT, AlarmSource::Slot, "SI(06) is off")
    }

    pub(super) fn emergency() -> Self {
        Self::new(EMERGENCY_STOP, AlarmSource::Controller, "the controller is in emergency stop")
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}: {}", self.alarm, self.place, self.why)
    }
}

pub(super) type Entry = (Alarm, AlarmSource);

/// Active alarms and history.
#[derive(Debug, Clone, Default)]
pub(super) struct AlarmLog {
    /// Active alarms. `true` means that only a power cycle clears the alarm.
    active: Vec<(Alarm, bool)>,
    history: VecDeque<Entry>,
    /// Latest alarm that a remote command caused (4.7.17).
    pub(super) latest_remote: Option<Entry>,
}

impl AlarmLog {
    /// Activates a serious alarm.
    pub(super) fn raise(&mut self, alarm: Alarm, place: AlarmSource, fatal: bool) {
        if self.active.iter().any(|(known, _)| *known == alarm) {
            return;
        }
        self.active.push((alarm, fatal));
        self.record(alarm, place);
    }

    /// Records an event in the history, without an active alarm.
    pub(super) fn record(&mut self, alarm: Alarm, place: AlarmSource) {
        self.history.push_front((alarm, place));
        self.history.truncate(HISTORY);
    }

    /// Records that a remote command was refused or aborted.
    pub(super) fn refuse(&mut self, fault: &Fault) {
        self.latest_remote = Some((fault.alarm, fault.place));
        // If an active alarm causes the refusal, the history already contains it.
        if !self.active.iter().any(|(known, _)| *known == fault.alarm) {
            self.record(fault.alarm, fault.place);
        }
    }

    /// Resets all alarms except those whose cause still exists.
    pub(super) fn reset(&mut self, still: impl Fn(Alarm) -> bool) {
        self.active.retain(|(alarm, fatal)| *fatal || still(*alarm));
    }

    /// Clears all alarms, as a power cycle does.
    pub(super) fn clear(&mut self) {
        self.active.clear();
    }

    pub(super) fn active(&self) -> Option<Alarm> {
        self.active.first().map(|(alarm, _)| *alarm)
    }

    pub(super) fn all_active(&self) -> impl Iterator<Item = Alarm> {
        self.active.iter().map(|(alarm, _)| *alarm)
    }

    /// Whether an active alarm requires a power cycle.
    pub(super) fn is_fatal(&self) -> bool {
        self.active.iter().any(|(_, fatal)| *fatal)
    }

    /// Entry of the history by its number; 1 is the newest entry.
    pub(super) fn entry(&self, number: usize) -> Option<Entry> {
        self.history.get(number.checked_sub(1)?).copied()
    }

    /// Appends an entry that is older than all others.
    pub(super) fn fill(&mut self, entry: Entry) {
        if self.history.len() < HISTORY {
            self.history.push_back(entry);
        }
    }

    pub(super) fn set_latest_remote(&mut self, entry: Entry) {
        self.latest_remote = Some(entry);
    }
}
