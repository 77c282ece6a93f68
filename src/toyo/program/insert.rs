//! `toyo program insert`.

use super::and_mode;
use super::get::Step;
use crate::eeprom::{Cells, STORED_VALUE};
use crate::prelude::*;
use armctl_controller::names::Names;
use armctl_controller::toyo::program::{Part, check_named};

/// Insert a step. The number of each later step increases by one.
#[derive(Debug, Args)]
#[command(after_help = and_mode("The insertion removes the last step of the task. If the last step is not a NOP, \
                                 armctl rejects the command."))]
pub struct Insert {
    /// Number of the new step
    #[arg(value_parser = clap::value_parser!(u16).range(1..=5000))]
    step: u16,
    /// Instruction, for example MOVP pick or OUT STN=0 PN1=.......1. Quote the characters < and >
    #[arg(num_args = 0.., default_value = "NOP", add = complete::INSTRUCTION)]
    instruction: Vec<String>,
    /// Task, 1 to 4 [default: the current task]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    task: Option<u8>,
}

impl Command for Insert {
    type Family = Toyo;
    type Report = Inserted;
    const ID: &'static str = "toyo.program.insert";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "insert a program step";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Inserted> {
        let Context { robot, link, screen, confirmer, .. } = context;
        let instruction = self.instruction(names::of_robot(robot, screen))?;
        if link.is_dry_run() {
            return self.dry_run(link, &confirmer, &instruction).await;
        }
        let outcome = self.insert(link, screen, &confirmer, &instruction).await;
        task_selection::restore_task(link, outcome).await
    }
}

impl Insert {
    /// Parses the instruction. A tag that it uses is not checked, because the tag can be anywhere in the program.
    fn instruction(&self, names: &Names) -> Result<Record> {
        let text = self.instruction.join(" ");
        let part = Part { first: self.step.into(), tags: None };
        let checked = check_named(text.as_bytes(), 1, Some(&part), names);
        let wrong = checked.errors().next().map(|finding| {
            let hint = finding.hint.clone().unwrap_or_else(|| "correct the instruction; nothing was sent".to_owned());
            Failure::usage(format!("column {} of '{text}': {}", finding.column, finding.message)).hint(hint)
        });
        match (wrong, checked.program.and_then(|program| program.steps.into_iter().next())) {
            (None, Some(step)) => Ok(step.record),
            (wrong, _) => Err(wrong.unwrap_or_else(|| {
                Failure::usage(format!("'{text}' is not a valid instruction")).hint(
                    "type one instruction with its operands, such as JMP TAG=5; see `armctl toyo program insert --help`",
                )
            })),
        }
    }

    fn order(&self) -> Request {
        Request::of(table::Command::Istx, [Value::Number(self.step.into())])
    }

    async fn insert(
        &self,
        link: &mut Link,
        screen: &Screen,
        confirmer: &Confirmer<'_>,
        instruction: &Record,
    ) -> Result<Inserted> {
        let step = self.step;
        let task = task_selection::select_task(link, self.task).await?;
        let room = steps::room(link, task, step).await?;
        let before = link.ask(&steps::read_request(step)).await?;
        let last = link.ask(&steps::read_request(room)).await?;
        if last != steps::nop() {
            let message = format!("step {room}, the last step of task {task}, would be lost: {}", last.written());
            return Err(Failure::new(Kind::Rejected, message).hint(
                "delete the step first, or increase the steps of the task with machine parameter E22 (task-steps)",
            ));
        }
        confirmer.confirm(&self.change(task, &before)).await?;
        steps::open(link).await?;
        link.ask(&self.order()).await?;
        if step < room {
            let behind = link.ask(&steps::read_request(step + 1)).await?;
            if behind != before {
                return Err(moved_wrong(step + 1, &before, &behind));
            }
        }
        let mut cells = Cells::default();
        link.store(screen, &steps::cell(step, instruction)?, &mut cells).await?;
        Ok(Inserted { task, inserted: Step::of(step.into(), instruction) })
    }

    fn change(&self, task: u8, before: &Record) -> Change {
        let step = self.step;
        let behind = format!("step {step} ({}) and later steps move by one", before.written());
        Change::new(format!("insert a step before step {step} of task {task}")).item(behind)
    }

    async fn dry_run(&self, link: &mut Link, confirmer: &Confirmer<'_>, instruction: &Record) -> Result<Inserted> {
        task_selection::select_task(link, self.task).await?;
        link.plan(&steps::rooms_request(), "number of steps of the task");
        link.plan(&steps::read_request(self.step), "the steps that move");
        let last = Reason::about("the last step, which must be a NOP").depending_on("number of steps of the task");
        link.plan_depending("@RSTX ?", last);
        confirmer.confirm(&Change::none()).await?;
        steps::plan_open(link).await?;
        link.ask(&self.order()).await?;
        if self.step < 5000 {
            link.plan_if(&steps::read_request(self.step + 1), "whether the inserted step is the last step");
        }
        let cell = steps::cell(self.step, instruction)?;
        link.plan(&cell.read, STORED_VALUE);
        link.plan_overwriting(&cell.read, &cell.write.text()).await?;
        link.put_back().await?;
        Err(unknown())
    }
}

/// Failure: the steps did not move as expected.
pub fn moved_wrong(step: u16, wanted: &Record, found: &Record) -> Failure {
    let (wanted, found) = (wanted.written(), found.written());
    Failure::new(Kind::Malformed, format!("the controller answered @OK, but step {step} is '{found}', not '{wanted}'"))
        .hint("use `toyo program get` to see the program")
}

/// Report of an inserted step.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Inserted {
    task: u8,
    inserted: Step,
}

impl Report for Inserted {
    fn view(&self) -> View {
        View::text(format!("inserted in task {}: {}", self.task, self.inserted.line()))
    }
}
