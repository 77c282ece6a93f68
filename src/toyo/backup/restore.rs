//! `toyo restore`.

use super::content::{self, Content, Table};
use super::manifest::{Controller, Manifest};
use super::parts::Part;
use crate::eeprom::{Cell, Cells};
use crate::number_arguments::saturated_byte;
use crate::prelude::*;
use armctl_controller::toyo::table::Group;
use armctl_frame::backup::arguments::RestoreOptions;
use armctl_frame::backup::manifest;
use armctl_frame::backup::manifest::{MANIFEST, Saved};
use armctl_frame::backup::parts::{ReplacedValues, compare_all, overwriting, settle, write_all};
use armctl_frame::backup::{NOT_CHOSEN, NOT_MACHINE, Only, RestoreReport, RestoreSelection, would_leave, would_write};
use armctl_frame::interrupt::interruptible;
use armctl_frame::local_names::private_folder;
use armctl_frame::robot::file::{FileItem, State};
use armctl_frame::settings_report::nothing_written;
use armctl_frame::store::PartResult;

/// Write a backup back to the controller.
#[derive(Debug, Args)]
#[command(after_help = "armctl first checks all files: their hashes and their content. It compares each value before \
                        the write. It does not write equal values, because an EEPROM cell wears out after about a \
                        million writes. To continue after an interruption, run the same command again.\n\nMachine \
                        parameters (E) and special parameters (U) need --machine. armctl writes them first. After a \
                        change of a machine parameter (E), armctl writes nothing else, because the controller \
                        executes no command until a restart. Restart the controller, then restore again without \
                        --machine.\n\nThe restore selects program mode temporarily.")]
pub struct Restore {
    #[command(flatten)]
    options: RestoreOptions,
    /// Continue an interrupted restore. With the name of a part, do not compare the parts before this part
    #[arg(long, value_name = "PART", num_args = 0..=1, require_equals = true, default_missing_value = "parameters")]
    resume: Option<Part>,
}

/// Options of a restore.
struct RestoreRequest {
    restoring: RestoreSelection,
    resume: Option<Part>,
}

/// A part to restore.
struct Job {
    part: Part,
    saved: Saved,
    /// Number of steps that a program needs.
    steps: u16,
    /// Rows of the part.
    table: Table,
}

/// Everything to restore, in the order of the writes.
struct Jobs {
    /// Parameters of the machine itself, if the user requested them.
    machine: Option<Table>,
    parts: Vec<Job>,
    /// Speed override of the backup, and the current speed override.
    speed: Option<(Cell, Option<u8>)>,
}

impl Command for Restore {
    type Family = Toyo;
    type Report = RestoreReport;
    const ID: &'static str = "toyo.restore";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite the data of the controller with the backup";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<RestoreReport> {
        let restoring = self.options.restoring();
        let folder = private_folder(&restoring.folder, &context.robot.name, context.several);
        RestoreRequest { restoring: RestoreSelection { folder, ..restoring }, resume: self.resume }.run(context).await
    }
}

/// Writes the data of a backup back to the controller.
pub async fn restore(context: Context<'_, Toyo>, restoring: &RestoreSelection) -> Result<RestoreReport> {
    RestoreRequest { restoring: restoring.clone(), resume: None }.run(context).await
}

impl RestoreRequest {
    async fn run(&self, context: Context<'_, Toyo>) -> Result<RestoreReport> {
        let Context { link, screen, robot, confirmer, .. } = context;
        let folder = &self.restoring.folder;
        let manifest: Manifest = manifest::open_existing(folder)?;
        // Checks that robot and address are as in the backup. The machine itself is checked later.
        manifest::check_origin(&manifest::open_existing::<serde_json::Value>(folder)?, robot, self.restoring.force)?;
        let parts = self.chosen(&manifest)?;
        if self.restoring.machine && !parts.contains(&Part::Parameters) {
            return Err(Failure::usage("--machine needs the parameters, which --only excludes")
                .hint("remove --machine, or add `parameters` to --only"));
        }
        let mut contents = Vec::new();
        for part in parts {
            if let Some(copy) = manifest.entry(&part.to_string()).and_then(|entry| entry.copy.as_ref()) {
                copy.check(folder)?;
                let loaded = Content::load(part, folder, manifest.controller.letters(), screen)?;
                contents.push((part, copy.clone(), loaded));
            }
        }
        if link.is_dry_run() {
            let jobs = self.jobs(&manifest.controller, contents, None)?;
            return self.dry_run(link, screen, &manifest, jobs).await;
        }
        let outcome = self.restore((link, screen, &confirmer), &manifest.controller, contents).await;
        match outcome {
            // After Ctrl-C, only the blocks that restore temporary changes are sent, when the link is closed.
            Ok(report) if report.is_interrupted() => Ok(report),
            outcome => task_selection::restore_task(link, outcome).await,
        }
    }

    /// Tables of the parts. The table of a program fills all steps of its task. Their number is not known in a dry run.
    fn jobs(
        &self,
        backup: &Controller,
        contents: Vec<(Part, Saved, Content)>,
        found: Option<&Controller>,
    ) -> Result<Jobs> {
        let mut jobs = Jobs { machine: None, parts: Vec::new(), speed: None };
        for (part, saved, content) in contents {
            let steps = content.steps();
            let room = match (part, found) {
                (Part::Program(task), Some(found)) => found.task_steps[usize::from(task) - 1],
                _ => steps,
            };
            let [machine, table] = content.tables(room);
            if let Some(machine) = machine {
                jobs.machine = Some(machine);
            }
            if let Some(table) = table {
                jobs.parts.push(Job { part, saved, steps, table });
            }
        }
        if self.restoring.only == Only::default() {
            jobs.speed = speed(backup)?.map(|cell| (cell, None));
        }
        Ok(jobs)
    }

    /// The parts to restore, in the order of writing.
    fn chosen(&self, manifest: &Manifest) -> Result<Vec<Part>> {
        let tasks = [1, 2, 3, 4];
        let mut parts = Part::all(&tasks, &tasks);
        parts.retain(|part| manifest.entry(&part.to_string()).is_some_and(|entry| entry.copy.is_some()));
        let only = &self.restoring.only;
        only.check(&parts.iter().flat_map(|part| part.names()).collect::<Vec<_>>())?;
        parts.retain(|part| only.has_any(&part.names()));
        if parts.is_empty() {
            return Err(Failure::usage("the backup has none of these parts")
                .hint(format!("see {MANIFEST} for the parts of the backup")));
        }
        if let Some(resume) = self.resume {
            let first = parts.iter().position(|part| *part == resume);
            // The parameters are always the first part. If they are not selected, the restore starts with the first
            // selected part.
            let first = first.or_else(|| (resume == Part::Parameters).then_some(0));
            let first = first.ok_or_else(|| {
                Failure::usage(format!("--resume={resume}: the backup does not contain this part"))
                    .hint("type a part from the manifest of the backup, or --resume alone")
            })?;
            parts.drain(..first);
        }
        Ok(parts)
    }

    async fn restore(
        &self,
        (link, screen, confirmer): (&mut Link, &Screen, &Confirmer<'_>),
        backup: &Controller,
        contents: Vec<(Part, Saved, Content)>,
    ) -> Result<RestoreReport> {
        let found = content::controller(link).await?;
        if !self.restoring.force {
            identify(backup, &found, self.restoring.machine)?;
        }
        let Jobs { mut machine, mut parts, mut speed } = self.jobs(backup, contents, Some(&found))?;
        let folder = &self.restoring.folder;
        let pending = |job: &Job| FileItem::values(job.part).from_copy(folder, &job.saved);
        let mut results: Vec<FileItem> = parts.iter().map(pending).collect();
        machine.take_if(|_| !self.restoring.machine);
        if let Some(machine) = &mut machine {
            interruptible(machine.compare(link, screen))
                .await
                .and_then(|compared| compared)
                .map_err(nothing_written)?;
        }
        let needs_power_cycle = machine.iter().any(changes_machine);
        if needs_power_cycle {
            speed = None;
        } else {
            check_room(&parts, &found)?;
            compare_all(link, screen, tables(&mut parts).zip(&mut results)).await?;
            if let Some((cell, present)) = &mut speed {
                *present =
                    link.read_if_present(&cell.read).await.map_err(nothing_written)?.map(|record| percent(&record));
            }
        }
        let compared = || parts.iter().zip(&results).filter(|(_, result)| !needs_power_cycle && result.error.is_none());
        let machine_values = machine.iter().map(|table| ReplacedValues::of(&"machine", table));
        let values = compared().map(|(job, _)| ReplacedValues::of(&job.part, &job.table));
        let replaced: Vec<_> = machine_values.chain(values).chain(speed.as_ref().and_then(replaced_speed)).collect();
        confirmer.confirm(&overwriting(folder, &replaced)).await?;
        steps::open(link).await?;
        if let Some(machine) = &mut machine {
            let written = interruptible(machine.write(link, screen)).await.and_then(|written| written);
            let is_whole = written.as_ref().is_ok_and(|written| written.failure.is_none());
            if needs_power_cycle || !is_whole {
                if let Some(result) = results.iter_mut().find(|result| result.name == Part::Parameters.to_string()) {
                    settle(result, written);
                    // The parameters that do not belong to the machine were not written.
                    if is_whole {
                        (result.more.state, result.ok) = (State::NotTried, false);
                    }
                }
                let mut restored = RestoreReport::new(folder, results);
                restored.needs_power_cycle = is_whole;
                return Ok(restored);
            }
        }
        write_all(link, screen, tables(&mut parts).zip(&mut results)).await;
        if let Some((cell, present)) = speed {
            let mut result = FileItem::values("override");
            if results.iter().all(|result| result.more.state != State::NotTried) {
                settle(&mut result, write_speed(link, screen, &cell, present).await);
            }
            results.push(result);
        }
        Ok(RestoreReport::new(folder, results))
    }

    async fn dry_run(
        &self,
        link: &mut Link,
        screen: &Screen,
        manifest: &Manifest,
        jobs: Jobs,
    ) -> Result<RestoreReport> {
        const ON: &str = "the comparison: armctl writes the values that differ";
        let Jobs { machine, mut parts, speed } = jobs;
        for entry in manifest.files.iter().filter(|entry| entry.copy.is_some()) {
            let Some(job) = parts.iter().find(|job| job.part.to_string() == entry.name) else {
                link.plan_item(would_leave(&entry.name, NOT_CHOSEN));
                continue;
            };
            link.plan_item(would_write(&entry.name, ("values", job.table.count() as u64), ON));
            if let Some(machine) = machine.as_ref().filter(|table| job.part == Part::Parameters && table.count() > 0) {
                let name = format!("{}: machine and special parameters", entry.name);
                let written = || would_write(&name, ("values", machine.count() as u64), ON);
                link.plan_item(if self.restoring.machine { written() } else { would_leave(&name, NOT_MACHINE) });
            }
        }
        content::plan_controller(link);
        let mut machine = machine.filter(|_| self.restoring.machine);
        if let Some(machine) = &mut machine {
            machine.compare(link, screen).await?;
        }
        for job in &mut parts {
            job.table.compare(link, screen).await?;
            if let Part::Program(_) = job.part {
                let behind = steps::read_request(job.steps.saturating_add(1).min(5000));
                link.plan(&behind, "and so on to the last step of the task");
            }
        }
        if let Some((cell, _)) = &speed {
            link.plan(&cell.read, "the override");
        }
        steps::plan_open(link).await?;
        if let Some(machine) = &mut machine {
            machine.write(link, screen).await?;
        }
        for job in &mut parts {
            job.table.write(link, screen).await?;
            if let Part::Program(_) = job.part {
                link.then(&format!("after the steps of {}, each later step that is not NOP becomes NOP", job.part));
            }
        }
        if let Some((cell, _)) = &speed {
            link.plan_overwriting(&cell.read, &cell.write.text()).await?;
        }
        link.put_back().await?;
        Err(unknown())
    }
}

/// Whether a part changes parameters of the machine itself, so that the controller needs a restart.
fn changes_machine(table: &Table) -> bool {
    let parameter = |name: &String| Parameter::named(name).is_some_and(|found| found.group() == Group::Machine);
    table.differing().iter().any(parameter)
}

/// The tables of the parts.
fn tables(parts: &mut [Job]) -> impl ExactSizeIterator<Item = &mut Table> {
    parts.iter_mut().map(|job| &mut job.table)
}

/// The override, if it will be replaced.
fn replaced_speed((cell, present): &(Cell, Option<u8>)) -> Option<ReplacedValues> {
    let (present, new) = ((*present)?, percent(&cell.wanted));
    let row = ["override".to_owned(), format!("{present} %"), format!("{new} %")];
    let values = if new == present { Vec::new() } else { vec![row] };
    Some(ReplacedValues { part: "override".to_owned(), nouns: ["override", "overrides"], values, notes: Vec::new() })
}

/// Speed override in an answer or a request.
fn percent(record: &Record) -> u8 {
    saturated_byte(record, "override")
}

/// Speed override of the backup.
fn speed(backup: &Controller) -> Result<Option<Cell>> {
    let Some(percent) = backup.speed_override_percent else { return Ok(None) };
    let values = vec![Value::Number(percent.into())];
    let wanted = table::Command::Rovr.row().answers[0].record(values.clone());
    Ok(Some(Cell {
        read: Request::bare(table::Command::Rovr),
        write: Request::new(table::Command::Wovr, values).map_err(|error| wrong(&error))?,
        wanted: wanted.map_err(|error| wrong(&error))?,
    }))
}

/// Writes the speed override if it differs.
async fn write_speed(link: &mut Link, screen: &Screen, cell: &Cell, present: Option<u8>) -> Result<PartResult> {
    if present.is_none_or(|present| present == percent(&cell.wanted)) {
        return Ok(PartResult { unchanged: usize::from(present.is_some()), ..PartResult::default() });
    }
    interruptible(link.overwrite(screen, cell, &mut Cells::default())).await.and_then(|written| written)?;
    Ok(PartResult { written: 1, ..PartResult::default() })
}

/// Checks that the controller is the machine of the backup: its robot type (SYSP), the axes of each task (parameter
/// E19), and the letters of the axes (parameter E01). With `machine`, E19 and E01 are restored, so they are not
/// compared.
fn identify(backup: &Controller, found: &Controller, machine: bool) -> Result<()> {
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
    let other: Vec<String> = other
        .map(|(what, saved, found, _)| format!("{what} is {saved} in the backup and {found} on this controller"))
        .collect();
    if other.is_empty() {
        return Ok(());
    }
    Err(Failure::new(Kind::Rejected, format!("the backup is from another machine: {}", other.join(", ")))
        .hint("use a backup of this robot, or add --force to write this backup anyway; nothing was written"))
}

/// Checks before the first write that all programs fit the tasks.
fn check_room(jobs: &[Job], found: &Controller) -> Result<()> {
    for Job { part, steps, .. } in jobs {
        let Part::Program(task) = part else { continue };
        let room = found.task_steps[usize::from(*task) - 1];
        if *steps > room {
            let message = format!("{part} needs {steps} steps, but task {task} has {room}");
            return Err(Failure::usage(message)
                .hint("restore E22 (task-steps) with --machine, or exclude the part with --only"));
        }
    }
    Ok(())
}
