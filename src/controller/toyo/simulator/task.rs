//! Task state: current step and wait condition.

use super::action::{Move, Test, Torque};
use super::motion::Coordinates;
use super::routine::Routine;
use crate::Now;
use crate::simulator::with_defaults;

/// Wait condition of a running task.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Wait {
    /// The task executes its step at this time.
    Ready(Now),
    /// The task waits until this time.
    Until(Now),
    /// The task moves to a pass point. The next step begins at this time, during the deceleration of the move.
    Pass(Now),
    /// The task waits for the end of its move.
    Motion,
    /// The task waits for the end of its move. Then the program ends.
    End,
    Test(Test),
    /// The task waits for coordinates from the host.
    Host(Move),
}

/// How a task continues after a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Flow {
    /// Continues with the next step.
    Next,
    /// Continues with this step.
    To(usize),
    /// Waits. Continues with this step after the wait.
    Wait(Wait, usize),
    /// Stops. After a restart, the task continues with the next step.
    Stop,
    End,
}

with_defaults! {
    #[derive(Debug, Clone)]
    pub(super) struct Task {
        /// Whether the program of the task was started and has not ended.
        pub(super) running: bool,
        /// Whether TSTO stopped the task.
        pub(super) stopped: bool,
        /// Current step, from 1.
        pub(super) step: usize = 1,
        /// Step with which the task continues after the wait.
        pub(super) next: usize = 1,
        pub(super) wait: Wait = Wait::Ready(Now::ZERO),
        /// Steps with which the task continues after each called subroutine.
        pub(super) stack: Vec<usize>,
        /// Row of the speed table for the next moves.
        pub(super) speed: i32 = 1,
        /// Rows of the acceleration table for the two ramps of the next moves.
        pub(super) ramps: [i32; 2] = [1, 1],
        /// Share of the deceleration during which the next move already runs, at pass points.
        pub(super) pass: f64 = 1.0,
        pub(super) offset: Coordinates,
        /// Position at the start of the last move.
        pub(super) from: Option<Coordinates>,
        /// Torque limit of the next move.
        pub(super) torque: Option<Torque>,
        /// Torque limit of the current move.
        pub(super) limited: Option<Torque>,
        /// Whether the escape input ends the current move.
        pub(super) escape: bool,
        /// Coordinates from the host that no move has used yet, with their row of the speed table.
        pub(super) supplied: Option<(Coordinates, i32)>,
        pub(super) routine: Option<Routine>,
        /// Whether the routine runs a part of the program at present.
        pub(super) called: bool,
    }
}

impl Task {
    /// Resets the task to the state before its first start.
    pub(super) fn reset(&mut self) {
        let mut stack = std::mem::take(&mut self.stack);
        stack.clear();
        *self = Self { stack, ..Self::default() };
    }

    pub(super) fn start(&mut self, step: usize, now: Now) {
        self.running = true;
        self.step = step;
        self.wait = Wait::Ready(now);
    }

    /// Time of the next action of the task.
    pub(super) fn due(&self) -> Option<Now> {
        match self.wait {
            Wait::Ready(at) | Wait::Until(at) | Wait::Pass(at) if self.running && !self.stopped => Some(at),
            _ => None,
        }
    }
}
