//! `backup`, `restore` and `diff` commands, for robots of any family and for each family.

use std::marker::PhantomData;

use super::arguments::{BackupOptions, RestoreOptions};
use super::compare::Differences;
use super::diff::DiffOptions;
use super::{BackupReport, RestoreReport, RestoreSelection, SaveOptions};
use super::{manifest, save};
use crate::local_names::private_folder;
use crate::prelude::basics::*;
use crate::settings::inventory::Inventory;
use crate::settings::target;
use crate::{Command, Context, Family};

/// A family with backups.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Backups: Family {
    /// Names of `backup`, `restore` and `diff` in envelopes and schemas.
    const IDS: [&'static str; 3];

    /// Maximum risk of reading all data of a robot.
    const BACKUP_RISK: Risk = Risk::Read;

    /// Risk of reading all data of this robot.
    fn backup_risk(_robot: &Robot) -> Risk {
        Self::BACKUP_RISK
    }
    /// Makes a backup.
    async fn back_up(context: Context<'_, Self>, making: SaveOptions) -> Result<BackupReport>;
    /// Restores a backup.
    async fn restore(context: Context<'_, Self>, restoring: &RestoreSelection) -> Result<RestoreReport>;
}

/// Saves the data of a controller to a folder of files.
#[derive(Debug, Args)]
#[group(skip)]
#[command(
    after_help = "The backup contains the files of a yerc controller, the points and data of a yrcx controller, or \
                  the parameters, points and programs of a toyo controller. With several robots, each robot has a \
                  folder with its name. manifest.json lists the files with sizes and hashes, and the missing data \
                  with the reason. `yrcx backup` and `toyo backup` have more options.\n\nTo save every task of a toyo \
                  controller, armctl selects each task temporarily. Selecting a task is a change, so armctl saves \
                  only the current task of a read-only robot."
)]
pub struct Backup<F: Backups> {
    #[command(flatten)]
    options: BackupOptions,
    #[arg(skip)]
    family: PhantomData<fn() -> F>,
}

impl<F: Backups> Backup<F> {
    /// Folder.
    pub fn folder(&self) -> &Path {
        self.options.folder()
    }
}

impl<F: Backups> Command for Backup<F> {
    type Family = F;
    type Report = BackupReport;
    const ID: &'static str = F::IDS[0];
    const RISK: Risk = F::BACKUP_RISK;

    fn risk_on(&self, robot: &Robot) -> Risk {
        F::backup_risk(robot)
    }

    async fn run(&self, context: Context<'_, F>) -> Result<BackupReport> {
        let making = self.options.making(None);
        let folder = save::folder_for(&making.folder, context.robot, context.several)?;
        F::back_up(context, SaveOptions { folder, ..making }).await
    }
}

/// Writes a backup to the controller.
#[derive(Debug, Args)]
#[group(skip)]
#[command(
    after_help = "armctl first checks all files against their hashes, then writes the data that differs from the \
                  controller. After an interruption, run the same command again to continue. Data that is not in the \
                  backup stays on the controller.\n\nWithout --machine, armctl does not write data that changes the \
                  machine itself: parameters and system data (yerc), parameters and settings (yrcx), machine \
                  parameters (toyo). `toyo restore` has more options."
)]
pub struct Restore<F: Backups> {
    #[command(flatten)]
    options: RestoreOptions,
    #[arg(skip)]
    family: PhantomData<fn() -> F>,
}

impl<F: Backups> Restore<F> {
    /// Family of the backup.
    pub fn of_family(&self) -> Option<target::Family> {
        target::family_of_backup(&self.options.restoring().folder)
    }
}

impl<F: Backups> Command for Restore<F> {
    type Family = F;
    type Report = RestoreReport;
    const ID: &'static str = F::IDS[1];
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite data of the controller with the backup";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, F>) -> Result<RestoreReport> {
        let restoring = self.options.restoring();
        let folder = place(&restoring.folder, context.robot, context.several);
        manifest::check_origin(&manifest::open_existing::<Value>(&folder)?, context.robot, restoring.force)?;
        F::restore(context, &RestoreSelection { folder, ..restoring }).await
    }
}

/// Compares a backup with another backup, or with a controller.
#[derive(Debug, Args)]
#[group(skip)]
#[command(
    after_help = "With two folders, armctl reads no robot. With one folder, armctl reads the same data from the \
                  controller and shows the changes since the backup: - is the backup, + is the controller. `armctl \
                  diff ROBOT ROBOT` reads and compares two controllers of a family. If a folder has the name of a \
                  robot, select the robots with -r. armctl compares texts by lines, and other files by their \
                  hashes.\n\nPositions (points, shifts, hands, positions of jobs) are equal if they differ by less \
                  than the tolerance: 0.001 mm, 0.001 degrees and 1 pulse, or the value of --tolerance. The \
                  comparison ignores the line ///DATE of jobs, because controllers rewrite this line. The result \
                  lists the files with such differences. --exact compares every byte. Exit code 0: equal; 8: \
                  different."
)]
pub struct Diff<F: Backups> {
    #[command(flatten)]
    options: DiffOptions,
    #[arg(skip)]
    family: PhantomData<fn() -> F>,
}

impl<F: Backups> Diff<F> {
    /// Family of the backup.
    pub fn of_family(&self) -> Option<target::Family> {
        target::family_of_backup(self.options.old.as_deref()?)
    }

    /// Comparison options.
    pub fn options(&self) -> &DiffOptions {
        &self.options
    }

    /// Whether the command may read robots. A comparison of two folders reads no robot.
    pub fn may_ask_robots(&self) -> bool {
        self.options.new.is_none() || !self.options.names_folder()
    }

    /// Two robots whose names were given instead of two folders.
    pub fn robots(&self, inventory: &Inventory) -> Option<[String; 2]> {
        let robots = [named(self.options.old.as_ref(), inventory)?, named(self.options.new.as_ref(), inventory)?];
        (!self.options.names_folder()).then_some(robots)
    }

    /// The robot whose name was given instead of a folder, if no folder with this name exists and the line has no
    /// second folder.
    pub fn only_robot(&self, inventory: &Inventory) -> Option<String> {
        let is_folder = self.options.old.as_ref().is_some_and(|path| path.exists());
        named(self.options.old.as_ref(), inventory).filter(|_| self.options.new.is_none() && !is_folder)
    }
}

/// The robot with this name.
fn named(path: Option<&PathBuf>, inventory: &Inventory) -> Option<String> {
    let name = path?.to_str()?;
    inventory.robots.iter().find(|robot| robot.name == name).map(|robot| robot.name.clone())
}

impl<F: Backups> Command for Diff<F> {
    type Family = F;
    type Report = Differences;
    const ID: &'static str = F::IDS[2];
    const USES_FILES: bool = true;
    const RISK: Risk = F::BACKUP_RISK;

    fn risk_on(&self, robot: &Robot) -> Risk {
        F::backup_risk(robot)
    }

    fn takes_robot(&self) -> bool {
        self.options.new.is_none()
    }

    fn run_alone(&self) -> Result<Differences> {
        self.options.two_folders()
    }

    async fn run(&self, context: Context<'_, F>) -> Result<Differences> {
        let robot = context.robot;
        let folder = place(self.options.folder()?, robot, context.several);
        self.options.with_controller(folder, robot, |making| F::back_up(context, making)).await
    }
}

/// Folder of a robot's backup: a subfolder with its name if there are several robots.
fn place(folder: &Path, robot: &Robot, several: bool) -> PathBuf {
    let own = private_folder(folder, &robot.name, true);
    let has_list = |folder: &Path| folder.join(manifest::MANIFEST).exists();
    if several || !has_list(folder) && has_list(&own) { own } else { folder.to_owned() }
}
