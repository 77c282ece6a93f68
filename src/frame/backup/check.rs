//! `armctl backup --verify`: integrity check of the files of a backup.

use crate::backup::manifest;
use crate::backup::manifest::MANIFEST;
use crate::prelude::basics::*;

/// Result of the integrity check.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Checked {
    /// Whether all files are present and unchanged.
    sound: bool,
    backups: Vec<Backup>,
}

/// A backup.
#[derive(Debug, Serialize, JsonSchema)]
struct Backup {
    /// Folder of the backup.
    folder: String,
    family: String,
    robot: String,
    /// Whether the backup was complete when it was made.
    complete: bool,
    /// Number of files.
    #[serde(rename = "file_count")]
    files: usize,
    /// Missing or changed files.
    damaged: Vec<Failure>,
}

impl Checked {
    /// The backup in a folder, or the backups in its subfolders, one per robot.
    pub fn check_folder(folder: &Path) -> Result<Self> {
        let several = if folder.join(MANIFEST).exists() { Vec::new() } else { manifest::folders_in(folder) };
        // Without a backup, the read of the folder's manifest reports the error.
        let folders = if several.is_empty() { vec![folder.to_owned()] } else { several };
        let backups = folders.iter().map(|folder| Backup::of(folder)).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { sound: backups.iter().all(|backup| backup.damaged.is_empty()), backups })
    }
}

impl Backup {
    fn of(folder: &Path) -> Result<Self> {
        let list = manifest::open_existing::<Value>(folder)?;
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

impl Report for Checked {
    fn view(&self) -> View {
        let mut table = Table::new(&["folder", "robot", "family", "files", "result"], "no backups");
        for backup in &self.backups {
            let result = match (&backup.damaged[..], backup.complete) {
                ([], true) => Cell::from("sound").tone(Tone::Good),
                ([], false) => Cell::from("valid but incomplete; complete it with --resume").tone(Tone::Warning),
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
        let (damaged, all) = self
            .backups
            .iter()
            .fold((0, 0), |(damaged, all), backup| (damaged + backup.damaged.len(), all + backup.files));
        Some(Failure { message: format!("{damaged} of {all} files damaged: {}", first.message), ..first.clone() })
    }
}
