//! `yrcx restore`.

use super::content::{self, Controller, Store};
use super::parts::Part;
use crate::command::Context;
use crate::command::backup::manifest;
use crate::command::backup::manifest::LeftOut;
use crate::command::backup::{NOT_CHOSEN, NOT_MACHINE, RestoreSelection, Restored, would_leave, would_write};
use crate::command::frame::dry_run::{Reason, unknown};
use crate::command::frame::interrupt::interruptible;
use crate::command::robot::file::{FileItem, State};
use crate::command::yrcx::link::Link;
use crate::command::yrcx::link::Yrcx;
use crate::command::yrcx::refusal::refused;
use crate::controller::yrcx::signal::output;
use crate::failure::{Failure, Kind};
use crate::gate::Change;
use crate::output::Screen;

/// A part with the values to be written.
struct Job {
    part: Part,
    /// Values in the order of writing.
    stores: Vec<Store>,
}

/// Restores a backup.
pub async fn restore(context: Context<'_, Yrcx>, restoring: &RestoreSelection) -> Result<Restored, Failure> {
    let Context { link, screen, authority, .. } = context;
    let RestoreSelection { folder, only, machine, force } = restoring;
    link.no_unit("a backup contains the whole controller")?;
    let manifest: manifest::Manifest<Controller> = manifest::open_existing(folder)?;
    let saved = || manifest.files.iter().filter(|entry| entry.copy.is_some());
    only.check(&saved().map(|entry| entry.name.as_str()).collect::<Vec<_>>())?;
    let (mut jobs, mut items) = (Vec::new(), Vec::new());
    for part in Part::in_order_of_writing().filter(|part| only.has(&part.to_string()) && *part != Part::Info) {
        let Some(copy) = manifest.entry(&part.to_string()).and_then(|entry| entry.copy.as_ref()) else { continue };
        if part.is_machine() && !machine {
            continue;
        }
        copy.check(folder)?;
        items.push(FileItem::values(part).from_copy(folder, copy));
        jobs.push(Job { part, stores: content::load(part, folder)? });
    }
    if jobs.is_empty() {
        return Err(Failure::usage("there is nothing to write in these parts")
            .hint("add --machine to write parameters and settings; info is never written"));
    }
    if link.is_dry() {
        plan_items(link, saved().map(|entry| entry.name.as_str()), &jobs, *machine);
        return dry_run(link, &jobs);
    }
    check_origin(link, &manifest.controller, *force).await?;
    let mut found = Comparison::default();
    let mut compared = screen.parts_progress("parts compared", jobs.len());
    for (job, item) in jobs.iter().zip(&mut items) {
        found.compare(link, screen, job, item).await?;
        compared.advance(1);
    }
    authority.confirm(&found.change(&folder.display().to_string())).await?;
    // Ctrl-C ends the work here, before the caller handles it, so that the result is reported.
    match interruptible(write_all(link, screen, &jobs, &found, &mut items)).await {
        Ok(outcome) => outcome?,
        Err(failure) => {
            let first = items.iter_mut().find(|item| item.more.state == State::NotTried);
            first.ok_or_else(|| failure.clone())?.fail(failure);
        }
    }
    Ok(Restored::new(folder, items))
}

/// Notes each part of the backup in a dry run.
fn plan_items<'m>(link: &mut Link, saved: impl Iterator<Item = &'m str>, jobs: &[Job], machine: bool) {
    let parts: Vec<Part> = Part::in_order_of_writing().collect();
    for name in saved {
        let part = parts.iter().find(|part| part.to_string() == name);
        let why = match part {
            None | Some(Part::Info) => "information about the controller, which a restore does not write",
            Some(part) if part.is_machine() && !machine => NOT_MACHINE,
            Some(_) => NOT_CHOSEN,
        };
        link.plan_item(match jobs.iter().find(|job| Some(&job.part) == part) {
            Some(job) => would_write(name, ("values", job.stores.len() as u64), IF_IT_DIFFERS),
            None => would_leave(name, why),
        });
    }
}

/// Checks whether the backup can be written to this controller now.
async fn check_origin(link: &mut Link, backup: &Controller, force: bool) -> Result<(), Failure> {
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

/// Comparison of the controller with the backup.
#[derive(Default)]
struct Comparison {
    /// Indexes of the values to be written, for each part.
    differ: Vec<Vec<usize>>,
    /// Overwritten values: name, old, new.
    replaced: Vec<(String, String, String)>,
    /// Number of values that are new to the controller.
    added: usize,
}

impl Comparison {
    /// Reads the current values of a part.
    async fn compare(
        &mut self,
        link: &mut Link,
        screen: &Screen,
        Job { part, stores }: &Job,
        item: &mut FileItem,
    ) -> Result<(), Failure> {
        let mut progress = screen.items_progress(&format!("comparing {part}"), stores.len() as u64);
        let mut differ = Vec::new();
        for (at, store) in stores.iter().enumerate() {
            let there = content::ask(link, &store.read).await.map_err(|failure| named(store, failure))?;
            match there {
                Ok(values) if store.is_there(&values) => count(&mut item.more.unchanged),
                Ok(values) => {
                    let what = format!("{} {}", part.kind(), store.key);
                    self.replaced.push((what, store.describe(&values), store.wanted()));
                    differ.push(at);
                }
                Err(_) => {
                    self.added += 1;
                    differ.push(at);
                }
            }
            progress.advance(1);
        }
        self.differ.push(differ);
        Ok(())
    }

    /// Content of the confirmation.
    fn change(&self, folder: &str) -> Change {
        let count = match self.replaced.len() {
            0 => return Change::none(),
            1 => "1 value".to_owned(),
            many => format!("{many} values"),
        };
        let change = Change::new(format!("overwrite {count} with the values of {folder}"));
        let change = self.replaced.iter().fold(change, |change, (what, old, new)| change.replaces(what, old, new));
        match self.added {
            0 => change,
            added => change.note(format!("New values are added: {added}.")),
        }
    }
}

/// Writes the differing values.
async fn write_all(
    link: &mut Link,
    screen: &Screen,
    jobs: &[Job],
    found: &Comparison,
    items: &mut [FileItem],
) -> Result<(), Failure> {
    let mut written = screen.parts_progress("parts written", jobs.len());
    for ((job, differ), item) in jobs.iter().zip(&found.differ).zip(items) {
        if let Err(failure) = write(link, screen, job, differ, item).await
            && !item.fail(failure)
        {
            break;
        }
        written.advance(1);
    }
    Ok(())
}

/// Writes the differing values of a part. A refusal is noted, and the other values are still written.
async fn write(
    link: &mut Link,
    screen: &Screen,
    Job { part, stores }: &Job,
    differ: &[usize],
    item: &mut FileItem,
) -> Result<(), Failure> {
    let mut progress = screen.items_progress(&format!("writing {part}"), differ.len() as u64);
    let mut refusal = None;
    for store in differ.iter().filter_map(|at| stores.get(*at)) {
        match content::ask(link, &store.write).await.map_err(|failure| named(store, failure))? {
            Ok(_) => count(&mut item.more.written),
            Err(alarm) => {
                let failure = refused(store.write.row(), alarm);
                item.more.left_out.push(LeftOut { key: store.key.clone(), why: failure.message.clone() });
                refusal.get_or_insert(named(store, failure));
            }
        }
        progress.advance(1);
    }
    item.succeed(State::Done);
    refusal.map_or(Ok(()), Err)
}

/// Failure with the name of the value.
fn named(store: &Store, failure: Failure) -> Failure {
    Failure { message: format!("{}: {}", store.key, failure.message), ..failure }
}

fn count(counter: &mut Option<usize>) {
    *counter = counter.map(|count| count + 1);
}

fn dry_run(link: &mut Link, jobs: &[Job]) -> Result<Restored, Failure> {
    Controller::plan(link)?;
    for Job { part, stores } in jobs {
        for store in stores {
            link.plan(&store.read, &format!("{part} {}, to compare", store.key));
        }
    }
    for Job { part, stores } in jobs {
        for store in stores {
            let about = format!("{part} {}", store.key);
            link.plan_depending(&store.write, &store.write, Reason::about(&about).depending_on(IF_IT_DIFFERS));
        }
    }
    Err(unknown())
}

/// Condition for writing a value, for dry runs.
const IF_IT_DIFFERS: &str = "the comparison: written if different";
