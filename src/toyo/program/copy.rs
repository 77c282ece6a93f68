//! `toyo program copy`.

use super::and_mode;
use super::insert::moved_wrong;
use crate::prelude::*;
use armctl_controller::toyo::program::tags;

/// Copy steps over other steps, within a task or to another task.
#[derive(Debug, Args)]
#[command(after_help = and_mode("If you copy a tag within a task, the task contains the tag twice, and a program \
                                 stops there with error A2."))]
pub struct Copy {
    /// First step to copy
    #[arg(value_parser = clap::value_parser!(u16).range(1..=5000))]
    from: u16,
    /// Last step to copy
    #[arg(value_parser = clap::value_parser!(u16).range(1..=5000))]
    to: u16,
    /// First step to overwrite
    #[arg(long, value_name = "STEP", value_parser = clap::value_parser!(u16).range(1..=5000))]
    at: u16,
    /// Task to copy from, 1 to 4 [default: the current task]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    from_task: Option<u8>,
    /// Task to copy to, 1 to 4 [default: the task to copy from]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    to_task: Option<u8>,
}

impl Command for Copy {
    type Family = Toyo;
    type Report = Copied;
    const ID: &'static str = "toyo.program.copy";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite program steps";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Copied> {
        let Context { link, screen, confirmer, .. } = context;
        if self.to < self.from {
            return Err(Failure::usage(format!("the last step {} is before the first step {}", self.to, self.from))
                .hint("type the lower step first"));
        }
        if usize::from(self.end()) > armctl_controller::toyo::program::MAX_STEPS {
            return Err(Failure::usage(format!("the copy would end at step {}; the limit is 5000", self.end()))
                .hint("copy fewer steps, or choose a lower target"));
        }
        if self.to_task.is_none() || self.from_task == self.to_task {
            self.overlap()?;
        }
        if link.is_dry_run() {
            return self.dry_run(link).await;
        }
        let outcome = self.copy(link, screen, &confirmer).await;
        task_selection::restore_task(link, outcome).await
    }
}

impl Copy {
    /// Returns the number of the last step that the copy overwrites.
    fn end(&self) -> u16 {
        self.at.saturating_add(self.to - self.from)
    }

    /// Returns an error if the steps and their copy overlap, because the manual does not define what the controller
    /// then does.
    fn overlap(&self) -> Result<()> {
        if self.at > self.to || self.end() < self.from {
            return Ok(());
        }
        let Self { from, to, at, .. } = self;
        Err(Failure::usage(format!("steps {from} to {to} overlap their copy, steps {at} to {}", self.end()))
            .hint("use `program get --from --to` and `program put --at` instead"))
    }

    fn order(&self, from_task: u8, to_task: u8) -> Request {
        let step = |step: u16| Value::Number(step.into());
        let task = |task: u8| Value::Number(task.into());
        let values = [task(from_task), step(self.from), step(self.to), task(to_task), step(self.at)];
        Request::of(table::Command::Cpss, values)
    }

    /// Text of the command. The current task is omitted, because it is not known yet.
    fn sketch(&self) -> String {
        let step = |step: u16| Some(Value::Number(step.into()));
        let task = |task: Option<u8>| task.map(|task| Value::Number(task.into()));
        let [from, to] = [self.from_task, self.to_task.or(self.from_task)].map(task);
        let values = [from, step(self.from), step(self.to), to, step(self.at)];
        format!("@{}", table::Command::Cpss.row().requests[0].sketch(&values).unwrap_or_default())
    }

    async fn copy(&self, link: &mut Link, screen: &Screen, confirmer: &Confirmer<'_>) -> Result<Copied> {
        let source = task_selection::select_task(link, self.from_task).await?;
        let target = self.to_task.unwrap_or(source);
        if source == target {
            self.overlap()?;
        }
        steps::room(link, source, self.to).await?;
        steps::room(link, target, self.end()).await?;
        let wanted = steps::read_all(link, screen, self.from..=self.to).await?;
        task_selection::select_task(link, Some(target)).await?;
        let found = steps::read_all(link, screen, self.at..=self.end()).await?;
        let report = Copied {
            from_task: source,
            first_step: self.from,
            last_step: self.to,
            to_task: target,
            at_step: self.at,
            steps: wanted.len(),
            was_there: found == wanted,
        };
        if report.was_there {
            return Ok(report);
        }
        if source == target
            && let Some(tag) = tags(&wanted, 1).keys().next()
        {
            screen.note(&format!(
                "warning: the task now contains tag {tag:03} twice, and a program stops there with error A2"
            ));
        }
        let lost = (self.at..).zip(wanted.iter().zip(&found));
        let lost = lost.filter(|(_, (wanted, found))| wanted != found && **found != steps::nop());
        let lost: Vec<[String; 3]> =
            lost.map(|(step, (wanted, found))| [format!("step {step}"), found.written(), wanted.written()]).collect();
        confirmer.confirm(&steps::overwriting(target, &lost)).await?;
        steps::open(link).await?;
        link.ask(&self.order(source, target)).await?;
        let found = steps::read_all(link, screen, self.at..=self.end()).await?;
        let different = (self.at..).zip(wanted.iter().zip(&found)).find(|(_, (wanted, found))| wanted != found);
        match different {
            Some((step, (wanted, found))) => Err(moved_wrong(step, wanted, found)),
            None => Ok(report),
        }
    }

    async fn dry_run(&self, link: &mut Link) -> Result<Copied> {
        task_selection::select_task(link, self.from_task).await?;
        link.plan(&steps::rooms_request(), "the number of steps of the task");
        link.plan(&steps::rooms_request(), "the number of steps of the target task");
        for step in self.from..=self.to {
            link.plan(&steps::read_request(step), "the source of the copy");
        }
        task_selection::select_task(link, self.to_task.or(self.from_task)).await?;
        let there: Vec<Request> = (self.at..=self.end()).map(steps::read_request).collect();
        for read in &there {
            link.plan(read, "the target of the copy");
        }
        steps::plan_open(link).await?;
        link.plan_order(&self.sketch(), "whether the steps differ, and the current task").await?;
        for read in &there {
            link.plan_if(read, "whether the steps differ");
        }
        link.put_back().await?;
        Err(unknown())
    }
}

/// Result of a copy.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Copied {
    from_task: u8,
    first_step: u16,
    last_step: u16,
    to_task: u8,
    /// First step that the copy overwrites.
    at_step: u16,
    /// Number of steps that were copied.
    steps: usize,
    /// Whether the target steps were already equal, so that nothing was written.
    was_there: bool,
}

impl Report for Copied {
    fn view(&self) -> View {
        let Self { from_task, first_step, last_step, to_task, at_step, steps, was_there } = self;
        let to = if from_task == to_task { String::new() } else { format!(" of task {to_task}") };
        let end = usize::from(*at_step) + steps - 1;
        let done = if *was_there { "nothing written: the steps are equal" } else { "copied, and compared" };
        View::text(format!("steps {first_step} to {last_step} of task {from_task} to {at_step} to {end}{to}: {done}"))
    }
}
