//! `toyo backup`.

use super::content::{self, Text};
use super::manifest::Controller;
use super::parts::Part;
use crate::prelude::*;
use armctl_frame::backup::arguments::BackupOptions;
use armctl_frame::backup::manifest::Entry;
use armctl_frame::backup::save::{self, Task, interrupted_failure};
use armctl_frame::backup::{BackupReport, Only, SaveOptions};
use armctl_frame::robot::file::FileItem;

/// Save all data of a controller to a folder of text files.
#[derive(Debug, Args)]
#[command(
    after_help = "The backup contains parameters, tables, palletizing and easy programs, and the points and program \
                  of each task. manifest.json lists these parts with sizes and hashes, and the reason for missing \
                  parts. At 9600 baud a backup takes some minutes: half a minute for the parameters. Each task takes \
                  a minute and a half for the points, and 35 ms for each step.\n\narmctl selects each task \
                  temporarily. Selecting a task is a change: for a read-only robot, use --current-task."
)]
pub struct Backup {
    #[command(flatten)]
    options: BackupOptions,
    /// Save only the points and the program of the current task, so that armctl changes nothing on the controller
    #[arg(long)]
    current_task: bool,
}

/// Marks in the scope of a backup that it contains only the current task.
const CURRENT_TASK: &str = "the current task";

impl Command for Backup {
    type Family = Toyo;
    type Report = BackupReport;
    const ID: &'static str = "toyo.backup";

    fn risk(&self) -> Risk {
        if self.current_task { Risk::Read } else { Risk::Write }
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<BackupReport> {
        let making = self.options.making(self.current_task.then(|| CURRENT_TASK.to_owned()));
        make(context, making, self.current_task).await
    }
}

/// Makes a backup. If nothing may be changed on the controller, the backup contains only the current task.
pub async fn back_up(context: Context<'_, Toyo>, mut making: SaveOptions, current_task: bool) -> Result<BackupReport> {
    let is_said = making.scope.iter().flatten().any(|word| word == CURRENT_TASK);
    if current_task && !making.resume && !is_said {
        making.scope.get_or_insert_default().push(CURRENT_TASK.to_owned());
    }
    make(context, making, current_task).await
}

async fn make(context: Context<'_, Toyo>, making: SaveOptions, current_task: bool) -> Result<BackupReport> {
    let Context { link, screen, robot, several, .. } = context;
    let task = Task::new(making, robot, several)?;
    if link.is_dry_run() {
        return dry_run(link, current_task).await;
    }
    if current_task && !task.scope.iter().any(|word| word == CURRENT_TASK) {
        return Err(Failure::usage(format!("{} is a backup of every task", task.folder.display()))
            .hint("use another folder for a backup of the current task"));
    }
    let outcome = interrupted_failure(&task.folder, Box::pin(save(link, (screen, robot), &task))).await;
    task_selection::restore_task(link, outcome).await
}

async fn save(link: &mut Link, (screen, robot): (&Screen, &Robot), task: &Task<Controller>) -> Result<BackupReport> {
    let controller = content::controller(link).await?;
    let mut chosen = parts(link, &controller, task.scope.iter().any(|word| word == CURRENT_TASK)).await?;
    let only = Only::of_scope(&task.scope);
    only.check(&chosen.iter().flat_map(|part| part.names()).collect::<Vec<_>>())?;
    chosen.retain(|part| only.has_any(&part.names()));
    let mut list = task.begin((screen, robot), controller.clone(), |earlier, entry| {
        let is_wanted = chosen.iter().any(|part| part.to_string() == entry.name);
        is_wanted && earlier.controller.robot_type == controller.robot_type
    })?;
    let mut saved = screen.parts_progress("parts saved", chosen.len());
    for part in &chosen {
        let entry = Entry { name: part.to_string(), holds: part.kind().to_owned(), ..Entry::default() };
        let read = async {
            let Text { text, left_out } = content::read(link, screen, *part, &controller).await?;
            Ok(save::SavedPart { left_out, ..save::SavedPart::new(save::Content::Text(part.file(), text)) })
        };
        if !list.part(entry, read).await? {
            break;
        }
        saved.advance(1);
    }
    let tried = list.files().len();
    list.end(chosen[tried..].iter().map(FileItem::pending))
}

async fn dry_run(link: &mut Link, current_task: bool) -> Result<BackupReport> {
    content::plan_controller(link);
    link.plan(&Request::bare(table::Command::Mtsk), "the current task");
    let first = Parameter::named("M01").and_then(|first| Request::read_parameter(first, None).ok());
    link.plan(&first.expect("the table has M01"), "the first of the parameters");
    if !current_task {
        task_selection::select_task(link, Some(1)).await?;
    }
    let points = if current_task { "of the current task" } else { "of every task, after the selection of the task" };
    link.then(&format!("every parameter, row, easy program and record is read, then every point and step {points}"));
    Err(unknown())
}

/// Parts of the controller. With `current_task`, the points and the program of the other tasks are omitted.
async fn parts(link: &mut Link, controller: &Controller, current_task: bool) -> Result<Vec<Part>> {
    let current = task_selection::select_task(link, None).await?;
    let wanted = |task: &u8| !current_task || *task == current;
    let points: Vec<u8> = controller.point_tasks().into_iter().filter(wanted).collect();
    let programs: Vec<u8> = controller.program_tasks().into_iter().filter(wanted).collect();
    Ok(Part::all(&points, &programs))
}
