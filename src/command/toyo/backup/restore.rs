//! `toyo restore`.

use clap::Args;

use super::content::{self, Content};
use super::manifest::{Controller, Manifest};
use super::parts::Part;
use crate::command::backup::arguments::RestoreOptions;
use crate::command::backup::manifest;
use crate::command::backup::manifest::{LeftOut, MANIFEST, Saved};
use crate::command::backup::{NOT_CHOSEN, NOT_MACHINE, Only, RestoreSelection, Restored, would_leave, would_write};
use crate::command::frame::authority::Authority;
use crate::command::frame::dry_run::unknown;
use crate::command::frame::local_names::private_folder;
use crate::command::robot::file::{FileItem, State};
use crate::command::toyo::eeprom::{Cell, Cells};
use crate::command::toyo::link::Toyo;
use crate::command::toyo::link::{Link, wrong};
use crate::command::toyo::program::steps;
use crate::command::toyo::stores::{self, Store, StoreResult, StoreTask};
use crate::command::toyo::values::NOT_IN_MANUAL;
use crate::command::toyo::{param, tasks};
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::controller::toyo::field::Value;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::{self, Group, Parameter};
use crate::failure::{Failure, Kind};
use crate::gate::{Change, Confirmation};
use crate::output::Screen;

/// Write a backup back to the controller.
#[derive(Debug, Args)]
#[command(after_help = "All files are checked first: their hashes and their content. Each value is compared \
                  before the write. Equal values are not written, because the EEPROM takes about a \
                  million rewrites. After an interrupted restore, the same command continues.\n\n\
                  Machine parameters (E) and special ones (U) need --machine. They are written first; \
                  after a change of E nothing else is written, because the controller executes nothing before a \
                  restart. Then restore again without --machine.\n\nThe restore \
                  selects program mode temporarily.")]
pub struct Restore {
    #[command(flatten)]
    options: RestoreOptions,
    /// Continue an interrupted restore; with a part, earlier parts are not compared
    #[arg(long, value_name = "PART", num_args = 0..=1, require_equals = true, default_missing_value = "parameters")]
    resume: Option<Part>,
}

/// What is asked for of a restore.
struct Asked {
    restoring: RestoreSelection,
    resume: Option<Part>,
}

/// A part with what is to be stored.
struct Job {
    part: Part,
    saved: Saved,
    content: Content,
}

const MACHINE: StoreTask = StoreTask {
    doing: "storing machine parameters",
    noun: "",
    things: ["a machine or special parameter", "machine and special parameters"],
};
const SPEED: StoreTask = StoreTask { doing: "storing the override", noun: "", things: ["the override", "overrides"] };
/// Values that a question shows one by one; more are counted by parts.
const SHOWN: usize = 10;

/// A part of which is known what is there.
struct Looked<'j> {
    /// Its place among the jobs.
    index: usize,
    job: &'j Job,
    stores: Vec<Store>,
}

impl Command for Restore {
    type Family = Toyo;
    type Report = Restored;
    const ID: &'static str = "toyo.restore";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite what the controller stores by the backup";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Restored, Failure> {
        let restoring = self.options.restoring();
        let folder = private_folder(&restoring.folder, &context.robot.name, context.several);
        Asked { restoring: RestoreSelection { folder, ..restoring }, resume: self.resume }.run(context).await
    }
}

/// Writes back what a backup holds.
pub async fn restore(context: Context<'_, Toyo>, restoring: &RestoreSelection) -> Result<Restored, Failure> {
    Asked { restoring: restoring.clone(), resume: None }.run(context).await
}

impl Asked {
    async fn run(&self, context: Context<'_, Toyo>) -> Result<Restored, Failure> {
        let Context { link, screen, robot, authority, .. } = context;
        let folder = &self.restoring.folder;
        let manifest: Manifest = manifest::open_existing(folder)?;
        // Whether robot and address are those of the backup; the machine itself is asked later.
        manifest::check_origin(&manifest::open_existing::<serde_json::Value>(folder)?, robot, self.restoring.force)?;
        let parts = self.chosen(&manifest)?;
        if self.restoring.machine && !parts.contains(&Part::Parameters) {
            return Err(Failure::usage("--machine needs the parameters, which --only excludes")
                .hint("remove --machine, or add `parameters` to --only"));
        }
        let mut jobs = Vec::new();
        for part in parts {
            if let Some(copy) = manifest.entry(&part.to_string()).and_then(|entry| entry.copy.as_ref()) {
                copy.check(folder)?;
                jobs.push(Job { part, saved: copy.clone(), content: Content::load(part, folder, screen)? });
            }
        }
        if link.is_dry() {
            self.plan_items(link, &manifest, &jobs)?;
            return self.dry_run(link, screen, &manifest.controller, &jobs).await;
        }
        let outcome = self.restore((link, screen, &authority), &manifest.controller, &jobs).await;
        match outcome {
            // Nothing more is sent then but what puts things back at the end of the link.
            Ok(report) if report.is_interrupted() => Ok(report),
            outcome => tasks::done(link, outcome).await,
        }
    }

    /// Whether all of the backup is restored.
    fn is_whole(&self) -> bool {
        self.restoring.only == Only::default()
    }

    /// The parts to restore, in the order of writing.
    fn chosen(&self, manifest: &Manifest) -> Result<Vec<Part>, Failure> {
        let tasks = [1, 2, 3, 4];
        let mut parts = Part::all(&tasks, &tasks);
        parts.retain(|part| manifest.entry(&part.to_string()).is_some_and(|entry| entry.copy.is_some()));
        let only = &self.restoring.only;
        only.check(&parts.iter().flat_map(|part| part.names()).collect::<Vec<_>>())?;
        parts.retain(|part| only.has_any(&part.names()));
        if parts.is_empty() {
            return Err(Failure::usage("the backup has none of these parts").hint(format!("{MANIFEST} lists them")));
        }
        if let Some(resume) = self.resume {
            let first = parts.iter().position(|part| *part == resume);
            // All of them, where it is the first that there can be.
            let first = first.or_else(|| (resume == Part::Parameters).then_some(0));
            let first = first.ok_or_else(|| {
                Failure::usage(format!("--resume={resume}: the backup does not have it"))
                    .hint("type a part from the manifest of the backup, or --resume alone")
            })?;
            parts.drain(..first);
        }
        Ok(parts)
    }

    async fn restore(
        &self,
        (link, screen, authority): (&mut Link, &Screen, &Authority<'_>),
        backup: &Controller,
        jobs: &[Job],
    ) -> Result<Restored, Failure> {
        let found = content::controller(link).await?;
        if !self.restoring.force {
            identify(backup, &found, self.restoring.machine)?;
        }
        let folder = &self.restoring.folder;
        let pending = |job: &Job| FileItem::values(job.part).from_copy(folder, &job.saved);
        let mut results: Vec<FileItem> = jobs.iter().map(pending).collect();
        let mut machine = self.machine_stores(jobs)?;
        stores::look(link, screen, &mut machine).await?;
        let changed: Vec<&Parameter> = machine.iter().filter(|store| store.differs()).filter_map(parameter).collect();
        let needs_power_cycle = changed.iter().any(|parameter| parameter.group() == Group::Machine);
        let (mut looked, mut speed) = (Vec::new(), Vec::new());
        if !needs_power_cycle {
            check_room(jobs, &found)?;
            looked = look_at(link, screen, jobs, &found, &mut results).await?;
            speed.extend(self::speed(backup)?.filter(|_| self.is_whole()));
            stores::look(link, screen, &mut speed).await?;
        }
        let mut change = replacing(&machine, &looked, &speed);
        if needs_power_cycle {
            change = change.note(param::consequence_of(&changed));
        }
        authority.confirm(&change).await?;
        steps::open(link).await?;
        let stored = stores::store_all(link, screen, MACHINE, &machine).await;
        if needs_power_cycle || stored.is_err() {
            let parameters = jobs.iter().position(|job| job.part == Part::Parameters);
            let needs_power_cycle = stored.is_ok();
            if let Some(result) = parameters.and_then(|index| results.get_mut(index)) {
                match stored {
                    Ok(fates) => count(result, stores::sum(&fates)),
                    Err(failure) => drop(result.fail(failure)),
                }
            }
            let mut restored = Restored::new(folder, results);
            restored.needs_power_cycle = needs_power_cycle;
            return Ok(restored);
        }
        for Looked { index, job, stores } in &looked {
            let outcome = store(link, screen, job, stores).await;
            if !settle(&mut results[*index], outcome) {
                break;
            }
        }
        if !speed.is_empty() {
            let mut result = FileItem::values("override");
            if results.iter().all(|result| result.more.state != State::NotTried) {
                settle(&mut result, store_all(link, screen, SPEED, &speed).await);
            }
            results.push(result);
        }
        Ok(Restored::new(folder, results))
    }

    /// Machine and special parameters, where they are wanted.
    fn machine_stores(&self, jobs: &[Job]) -> Result<Vec<Store>, Failure> {
        let stores = jobs.iter().filter(|_| self.restoring.machine).map(|job| job.content.machine_stores());
        Ok(stores.collect::<Result<Vec<_>, _>>()?.concat())
    }

    /// What a dry run says of each part of the backup.
    fn plan_items(&self, link: &mut Link, manifest: &Manifest, jobs: &[Job]) -> Result<(), Failure> {
        const ON: &str = "the comparison: values that differ are written";
        for entry in manifest.files.iter().filter(|entry| entry.copy.is_some()) {
            let Some(job) = jobs.iter().find(|job| job.part.to_string() == entry.name) else {
                link.plan_item(would_leave(&entry.name, NOT_CHOSEN));
                continue;
            };
            let count = job.content.stores(job.content.steps())?.len() as u64;
            link.plan_item(would_write(&entry.name, ("values", count), ON));
            let machine = job.content.machine_stores()?.len() as u64;
            if machine > 0 {
                let name = format!("{}: machine and special", entry.name);
                let written = || would_write(&name, ("values", machine), ON);
                link.plan_item(if self.restoring.machine { written() } else { would_leave(&name, NOT_MACHINE) });
            }
        }
        Ok(())
    }

    async fn dry_run(
        &self,
        link: &mut Link,
        screen: &Screen,
        backup: &Controller,
        jobs: &[Job],
    ) -> Result<Restored, Failure> {
        content::plan_controller(link);
        let mut machine = self.machine_stores(jobs)?;
        stores::look(link, screen, &mut machine).await?;
        let mut looked = Vec::new();
        for (index, job) in jobs.iter().enumerate() {
            choose(link, job.part).await?;
            let mut stores = job.content.stores(job.content.steps())?;
            stores::look(link, screen, &mut stores).await?;
            if let Part::Program(_) = job.part {
                let behind = steps::read_request(job.content.steps().saturating_add(1).min(5000));
                link.plan(&behind, "and so on to the end of the task");
            }
            looked.push(Looked { index, job, stores });
        }
        let mut speed: Vec<Store> = speed(backup)?.filter(|_| self.is_whole()).into_iter().collect();
        stores::look(link, screen, &mut speed).await?;
        steps::plan_open(link).await?;
        stores::store_all(link, screen, MACHINE, &machine).await?;
        for Looked { job, stores, .. } in &looked {
            choose(link, job.part).await?;
            stores::store_all(link, screen, job.content.work(), stores).await?;
            if let Part::Program(_) = job.part {
                link.then(&format!("steps behind those of {} that are no NOP become one", job.part));
            }
        }
        stores::store_all(link, screen, SPEED, &speed).await?;
        link.put_back().await?;
        Err(unknown())
    }
}

/// Makes the task of a part the current one, where it has one.
async fn choose(link: &mut Link, part: Part) -> Result<(), Failure> {
    if let Part::Points(task) | Part::Program(task) = part {
        tasks::choose(link, Some(task)).await?;
    }
    Ok(())
}

/// What is there of all parts. One that cannot be read fails alone; nothing of it is written.
async fn look_at<'j>(
    link: &mut Link,
    screen: &Screen,
    jobs: &'j [Job],
    found: &Controller,
    results: &mut [FileItem],
) -> Result<Vec<Looked<'j>>, Failure> {
    let (mut looked, mut read) = (Vec::new(), screen.parts_progress("parts read", jobs.len()));
    for ((index, job), result) in jobs.iter().enumerate().zip(results) {
        match look_at_one(link, screen, job, found).await {
            Ok(stores) => looked.push(Looked { index, job, stores }),
            Err(failure) if failure.kind == Kind::Interrupted => return Err(failure),
            Err(failure) => {
                if !result.fail(failure) {
                    looked.clear();
                    break;
                }
            }
        }
        read.advance(1);
    }
    Ok(looked)
}

async fn look_at_one(link: &mut Link, screen: &Screen, job: &Job, found: &Controller) -> Result<Vec<Store>, Failure> {
    let Job { part, content, .. } = job;
    choose(link, *part).await?;
    let room = match part {
        Part::Points(task) | Part::Program(task) => found.task_steps[usize::from(*task) - 1],
        _ => 0,
    };
    for (step, text) in content.unlisted_steps() {
        must_be_there(link, step, &text).await?;
    }
    let stores = content.stores(room)?;
    let mut stores: Vec<Store> = stores.into_iter().map(|store| store.by(found.letters())).collect();
    stores::look(link, screen, &mut stores).await?;
    Ok(stores)
}

/// What is replaced, for a person to confirm: a few values one by one, many by parts.
fn replacing(machine: &[Store], looked: &[Looked<'_>], speed: &[Store]) -> Change {
    let of = |part: String, work: StoreTask, stores: &[Store]| (part, work.things, stores::replaced(work, stores));
    let mut parts = vec![of("machine".to_owned(), MACHINE, machine)];
    parts.extend(looked.iter().map(|Looked { job, stores, .. }| of(job.part.to_string(), job.content.work(), stores)));
    parts.push(of("override".to_owned(), SPEED, speed));
    parts.retain(|(_, _, replaced)| !replaced.is_empty());
    let total: usize = parts.iter().map(|(_, _, replaced)| replaced.len()).sum();
    let values = if total == 1 { "a value" } else { &format!("{total} values") };
    let change = match total {
        0 => return Change::none(),
        _ => Change::new(format!("overwrite {values} by the backup")),
    };
    parts.iter().fold(change, |change, (part, [one, several], replaced)| {
        if total > SHOWN {
            let count = replaced.len();
            let what = if count == 1 { (*one).to_owned() } else { format!("{count} {several}") };
            return change.item(format!("{part}: {what}"));
        }
        replaced.iter().fold(change, |change, [what, old, new]| change.replaces(&format!("{part}, {what}"), old, new))
    })
}

/// The parameter of a cell.
fn parameter(store: &Store) -> Option<&'static Parameter> {
    store.cell.read.parameter()
}

/// The override that the backup has.
fn speed(backup: &Controller) -> Result<Option<Store>, Failure> {
    let Some(percent) = backup.speed_override_percent else { return Ok(None) };
    let values = vec![Value::Number(percent.into())];
    let wanted = table::Command::Rovr.row().answers[0].record(values.clone());
    let cell = Cell {
        read: Request::bare(table::Command::Rovr),
        write: Request::new(table::Command::Wovr, values).map_err(|error| wrong(&error))?,
        wanted: wanted.map_err(|error| wrong(&error))?,
    };
    Ok(Some(Store { is_optional: true, ..Store::new("override", cell) }))
}

/// Whether the controller is the machine that the backup is of: its robot type (SYSP), which task has which axes (E19), and
/// what the axes are called (E01). With `machine`, E19 and E01 are among what is restored.
fn identify(backup: &Controller, found: &Controller, machine: bool) -> Result<(), Failure> {
    let none = String::new();
    let letters = [backup, found].map(|one| one.axis_letters.as_ref());
    let marks = [
        ("robot type", &backup.robot_type, &found.robot_type, true),
        ("E19 (task-axes)", &backup.task_axes, &found.task_axes, !machine),
        (
            "E01 (axis-letters)",
            letters[0].unwrap_or(&none),
            letters[1].unwrap_or(&none),
            !machine && letters.iter().all(Option::is_some),
        ),
    ];
    let other = marks.iter().filter(|(_, saved, found, counts)| *counts && saved != found);
    let other: Vec<String> =
        other.map(|(what, saved, found, _)| format!("{what} is {saved} in the backup and {found} here")).collect();
    if other.is_empty() {
        return Ok(());
    }
    Err(Failure::new(Kind::Rejected, format!("the backup is of another machine: {}", other.join(", ")))
        .hint("use the backup of this robot, or --force to write this one; nothing was written"))
}

/// Whether all programs fit the tasks; before anything is written.
fn check_room(jobs: &[Job], found: &Controller) -> Result<(), Failure> {
    for Job { part, content, .. } in jobs {
        let Part::Program(task) = part else { continue };
        let room = found.task_steps[usize::from(*task) - 1];
        if content.steps() > room {
            let message = format!("{part} needs {} steps, but task {task} has {room}", content.steps());
            return Err(Failure::usage(message)
                .hint("restore E22 (task-steps) with --machine, or exclude the part with --only"));
        }
    }
    Ok(())
}

/// Stores a part.
async fn store(
    link: &mut Link,
    screen: &Screen,
    job: &Job,
    stores: &[Store],
) -> Result<(Cells, Vec<LeftOut>), Failure> {
    choose(link, job.part).await?;
    store_all(link, screen, job.content.work(), stores).await
}

/// A step that the manual does not list is not written. Where something else is in its place, the program would be another
/// one, and none of it is written.
async fn must_be_there(link: &mut Link, step: u16, text: &str) -> Result<(), Failure> {
    let found = link.ask(&steps::read_request(step)).await?.written();
    if found == text {
        return Ok(());
    }
    let message = format!(
        "step {step} is '{text}' in the backup, which is {NOT_IN_MANUAL} and cannot be written; the controller has '{found}'"
    );
    Err(Failure::new(Kind::Rejected, message)
        .hint("write the step with the teach pendant, then restore again; nothing of this program was written"))
}

/// Stores cells: how many were written, and which the controller does not have.
async fn store_all(
    link: &mut Link,
    screen: &Screen,
    work: StoreTask,
    stores: &[Store],
) -> Result<(Cells, Vec<LeftOut>), Failure> {
    let fates = stores::store_all(link, screen, work, stores).await?;
    let absent = stores.iter().zip(&fates).filter(|(_, fate)| **fate == StoreResult::NotThere);
    let why = "missing on the controller";
    let absent = absent.map(|(store, _)| LeftOut { key: store.key.clone(), why: why.to_owned() });
    Ok((stores::sum(&fates), absent.collect()))
}

/// Writes down what became of a part, and says whether the next one can be tried.
fn settle(result: &mut FileItem, outcome: Result<(Cells, Vec<LeftOut>), Failure>) -> bool {
    match outcome {
        Ok((cells, left_out)) => {
            result.succeed(State::Done);
            count(result, cells);
            result.more.left_out = left_out;
            true
        }
        Err(failure) => result.fail(failure),
    }
}

/// Reports how many values were written and how many were equal.
fn count(result: &mut FileItem, cells: Cells) {
    let number = |cells: u32| usize::try_from(cells).unwrap_or(usize::MAX);
    (result.more.written, result.more.unchanged) =
        (Some(number(cells.cells_written)), Some(number(cells.cells_unchanged)));
}
