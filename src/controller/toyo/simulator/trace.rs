//! What happened, for those who watch a program run.

use std::collections::{BTreeMap, VecDeque};

use super::io::Port;
use super::motion::Coordinates;
use crate::Now;

/// Events that are kept; the oldest give way.
const MOST: usize = 1 << 16;

/// Something that happened.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// When.
    pub at: Now,
    /// Coordinates of the four axes then, in mm.
    pub position: [f64; 4],
    /// What.
    pub what: What,
}

/// What happened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum What {
    /// A task begins a step.
    Step {
        /// 1 to 4.
        task: usize,
        /// From 1.
        step: usize,
    },
    /// A port of outputs changed.
    Output {
        /// 0 to 4.
        station: usize,
        /// From 1.
        port: usize,
        /// Bit 1 of the manual is the least significant.
        bits: u8,
    },
    /// An error came up; the code is of TO 4-1.
    Error(u8),
    /// Programs stand, and can go on.
    Stopped,
    /// A task came to its end, 1 to 4.
    Ended(usize),
    /// The axes came to rest after a return to origin.
    Origin,
    /// A line of the console that had been put off could not be carried out.
    Console(String),
}

/// The events, while somebody watches.
#[derive(Debug, Clone, Default)]
pub(super) struct Trace {
    events: Option<VecDeque<Event>>,
    shown: BTreeMap<Port, u8>,
}

impl Trace {
    pub(super) fn watch(&mut self, on: bool) {
        self.events = on.then(VecDeque::new);
    }

    pub(super) const fn is_watched(&self) -> bool {
        self.events.is_some()
    }

    pub(super) fn record(&mut self, at: Now, position: Coordinates, what: What) {
        let Some(events) = &mut self.events else { return };
        if events.len() >= MOST {
            events.pop_front();
        }
        events.push_back(Event { at, position, what });
    }

    /// Notes the output ports that have changed since the last time; at first all are off.
    pub(super) fn outputs(&mut self, at: Now, position: Coordinates, outputs: impl Iterator<Item = (Port, u8)>) {
        for (port, bits) in outputs {
            if self.shown.insert(port, bits).unwrap_or_default() != bits {
                self.record(at, position, What::Output { station: port.station, port: port.port, bits });
            }
        }
    }

    pub(super) fn take(&mut self) -> Vec<Event> {
        self.events.as_mut().map(|events| events.drain(..).collect()).unwrap_or_default()
    }
}
