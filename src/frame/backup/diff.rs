//! Options of a comparison of two backups, or a backup and a controller. A controller is read into a temporary
//! folder.

use super::compare::{BackupSide, CompareOptions, Differences};
use super::manifest;
use super::tolerance::{Limit, Tolerance};
use super::{BackupReport, Only, SaveOptions};
use crate::dry_run::unknown;
use crate::prelude::basics::*;

/// Comparison options.
#[derive(Debug, Args)]
#[group(skip)]
pub struct DiffOptions {
    /// Folder of a backup
    #[arg(value_name = "FOLDER")]
    pub(super) old: Option<PathBuf>,
    /// Folder of another backup [default: the controller]
    #[arg(value_name = "OTHER")]
    pub(super) new: Option<PathBuf>,
    /// Only these files or parts: names or patterns, for example '*.JBI' or 'points*' (repeatable)
    #[arg(long, value_name = "PATTERN", value_delimiter = ',')]
    only: Vec<String>,
    /// Tolerance of positions, for example 0.05 (mm and degrees), or 0.1mm,0.05deg,5pulses
    #[arg(long, value_name = "LIMIT", value_delimiter = ',', value_parser = Limit::parse)]
    tolerance: Vec<Limit>,
    /// Compare all bytes, without a tolerance, and including the line ///DATE of jobs
    #[arg(long, conflicts_with = "tolerance")]
    exact: bool,
}

impl DiffOptions {
    /// Folder to compare.
    pub fn folder(&self) -> Result<&Path> {
        self.old.as_deref().ok_or_else(|| {
            Failure::usage("no backup to compare")
                .hint("type the folder of a backup, or two robots: `armctl diff ROBOT ROBOT`")
        })
    }

    /// Whether one of the names is an existing folder or file.
    pub fn names_folder(&self) -> bool {
        [&self.old, &self.new].into_iter().flatten().any(|path| path.exists())
    }

    /// Compares two folders.
    pub fn two_folders(&self) -> Result<Differences> {
        let old = self.folder()?;
        let new = self.new.as_deref().unwrap_or(old);
        self.compare(&side(old.to_owned())?, &side(new.to_owned())?)
    }

    /// Compares two controllers that were read into folders.
    pub fn two_controllers(&self, folders: [PathBuf; 2]) -> Result<Differences> {
        let read = |folder: PathBuf| {
            Ok::<_, Failure>(BackupSide { manifest: manifest::open_existing(&folder)?, folder, is_controller: true })
        };
        let [old, new] = folders;
        self.compare(&read(old)?, &read(new)?)
    }

    /// Scope of the reads of two controllers.
    pub fn scope_of_controllers(&self) -> Vec<String> {
        Only(self.only.clone()).scope().collect()
    }

    /// Compares a folder with the data that `read` saves from a controller.
    pub async fn with_controller(
        &self,
        old: PathBuf,
        robot: &Robot,
        read: impl AsyncFnOnce(SaveOptions) -> Result<BackupReport>,
    ) -> Result<Differences> {
        let old = side(old)?;
        manifest::check_origin(&old.manifest, robot, true)?;
        let temporary = tempfile::tempdir().context("cannot create a temporary folder")?;
        let folder = temporary.path().join("controller");
        let options =
            SaveOptions { folder: folder.clone(), scope: Some(self.scope(&old)), resume: false, force: false };
        // An aborted read is not useful, but a refusal of the controller is a difference.
        let unread_files = match read(options).await {
            Ok(made) => made.unread(),
            Err(failure) if failure.kind == Kind::Interrupted => {
                Some(Failure::new(failure.kind, "not everything was read"))
            }
            Err(failure) => Some(failure),
        };
        if let Some(failure) = unread_files {
            return Err(Failure { message: format!("not compared: {}", failure.message), ..failure });
        }
        // A dry run saves nothing.
        let Some(manifest) = manifest::read(&folder)? else { return Err(unknown()) };
        self.compare(&old, &BackupSide { manifest, folder, is_controller: true })
    }

    fn compare(&self, old: &BackupSide, new: &BackupSide) -> Result<Differences> {
        let options =
            if self.exact { CompareOptions::EXACT } else { CompareOptions::usual(Tolerance::of(&self.tolerance)) };
        Differences::of(old, new, &Only(self.only.clone()), options)
    }

    /// Scope of the controller read: the scope of the backup, or the selection within it.
    fn scope(&self, old: &BackupSide) -> Vec<String> {
        let scope = &old.manifest.scope;
        let only = Only(self.only.clone());
        if only == Only::default() {
            return scope.clone();
        }
        let before = Only::of_scope(scope);
        let others = scope.iter().filter(|word| Only::of_scope(std::slice::from_ref(word)) == Only::default()).cloned();
        let scope: Vec<String> = if before == Only::default() {
            only.scope().collect()
        } else {
            let names = old.manifest.files.iter().map(|entry| entry.name.clone()).filter(|name| only.has(name));
            Only(names.collect()).scope().collect()
        };
        others.chain(scope).collect()
    }
}

fn side(folder: PathBuf) -> Result<BackupSide> {
    Ok(BackupSide { manifest: manifest::open_existing(&folder)?, folder, is_controller: false })
}
