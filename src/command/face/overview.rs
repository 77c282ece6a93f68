//! A robot in the line that `armctl status` prints.

use schemars::JsonSchema;
use serde::Serialize;

use super::sample::Alarm;
use crate::command::Report;
use crate::failure::Failure;
use crate::output::view::{Cell, Table, Tone, View};
use crate::settings::Robot;
use crate::settings::alarms;

/// The state of one robot in a line.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct OverviewReport {
    /// The family.
    pub family: &'static str,
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
    /// Which alarm or error it is.
    #[serde(flatten)]
    pub fault: Fault,
    /// The first robot in base coordinates.
    pub position: Option<PositionMm>,
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

/// What is wrong with a controller, under the same names in every family.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, JsonSchema)]
pub struct Fault {
    /// Whether an alarm or error is present; null if that is not known.
    pub faulted: Option<bool>,
    /// Its code as the controller writes it, such as `4315`, `12.600` or `28`; null without one, or where it was not told.
    pub fault_code: Option<String>,
    /// What it says, or what `alarms.toml` has for the code; null like the code.
    pub fault_text: Option<String>,
}

impl Fault {
    /// Whether there is one, and the first of those that are present, where it was told.
    pub fn new(is_present: bool, first: Option<&Alarm>) -> Self {
        let first = first.filter(|_| is_present);
        Self {
            faulted: Some(is_present),
            fault_code: first.map(|alarm| alarm.code.clone()).filter(|code| code != Alarm::UNREADABLE),
            fault_text: first.map(|alarm| alarm.text.clone()).filter(|text| !text.is_empty()),
        }
    }

    /// Takes the text that the operator's `alarms.toml` has for the code, if it has one.
    pub fn explain(&mut self, robot: &Robot) -> Result<(), Failure> {
        if let Some(code) = &self.fault_code
            && let Some(explained) = alarms::find(robot, code)?
        {
            self.fault_text = Some(explained.text);
        }
        Ok(())
    }

    /// Code and text, as far as they are known.
    pub fn describe(&self) -> Option<String> {
        let parts = [&self.fault_code, &self.fault_text];
        let told = parts.into_iter().flatten().map(String::as_str).collect::<Vec<_>>().join(" ");
        Some(told).filter(|told| !told.is_empty())
    }
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

impl OverviewReport {
    /// What is wrong with it, in a few words; `None` if nothing is.
    pub fn trouble(&self) -> Option<String> {
        if self.fault.faulted != Some(true) {
            return None;
        }
        let kind = if self.alarm == Some(true) { "alarm" } else { "error" };
        Some(self.fault.describe().unwrap_or_else(|| kind.to_owned()))
    }
}

impl Report for OverviewReport {
    fn view(&self) -> View {
        let mut table = Table::new(&["family", "mode", "servo", "state", "alarm", "x y z (mm)"], "");
        if !self.reachable {
            let dash = || Cell::from("-");
            let silent = Cell::from("no answer").tone(Tone::Bad);
            table.row([self.family.into(), dash(), dash(), silent, dash(), dash()]);
            return View::table(table);
        }
        let state = match (self.held, self.running) {
            (Some(true), _) => Cell::from("hold").tone(Tone::Warning),
            (_, Some(true)) => Cell::from("running").tone(Tone::Good),
            _ => "stopped".into(),
        };
        let alarm = self.trouble().map_or_else(|| "none".into(), |told| Cell::from(told).tone(Tone::Bad));
        // To a tenth, as a screen of 80 columns has room for the alarm as well; JSON has it whole.
        let position = self.position.as_ref().map(|at| format!("{:.1} {:.1} {:.1}", at.x_mm, at.y_mm, at.z_mm));
        table.row([
            self.family.into(),
            Cell::maybe(self.mode),
            Cell::maybe(self.servo_on.map(Cell::switch)),
            state,
            alarm,
            Cell::maybe(position.or(self.not_asked.map(|_| "not asked".to_owned()))).whole(),
        ]);
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        self.failure.clone()
    }
}
