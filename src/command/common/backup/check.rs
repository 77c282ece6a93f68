//! `armctl backup --check`: whether the files of a backup are still what was saved.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use crate::command::Report;
use crate::command::manifest::{self, MANIFEST};
use crate::failure::Failure;
use crate::output::view::{Cell, Table, Tone, View};

/// What is left of backups.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Checked {
    /// Whether every file is what was saved, and none is missing.
    sound: bool,
    backups: Vec<Backup>,
}

/// A backup.
#[derive(Debug, Serialize, JsonSchema)]
struct Backup {
    /// Its folder.
    folder: String,
    family: String,
    robot: String,
    /// Whether nothing was missing when it was made.
    complete: bool,
    /// How many files it has.
    files: usize,
    /// Which of them are not what was saved.
    damaged: Vec<Failure>,
}

impl Checked {
    /// The backup in a folder, or those in the folders in it, one a robot.
    pub fn of(folder: &Path) -> Result<Self, Failure> {
        let backups = folders(folder)?.iter().map(|folder| Backup::of(folder)).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { sound: backups.iter().all(|backup| backup.damaged.is_empty()), backups })
    }
}

impl Backup {
    fn of(folder: &Path) -> Result<Self, Failure> {
        let list = manifest::existing::<Value>(folder)?;
        let copies: Vec<_> = list.files.iter().filter_map(|entry| entry.copy.as_ref()).collect();
        Ok(Self {
            folder: folder.display().to_string(),
            complete: list.complete,
            files: copies.len(),
            damaged: copies.iter().filter_map(|copy| copy.check(folder).err()).collect(),
            family: list.family,
            robot: list.robot,
        })
    }
}

/// The folders with a list: this one, or those in it.
fn folders(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let has_list = |folder: &Path| folder.join(MANIFEST).exists();
    let failed = |error: &std::io::Error| Failure::io(folder.display(), error);
    let mut found = Vec::new();
    if !has_list(folder) {
        for entry in std::fs::read_dir(folder).map_err(|error| failed(&error))? {
            found.push(entry.map_err(|error| failed(&error))?.path());
        }
        found.retain(|folder| has_list(folder));
        found.sort();
    }
    // Without any, the folder itself is asked for its list, and says that it has none.
    Ok(if found.is_empty() { vec![folder.to_owned()] } else { found })
}

impl Report for Checked {
    fn view(&self) -> View {
        let mut table = Table::new(&["folder", "robot", "family", "files", "result"], "no backups");
        for backup in &self.backups {
            let result = match (&backup.damaged[..], backup.complete) {
                ([], true) => Cell::from("sound").tone(Tone::Good),
                ([], false) => Cell::from("sound, but not whole: --resume completes it").tone(Tone::Warning),
                ([first, ..], _) => {
                    let all = backup.damaged.len();
                    Cell::from(format!("{all} of {} damaged: {}", backup.files, first.message)).tone(Tone::Bad)
                }
            };
            let (folder, robot) = (backup.folder.as_str().into(), backup.robot.as_str().into());
            table.row([folder, robot, backup.family.as_str().into(), backup.files.into(), result]);
        }
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        let first = self.backups.iter().flat_map(|backup| &backup.damaged).next()?;
        let count: usize = self.backups.iter().map(|backup| backup.damaged.len()).sum();
        Some(Failure { message: format!("{count} files are not what was saved: {}", first.message), ..first.clone() })
    }
}
