//! Programs and jobs: the same keys in what starts, waits for and shows them in every family.

use schemars::JsonSchema;
use serde::Serialize;

use super::item::Plain;
use crate::command::frame::cycle::Cycle;
use crate::output::view::{Cell, Tone};

/// A program or job. Null: the protocol does not report it, or nobody waited for the end.
#[derive(Debug, Default, Serialize, JsonSchema)]
pub struct Program<M = Plain> {
    /// Its name; its number where it has no name.
    pub program: Option<String>,
    /// The line at which it stands.
    pub line: Option<i64>,
    /// The step at which it stands.
    pub step: Option<i64>,
    /// What it does.
    pub state: Option<ProgramState>,
    /// From the acceptance of the start to the end, of the last run if there were several.
    pub elapsed_ms: Option<u64>,
    /// How long each of several runs took.
    #[serde(flatten)]
    pub cycle: Cycle,
    /// What the family adds.
    #[serde(flatten)]
    pub more: M,
}

/// What a program does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ProgramState {
    /// It stands, and has not begun or was reset.
    Stopped,
    /// It runs.
    Running,
    /// It stands in the middle and can continue.
    Held,
    /// It has reached its end.
    Ended,
}

impl ProgramState {
    /// As a table shows it.
    pub fn cell(self) -> Cell {
        match self {
            Self::Stopped => "stopped".into(),
            Self::Running => Cell::from("started").tone(Tone::Good),
            Self::Held => Cell::from("held").tone(Tone::Warning),
            Self::Ended => Cell::from("ended").tone(Tone::Good),
        }
    }
}

impl<M> Program<M> {
    /// What a table shows; `more` are the rows of the family, before the times.
    pub fn fields(&self, more: Vec<(&'static str, Cell)>) -> Vec<(&'static str, Cell)> {
        let known = [("line", self.line.map(Cell::from)), ("step", self.step.map(Cell::from))];
        let known = known.into_iter().filter_map(|(name, cell)| Some((name, cell?)));
        let mut fields = vec![("program", Cell::maybe(self.program.as_deref()))];
        fields.extend(self.state.map(|state| ("state", state.cell())));
        fields.extend(known.filter(|(name, _)| !more.iter().any(|(other, _)| other == name)));
        fields.extend(more);
        fields.extend(self.elapsed_ms.map(|elapsed| ("elapsed (ms)", elapsed.into())));
        fields.extend(self.cycle.rows());
        fields
    }
}
