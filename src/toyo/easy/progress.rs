//! `toyo easy progress`.

use crate::prelude::*;

/// Show the progress of the running or selected easy program.
#[derive(Debug, Args)]
pub struct Progress {}

impl Command for Progress {
    type Family = Toyo;
    type Report = ProgressReport;
    const ID: &'static str = "toyo.easy.progress";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<ProgressReport> {
        let answer = context.link.ask(&Request::bare(table::Command::Resd)).await?;
        let number = |name| answer.number(name).unwrap_or_default();
        Ok(ProgressReport {
            program: number("program"),
            step: number("step"),
            sequential_step: number("sequential"),
            hand_tag: number("tag"),
            loops: number("loop"),
        })
    }
}

/// Progress of an easy program.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProgressReport {
    /// Number of the program, 1 to 8.
    #[serde(rename = "number")]
    program: i32,
    /// Current step of the easy program.
    step: i32,
    /// Current step of the sequential program.
    sequential_step: i32,
    /// Current tag of the hand program.
    hand_tag: i32,
    /// Number of repetitions.
    loops: i32,
}

impl Report for ProgressReport {
    fn view(&self) -> View {
        View::fields([
            ("program", self.program.into()),
            ("step", self.step.into()),
            ("sequential step", self.sequential_step.into()),
            ("hand program tag", self.hand_tag.into()),
            ("loops", self.loops.into()),
        ])
    }
}
