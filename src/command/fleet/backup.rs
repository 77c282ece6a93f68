//! `armctl backup`, `restore` and `diff` for robots of any family. The commands of the family do the work.

use crate::command::families;
use crate::command::fleet::status::{Fleet, Link};
use armctl_frame::AnyContext;
use armctl_frame::backup::check::Checked;
use armctl_frame::backup::family_backup::{self, Backups};
use armctl_frame::backup::{BackupReport, RestoreReport, RestoreSelection, SaveOptions};
use armctl_frame::face::Face;
use armctl_frame::local_names::private_folder;
use armctl_frame::prelude::*;

/// Arguments of `armctl restore`.
pub type Restore = family_backup::Restore<Fleet>;
/// Arguments of `armctl diff`.
pub type Diff = family_backup::Diff<Fleet>;

/// `armctl backup`: makes a backup, or checks an existing one.
#[derive(Debug, Args)]
pub struct Backup {
    #[command(flatten)]
    making: family_backup::Backup<Fleet>,
    /// Check a backup without a connection: compare its files with their hashes
    #[arg(long, conflicts_with_all = ["resume", "force", "only"])]
    verify: bool,
}

impl Backup {
    /// Whether the command needs a robot.
    pub fn takes_robot(&self) -> bool {
        !self.verify
    }

    /// Arguments for making a backup.
    pub fn options(&self) -> &family_backup::Backup<Fleet> {
        &self.making
    }

    /// Runs the command.
    pub async fn run(&self, run: &Run) -> Result<(), RunError> {
        if self.verify {
            return run.local("backup.check", &Checked::check_folder(self.making.folder())?);
        }
        run.robots(&self.making).await
    }
}

/// `armctl diff`: compares two folders, a folder and a robot, or two robots.
pub async fn diff(diff: Diff, run: &Run) -> Result<(), RunError> {
    let are_robots = diff.robots(&run.sources.inventory).is_some();
    let is_plural = run.sources.selection.is_plural() && diff.options().folder().is_err();
    if let Some(robot) = diff.only_robot(&run.sources.inventory) {
        let failure = Failure::usage(format!("{robot} is a robot, and no folder has this name"));
        return Err(failure.hint("compare two robots: `armctl diff ROBOT ROBOT`, or a robot with its backup").into());
    }
    if !are_robots && !is_plural {
        return run.robots(&diff).await;
    }
    let folder = tempfile::tempdir().context("a temporary folder")?;
    let reading = Reading { folder: folder.path().to_owned(), scope: diff.options().scope_of_controllers() };
    if run.gate.dry_run {
        return run.robots(&reading).await;
    }
    let robots = run.authorize_robots(&reading).await?;
    let [old, new] = &robots[..] else {
        let failure = Failure::usage(format!("diff compares two robots; selected: {}", robots.len()));
        return Err(failure.hint("select two: `armctl diff ROBOT ROBOT`").into());
    };
    if old.family != new.family {
        let message =
            format!("{} is a {} controller, but {} is a {} controller", old.name, old.family, new.name, new.family);
        return Err(Failure::usage(message).hint("compare robots of one family").into());
    }
    for (robot, outcome) in robots.iter().zip(run.collect(&reading, &robots).await) {
        if let Err(failure) = outcome {
            let message = format!("nothing was compared: {}", failure.message);
            return Err(RunError::for_robot(robot, &reading, Failure { message, ..failure }));
        }
    }
    run.local("diff", &diff.options().two_controllers([reading.place(old), reading.place(new)])?)
}

/// Reads robots into folders for a comparison.
struct Reading {
    folder: PathBuf,
    scope: Vec<String>,
}

impl Reading {
    fn place(&self, robot: &Robot) -> PathBuf {
        private_folder(&self.folder, &robot.name, true)
    }
}

impl Command for Reading {
    type Family = Fleet;
    type Report = BackupReport;
    const ID: &'static str = "diff";
    const RISK: Risk = Fleet::BACKUP_RISK;

    fn risk_on(&self, robot: &Robot) -> Risk {
        Fleet::backup_risk(robot)
    }

    async fn run(&self, context: Context<'_, Fleet>) -> Result<BackupReport> {
        let folder = self.place(context.robot);
        let options = SaveOptions { folder, scope: Some(self.scope.clone()), resume: false, force: false };
        let result = Fleet::back_up(context, options).await?;
        // Data that a controller refuses is a difference, not a failure.
        result.unread().map_or(Ok(result), Err)
    }
}

impl Backups for Fleet {
    const IDS: [&'static str; 3] = ["backup", "restore", "diff"];
    const BACKUP_RISK: Risk = Risk::Write;

    fn backup_risk(robot: &Robot) -> Risk {
        (families::of(robot.family).backup_risk)(robot)
    }

    async fn back_up(context: Context<'_, Self>, making: SaveOptions) -> Result<BackupReport> {
        let (face, context) = open_folder(context)?;
        (face.back_up)(context, making).await
    }

    async fn restore(context: Context<'_, Self>, restoring: &RestoreSelection) -> Result<RestoreReport> {
        let (face, context) = open_folder(context)?;
        (face.restore)(context, restoring).await
    }
}

/// Splits a context of any family into its face and connection.
fn open_folder(context: Context<'_, Fleet>) -> Result<(&'static Face, AnyContext<'_>)> {
    let Context { link, screen, robot, confirmer, .. } = context;
    match link {
        Link::Open(face, connection) => {
            Ok((*face, AnyContext { robot, connection: &mut **connection, screen, several: false, confirmer }))
        }
        Link::Absent(absent) => Err(absent.failure.clone()),
    }
}
