//! `toyo program show`.

use crate::prelude::*;
use crate::refusal;
use armctl_client::toyo::Refusal;
use armctl_frame::robot::program::Program;

/// Show the current step of the program of the current task.
#[derive(Debug, Args)]
pub struct Show {
    /// Program to draw: a file, or the task of a program, 1 to 4 [default: the current task]. With --from, a file moves
    /// to the points of task 1
    #[arg(value_name = "FILE|NUMBER", requires = "path", value_parser = parse_program)]
    pub program: Option<String>,
    /// CSV file of points from `point dump`, for a program file
    #[arg(long, value_name = "FILE", requires = "program", conflicts_with = "from")]
    pub points: Option<PathBuf>,
    /// Parameters and tables (CSV) from `param dump`, for a program file
    #[arg(long, value_name = "FILE", requires = "program", conflicts_with = "from")]
    pub params: Option<PathBuf>,
}

/// Parses a file name or the number of a task.
fn parse_program(text: &str) -> Result<String, String> {
    match text.parse::<u32>() {
        Ok(number) if !(1..=4).contains(&number) => {
            Err(format!("the tasks are 1 to 4; a file of this name is ./{text}"))
        }
        _ => Ok(text.to_owned()),
    }
}

impl Command for Show {
    type Family = Toyo;
    type Report = Current;
    const ID: &'static str = "toyo.program.show";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Current> {
        let link = context.link;
        let (which, request) = (Request::bare(table::Command::Mtsk), steps::read_request(0));
        if link.is_dry_run() {
            link.plan(&which, "the current task");
            link.plan(&request, "the current step");
            return Err(unknown());
        }
        let which = link.ask(&which).await?;
        let answer = steps::numbered(link, 0).await?.map_err(|Refusal(request)| refusal::of_question(&request))?;
        let task = which.number("task").unwrap_or_default();
        let more = Instruction { task, instruction: answer.text("text").map(ToOwned::to_owned) };
        let step = answer.number("step").map(i64::from);
        Ok(Current(Program { program: Some(format!("task {task}")), step, more, ..Program::default() }))
    }
}

/// Current step of a program.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct Current(Program<Instruction>);

/// Fields that toyo adds to the step.
#[derive(Debug, Default, Serialize, JsonSchema)]
struct Instruction {
    /// Task of the program.
    task: i32,
    /// Instruction of the step.
    instruction: Option<String>,
}

impl Report for Current {
    fn view(&self) -> View {
        let Self(program) = self;
        View::fields([
            ("task", program.more.task.into()),
            ("step", Cell::optional(program.step)),
            ("instruction", Cell::optional(program.more.instruction.as_deref())),
        ])
    }
}
