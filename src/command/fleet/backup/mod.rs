//! `armctl backup`, `restore` and `diff`: the same for robots of any family, whose own commands do the work.

mod check;
mod compare;
mod diff;
mod restore;
mod tolerance;

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::Value;

pub use check::Checked;
pub use compare::Differences;
pub use diff::Diff;
pub use restore::Restore;

use crate::command::backup::manifest;
use crate::command::backup::{BackedUp, Making, Only};
use crate::command::face::Face;
use crate::command::families;
use crate::command::fleet::status::{Fleet, Link};
use crate::command::frame::local::own_folder;
use crate::command::frame::run::{Run, RunError};
use crate::command::{AnyContext, Command, Context};
use crate::controller::Risk;
use crate::failure::Failure;
use crate::settings::Robot;
use crate::settings::target::Family;

/// Saves what a controller stores in a folder of files.
#[derive(Debug, Args)]
#[command(
    after_help = "Files of a yerc, points and data of a yrcx, parameters, points and programs of a toyo controller; several \
                  robots each in a folder of their name. manifest.json lists what is there with sizes and hashes, and \
                  what is missing and why. More choice have `yerc file backup`, `yrcx backup` and `toyo backup`.\n\nTo save \
                  every task of a toyo controller, each is made the current one for a while. That is a change: of a \
                  read-only robot the current task alone is saved."
)]
pub struct Backup {
    /// Folder, made if it is not there
    folder: PathBuf,
    /// Files or parts whose names fit, such as '*.JBI' or 'points*' (repeatable)
    #[arg(long, value_name = "PATTERN", value_delimiter = ',')]
    only: Vec<String>,
    /// Go on with a backup that is not whole; files that are there already are kept
    #[arg(long, conflicts_with_all = ["force", "only"])]
    resume: bool,
    /// Make a new backup over the one in the folder
    #[arg(long)]
    force: bool,
    /// Talk to nobody: compare the files in the folder with their hashes
    #[arg(long, conflicts_with_all = ["resume", "force", "only"])]
    check: bool,
}

impl Backup {
    /// Whether it needs no robot.
    pub fn is_local(&self) -> bool {
        self.check
    }

    /// Does it.
    pub async fn run(&self, run: &Run) -> Result<(), RunError> {
        if self.check {
            return run.local("backup.check", &Checked::of(&self.folder)?);
        }
        run.robots(self).await
    }
}

impl Command for Backup {
    type Family = Fleet;
    type Report = BackedUp;
    const ID: &'static str = "backup";
    const RISK: Risk = Risk::Write;

    fn risk_on(&self, robot: &Robot) -> Risk {
        reading_risk(robot)
    }

    async fn run(&self, context: Context<'_, Fleet>) -> Result<BackedUp, Failure> {
        let folder = own_folder(&self.folder, &context.robot.name, context.several);
        let scope = Some(Only(self.only.clone()).scope().collect()).filter(|_| !self.only.is_empty());
        make(context, Making { folder, scope, resume: self.resume, force: self.force }).await
    }
}

/// What it takes to read all of a controller.
fn reading_risk(robot: &Robot) -> Risk {
    families::of(robot.family).backup_risk(robot)
}

/// Makes a backup of a robot of any family.
async fn make(context: Context<'_, Fleet>, making: Making) -> Result<BackedUp, Failure> {
    let (face, context) = opened(context)?;
    face.back_up(context, making).await
}

/// The connection of a robot of any family, and what it can be asked.
fn opened(context: Context<'_, Fleet>) -> Result<(&'static dyn Face, AnyContext<'_>), Failure> {
    let Context { link, screen, robot, authority, .. } = context;
    match link {
        Link::Open(face, connection) => {
            Ok((*face, AnyContext { robot, connection: &mut **connection, screen, several: false, authority }))
        }
        Link::Absent(failure) => Err(failure.clone()),
    }
}

/// The folder of a robot's backup in what was named: the folder of its name in it, where several robots have one.
fn place(folder: &Path, robot: &Robot, several: bool) -> PathBuf {
    let own = own_folder(folder, &robot.name, true);
    let has_list = |folder: &Path| folder.join(manifest::MANIFEST).exists();
    if several || !has_list(folder) && has_list(&own) { own } else { folder.to_owned() }
}

/// The family of the backup in a folder, for simulators, which can be of any.
fn family_of(folder: &Path) -> Option<Family> {
    manifest::read::<Value>(folder).ok()??.family.parse().ok()
}
