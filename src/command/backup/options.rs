//! What the command line takes to make and to restore a backup, in every family.

use std::path::PathBuf;

use clap::Args;

use super::{Making, Only, Restoring};
use crate::command::ValueKind;

/// What is saved, and where.
#[derive(Debug, Args)]
#[group(skip)]
pub struct BackupOptions {
    /// Folder, made if it is not there
    folder: PathBuf,
    /// Files or parts whose names fit, such as '*.JBI' or 'points*' (repeatable)
    #[arg(long, value_name = "PATTERN", value_delimiter = ',')]
    only: Vec<String>,
    /// Go on with a backup that is not whole; what is there already is kept
    #[arg(long, conflicts_with = "force")]
    resume: bool,
    /// Make a new backup over the one in the folder
    #[arg(long)]
    force: bool,
}

impl BackupOptions {
    /// The folder.
    pub fn folder(&self) -> &PathBuf {
        &self.folder
    }

    /// What is asked for, with what the family's own options narrow it to.
    pub fn making(&self, narrowed: impl IntoIterator<Item = String>) -> Making {
        let scope: Vec<String> = narrowed.into_iter().chain(Only(self.only.clone()).scope()).collect();
        Making {
            folder: self.folder.clone(),
            scope: Some(scope).filter(|scope| !scope.is_empty()),
            resume: self.resume,
            force: self.force,
        }
    }
}

/// What is restored, and how.
#[derive(Debug, Args)]
#[group(skip)]
pub struct RestoreOptions {
    /// Folder of the backup
    #[arg(add = ValueKind::Backup)]
    folder: PathBuf,
    /// Files or parts whose names fit, such as '*.JBI' or 'points*' (repeatable)
    #[arg(long, value_name = "PATTERN", value_delimiter = ',')]
    only: Vec<String>,
    /// Write what makes it another machine, too, such as parameters
    #[arg(long)]
    machine: bool,
    /// Write the backup of one robot or model to another
    #[arg(long)]
    force: bool,
}

impl RestoreOptions {
    /// What is asked for.
    pub fn restoring(&self) -> Restoring {
        let Self { folder, only, machine, force } = self;
        Restoring { folder: folder.clone(), only: Only(only.clone()), machine: *machine, force: *force }
    }
}
