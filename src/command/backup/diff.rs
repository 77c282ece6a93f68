//! What two backups, or a backup and a controller, are compared by. A controller is read into a folder for a while.

use std::path::PathBuf;

use anyhow::Context as _;
use clap::Args;

use super::compare::{Differences, Manner, Side};
use super::manifest;
use super::tolerance::{Limit, Tolerance};
use super::{BackedUp, Making, Only};
use crate::command::frame::dry_run::unknown;
use crate::failure::{Failure, Kind};
use crate::settings::Robot;

/// What is compared, and how exactly.
#[derive(Debug, Args)]
#[group(skip)]
pub struct DiffOptions {
    /// Folder of a backup
    #[arg(value_name = "FOLDER")]
    pub(super) old: PathBuf,
    /// Folder of another one; without it, the controller
    #[arg(value_name = "OTHER")]
    pub(super) new: Option<PathBuf>,
    /// Files or parts whose names fit, such as '*.JBI' or 'points*' (repeatable)
    #[arg(long, value_name = "PATTERN", value_delimiter = ',')]
    only: Vec<String>,
    /// How far apart positions may be: 0.05, or 0.1mm,0.05deg,5pulses
    #[arg(long, value_name = "LIMIT", value_delimiter = ',', value_parser = Limit::parse)]
    tolerance: Vec<Limit>,
    /// Compare byte for byte: no tolerance, and the line ///DATE of jobs counts
    #[arg(long, conflicts_with = "tolerance")]
    exact: bool,
}

impl DiffOptions {
    /// Compares the folders.
    pub fn two_folders(&self) -> Result<Differences, Failure> {
        let new = self.new.as_ref().unwrap_or(&self.old);
        self.compare(&side(self.old.clone())?, &side(new.clone())?)
    }

    /// Compares a folder with what `read` saves of a controller.
    pub async fn with_controller(
        &self,
        old: PathBuf,
        robot: &Robot,
        read: impl AsyncFnOnce(Making) -> Result<BackedUp, Failure>,
    ) -> Result<Differences, Failure> {
        let old = side(old)?;
        manifest::check_origin(&old.manifest, robot, true)?;
        let temporary = tempfile::tempdir().context("a folder for a while")?;
        let folder = temporary.path().join("controller");
        let making = Making { folder: folder.clone(), scope: Some(self.scope(&old)), resume: false, force: false };
        // What was read so far is of no use; but what a controller refuses to tell is a difference.
        let unread = match read(making).await {
            Ok(made) => made.gravest().filter(|failure| failure.kind != Kind::Refused),
            Err(failure) if failure.kind == Kind::Interrupted => Some(Failure::new(failure.kind, "interrupted")),
            Err(failure) => Some(failure),
        };
        if let Some(failure) = unread {
            return Err(Failure { message: format!("nothing was compared: {}", failure.message), ..failure });
        }
        // A dry run saves nothing.
        let Some(manifest) = manifest::read(&folder)? else { return Err(unknown()) };
        self.compare(&old, &Side { manifest, folder, is_controller: true })
    }

    fn compare(&self, old: &Side, new: &Side) -> Result<Differences, Failure> {
        let manner = if self.exact { Manner::EXACT } else { Manner::usual(Tolerance::of(&self.tolerance)) };
        Differences::of(old, new, &Only(self.only.clone()), manner)
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

fn side(folder: PathBuf) -> Result<Side, Failure> {
    Ok(Side { manifest: manifest::existing(&folder)?, folder, is_controller: false })
}
