//! `toyo palletizing progress`.

use crate::prelude::*;

/// Show the progress of the running or selected palletizing program.
#[derive(Debug, Args)]
pub struct Progress {}

impl Command for Progress {
    type Family = Toyo;
    type Report = ProgressReport;
    const ID: &'static str = "toyo.palletizing.progress";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<ProgressReport> {
        Ok(ProgressReport::of(&context.link.ask(&Request::bare(table::Command::Rpld)).await?))
    }
}

/// Progress of a palletizing program.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProgressReport {
    /// Number of the program, 1 to 16.
    #[serde(rename = "number")]
    program: i32,
    /// Mode: which sides are a matrix (`M-1`, `1-M` or `M-M`).
    mode: &'static str,
    /// Meaning of the mode.
    mode_meaning: String,
    /// Part of the program that runs now: `START`, `SOURCE`, `DESTI` or `END`.
    state: &'static str,
    /// Meaning of the state.
    state_meaning: String,
    /// Progress in each of the three directions.
    directions: [Pieces; 3],
    /// Current tag of the hand program.
    hand_tag: i32,
    /// Current step of the sequential program.
    sequential_step: i32,
}

/// Progress in one direction.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Pieces {
    /// Number of the current piece.
    done: i32,
    /// Total number of pieces.
    pieces: i32,
}

impl ProgressReport {
    fn of(record: &Record) -> Self {
        let number = |name| record.number(name).unwrap_or_default();
        let meaning = |name| {
            let pair = record.pairs().find(|(field, _)| field.name == name);
            pair.map_or_else(String::new, |(field, value)| field.meaning(value).into_owned())
        };
        let pieces = |done, pieces| Pieces { done: number(done), pieces: number(pieces) };
        Self {
            program: number("program"),
            mode: record.word("mode").unwrap_or_default(),
            mode_meaning: meaning("mode"),
            state: record.word("state").unwrap_or_default(),
            state_meaning: meaning("state"),
            directions: [pieces("done1", "pieces1"), pieces("done2", "pieces2"), pieces("done3", "pieces3")],
            hand_tag: number("tag"),
            sequential_step: number("step"),
        }
    }
}

impl Report for ProgressReport {
    fn view(&self) -> View {
        let pieces = |index: usize| {
            let Pieces { done, pieces } = self.directions[index];
            format!("{done} of {pieces}")
        };
        View::fields([
            ("program", self.program.into()),
            ("mode", format!("{}: {}", self.mode, self.mode_meaning).into()),
            ("executes", self.state_meaning.as_str().into()),
            ("direction 1", pieces(0).into()),
            ("direction 2", pieces(1).into()),
            ("direction 3", pieces(2).into()),
            ("hand program tag", self.hand_tag.into()),
            ("sequential step", self.sequential_step.into()),
        ])
    }
}
