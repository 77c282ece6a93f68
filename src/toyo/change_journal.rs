//! Journal of temporary changes: the host, the current task, the mode, motion. It is written before each change.
//!
//! A command restores all settings that it changed. If its process is killed, the settings stay changed. The next
//! command then finds the journal entry, reads whether the change is still present, and reports how to undo it. The
//! process that owns an entry holds the lock on the file of the entry.

use std::fs::{self, File, OpenOptions};
use std::io::{Seek as _, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use armctl_client::toyo::MotionKind;
use armctl_files as files;
use armctl_frame::local_names::state_folder;

/// Changes that have not been restored yet.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct JournalEntry {
    /// Target URL of the robot.
    robot: String,
    /// Time of the first change in seconds since 1970.
    since: u64,
    /// Whether the host was OFF, and was switched ON.
    pub host: bool,
    /// Blocks that restore settings, such as `@CTSK TASK=01`, in the order of the changes.
    pub back: Vec<String>,
    /// Motion that was started: `jog` or `program`.
    pub moving: Option<String>,
}

impl JournalEntry {
    /// Whether all changes were restored.
    pub fn is_empty(&self) -> bool {
        !self.host && self.back.is_empty() && self.moving.is_none()
    }
}

/// Journal of one link.
#[derive(Debug, Default)]
pub struct ChangeJournal {
    /// Folder of the entries; `None` for a simulator in this process.
    folder: Option<PathBuf>,
    entry: JournalEntry,
    file: Option<(File, PathBuf)>,
}

/// Journal entry that a process left when it ended.
#[derive(Debug)]
pub struct AbandonedEntry {
    /// Changes that the process did not restore.
    pub entry: JournalEntry,
    path: PathBuf,
}

/// Maximum size of an entry.
const MAX_SIZE: u64 = 16 * 1024;
/// Entries that are older than this are deleted, because the robot has been used since then.
const MAX_AGE: Duration = Duration::from_secs(30 * 24 * 3600);

impl ChangeJournal {
    /// Journal of a link to a robot.
    pub fn of(robot: &str) -> Self {
        Self::within(state_folder().map(|folder| folder.join("toyo-changes")), robot)
    }

    /// Journal without files, for a simulator in this process and for dry runs.
    pub fn without_files() -> Self {
        Self::default()
    }

    fn within(folder: Option<PathBuf>, robot: &str) -> Self {
        Self { folder, entry: JournalEntry { robot: robot.to_owned(), ..JournalEntry::default() }, file: None }
    }

    /// Records that the host is switched ON, or is OFF again.
    pub fn host(&mut self, is_taken: bool) {
        self.change(|entry| entry.host = is_taken);
    }

    /// Records a change. The block `back` restores it.
    pub fn push(&mut self, back: &str) {
        self.change(|entry| entry.back.push(back.to_owned()));
    }

    /// Removes the last change that the block `back` restores, because it was restored.
    pub fn pop(&mut self, back: &str) {
        self.change(|entry| {
            if let Some(last) = entry.back.iter().rposition(|block| block == back) {
                entry.back.remove(last);
            }
        });
    }

    /// Records the start or the end of a motion.
    pub fn moving(&mut self, moving: Option<MotionKind>) {
        let word = |moving| if moving == MotionKind::Jog { "jog" } else { "program" }.to_owned();
        self.change(|entry| entry.moving = moving.map(word));
    }

    /// Changes the entry and saves it. An error is ignored, because the command must run even if the journal cannot be
    /// written.
    fn change(&mut self, change: impl FnOnce(&mut JournalEntry)) {
        let old = self.entry.clone();
        change(&mut self.entry);
        if old != self.entry {
            self.save().unwrap_or_default();
        }
    }

    fn save(&mut self) -> std::io::Result<()> {
        let Some(folder) = &self.folder else { return Ok(()) };
        if self.entry.is_empty() {
            if let Some((_, path)) = self.file.take() {
                fs::remove_file(path)?;
            }
            return Ok(());
        }
        if self.file.is_none() {
            self.entry.since = now();
            fs::create_dir_all(folder)?;
            let path = folder.join(format!("{:016x}.json", fastrand::u64(..)));
            let file = OpenOptions::new().create_new(true).write(true).open(&path)?;
            files::lock(&file);
            self.file = Some((file, path));
        }
        if let Some((file, _)) = &mut self.file {
            let text = serde_json::to_vec(&self.entry)?;
            file.rewind()?;
            file.write_all(&text)?;
            file.set_len(text.len() as u64)?;
        }
        Ok(())
    }

    /// Changes of this process that have not been restored yet.
    pub fn entry(&self) -> &JournalEntry {
        &self.entry
    }

    /// Entries for the same robot that other processes left when they ended.
    pub fn abandoned_entries(&self) -> Vec<AbandonedEntry> {
        let abandoned = self.paths().filter_map(|path| Some(AbandonedEntry { entry: read_abandoned(&path)?, path }));
        abandoned.filter(|abandoned| abandoned.entry.robot == self.entry.robot).collect()
    }

    /// Whether another running process has changed settings of the same robot.
    pub fn has_entry_of_running_process(&self) -> bool {
        let own = self.file.as_ref().map(|(_, path)| path);
        let others = self.paths().filter(|path| Some(path) != own);
        let mut running = others.filter(|path| {
            fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file()) && !files::is_abandoned(path)
        });
        running.any(|path| read_entry(&path).is_some_and(|entry| entry.robot == self.entry.robot))
    }

    /// Paths of all entries.
    fn paths(&self) -> impl Iterator<Item = PathBuf> {
        let entries = self.folder.as_ref().and_then(|folder| fs::read_dir(folder).ok()).into_iter().flatten().flatten();
        entries.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|ending| ending == "json"))
    }
}

impl AbandonedEntry {
    /// Deletes the entry when all changes were restored.
    pub fn delete(&self) {
        fs::remove_file(&self.path).unwrap_or_default();
    }

    /// Time of the first change as text.
    pub fn since(&self) -> String {
        let seconds = i64::try_from(self.entry.since).unwrap_or_default();
        jiff::Timestamp::from_second(seconds).map_or_else(|_| "?".to_owned(), |time| time.to_string())
    }
}

/// The entry in a file; `None` if the process that wrote it is still running.
fn read_abandoned(path: &Path) -> Option<JournalEntry> {
    let metadata =
        fs::symlink_metadata(path).ok().filter(|metadata| metadata.is_file() && metadata.len() <= MAX_SIZE)?;
    if !files::is_abandoned(path) {
        return None;
    }
    if metadata.modified().ok().and_then(|time| time.elapsed().ok()).is_some_and(|age| age > MAX_AGE) {
        fs::remove_file(path).unwrap_or_default();
        return None;
    }
    read_entry(path)
}

/// The entry in a file.
fn read_entry(path: &Path) -> Option<JournalEntry> {
    serde_json::from_slice(&files::read(path, MAX_SIZE).ok()?).ok()
}

fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_exists_while_a_change_is_present() {
        let folder = tempfile::tempdir().unwrap();
        let file_count = || fs::read_dir(folder.path()).unwrap().count();
        let journal_of = || ChangeJournal::within(Some(folder.path().to_owned()), "tcp://cell");
        let mut journal = journal_of();
        journal.host(true);
        journal.push("@CTSK TASK=01");
        journal.moving(Some(MotionKind::Jog));
        assert_eq!(file_count(), 1);
        // The process that wrote the entry is still running.
        assert!(
            journal_of().abandoned_entries().is_empty()
                && journal_of().has_entry_of_running_process()
                && !journal.has_entry_of_running_process()
        );
        journal.moving(None);
        journal.pop("@CTSK TASK=01");
        assert_eq!(file_count(), 1);
        journal.host(false);
        assert_eq!(file_count(), 0);
    }

    #[test]
    fn an_entry_of_an_ended_process_is_found_until_it_is_deleted() {
        let folder = tempfile::tempdir().unwrap();
        let journal_of = |robot| ChangeJournal::within(Some(folder.path().to_owned()), robot);
        let mut journal = journal_of("tcp://cell");
        journal.host(true);
        journal.push("@CTSK TASK=01");
        // When the process ends, it releases the lock, and nothing was restored.
        drop(journal);
        fs::write(folder.path().join("odd.json"), "{").unwrap();
        assert!(
            journal_of("tcp://other").abandoned_entries().is_empty()
                && !journal_of("tcp://cell").has_entry_of_running_process()
        );
        let abandoned = journal_of("tcp://cell").abandoned_entries();
        assert_eq!(abandoned.len(), 1);
        assert!(
            abandoned[0].entry.host
                && abandoned[0].entry.back == ["@CTSK TASK=01"]
                && abandoned[0].entry.moving.is_none()
        );
        abandoned[0].delete();
        assert!(journal_of("tcp://cell").abandoned_entries().is_empty());
    }
}
