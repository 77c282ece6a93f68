//! `yrcx restore`.

use super::content::{self, Controller};
use super::parts::Part;
use crate::prelude::*;
use armctl_frame::backup::manifest;
use armctl_frame::backup::parts::{ReplacedValues, Table, compare_all, overwriting, write_all};
use armctl_frame::backup::{NOT_CHOSEN, NOT_MACHINE, RestoreReport, RestoreSelection, would_leave, would_write};
use armctl_frame::robot::file::FileItem;

/// A part with the rows to be written.
struct Job {
    part: Part,
    table: Table<Yrcx>,
}

/// Restores a backup.
pub async fn restore(context: Context<'_, Yrcx>, restoring: &RestoreSelection) -> Result<RestoreReport> {
    let Context { link, screen, confirmer, .. } = context;
    let RestoreSelection { folder, only, machine, force } = restoring;
    link.reject_unit("a backup contains the whole controller")?;
    let manifest: manifest::Manifest<Controller> = manifest::open_existing(folder)?;
    let copy = |part: &Part| manifest.entry(&part.to_string()).and_then(|entry| entry.copy.as_ref());
    let saved: Vec<_> = Part::in_order_of_writing().filter_map(|part| Some((part, copy(&part)?))).collect();
    only.check(&saved.iter().flat_map(|(part, _)| part.names()).collect::<Vec<_>>())?;
    let (mut jobs, mut items) = (Vec::new(), Vec::new());
    for (part, copy) in &saved {
        if !only.has_any(&part.names()) || part.is_machine() && !machine || *part == Part::Info {
            continue;
        }
        copy.check(folder)?;
        if let Some(table) = content::load(*part, folder)? {
            items.push(FileItem::values(part).from_copy(folder, copy));
            jobs.push(Job { part: *part, table });
        }
    }
    if jobs.is_empty() {
        return Err(Failure::usage("there is nothing to write in these parts")
            .hint("add --machine to write parameters and settings; `info` is never written"));
    }
    if link.is_dry_run() {
        plan_items(link, saved.iter().map(|(part, _)| *part), &jobs, *machine);
        return dry_run(link, screen, &mut jobs).await;
    }
    check_origin(link, &manifest.controller, *force).await?;
    compare_all(link, screen, tables(&mut jobs).zip(&mut items)).await?;
    let compared = jobs.iter().zip(&items).filter(|(_, item)| item.error.is_none());
    let replaced: Vec<ReplacedValues> = compared.map(|(job, _)| ReplacedValues::of(&job.part, &job.table)).collect();
    confirmer.confirm(&overwriting(folder, &replaced)).await?;
    write_all(link, screen, tables(&mut jobs).zip(&mut items)).await;
    Ok(RestoreReport::new(folder, items))
}

fn tables(jobs: &mut [Job]) -> impl ExactSizeIterator<Item = &mut Table<Yrcx>> {
    jobs.iter_mut().map(|job| &mut job.table)
}

/// Notes for each part of the backup, in a dry run, whether it would be written.
fn plan_items(link: &mut Link, saved: impl Iterator<Item = Part>, jobs: &[Job], machine: bool) {
    for part in saved {
        let why = match part {
            Part::Info => "information about the controller, which a restore does not write",
            part if part.is_machine() && !machine => NOT_MACHINE,
            _ => NOT_CHOSEN,
        };
        link.plan_item(match jobs.iter().find(|job| job.part == part) {
            Some(job) => {
                would_write(part, ("values", job.table.count() as u64), "the comparison: written if different")
            }
            None => would_leave(part, why),
        });
    }
}

/// Checks that the controller can accept this backup now: no program is running, and the robots are the same.
async fn check_origin(link: &mut Link, backup: &Controller, force: bool) -> Result<()> {
    let image = link.look().await?;
    if output::PROGRAM_RUNNING.is_on(&image) {
        return Err(Failure::new(
            Kind::Rejected,
            "the robot program is running, and may use the data that the restore writes",
        )
        .hint("stop the program (`yrcx stop`), then restore"));
    }
    let found = Controller::ask(link).await?;
    if found.robots != backup.robots && !force {
        let message =
            format!("the backup is from robot type {}, but the controller has {}", backup.types(), found.types());
        return Err(Failure::new(Kind::Rejected, message)
            .hint("use a backup of this controller, or add --force to write this backup anyway"));
    }
    Ok(())
}

/// Notes the requests of all comparisons, then those of all writes.
async fn dry_run(link: &mut Link, screen: &Screen, jobs: &mut [Job]) -> Result<RestoreReport> {
    Controller::plan(link)?;
    for table in tables(jobs) {
        table.compare(link, screen).await?;
    }
    for table in tables(jobs) {
        table.write(link, screen).await?;
    }
    Err(unknown())
}
