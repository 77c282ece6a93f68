//! A task: which step it is at, and what it waits for.

use super::action::{Move, Test, Torque};
use super::motion::Coordinates;
use super::routine::Routine;
use crate::Now;

/// What a task that runs waits for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Wait {
    /// To do its step, at this moment.
    Ready(Now),
    /// A moment.
    Until(Now),
    /// A pass point: the moment at which the next step begins while the move still slows down.
    Pass(Now),
    /// Its move to be over.
    Motion,
    /// The same, to end.
    End,
    Test(Test),
    /// Coordinates from the host.
    Host(Move),
}

/// How a task goes on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Flow {
    /// With the next step.
    Next,
    /// With this step.
    To(usize),
    /// After a wait, with this step.
    Wait(Wait, usize),
    /// With the next step, once it is started again.
    Stop,
    End,
}

/// One of four.
#[derive(Debug, Clone)]
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
pub(super) struct Task {
    /// Whether it was started and has not ended.
    pub(super) running: bool,
    /// Whether TSTO stopped it.
    pub(super) stopped: bool,
    /// From 1.
    pub(super) step: usize,
    /// The step to go on with after a wait.
    pub(super) next: usize,
    pub(super) wait: Wait,
    /// Steps to return to.
    pub(super) stack: Vec<usize>,
    /// Row of the speed table.
    pub(super) speed: i32,
    /// Rows of the acceleration table.
    pub(super) ramps: [i32; 2],
    /// Share of the last ramp at pass points.
    pub(super) pass: f64,
    pub(super) offset: Coordinates,
    /// Where the last move began.
    pub(super) from: Option<Coordinates>,
    /// How the next move is limited.
    pub(super) torque: Option<Torque>,
    /// How the move under way is.
    pub(super) limited: Option<Torque>,
    /// Whether the escape input ends the move under way.
    pub(super) escape: bool,
    /// Coordinates from the host that were not used yet, and a row of the speed table.
    pub(super) supplied: Option<(Coordinates, i32)>,
    /// What it does besides its program.
    pub(super) routine: Option<Routine>,
    /// Whether the routine has called the program.
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
    /// As before its program was started.
    pub(super) fn reset(&mut self) {
        let mut stack = std::mem::take(&mut self.stack);
        stack.clear();
        *self = Self { stack, ..Self::default() };
    }

    /// Starts at a step.
    pub(super) fn start(&mut self, step: usize, now: Now) {
        self.running = true;
        self.step = step;
        self.wait = Wait::Ready(now);
    }

    /// When it does something by itself.
    pub(super) fn due(&self) -> Option<Now> {
        match self.wait {
            Wait::Ready(at) | Wait::Until(at) | Wait::Pass(at) if self.running && !self.stopped => Some(at),
            _ => None,
        }
    }
}
