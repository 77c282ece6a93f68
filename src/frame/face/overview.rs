//! Summary of a robot for `armctl status`.

use crate::prelude::basics::*;
use crate::robot::state::State;

/// State of one robot in one line.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct OverviewReport {
    /// Family.
    pub family: &'static str,
    /// State of the robot.
    #[serde(flatten)]
    pub state: State,
    /// Reason why the position was not read (yrcx without a session); null if it was read.
    pub not_asked: Option<&'static str>,
    /// State that an earlier client left, and how to undo it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_over: Vec<LeftOver>,
    /// Reason why the robot is not reachable.
    #[serde(skip)]
    pub failure: Option<Failure>,
}

/// State that a client left: a hold, host control, a running program.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct LeftOver {
    /// Description.
    pub what: String,
    /// How to undo it.
    pub undo: String,
}

impl LeftOver {
    /// Creates the entry if `is_so` is true.
    pub fn new(is_so: bool, what: &str, undo: &str) -> Option<Self> {
        is_so.then(|| Self { what: what.to_owned(), undo: undo.to_owned() })
    }
}

impl OverviewReport {
    /// Short description of the problem; `None` if there is none.
    pub fn fault_text(&self) -> Option<String> {
        let fault = &self.state.fault;
        (fault.faulted == Some(true)).then(|| fault.describe().unwrap_or_else(|| "alarm".to_owned()))
    }
}

impl Report for OverviewReport {
    fn view(&self) -> View {
        let mut table = Table::new(&["family", "mode", "servo", "state", "alarm", "x y z (mm)"], "");
        let state = &self.state;
        if !state.reachable {
            let dash = || Cell::from("-");
            let silent = Cell::from("no answer").tone(Tone::Bad);
            table.row([self.family.into(), dash(), dash(), silent, dash(), dash()]);
            return View::table(table);
        }
        let motion = match (state.held, state.running) {
            (Some(true), _) => Cell::from("hold").tone(Tone::Warning),
            (_, Some(true)) => Cell::from("running").tone(Tone::Good),
            _ => "stopped".into(),
        };
        let alarm = self.fault_text().map_or_else(|| "none".into(), |described| Cell::from(described).tone(Tone::Bad));
        // One decimal, so that an 80-column screen has space for the alarm; JSON has all digits.
        let position = state.position.as_ref().map(|at| format!("{:.1} {:.1} {:.1}", at.x_mm, at.y_mm, at.z_mm));
        table.row([
            self.family.into(),
            Cell::optional(state.controller_mode),
            Cell::optional(state.servo_on.map(Cell::switch)),
            motion,
            alarm,
            Cell::optional(position.or(self.not_asked.map(|_| "not asked".to_owned()))).whole(),
        ]);
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        self.failure.clone()
    }
}
