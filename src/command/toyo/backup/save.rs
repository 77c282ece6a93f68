//! `toyo backup`.

use std::path::{Path, PathBuf};

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::content::{self, Text};
use super::manifest::{Controller, Entry, Manifest};
use super::parts::{self, Part, PartResult};
use crate::command::interrupt::interruptible;
use crate::command::local::{Target, make_folder, own_folder};
use crate::command::manifest::{self, Hash, MANIFEST, Reason, Saved, State};
use crate::command::toyo::link::Link;
use crate::command::toyo::{Family, files, tasks};
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
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
    /// Go on with a backup that is not whole; parts that are there already are kept
    #[arg(long, conflicts_with = "force")]
    resume: bool,
    /// Make a new backup over the one in the folder
    #[arg(long)]
    force: bool,
}

impl Command for Backup {
    type Family = Family;
    type Report = BackedUp;
    const ID: &'static str = "toyo.backup";

    fn risk(&self) -> Risk {
        if self.current_task { Risk::Read } else { Risk::Write }
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<BackedUp, Failure> {
        let Context { link, screen, robot, several } = context;
        let folder = own_folder(&self.folder, &robot.name, several);
        let earlier = manifest::earlier(&folder, robot.target.value.url(), self.resume, self.force)?;
        if link.is_dry() {
            return self.rehearse(link).await;
        }
        // The caller waits for Ctrl-C too, but asks this work first; so it ends here, with what was saved.
        let outcome = interruptible(self.save(link, screen, robot, &folder, earlier)).await.and_then(|outcome| outcome);
        let outcome = outcome.map_err(|failure| told(failure, &folder));
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
        earlier: Option<Manifest>,
    ) -> Result<BackedUp, Failure> {
        let controller = content::controller(link).await?;
        let chosen = self.parts(link, &controller).await?;
        make_folder(folder)?;
        let target = robot.target.value.url().to_owned();
        let mut manifest = Manifest::new(robot.name.clone(), target, controller.clone());
        // What was saved before stays in the list until it is saved anew, so that it is kept whenever this is cut off.
        let earlier = earlier.filter(|earlier| earlier.controller.robot_type == controller.robot_type);
        let kept = |part: Part| {
            let entry = earlier.as_ref()?.entry(part)?;
            entry.copy.as_ref().filter(|copy| copy.check(folder).is_ok())?;
            Some(entry.clone())
        };
        manifest.parts = chosen.iter().filter_map(|part| kept(*part)).collect();
        manifest.write(folder)?;
        let mut results: Vec<PartResult> = chosen.iter().map(PartResult::pending).collect();
        let total = chosen.len();
        for (number, (part, result)) in chosen.iter().zip(&mut results).enumerate() {
            if let Some(entry) = manifest.entry(*part) {
                result.state = State::Kept;
                result.file = entry.copy.as_ref().map(|copy| copy.file.clone());
                result.left_out.clone_from(&entry.left_out);
                continue;
            }
            screen.step(&format!("{}/{total} {part}", number + 1));
            let read = content::read(link, screen, *part, &controller).await;
            let (entry, goes_on) = entry_of(*part, read, folder, result)?;
            manifest.parts.push(entry);
            manifest.write(folder)?;
            if !goes_on {
                break;
            }
        }
        let complete = results.iter().all(|part| matches!(part.state, State::Done | State::Kept));
        manifest.complete = complete;
        manifest.write(folder)?;
        Ok(BackedUp::new(folder, controller, complete, results))
    }

    async fn parts(&self, link: &mut Link, controller: &Controller) -> Result<Vec<Part>, Failure> {
        let current = tasks::choose(link, None).await?;
        let wanted = |task: &u8| !self.current_task || *task == current;
        let points: Vec<u8> = controller.point_tasks().into_iter().filter(wanted).collect();
        let programs: Vec<u8> = controller.program_tasks().into_iter().filter(wanted).collect();
        Ok(Part::all(&points, &programs))
    }

    async fn rehearse(&self, link: &mut Link) -> Result<BackedUp, Failure> {
        content::foresee_controller(link);
        let mut first = |part: Part, about: &str| -> Result<(), Failure> {
            link.foresee(&content::first_read(part)?, about);
            Ok(())
        };
        first(Part::Parameters, "and so on, every parameter and every row of the tables")?;
        first(Part::Easy, "and so on, every easy program")?;
        first(Part::Palletizing(1), "and so on, every record of the palletizing programs")?;
        if self.current_task {
            tasks::choose(link, None).await?;
        } else {
            tasks::choose(link, Some(1)).await?;
        }
        let of = if self.current_task { "of the current task" } else { "of each task, which is chosen before" };
        link.foresee(&content::first_read(Part::Points(1))?, &format!("and so on, every point {of}"));
        link.foresee(&content::first_read(Part::Program(1))?, &format!("and so on, every step {of}"));
        std::future::pending().await
    }
}

/// Writes the file of a part that was read, and says whether the next one can be read.
fn entry_of(
    part: Part,
    read: Result<Text, Failure>,
    folder: &Path,
    result: &mut PartResult,
) -> Result<(Entry, bool), Failure> {
    let mut entry = Entry { part: part.to_string(), copy: None, left_out: Vec::new(), error: None };
    let Text { text, left_out } = match read {
        Ok(text) => text,
        Err(failure) => {
            entry.error = Some(Reason::from(&failure));
            return Ok((entry, result.fail(failure)));
        }
    };
    files::write(&Target::new(folder.join(part.file()), true)?, &text)?;
    let mut hash = Hash::default();
    hash.take(text.as_bytes());
    entry.copy = Some(Saved { file: part.file(), bytes: hash.bytes, sha256: hash.hex() });
    entry.left_out.clone_from(&left_out);
    result.state = State::Done;
    result.file = Some(part.file());
    result.left_out = left_out;
    Ok((entry, true))
}

/// A failure that ended the work, with what is there already.
fn told(failure: Failure, folder: &Path) -> Failure {
    let saved = match manifest::read::<Manifest>(folder) {
        Ok(Some(list)) => list.parts.iter().filter(|entry| entry.copy.is_some()).count(),
        _ => return failure,
    };
    let message = format!("{}; {saved} parts are in {}", failure.message.trim_end_matches('.'), folder.display());
    let again = "--resume goes on from there";
    let hint = failure.hint.as_ref().map_or(again.to_owned(), |hint| format!("{hint}; then {again}"));
    Failure { message, ..failure }.hint(hint)
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
}

impl BackedUp {
    fn new(folder: &Path, controller: Controller, complete: bool, parts: Vec<PartResult>) -> Self {
        let manifest = folder.join(MANIFEST).display().to_string();
        Self { folder: folder.display().to_string(), manifest, complete, controller, parts }
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
