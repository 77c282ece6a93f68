//! A robot in the line that `armctl status` prints.

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::Report;
use crate::command::robot::state::State;
use crate::failure::Failure;
use crate::output::view::{Cell, Table, Tone, View};

/// The state of one robot in a line.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct OverviewReport {
    /// The family.
    pub family: &'static str,
    /// The concept: how it stands.
    #[serde(flatten)]
    pub state: State,
    /// Why the position was not asked (yrcx without a session); null where it was.
    pub not_asked: Option<&'static str>,
    /// What somebody left behind, and how to undo it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_over: Vec<LeftOver>,
    /// Why it is not reachable.
    #[serde(skip)]
    pub failure: Option<Failure>,
}

/// Something that a client left behind: a hold, control by the host, a program that runs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct LeftOver {
    /// What it is.
    pub what: String,
    /// How to undo it.
    pub undo: String,
}

impl LeftOver {
    /// What it is, and how to undo it; nothing where it is not so.
    pub fn new(is_so: bool, what: &str, undo: &str) -> Option<Self> {
        is_so.then(|| Self { what: what.to_owned(), undo: undo.to_owned() })
    }
}

impl OverviewReport {
    /// What is wrong with it, in a few words; `None` if nothing is.
    pub fn trouble(&self) -> Option<String> {
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
        let alarm = self.trouble().map_or_else(|| "none".into(), |told| Cell::from(told).tone(Tone::Bad));
        // To a tenth, as a screen of 80 columns has room for the alarm as well; JSON has it whole.
        let position = state.position.as_ref().map(|at| format!("{:.1} {:.1} {:.1}", at.x_mm, at.y_mm, at.z_mm));
        table.row([
            self.family.into(),
            Cell::maybe(state.controller_mode),
            Cell::maybe(state.servo_on.map(Cell::switch)),
            motion,
            alarm,
            Cell::maybe(position.or(self.not_asked.map(|_| "not asked".to_owned()))).whole(),
        ]);
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        self.failure.clone()
    }
}
