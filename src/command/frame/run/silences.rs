//! Messages of a watch about a robot that does not answer, with limited repetition.

use std::time::Instant;

use super::Run;
use crate::command::frame::repeats::{Line, Repeats};
use crate::failure::Failure;
use crate::output::log::Level;
use crate::settings::Robot;

/// Missing answers of a watched robot.
pub(super) struct Silences<'a> {
    run: &'a Run,
    robot: &'a Robot,
    repeats: Repeats,
    last: Option<Failure>,
}

impl<'a> Silences<'a> {
    pub fn new(run: &'a Run, robot: &'a Robot) -> Self {
        Self { run, robot, repeats: Repeats::default(), last: None }
    }

    /// Reports a missing answer, unless it was just reported.
    pub fn say(&mut self, failure: &Failure) {
        let line = Line::new(Level::Warning, &failure.message, &[("robot", &self.robot.name)]);
        self.last = Some(failure.clone());
        let lines = self.repeats.lines(line, Instant::now());
        self.print(lines);
    }

    /// Reports the number of missing answers when the robot answers again or the watch ends.
    pub fn end(&mut self) {
        let lines = self.repeats.due(Instant::now(), true);
        self.print(lines);
        self.repeats = Repeats::default();
    }

    fn print(&self, lines: Vec<Line>) {
        for Line { text, .. } in lines {
            if let Some(failure) = &self.last {
                self.run.screen.failure(&Failure { message: text, ..failure.clone() });
                self.run.redraw.forget();
            }
        }
    }
}

impl Drop for Silences<'_> {
    fn drop(&mut self) {
        self.end();
    }
}
