//! Command-line options of backup and restore, common to all families.

use std::path::PathBuf;

use clap::Args;

use super::{Only, RestoreSelection, SaveOptions};
use crate::ValueKind;

/// Backup options.
#[derive(Debug, Args)]
#[group(skip)]
pub struct BackupOptions {
    /// Folder of the backup. armctl creates the folder if it does not exist
    folder: PathBuf,
    /// Only these files or parts: names or patterns, for example '*.JBI' or 'points*' (repeatable)
    #[arg(long, value_name = "PATTERN", value_delimiter = ',')]
    only: Vec<String>,
    /// Continue an incomplete backup and keep its files
    #[arg(long, conflicts_with = "force")]
    resume: bool,
    /// Replace the backup in the folder
    #[arg(long)]
    force: bool,
}

impl BackupOptions {
    /// Folder.
    pub fn folder(&self) -> &PathBuf {
        &self.folder
    }

    /// Backup request, with additional selections of the family.
    pub fn making(&self, narrowed: impl IntoIterator<Item = String>) -> SaveOptions {
        let scope: Vec<String> = narrowed.into_iter().chain(Only(self.only.clone()).scope()).collect();
        SaveOptions {
            folder: self.folder.clone(),
            scope: Some(scope).filter(|scope| !scope.is_empty()),
            resume: self.resume,
            force: self.force,
        }
    }
}

/// Restore options.
#[derive(Debug, Args)]
#[group(skip)]
pub struct RestoreOptions {
    /// Folder of the backup
    #[arg(add = ValueKind::Backup)]
    folder: PathBuf,
    /// Only these files or parts: names or patterns, for example '*.JBI' or 'points*' (repeatable)
    #[arg(long, value_name = "PATTERN", value_delimiter = ',')]
    only: Vec<String>,
    /// Also write data that changes the machine itself, such as parameters
    #[arg(long)]
    machine: bool,
    /// Write the backup even if it comes from another robot or model
    #[arg(long)]
    force: bool,
}

impl RestoreOptions {
    /// Restore request.
    pub fn restoring(&self) -> RestoreSelection {
        let Self { folder, only, machine, force } = self;
        RestoreSelection { folder: folder.clone(), only: Only(only.clone()), machine: *machine, force: *force }
    }
}
