//! `armctl diff`: two backups, or a backup and a controller, which is read into a folder for a while.

use std::path::PathBuf;

use anyhow::Context as _;
use clap::Args;

use super::compare::{Differences, Side};
use super::tolerance::{Limit, Tolerance};
use super::{family_of, make, place, reading_risk};
use crate::command::backup::manifest;
use crate::command::backup::{Making, Only};
use crate::command::fleet::status::Fleet;
use crate::command::frame::run::{Run, RunError};
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::failure::{Failure, Kind};
use crate::settings::Robot;
use crate::settings::target::Family;

/// Compares a backup with another one, or with a controller.
#[derive(Debug, Args)]
#[command(
    after_help = "With two folders no robot is asked. With one, the controller is read as far as the backup goes, and what \
                  is shown is what changed since: - is the backup, + the controller. Texts are compared by lines, other \
                  files by their hashes.\n\nPositions (points, shifts, hands, positions of jobs) that are no further apart than \
                  the tolerance are the same: 0.001 mm, 0.001 degrees and 1 pulse, unless --tolerance says otherwise; \
                  such files are named. Exit code 0: the same; 8: different."
)]
pub struct Diff {
    /// Folder of a backup
    #[arg(value_name = "FOLDER")]
    old: PathBuf,
    /// Folder of another one; without it, the controller
    #[arg(value_name = "OTHER")]
    new: Option<PathBuf>,
    /// Files or parts whose names fit, such as '*.JBI' or 'points*' (repeatable)
    #[arg(long, value_name = "PATTERN", value_delimiter = ',')]
    only: Vec<String>,
    /// How far apart positions may be: 0.05, or 0.1mm,0.05deg,5pulses
    #[arg(long, value_name = "LIMIT", value_delimiter = ',', value_parser = Limit::parse)]
    tolerance: Vec<Limit>,
}

impl Diff {
    /// Whether it needs no robot.
    pub fn is_local(&self) -> bool {
        self.new.is_some()
    }

    /// The family of the backup.
    pub fn family(&self) -> Option<Family> {
        family_of(&self.old)
    }

    /// Does it.
    pub async fn run(&self, run: &Run) -> Result<(), RunError> {
        let Some(new) = &self.new else { return run.robots(self).await };
        let (old, new) = (Self::side(self.old.clone())?, Self::side(new.clone())?);
        run.local(Self::ID, &self.compare(&old, &new)?)
    }

    fn side(folder: PathBuf) -> Result<Side, Failure> {
        Ok(Side { manifest: manifest::existing(&folder)?, folder, is_controller: false })
    }

    fn compare(&self, old: &Side, new: &Side) -> Result<Differences, Failure> {
        Differences::of(old, new, &Only(self.only.clone()), Tolerance::of(&self.tolerance))
    }

    /// What is read of the controller: what the backup was asked for, or of that what is asked for now.
    fn scope(&self, old: &Side) -> Vec<String> {
        let scope = &old.manifest.scope;
        let only = Only(self.only.clone());
        if only == Only::default() {
            return scope.clone();
        }
        let before = Only::of_scope(scope);
        let others = scope.iter().filter(|word| Only::of_scope(std::slice::from_ref(word)) == Only::default()).cloned();
        let narrowed: Vec<String> = if before == Only::default() {
            only.scope().collect()
        } else {
            let names = old.manifest.files.iter().map(|entry| entry.name.clone()).filter(|name| only.has(name));
            Only(names.collect()).scope().collect()
        };
        others.chain(narrowed).collect()
    }
}

impl Command for Diff {
    type Family = Fleet;
    type Report = Differences;
    const ID: &'static str = "diff";
    const RISK: Risk = Risk::Write;

    fn risk_on(&self, robot: &Robot) -> Risk {
        reading_risk(robot)
    }

    async fn run(&self, context: Context<'_, Fleet>) -> Result<Differences, Failure> {
        let robot = context.robot;
        let old = Self::side(place(&self.old, robot, context.several))?;
        manifest::check_origin(&old.manifest, robot, true)?;
        let temporary = tempfile::tempdir().context("a folder for a while")?;
        let folder = temporary.path().join("controller");
        let making = Making { folder: folder.clone(), scope: Some(self.scope(&old)), resume: false, force: false };
        // What was read so far is of no use; but what a controller refuses to tell is a difference.
        let unread = match make(context, making).await {
            Ok(made) => made.gravest().filter(|failure| failure.kind != Kind::Refused),
            Err(failure) if failure.kind == Kind::Interrupted => Some(Failure::new(failure.kind, "interrupted")),
            Err(failure) => Some(failure),
        };
        if let Some(failure) = unread {
            return Err(Failure { message: format!("nothing was compared: {}", failure.message), ..failure });
        }
        let new = Side { manifest: manifest::existing(&folder)?, folder, is_controller: true };
        self.compare(&old, &new)
    }
}
