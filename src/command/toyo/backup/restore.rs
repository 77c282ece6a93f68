//! `toyo restore`.

use std::path::{Path, PathBuf};

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::content::{self, Content};
use super::manifest::{Controller, Manifest};
use super::parts::{self, Part, PartResult, Parts};
use crate::command::backup::{self, Item, Items, Only, POWER_CYCLE, Restoring};
use crate::command::dry_run::unknown;
use crate::command::local::own_folder;
use crate::command::manifest::{self, LeftOut, MANIFEST, State};
use crate::command::toyo::cells::{Cell, Cells};
use crate::command::toyo::link::{Link, wrong};
use crate::command::toyo::program::steps;
use crate::command::toyo::stores::{self, Fate, Store, Work};
use crate::command::toyo::values::NOT_IN_MANUAL;
use crate::command::toyo::{Family, tasks};
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::toyo::field::Value;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::output::view::View;

/// Writes back what a backup holds.
#[derive(Debug, Args)]
#[command(
    after_help = "All files are checked first, against their hashes and for their content. Each value is compared \
                  before it is written: what the controller holds already is not written, as its EEPROM takes about a \
                  million rewrites. So after a restore that was cut off the same command goes on where it ended.\n\n\
                  Machine parameters (E) and special ones (U) are left out unless --machine is given. They come first; \
                  if one of E was changed, nothing else is written, as only communication works until the \
                  controller's power was switched off and on. Then restore again without --machine.\n\nSteps and all \
                  else are written in program mode; a controller in another mode is switched to it, and back."
)]
pub struct Restore {
    /// Folder of the backup
    folder: PathBuf,
    /// These parts only, such as parameters,points-1,program
    #[arg(long, value_name = "PART", value_delimiter = ',')]
    only: Vec<Parts>,
    /// Write machine and special parameters, too; needs --yes
    #[arg(long)]
    machine: bool,
    /// Go on with a restore that was cut off; with a part, those before it are not even compared
    #[arg(long, value_name = "PART", num_args = 0..=1, require_equals = true, default_missing_value = "parameters")]
    resume: Option<Part>,
    /// Write the backup of one robot or machine to another
    #[arg(long)]
    force: bool,
    /// Parts whose names fit
    #[arg(skip)]
    patterns: Only,
}

/// A part with what is to be stored.
struct Job {
    part: Part,
    content: Content,
}

const MACHINE: Work = Work { doing: "storing machine parameters", noun: "", resumes: false };
const SPEED: Work = Work { doing: "storing the override", noun: "", resumes: false };

impl Command for Restore {
    type Family = Family;
    type Report = Restored;
    const ID: &'static str = "toyo.restore";

    fn risk(&self) -> Risk {
        Risk::Destroy
    }

    fn intent(&self) -> String {
        "overwrite what the controller stores by the backup".to_owned()
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Restored, Failure> {
        let Context { link, screen, robot, several, .. } = context;
        let folder = own_folder(&self.folder, &robot.name, several);
        let manifest: Manifest = manifest::existing(&folder)?;
        // Whether robot and address are those of the backup; the machine itself is asked later.
        manifest::admit(&manifest::existing::<serde_json::Value>(&folder)?, robot, self.force)?;
        let parts = self.chosen(&manifest)?;
        if self.machine && !parts.contains(&Part::Parameters) {
            return Err(Failure::usage("--machine is about the parameters, which are not among the parts")
                .hint("leave --machine away, or name `parameters` with --only"));
        }
        let mut jobs = Vec::new();
        for part in parts {
            if let Some(copy) = manifest.entry(&part.to_string()).and_then(|entry| entry.copy.as_ref()) {
                copy.check(&folder)?;
                jobs.push(Job { part, content: Content::load(part, &folder, screen)? });
            }
        }
        if link.is_dry() {
            return self.rehearse(link, screen, &manifest.controller, &jobs).await;
        }
        let outcome = self.restore(link, screen, &manifest.controller, &jobs).await;
        match outcome {
            // Nothing more is sent then but what puts things back at the end of the link.
            Ok(report) if report.is_interrupted() => Ok(report),
            outcome => tasks::done(link, outcome).await,
        }
    }
}

impl Restore {
    /// Of what is asked for in any family.
    pub fn of(restoring: &Restoring) -> Self {
        let Restoring { folder, only: patterns, machine, force } = restoring.clone();
        Self { folder, only: Vec::new(), machine, resume: None, force, patterns }
    }

    /// Whether all of the backup is restored.
    fn is_whole(&self) -> bool {
        self.only.is_empty() && self.patterns == Only::default()
    }

    /// The parts to restore, in the order of writing.
    fn chosen(&self, manifest: &Manifest) -> Result<Vec<Part>, Failure> {
        let tasks = [1, 2, 3, 4];
        let mut parts = Part::all(&tasks, &tasks);
        parts.retain(|part| manifest.entry(&part.to_string()).is_some_and(|entry| entry.copy.is_some()));
        let names: Vec<String> = parts.iter().map(ToString::to_string).collect();
        self.patterns.check(&names)?;
        parts.retain(|part| self.only.is_empty() || self.only.iter().any(|only| only.has(*part)));
        parts.retain(|part| self.patterns.has(&part.to_string()));
        if parts.is_empty() {
            return Err(Failure::usage("the backup has none of these parts").hint(format!("{MANIFEST} lists them")));
        }
        if let Some(resume) = self.resume {
            let first = parts.iter().position(|part| *part == resume);
            // All of them, where it is the first that there can be.
            let first = first.or_else(|| (resume == Part::Parameters).then_some(0));
            let first = first.ok_or_else(|| {
                Failure::usage(format!("--resume={resume}: the backup does not have it"))
                    .hint("name a part that the manifest of the backup lists, or --resume alone")
            })?;
            parts.drain(..first);
        }
        Ok(parts)
    }

    async fn restore(
        &self,
        link: &mut Link,
        screen: &Screen,
        backup: &Controller,
        jobs: &[Job],
    ) -> Result<Restored, Failure> {
        let found = content::controller(link).await?;
        if !self.force {
            identify(backup, &found, self.machine)?;
        }
        let mut results: Vec<PartResult> = jobs.iter().map(|job| pending(job.part)).collect();
        if !self.machine {
            check_room(jobs, &found)?;
        }
        steps::open(link).await?;
        let mut report = Restored { parts: Vec::new(), needs_power_cycle: false };
        if self.machine {
            report.needs_power_cycle = machine(link, screen, jobs, &mut results).await?;
            if report.needs_power_cycle || results.iter().any(|result| result.state == State::Failed) {
                report.parts = results;
                return Ok(report);
            }
            // Those of them that took hold at once.
            check_room(jobs, &content::controller(link).await?)?;
        }
        let total = jobs.len();
        for (number, (job, result)) in jobs.iter().zip(&mut results).enumerate() {
            screen.step(&format!("{}/{total} {}", number + 1, job.part));
            let outcome = store(link, screen, job, &found).await;
            if !settle(result, outcome) {
                break;
            }
        }
        if self.is_whole()
            && let Some(store) = speed(backup)?
        {
            let mut result = PartResult::pending("override");
            if results.iter().all(|result| matches!(result.state, State::Done | State::Failed)) {
                settle(&mut result, store_all(link, screen, SPEED, &[store]).await);
            }
            results.push(result);
        }
        report.parts = results;
        Ok(report)
    }

    async fn rehearse(
        &self,
        link: &mut Link,
        screen: &Screen,
        backup: &Controller,
        jobs: &[Job],
    ) -> Result<Restored, Failure> {
        content::foresee_controller(link);
        steps::foresee_open(link).await?;
        if self.machine {
            for job in jobs {
                stores::store_all(link, screen, MACHINE, &job.content.machine_stores()?, 0).await?;
            }
        }
        for Job { part, content } in jobs {
            if let Part::Points(task) | Part::Program(task) = part {
                tasks::choose(link, Some(*task)).await?;
            }
            let steps = content.steps();
            stores::store_all(link, screen, content.work(), &content.stores(steps)?, 0).await?;
            if let Part::Program(_) = part {
                let rest = "and so on to the end of the task: what is no NOP becomes one";
                link.foresee(&steps::read_request(steps.saturating_add(1).min(5000)), rest);
            }
        }
        if let Some(store) = speed(backup)?.filter(|_| self.is_whole()) {
            stores::store_all(link, screen, SPEED, &[store], 0).await?;
        }
        link.put_back().await?;
        Err(unknown())
    }
}

/// A part before it is tried.
fn pending(part: Part) -> PartResult {
    PartResult { file: Some(part.file()), ..PartResult::pending(part) }
}

/// The override that the backup has.
fn speed(backup: &Controller) -> Result<Option<Store>, Failure> {
    let Some(percent) = backup.override_percent else { return Ok(None) };
    let values = vec![Value::Number(percent.into())];
    let wanted = table::Command::Rovr.row().answers[0].record(values.clone());
    let cell = Cell {
        read: Request::bare(table::Command::Rovr),
        write: Request::new(table::Command::Wovr, values).map_err(|error| wrong(&error))?,
        wanted: wanted.map_err(|error| wrong(&error))?,
    };
    Ok(Some(Store { key: "override".to_owned(), cell, is_optional: true, found: None }))
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
    Err(Failure::new(Kind::RefusedHere, format!("the backup is of another machine: {}", other.join(", ")))
        .hint("nothing was written; take the backup of this robot; --force writes it all the same"))
}

/// Whether all programs fit the tasks; before anything is written.
fn check_room(jobs: &[Job], found: &Controller) -> Result<(), Failure> {
    for Job { part, content } in jobs {
        let Part::Program(task) = part else { continue };
        let room = found.task_steps[usize::from(*task) - 1];
        if content.steps() > room {
            let message = format!("{part} needs room for {} steps, and task {task} has {room}", content.steps());
            return Err(Failure::usage(message).hint(
                "--machine restores the machine parameters, E22 (task-steps) among them; or leave the part out with --only",
            ));
        }
    }
    Ok(())
}

/// Stores machine and special parameters, and says whether the controller wants its power to be cycled.
async fn machine(link: &mut Link, screen: &Screen, jobs: &[Job], results: &mut [PartResult]) -> Result<bool, Failure> {
    for (job, result) in jobs.iter().zip(results) {
        let stores = job.content.machine_stores()?;
        match stores::store_all(link, screen, MACHINE, &stores, 0).await {
            Ok(fates) => {
                let changed = |(store, fate): (&Store, &Fate)| store.key.starts_with('E') && *fate == Fate::Written;
                if stores.iter().zip(&fates).any(changed) {
                    result.cells = Some(stores::sum(&fates));
                    return Ok(true);
                }
            }
            Err(failure) => {
                result.fail(failure);
                return Ok(false);
            }
        }
    }
    Ok(false)
}

/// Stores a part.
async fn store(
    link: &mut Link,
    screen: &Screen,
    job: &Job,
    found: &Controller,
) -> Result<(Cells, Vec<LeftOut>), Failure> {
    let Job { part, content } = job;
    let mut room = 0;
    if let Part::Points(task) | Part::Program(task) = part {
        tasks::choose(link, Some(*task)).await?;
        room = found.task_steps[usize::from(*task) - 1];
    }
    for (step, text) in content.unlisted_steps() {
        must_be_there(link, step, &text).await?;
    }
    store_all(link, screen, content.work(), &content.stores(room)?).await
}

/// A step that the manual does not list is not written. Where something else is in its place, the program would be another
/// one, and none of it is written.
async fn must_be_there(link: &mut Link, step: u16, text: &str) -> Result<(), Failure> {
    let found = link.read_content(&steps::read_request(step)).await?.written();
    if found == text {
        return Ok(());
    }
    let message = format!(
        "step {step} is '{text}' in the backup, which is {NOT_IN_MANUAL} and is not written; here it is '{found}'"
    );
    Err(Failure::new(Kind::RefusedHere, message)
        .hint("nothing of this program was written; write the step with the teach pendant, then restore again"))
}

/// Stores cells: how many were written, and which the controller does not have.
async fn store_all(
    link: &mut Link,
    screen: &Screen,
    work: Work,
    stores: &[Store],
) -> Result<(Cells, Vec<LeftOut>), Failure> {
    let fates = stores::store_all(link, screen, work, stores, 0).await?;
    let absent = stores.iter().zip(&fates).filter(|(_, fate)| **fate == Fate::NotThere);
    let why = "the controller does not have it";
    let absent = absent.map(|(store, _)| LeftOut { key: store.key.clone(), why: why.to_owned() });
    Ok((stores::sum(&fates), absent.collect()))
}

/// Writes down what became of a part, and says whether the next one can be tried.
fn settle(result: &mut PartResult, outcome: Result<(Cells, Vec<LeftOut>), Failure>) -> bool {
    match outcome {
        Ok((cells, left_out)) => {
            result.state = State::Done;
            result.cells = Some(cells);
            result.left_out = left_out;
            true
        }
        Err(failure) => result.fail(failure),
    }
}

/// What became of a backup.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Restored {
    /// In the order of writing.
    parts: Vec<PartResult>,
    /// Machine parameters were changed, and nothing else was written: nothing but communication works until the
    /// controller's power was switched off and on.
    needs_power_cycle: bool,
}

impl Restored {
    fn is_interrupted(&self) -> bool {
        let kinds = self.parts.iter().filter_map(|part| part.error.as_ref());
        kinds.into_iter().any(|failure| failure.kind == Kind::Interrupted)
    }
}

impl Restored {
    /// As all families report it.
    pub fn of_folder(self, folder: &Path) -> backup::Restored {
        let Self { parts, needs_power_cycle } = self;
        let items = Items::new(parts.into_iter().map(Item::from).collect());
        let mut restored = backup::Restored::new(folder, items);
        restored.needs_power_cycle = needs_power_cycle;
        restored
    }
}

impl Report for Restored {
    fn view(&self) -> View {
        View::table(parts::table(&self.parts, "restored"))
    }

    fn failure(&self) -> Option<Failure> {
        let not_done = self.needs_power_cycle.then(|| Failure::new(Kind::ConditionNotMet, POWER_CYCLE));
        parts::failure(&self.parts).or(not_done)
    }
}
