//! `toyo backup`.

use std::path::{Path, PathBuf};

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::content::{self, Text};
use super::manifest::{Controller, Manifest};
use super::parts::{self, Part, PartResult};
use crate::command::backup::manifest;
use crate::command::backup::manifest::{Entry, MANIFEST, Reason, State};
use crate::command::backup::{self, Item, Items, Making, Only, cut_off, write_text};
use crate::command::frame::dry_run::unknown;
use crate::command::frame::interrupt::interruptible;
use crate::command::frame::local::{make_folder, own_folder};
use crate::command::toyo::link::Link;
use crate::command::toyo::link::Toyo;
use crate::command::toyo::tasks;
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::failure::Failure;
use crate::output::Screen;
use crate::output::view::View;
use crate::settings::Robot;

/// Saves all that is stored in a controller in a folder of text files.
#[derive(Debug, Args)]
#[command(after_help = "Parameters and tables, palletizing and easy programs, and of each task points and program; \
                  manifest.json lists them with sizes and hashes, and says what is missing and why. At 9600 baud it \
                  takes some minutes: half a minute for the parameters, and for each task a minute and a half for the \
                  points and 35 ms for each step.\n\nEach task is made the current one for a while, which is a change: \
                  a read-only robot refuses it, unless --current-task leaves the other tasks out.")]
pub struct Backup {
    /// Folder, made if it is not there
    folder: PathBuf,
    /// Points and program of the current task only, so that nothing is changed
    #[arg(long)]
    current_task: bool,
    /// What is asked for, where that was said for all families
    #[arg(skip)]
    scope: Option<Vec<String>>,
    /// Go on with a backup that is not whole; parts that are there already are kept
    #[arg(long, conflicts_with = "force")]
    resume: bool,
    /// Make a new backup over the one in the folder
    #[arg(long)]
    force: bool,
}

/// In the scope of a backup, where the other tasks are not in it.
const CURRENT_TASK: &str = "the current task";

impl Backup {
    /// Of what is asked for in any family; of the current task only where nothing may be changed.
    pub fn of(making: &Making, current_task: bool) -> Self {
        let Making { folder, mut scope, resume, force } = making.clone();
        let is_said = scope.iter().flatten().any(|word| word == CURRENT_TASK);
        if current_task && !resume && !is_said {
            scope.get_or_insert_default().push(CURRENT_TASK.to_owned());
        }
        Self { folder, current_task, scope, resume, force }
    }

    /// What is asked for, as the list says it; `None` if nobody says.
    fn scope(&self) -> Option<Vec<String>> {
        self.scope.clone().or_else(|| self.current_task.then(|| vec![CURRENT_TASK.to_owned()]))
    }
}

impl Command for Backup {
    type Family = Toyo;
    type Report = BackedUp;
    const ID: &'static str = "toyo.backup";

    fn risk(&self) -> Risk {
        if self.current_task { Risk::Read } else { Risk::Write }
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<BackedUp, Failure> {
        let Context { link, screen, robot, several, .. } = context;
        let folder = own_folder(&self.folder, &robot.name, several);
        let scope = self.scope();
        let earlier: Option<Manifest> = manifest::earlier(&folder, robot, scope.as_deref(), self.resume, self.force)?;
        if link.is_dry() {
            return self.dry_run(link).await;
        }
        let scope = scope.or_else(|| earlier.as_ref().map(|earlier| earlier.scope.clone())).unwrap_or_default();
        if self.current_task && !scope.iter().any(|word| word == CURRENT_TASK) {
            return Err(Failure::usage(format!("{} is a backup of every task", folder.display()))
                .hint("of the current task alone, make one in another folder"));
        }
        // The caller waits for Ctrl-C too, but asks this work first; so it ends here, with what was saved.
        let outcome =
            interruptible(self.save(link, screen, robot, &folder, scope, earlier)).await.and_then(|outcome| outcome);
        let outcome = outcome.map_err(|failure| match manifest::read::<Controller>(&folder) {
            Ok(Some(list)) => cut_off(failure, &folder, list.files.iter().filter(|entry| entry.copy.is_some()).count()),
            _ => failure,
        });
        tasks::done(link, outcome).await
    }
}

impl Backup {
    async fn save(
        &self,
        link: &mut Link,
        screen: &Screen,
        robot: &Robot,
        folder: &Path,
        scope: Vec<String>,
        earlier: Option<Manifest>,
    ) -> Result<BackedUp, Failure> {
        let controller = content::controller(link).await?;
        let mut chosen = parts(link, &controller, scope.iter().any(|word| word == CURRENT_TASK)).await?;
        let only = Only::of_scope(&scope);
        let names: Vec<String> = chosen.iter().map(ToString::to_string).collect();
        only.check(&names)?;
        chosen.retain(|part| only.has(&part.to_string()));
        make_folder(folder)?;
        let mut manifest = Manifest::new(robot, controller.clone(), scope);
        // What was saved before stays in the list until it is saved anew, so that it is kept whenever this is cut off.
        let earlier = earlier.filter(|earlier| earlier.controller.robot_type == controller.robot_type);
        let kept = |part: Part| {
            let entry = earlier.as_ref()?.entry(&part.to_string())?;
            entry.copy.as_ref().filter(|copy| copy.check(folder).is_ok())?;
            Some(entry.clone())
        };
        manifest.files = chosen.iter().filter_map(|part| kept(*part)).collect();
        manifest.write(folder)?;
        let mut results: Vec<PartResult> = chosen.iter().map(PartResult::pending).collect();
        let total = chosen.len();
        for (number, (part, result)) in chosen.iter().zip(&mut results).enumerate() {
            if let Some(entry) = manifest.entry(&part.to_string()) {
                result.state = State::Kept;
                result.file = entry.copy.as_ref().map(|copy| copy.file.clone());
                result.left_out.clone_from(&entry.left_out);
                continue;
            }
            screen.step(&format!("{}/{total} {part}", number + 1));
            let read = content::read(link, screen, *part, &controller).await;
            let (entry, goes_on) = entry_of(*part, read, folder, result)?;
            manifest.files.push(entry);
            manifest.write(folder)?;
            if !goes_on {
                break;
            }
        }
        let complete = results.iter().all(|part| matches!(part.state, State::Done | State::Kept));
        manifest.complete = complete;
        manifest.write(folder)?;
        Ok(BackedUp::new(folder, controller, manifest.scope, complete, results))
    }

    async fn dry_run(&self, link: &mut Link) -> Result<BackedUp, Failure> {
        content::plan_controller(link);
        link.plan(&Request::bare(table::Command::Mtsk), "which task is the current one");
        link.plan(&content::first_read(Part::Parameters)?, "the first of the parameters");
        if !self.current_task {
            tasks::choose(link, Some(1)).await?;
        }
        let points =
            if self.current_task { "of the current task" } else { "of every task, which is made the current one" };
        link.then(&format!(
            "every parameter, row, easy program and record is read, then every point and step {points}"
        ));
        Err(unknown())
    }
}

/// What there is, or what there is of the current task alone.
async fn parts(link: &mut Link, controller: &Controller, current_task: bool) -> Result<Vec<Part>, Failure> {
    let current = tasks::choose(link, None).await?;
    let wanted = |task: &u8| !current_task || *task == current;
    let points: Vec<u8> = controller.point_tasks().into_iter().filter(wanted).collect();
    let programs: Vec<u8> = controller.program_tasks().into_iter().filter(wanted).collect();
    Ok(Part::all(&points, &programs))
}

/// Writes the file of a part that was read, and says whether the next one can be read.
fn entry_of(
    part: Part,
    read: Result<Text, Failure>,
    folder: &Path,
    result: &mut PartResult,
) -> Result<(Entry, bool), Failure> {
    let mut entry = Entry { name: part.to_string(), holds: part.kind().to_owned(), ..Entry::default() };
    let Text { text, left_out } = match read {
        Ok(text) => text,
        Err(failure) => {
            entry.error = Some(Reason::from(&failure));
            return Ok((entry, result.fail(failure)));
        }
    };
    entry.copy = Some(write_text(folder, part.file(), &text)?);
    entry.left_out.clone_from(&left_out);
    result.state = State::Done;
    result.file = Some(part.file());
    result.left_out = left_out;
    Ok((entry, true))
}

/// What is in the folder now.
#[derive(Debug, Serialize, JsonSchema)]
pub struct BackedUp {
    /// The folder.
    folder: String,
    /// The list of what is in it.
    manifest: String,
    /// Whether nothing is missing.
    complete: bool,
    controller: Controller,
    parts: Vec<PartResult>,
    #[serde(skip)]
    of: (PathBuf, Vec<String>),
}

impl BackedUp {
    fn new(folder: &Path, controller: Controller, scope: Vec<String>, complete: bool, parts: Vec<PartResult>) -> Self {
        let manifest = folder.join(MANIFEST).display().to_string();
        let of = (folder.to_owned(), scope);
        Self { folder: folder.display().to_string(), manifest, complete, controller, parts, of }
    }
}

impl From<BackedUp> for backup::BackedUp {
    fn from(BackedUp { complete, parts, of: (folder, scope), .. }: BackedUp) -> Self {
        Self::new(&folder, scope, complete, Items::new(parts.into_iter().map(Item::from).collect()))
    }
}

impl Report for BackedUp {
    fn view(&self) -> View {
        View::table(parts::table(&self.parts, "saved"))
    }

    fn failure(&self) -> Option<Failure> {
        let failure = parts::failure(&self.parts)?;
        let again = "--resume reads what is missing";
        let hint = failure.hint.as_ref().map_or(again.to_owned(), |hint| format!("{hint}\n{again}"));
        Some(failure.hint(hint))
    }
}
