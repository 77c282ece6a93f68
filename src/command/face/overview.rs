//! A robot in the line that `armctl status` prints.

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::Report;
use crate::failure::Failure;
use crate::output::view::{Cell, Table, Tone, View};

/// The state of one robot in a line.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct OverviewReport {
    /// Where it is false, all that follows is null.
    pub reachable: bool,
    /// `teach` or `play` (yerc); `auto` or `manual` (yrcx); `automatic`, `step` or `program` (toyo); null if unknown.
    pub mode: Option<&'static str>,
    /// Servo power.
    pub servo_on: Option<bool>,
    /// A job or program runs, or an axis moves.
    pub running: Option<bool>,
    /// Held or paused.
    pub held: Option<bool>,
    /// An alarm is present (yerc, yrcx).
    pub alarm: Option<bool>,
    /// An error is present.
    pub error: Option<bool>,
    /// The first robot in base coordinates.
    pub position: Option<PositionMm>,
    /// Why the position was not asked (yrcx without a session); null where it was.
    pub not_asked: Option<&'static str>,
    /// Why it is not reachable.
    #[serde(skip)]
    pub failure: Option<Failure>,
}

/// A place in base coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct PositionMm {
    /// X.
    pub x_mm: f64,
    /// Y.
    pub y_mm: f64,
    /// Z.
    pub z_mm: f64,
}

impl Report for OverviewReport {
    fn view(&self) -> View {
        let mut table = Table::new(&["reachable", "mode", "servo", "state", "alarm", "x y z (mm)"], "");
        if !self.reachable {
            let dash = || Cell::from("-");
            table.row([Cell::from("no").tone(Tone::Bad), dash(), dash(), dash(), dash(), dash()]);
            return View::table(table);
        }
        let state = match (self.held, self.running) {
            (Some(true), _) => Cell::from("hold").tone(Tone::Warning),
            (_, Some(true)) => Cell::from("running").tone(Tone::Good),
            _ => "stopped".into(),
        };
        let alarm = match (self.alarm, self.error) {
            (Some(true), _) => Cell::from("alarm").tone(Tone::Bad),
            (_, Some(true)) => Cell::from("error").tone(Tone::Bad),
            _ => "none".into(),
        };
        let position = self.position.as_ref().map(|at| format!("{:.3} {:.3} {:.3}", at.x_mm, at.y_mm, at.z_mm));
        table.row([
            Cell::from("yes").tone(Tone::Good),
            Cell::maybe(self.mode),
            Cell::maybe(self.servo_on.map(Cell::switch)),
            state,
            alarm,
            Cell::maybe(position.or(self.not_asked.map(|_| "not asked".to_owned()))),
        ]);
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        self.failure.clone()
    }
}
