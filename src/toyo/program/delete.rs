//! `toyo program delete`.

use super::and_mode;
use super::get::Step;
use super::insert::moved_wrong;
use crate::prelude::*;

/// Delete steps; later steps move up.
#[derive(Debug, Args)]
#[command(after_help = and_mode("The command prints the deleted steps in the form of a program file."))]
pub struct Delete {
    /// Step to delete, or the first of several steps
    #[arg(value_parser = clap::value_parser!(u16).range(1..=5000))]
    step: u16,
    /// Last of several steps to delete
    #[arg(long, value_name = "STEP", value_parser = clap::value_parser!(u16).range(1..=5000))]
    to: Option<u16>,
    /// Task, 1 to 4 [default: the current task]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    task: Option<u8>,
}

impl Command for Delete {
    type Family = Toyo;
    type Report = Deleted;
    const ID: &'static str = "toyo.program.delete";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "delete program steps";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Deleted> {
        let Context { link, screen, confirmer, .. } = context;
        let last = self.to.unwrap_or(self.step);
        if last < self.step {
            return Err(
                Failure::usage(format!("--to {last} is before step {}", self.step)).hint("type the lower step first")
            );
        }
        if link.is_dry_run() {
            return self.dry_run(link, &confirmer, last).await;
        }
        let outcome = self.delete(link, screen, &confirmer, last).await;
        task_selection::restore_task(link, outcome).await
    }
}

impl Delete {
    fn order(&self, last: u16) -> Request {
        let (first, last) = (Value::Number(self.step.into()), Value::Number(last.into()));
        if first == last {
            Request::of(table::Command::Dstx, [first])
        } else {
            Request::of(table::Command::Dstl, [first, last])
        }
    }

    /// Builds the change that the user must confirm.
    fn change(&self, deleted: &[Record], task: u8) -> Change {
        // Steps that do nothing are also listed, because later steps move up.
        let steps = (self.step..).zip(deleted).map(|(step, record)| format!("step {step}: {}", record.written()));
        let change = match deleted.len() {
            1 => Change::new(format!("delete a step of task {task}")),
            many => Change::new(format!("delete {many} steps of task {task}")),
        };
        steps.fold(change, Change::item).note("Later steps move up.")
    }

    async fn delete(&self, link: &mut Link, screen: &Screen, confirmer: &Confirmer<'_>, last: u16) -> Result<Deleted> {
        let task = task_selection::select_task(link, self.task).await?;
        let room = steps::room(link, task, last).await?;
        let deleted = steps::read_all(link, screen, self.step..=last).await?;
        let behind = match last {
            last if last < room => link.ask(&steps::read_request(last + 1)).await?,
            _ => steps::nop(),
        };
        confirmer.confirm(&self.change(&deleted, task)).await?;
        steps::open(link).await?;
        link.ask(&self.order(last)).await?;
        let found = link.ask(&steps::read_request(self.step)).await?;
        if found != behind {
            return Err(moved_wrong(self.step, &behind, &found));
        }
        let deleted = (usize::from(self.step)..).zip(&deleted);
        let deleted = deleted.map(|(step, record)| Step::of(step, record)).collect();
        Ok(Deleted { task, deleted })
    }

    async fn dry_run(&self, link: &mut Link, confirmer: &Confirmer<'_>, last: u16) -> Result<Deleted> {
        task_selection::select_task(link, self.task).await?;
        link.plan(&steps::rooms_request(), "number of steps of the task");
        for step in self.step..=last {
            link.plan(&steps::read_request(step), "the deleted steps");
        }
        let behind = steps::read_request(last.saturating_add(1).min(5000));
        link.plan_if(&behind, "whether a later step exists");
        confirmer.confirm(&Change::none()).await?;
        steps::plan_open(link).await?;
        link.ask(&self.order(last)).await?;
        link.plan(&steps::read_request(self.step), "the steps after the change");
        link.put_back().await?;
        Err(unknown())
    }
}

/// Deleted steps.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Deleted {
    task: u8,
    /// Deleted steps, with the numbers that they had.
    deleted: Vec<Step>,
}

impl Report for Deleted {
    fn view(&self) -> View {
        let lines = self.deleted.iter().map(|step| format!("{}\n", step.line()));
        View::text(format!("# deleted from task {}\n{}", self.task, lines.collect::<String>()))
    }
}
