//! `armctl backup`, `restore` and `diff`: the same for robots of any family, whose own commands do the work.

use clap::Args;

use crate::command::backup::check::Checked;
use crate::command::backup::words::{self, Backups};
use crate::command::backup::{BackedUp, Making, Restored, Restoring};
use crate::command::face::Face;
use crate::command::families;
use crate::command::fleet::status::{Fleet, Link};
use crate::command::frame::run::{Run, RunError};
use crate::command::{AnyContext, Context};
use crate::controller::Risk;
use crate::failure::Failure;
use crate::settings::Robot;

/// `armctl restore`.
pub type Restore = words::Restore<Fleet>;
/// `armctl diff`.
pub type Diff = words::Diff<Fleet>;

/// `armctl backup`: makes one, or looks whether one is still sound.
#[derive(Debug, Args)]
pub struct Backup {
    #[command(flatten)]
    making: words::Backup<Fleet>,
    /// Talk to nobody: compare the files in the folder with their hashes
    #[arg(long, conflicts_with_all = ["resume", "force", "only"])]
    check: bool,
}

impl Backup {
    /// Whether it takes a robot.
    pub fn takes_robot(&self) -> bool {
        !self.check
    }

    /// What makes a backup.
    pub fn making(&self) -> &words::Backup<Fleet> {
        &self.making
    }

    /// Does it.
    pub async fn run(&self, run: &Run) -> Result<(), RunError> {
        if self.check {
            return run.local("backup.check", &Checked::of(self.making.folder())?);
        }
        run.robots(&self.making).await
    }
}

impl Backups for Fleet {
    const IDS: [&'static str; 3] = ["backup", "restore", "diff"];
    const BACKUP_RISK: Risk = Risk::Write;

    fn backup_risk(robot: &Robot) -> Risk {
        families::of(robot.family).backup_risk(robot)
    }

    async fn back_up(context: Context<'_, Self>, making: Making) -> Result<BackedUp, Failure> {
        let (face, context) = opened(context)?;
        face.back_up(context, making).await
    }

    async fn restore(context: Context<'_, Self>, restoring: &Restoring) -> Result<Restored, Failure> {
        let (face, context) = opened(context)?;
        face.restore(context, restoring).await
    }
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
