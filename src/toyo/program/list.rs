//! `toyo program list`.

use crate::prelude::*;
use armctl_controller::toyo::program::{tags, used};
use armctl_frame::items::{ItemError, verdict};

/// List the tasks, with the number of steps of each task.
#[derive(Debug, Args)]
#[command(
    after_help = "With --used, armctl reads every step of every task, which takes about 35 ms per step at 9600 baud. \
                  armctl selects each task temporarily. A read-only robot does not allow this change."
)]
pub struct List {
    /// Read the programs to count their steps and list their tags
    #[arg(long)]
    used: bool,
}

impl Command for List {
    type Family = Toyo;
    type Report = Listed;
    const ID: &'static str = "toyo.program.list";

    fn risk(&self) -> Risk {
        if self.used { Risk::Write } else { Risk::Read }
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Listed> {
        let Context { link, screen, .. } = context;
        if link.is_dry_run() {
            task_selection::select_task(link, None).await?;
            link.plan(&steps::rooms_request(), "number of steps of the tasks");
            if self.used {
                link.then("each task is selected, and all its steps are read");
            }
            return Err(unknown());
        }
        let outcome = self.list(link, screen).await;
        task_selection::restore_task(link, outcome).await
    }
}

impl List {
    async fn list(&self, link: &mut Link, screen: &Screen) -> Result<Listed> {
        let current = task_selection::select_task(link, None).await?;
        let mut tasks = Vec::new();
        for (task, room) in (1..).zip(steps::rooms(link).await?) {
            let mut listed =
                Task { task, current: task == current, room_steps: room, used_steps: None, tags: None, error: None };
            if self.used && room > 0 {
                task_selection::select_task(link, Some(task)).await?;
                match steps::read_all(link, screen, 1..=room).await {
                    Ok(read) => {
                        listed.used_steps = Some(used(&read));
                        listed.tags = Some(tags(&read, 1).into_keys().collect());
                    }
                    Err(failure) if matches!(failure.kind, Kind::Refused | Kind::Malformed) => {
                        listed.error = Some(ItemError::new(format!("task {task}"), failure));
                    }
                    Err(failure) => return Err(failure),
                }
            }
            tasks.push(listed);
        }
        Ok(Listed { tasks })
    }
}

/// The tasks.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Listed {
    tasks: Vec<Task>,
}

/// A task.
#[derive(Debug, Serialize, JsonSchema)]
struct Task {
    task: u8,
    /// Whether the task is the current task.
    current: bool,
    /// Number of steps of the task (parameter E22).
    room_steps: u16,
    /// Number of steps up to the last step that is not a NOP; null if the steps were not read.
    used_steps: Option<usize>,
    /// Tags of the program; null if the program was not read.
    tags: Option<Vec<i32>>,
    /// Reason why the program could not be read.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ItemError")]
    error: Option<ItemError>,
}

impl Report for Listed {
    fn view(&self) -> View {
        let mut table = Table::new(&["task", "current", "steps", "used", "tags"], "no tasks");
        for Task { task, current, room_steps, used_steps, tags, error } in &self.tasks {
            let tags = tags.as_ref().map(|tags| tags.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "));
            let tags = error.as_ref().map_or_else(|| Cell::optional(tags), ItemError::cell);
            table.row([
                (*task).into(),
                if *current { "yes" } else { "" }.into(),
                (*room_steps).into(),
                used_steps.map_or_else(|| Cell::number("-"), Cell::from),
                tags,
            ]);
        }
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        verdict(self.tasks.len(), self.tasks.iter().filter_map(|task| task.error.as_ref()))
    }
}
