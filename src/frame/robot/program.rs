//! Programs and jobs: the report keys that all families share.

use super::item::Plain;
use crate::prelude::basics::*;
use crate::repeated_runs::Cycle;

/// A program or job. A field is null if the protocol does not report it, or if the command did not wait for the end.
#[derive(Debug, Default, Serialize, JsonSchema)]
pub struct Program<M = Plain> {
    /// Name, or number if there is no name.
    pub program: Option<String>,
    /// Current line.
    pub line: Option<i64>,
    /// Current step.
    pub step: Option<i64>,
    /// State.
    pub state: Option<ProgramState>,
    /// Duration of the last run in ms, from the acceptance of the start to the end.
    pub elapsed_ms: Option<u64>,
    /// Times of repeated runs.
    #[serde(flatten)]
    pub cycle: Cycle,
    /// Family-specific fields.
    #[serde(flatten)]
    pub more: M,
}

/// State of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ProgramState {
    /// Not started, or reset.
    Stopped,
    /// Running.
    Running,
    /// Stopped before its end; it can continue.
    Held,
    /// At its end.
    Ended,
}

impl ProgramState {
    /// Cell of a table.
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
    /// Rows of a table; `more` are the rows of the family, before the times.
    pub fn fields(&self, more: Vec<(&'static str, Cell)>) -> Vec<(&'static str, Cell)> {
        let known = [("line", self.line.map(Cell::from)), ("step", self.step.map(Cell::from))];
        let known = known.into_iter().filter_map(|(name, cell)| Some((name, cell?)));
        let mut fields = vec![("program", Cell::optional(self.program.as_deref()))];
        fields.extend(self.state.map(|state| ("state", state.cell())));
        fields.extend(known.filter(|(name, _)| !more.iter().any(|(other, _)| other == name)));
        fields.extend(more);
        fields.extend(self.elapsed_ms.map(|elapsed| ("elapsed (ms)", elapsed.into())));
        fields.extend(self.cycle.rows());
        fields
    }
}
