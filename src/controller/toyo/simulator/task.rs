//! Task state: current step and wait condition.

use super::action::{Move, Test, Torque};
use super::motion::Coordinates;
use super::routine::Routine;
use crate::Now;

/// Wait condition of a running task.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Wait {
    /// Executes its step at this time.
    Ready(Now),
    /// Waits until this time.
    Until(Now),
    /// Moves to a pass point. The next step begins at this time during the deceleration.
    Pass(Now),
    /// Waits for the end of its move.
    Motion,
    /// Waits for the end of its move, then ends the program.
    End,
    Test(Test),
    /// Waits for coordinates from the host.
    Host(Move),
}

/// How a task continues after a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Flow {
    /// The next step.
    Next,
    /// A certain step.
    To(usize),
    /// A certain step, after a wait.
    Wait(Wait, usize),
    /// Stops. After a restart, the next step follows.
    Stop,
    End,
}

#[derive(Debug, Clone)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent state")]
pub(super) struct Task {
    /// Started and not ended.
    pub(super) running: bool,
    /// Stopped by TSTO.
    pub(super) stopped: bool,
    /// From 1.
    pub(super) step: usize,
    /// Step that follows the wait.
    pub(super) next: usize,
    pub(super) wait: Wait,
    /// Steps to which the subroutines return.
    pub(super) stack: Vec<usize>,
    /// Row of the speed table.
    pub(super) speed: i32,
    /// Rows of the acceleration table.
    pub(super) ramps: [i32; 2],
    /// Share of the deceleration at pass points.
    pub(super) pass: f64,
    pub(super) offset: Coordinates,
    /// Start of the last move.
    pub(super) from: Option<Coordinates>,
    /// Torque limit of the next move.
    pub(super) torque: Option<Torque>,
    /// Torque limit of the current move.
    pub(super) limited: Option<Torque>,
    /// Whether the escape input ends the current move.
    pub(super) escape: bool,
    /// Coordinates from the host that no move has used yet, and a row of the speed table.
    pub(super) supplied: Option<(Coordinates, i32)>,
    pub(super) routine: Option<Routine>,
    /// Whether the routine has called a part of the program.
    pub(super) called: bool,
}

impl Default for Task {
    fn default() -> Self {
        Self {
            running: false,
            stopped: false,
            step: 1,
            next: 1,
            wait: Wait::Ready(Now::ZERO),
            stack: Vec::new(),
            speed: 1,
            ramps: [1, 1],
            pass: 1.0,
            offset: Coordinates::default(),
            from: None,
            torque: None,
            limited: None,
            escape: false,
            supplied: None,
            routine: None,
            called: false,
        }
    }
}

impl Task {
    /// Resets the task to its state before the first start.
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

    /// Time of the next action.
    pub(super) fn due(&self) -> Option<Now> {
        match self.wait {
            Wait::Ready(at) | Wait::Until(at) | Wait::Pass(at) if self.running && !self.stopped => Some(at),
            _ => None,
        }
    }
}
