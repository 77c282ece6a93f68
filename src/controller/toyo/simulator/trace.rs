//! Event trace of a program run.

use std::collections::{BTreeMap, VecDeque};

use super::io::Port;
use super::motion::Coordinates;
use crate::Now;

/// Maximum number of stored events. The oldest events are dropped.
const MOST: usize = 1 << 16;

/// A timed event.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// Time of the event.
    pub at: Now,
    /// Axis coordinates at this time, in mm.
    pub position: [f64; 4],
    /// The event.
    pub what: What,
}

/// Kind of event.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum What {
    /// A task begins a step.
    Step {
        /// 1 to 4.
        task: usize,
        /// From 1.
        step: usize,
    },
    /// An output port has changed.
    Output {
        /// 0 to 4.
        station: usize,
        /// From 1.
        port: usize,
        /// Bit 1 of the manual is the least significant.
        bits: u8,
    },
    /// An error occurred; codes as in TO 4-1.
    Error(u8),
    /// Programs have stopped and can continue.
    Stopped,
    /// A task, 1 to 4, has ended.
    Ended(usize),
    /// The return to origin is complete.
    Origin,
    /// A scheduled console line could not be executed.
    Console(String),
}

/// Recorder of events.
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

    /// Records output ports that have changed since the last call. Initially, all outputs are off.
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
