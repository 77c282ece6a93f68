//! `backup`, `restore` and `diff`: one set of words, for robots of any family and below the word of each.

use std::marker::PhantomData;
use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::Value;

use super::compare::Differences;
use super::diff::DiffOptions;
use super::manifest;
use super::options::{BackupOptions, RestoreOptions};
use super::{BackedUp, Making, Restored, Restoring};
use crate::command::frame::local::own_folder;
use crate::command::{Command, Context, Family};
use crate::controller::Risk;
use crate::failure::Failure;
use crate::gate::Confirmation;
use crate::settings::inventory::Inventory;
use crate::settings::{Robot, target};

/// A family whose robots can be backed up.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Backups: Family {
    /// The names of `backup`, `restore` and `diff` in envelopes and schemas.
    const IDS: [&'static str; 3];

    /// What it takes to read all of a robot, at the most.
    const BACKUP_RISK: Risk = Risk::Read;

    /// What it takes to read all of this robot.
    fn backup_risk(_robot: &Robot) -> Risk {
        Self::BACKUP_RISK
    }
    /// Makes a backup.
    async fn back_up(context: Context<'_, Self>, making: Making) -> Result<BackedUp, Failure>;
    /// Writes a backup back.
    async fn restore(context: Context<'_, Self>, restoring: &Restoring) -> Result<Restored, Failure>;
}

/// Saves what a controller stores in a folder of files.
#[derive(Debug, Args)]
#[group(skip)]
#[command(
    after_help = "Files of a yerc, points and data of a yrcx, parameters, points and programs of a toyo controller; several \
                  robots each in a folder of their name. manifest.json lists what is there with sizes and hashes, and \
                  what is missing and why. `yrcx backup` and `toyo backup` have more options.\n\nTo save \
                  every task of a toyo controller, each is made the current one for a while. That is a change: of a \
                  read-only robot the current task alone is saved."
)]
pub struct Backup<F: Backups> {
    #[command(flatten)]
    options: BackupOptions,
    #[arg(skip)]
    family: PhantomData<fn() -> F>,
}

impl<F: Backups> Backup<F> {
    /// The folder.
    pub fn folder(&self) -> &Path {
        self.options.folder()
    }
}

impl<F: Backups> Command for Backup<F> {
    type Family = F;
    type Report = BackedUp;
    const ID: &'static str = F::IDS[0];
    const RISK: Risk = F::BACKUP_RISK;

    fn risk_on(&self, robot: &Robot) -> Risk {
        F::backup_risk(robot)
    }

    async fn run(&self, context: Context<'_, F>) -> Result<BackedUp, Failure> {
        let making = self.options.making(None);
        let folder = own_folder(&making.folder, &context.robot.name, context.several);
        F::back_up(context, Making { folder, ..making }).await
    }
}

/// Writes back what a backup holds.
#[derive(Debug, Args)]
#[group(skip)]
#[command(
    after_help = "All files are checked against their hashes first, and what differs from the controller is written. So \
                  after a restore that was cut off the same command goes on where it ended. What the controller has \
                  beyond the backup stays.\n\nWhat makes it another machine is left out unless --machine is given: \
                  parameters and system data (yerc), parameters and settings (yrcx), machine parameters (toyo). \
                  `toyo restore` has more options."
)]
pub struct Restore<F: Backups> {
    #[command(flatten)]
    options: RestoreOptions,
    #[arg(skip)]
    family: PhantomData<fn() -> F>,
}

impl<F: Backups> Restore<F> {
    /// The family of the backup.
    pub fn of_family(&self) -> Option<target::Family> {
        family_of(&self.options.restoring().folder)
    }
}

impl<F: Backups> Command for Restore<F> {
    type Family = F;
    type Report = Restored;
    const ID: &'static str = F::IDS[1];
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite what the controller stores by the backup";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, F>) -> Result<Restored, Failure> {
        let restoring = self.options.restoring();
        let folder = place(&restoring.folder, context.robot, context.several);
        manifest::check_origin(&manifest::existing::<Value>(&folder)?, context.robot, restoring.force)?;
        F::restore(context, &Restoring { folder, ..restoring }).await
    }
}

/// Compares a backup with another one, or with a controller.
#[derive(Debug, Args)]
#[group(skip)]
#[command(
    after_help = "With two folders no robot is asked. With one, the controller is read as far as the backup goes, and what \
                  is shown is what changed since: - is the backup, + the controller. `armctl diff ROBOT ROBOT` reads and \
                  compares two controllers of a family; where a folder has such a name, name them with -r. Texts are \
                  compared by lines, other files by their hashes.\n\nPositions (points, shifts, hands, positions of jobs) that are no further apart than \
                  the tolerance are the same: 0.001 mm, 0.001 degrees and 1 pulse, unless --tolerance says otherwise; \
                  such files are named. So are jobs that differ in the line ///DATE alone, which \
                  controllers rewrite: it is ignored. --exact compares every byte. Exit code 0: the same; 8: different."
)]
pub struct Diff<F: Backups> {
    #[command(flatten)]
    options: DiffOptions,
    #[arg(skip)]
    family: PhantomData<fn() -> F>,
}

impl<F: Backups> Diff<F> {
    /// The family of the backup.
    pub fn of_family(&self) -> Option<target::Family> {
        family_of(self.options.old.as_deref()?)
    }

    /// What is compared, and how exactly.
    pub fn options(&self) -> &DiffOptions {
        &self.options
    }

    /// Whether robots may be asked: not where two folders are compared.
    pub fn may_ask_robots(&self) -> bool {
        self.options.new.is_none() || !self.options.names_folder()
    }

    /// The two robots that are named in place of folders.
    pub fn robots(&self, inventory: &Inventory) -> Option<[String; 2]> {
        let named = |path: &Option<PathBuf>| {
            let name = path.as_ref()?.to_str()?;
            inventory.robots.iter().find(|robot| robot.name == name).map(|robot| robot.name.clone())
        };
        let robots = [named(&self.options.old)?, named(&self.options.new)?];
        (!self.options.names_folder()).then_some(robots)
    }
}

impl<F: Backups> Command for Diff<F> {
    type Family = F;
    type Report = Differences;
    const ID: &'static str = F::IDS[2];
    const RISK: Risk = F::BACKUP_RISK;

    fn risk_on(&self, robot: &Robot) -> Risk {
        F::backup_risk(robot)
    }

    fn uses_files(&self) -> bool {
        true
    }

    fn takes_robot(&self) -> bool {
        self.options.new.is_none()
    }

    fn run_alone(&self) -> Result<Differences, Failure> {
        self.options.two_folders()
    }

    async fn run(&self, context: Context<'_, F>) -> Result<Differences, Failure> {
        let robot = context.robot;
        let folder = place(self.options.folder()?, robot, context.several);
        self.options.with_controller(folder, robot, |making| F::back_up(context, making)).await
    }
}

/// The folder of a robot's backup in what was named: the folder of its name in it, where several robots have one.
fn place(folder: &Path, robot: &Robot, several: bool) -> PathBuf {
    let own = own_folder(folder, &robot.name, true);
    let has_list = |folder: &Path| folder.join(manifest::MANIFEST).exists();
    if several || !has_list(folder) && has_list(&own) { own } else { folder.to_owned() }
}

/// The family of the backup in a folder, for simulators, which can be of any.
fn family_of(folder: &Path) -> Option<target::Family> {
    manifest::read::<Value>(folder).ok()??.family.parse().ok()
}
