//! `yrcx restore`.

use std::path::PathBuf;

use clap::Args;

use super::content::{self, Controller, Store};
use super::parts::Part;
use crate::command::backup::{Item, Items, Only, Restored, Restoring};
use crate::command::dry_run::unknown;
use crate::command::interrupt::interruptible;
use crate::command::local::own_folder;
use crate::command::manifest::{self, LeftOut, State};
use crate::command::yrcx::Family;
use crate::command::yrcx::link::Link;
use crate::command::yrcx::refusal::refused;
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::controller::yrcx::signal::output;
use crate::failure::{Failure, Kind};
use crate::output::Screen;

/// Writes back what a backup holds.
#[derive(Debug, Args)]
#[command(
    after_help = "All files are checked first, against their hashes and for their content. Each value is compared \
                  before it is written: what the controller holds already is not written. So after a restore that was \
                  cut off the same command goes on where it ended. What the backup does not have stays as it is: \
                  remote commands cannot remove a point.\n\nParameters and settings (speeds, inching distance, hand \
                  system) change how the robot moves, and are left out unless --machine is given. While the robot \
                  program runs, nothing is written."
)]
pub struct Restore {
    /// Folder of the backup
    folder: PathBuf,
    /// Parts whose names fit, such as variables or 'points*' (repeatable)
    #[arg(long, value_name = "PATTERN", value_delimiter = ',')]
    only: Vec<String>,
    /// Write parameters and settings, too; needs --yes
    #[arg(long)]
    machine: bool,
    /// Write the backup of other robots
    #[arg(long)]
    force: bool,
}

/// A part with what is to be written.
struct Job {
    part: Part,
    stores: Vec<Store>,
}

impl Restore {
    /// Of what is asked for in any family.
    pub fn of(restoring: &Restoring) -> Self {
        let Restoring { folder, only: Only(only), machine, force } = restoring.clone();
        Self { folder, only, machine, force }
    }
}

impl Command for Restore {
    type Family = Family;
    type Report = Restored;
    const ID: &'static str = "yrcx.restore";

    fn risk(&self) -> Risk {
        Risk::Destroy
    }

    fn intent(&self) -> String {
        "overwrite what the controller stores by the backup".to_owned()
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Restored, Failure> {
        let Context { link, screen, robot, several, .. } = context;
        link.no_unit("a backup is of the whole controller")?;
        let folder = own_folder(&self.folder, &robot.name, several);
        let manifest: manifest::Manifest<Controller> = manifest::existing(&folder)?;
        let only = Only(self.only.clone());
        let saved = || manifest.files.iter().filter(|entry| entry.copy.is_some());
        only.check(&saved().map(|entry| entry.name.as_str()).collect::<Vec<_>>())?;
        let mut jobs = Vec::new();
        for part in Part::in_order_of_writing().filter(|part| only.has(&part.to_string()) && *part != Part::Info) {
            let Some(copy) = manifest.entry(&part.to_string()).and_then(|entry| entry.copy.as_ref()) else { continue };
            if part.is_machine() && !self.machine {
                continue;
            }
            copy.check(&folder)?;
            jobs.push(Job { part, stores: content::load(part, &folder)? });
        }
        if jobs.is_empty() {
            return Err(Failure::usage("there is nothing to write in these parts")
                .hint("parameters and settings are written with --machine only, and info never"));
        }
        if link.is_dry() {
            return dry_run(link, &jobs).await;
        }
        // The caller waits for Ctrl-C too, but asks this work first; so it ends here, with the account.
        let mut items: Vec<Item> = jobs.iter().map(|job| pending(job.part)).collect();
        match interruptible(self.restore(link, screen, &manifest.controller, &jobs, &mut items)).await {
            Ok(outcome) => outcome?,
            Err(failure) => {
                let first = items.iter_mut().find(|item| matches!(item.state, State::NotTried));
                first.ok_or_else(|| failure.clone())?.fail(failure);
            }
        }
        Ok(Restored::new(&folder, Items::new(items)))
    }
}

impl Restore {
    async fn restore(
        &self,
        link: &mut Link,
        screen: &Screen,
        backup: &Controller,
        jobs: &[Job],
        items: &mut [Item],
    ) -> Result<(), Failure> {
        let image = link.look().await?;
        if output::PROGRAM_RUNNING.is_on(&image) {
            return Err(Failure::new(Kind::RefusedHere, "the robot program runs, and may use what would be written")
                .hint("stop it first (`yrcx stop`), then restore"));
        }
        let found = Controller::ask(link).await?;
        if found.robots != backup.robots && !self.force {
            let message =
                format!("the backup is of robot type {}, the controller has {}", backup.types(), found.types());
            return Err(Failure::new(Kind::RefusedHere, message)
                .hint("take the backup of this controller; --force writes it all the same"));
        }
        let total = jobs.len();
        for (number, (Job { part, stores }, item)) in jobs.iter().zip(items).enumerate() {
            screen.step(&format!("{}/{total} {part}", number + 1));
            match store_all(link, screen, *part, stores, item).await {
                Ok(()) => {}
                Err(failure) => {
                    if !item.fail(failure) {
                        break;
                    }
                }
            }
        }
        Ok(())
    }
}

fn pending(part: Part) -> Item {
    Item { file: Some(part.file()), written: Some(0), unchanged: Some(0), ..Item::pending(part) }
}

/// Writes what differs. What the controller refuses is noted, and the rest goes on.
async fn store_all(
    link: &mut Link,
    screen: &Screen,
    part: Part,
    stores: &[Store],
    item: &mut Item,
) -> Result<(), Failure> {
    let mut progress = screen.items_progress(&format!("writing {part}"), stores.len() as u64);
    let mut refusal = None;
    for store in stores {
        let at = |failure: Failure| Failure { message: format!("{}: {}", store.key, failure.message), ..failure };
        let there = content::ask(link, &store.read).await.map_err(at)?;
        if there.is_ok_and(|values| store.is_there(&values)) {
            count(&mut item.unchanged);
        } else {
            match content::ask(link, &store.write).await.map_err(at)? {
                Ok(_) => count(&mut item.written),
                Err(alarm) => {
                    let failure = refused(store.write.row(), alarm);
                    item.left_out.push(LeftOut { key: store.key.clone(), why: failure.message.clone() });
                    refusal.get_or_insert(at(failure));
                }
            }
        }
        progress.advance(1);
    }
    item.state = State::Done;
    refusal.map_or(Ok(()), Err)
}

fn count(counter: &mut Option<usize>) {
    *counter = counter.map(|count| count + 1);
}

async fn dry_run(link: &mut Link, jobs: &[Job]) -> Result<Restored, Failure> {
    Controller::plan(link)?;
    for Job { part, stores } in jobs {
        for store in stores {
            link.plan(&store.read, &format!("{part} {}, to compare", store.key));
            link.plan(&store.write, "if it differs");
        }
    }
    Err(unknown())
}
