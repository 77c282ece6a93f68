//! Event trace of a program run.

use std::collections::{BTreeMap, VecDeque};

use super::io::Port;
use super::motion::Coordinates;
use crate::Now;

/// Maximum number of stored events. The oldest events are dropped.
const MAX_EVENTS: usize = 1 << 16;

/// A timed event.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// Time of the event.
    pub at: Now,
    /// Axis coordinates at this time, in mm.
    pub position: [f64; 4],
    /// Description of the event.
    pub what: What,
}

/// Kind of event.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum What {
    /// A task begins a step.
    Step {
        /// Task, 1 to 4.
        task: usize,
        /// Step, from 1.
        step: usize,
    },
    /// An output port has changed.
    Output {
        /// Station, 0 to 4.
        station: usize,
        /// Port, from 1.
        port: usize,
        /// State of the port. Bit 1 of the manual is the least significant bit.
        bits: u8,
    },
    /// An error with this code occurred (TO 4-1).
    Error(u8),
    /// Programs have stopped and can continue.
    Stopped,
    /// A task, 1 to 4, has ended.
    Ended(usize),
    /// The return to origin is complete.
    Origin,
    /// A console line of the start state could not be executed at its time. Contains the message.
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
        if events.len() >= MAX_EVENTS {
            events.pop_front();
        }
        events.push_back(Event { at, position, what });
    }

    /// Records the output ports that have changed since the last call. All outputs count as off before the first call.
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
