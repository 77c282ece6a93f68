//! Journal of temporary changes, written before each change: the host, the current task, the mode, motion.
//!
//! A command restores all changes. A killed process cannot. The next command then finds the journal entry, reads
//! whether the change is still present, and reports how to undo it. The process that owns an entry holds the lock of
//! its file.

use std::fs::{self, File, OpenOptions};
use std::io::{Seek as _, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::client::toyo::Moving;
use crate::command::frame::local_names::state_folder;
use crate::files;

/// Changes that are not restored yet.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Owed {
    /// Target URL of the robot.
    robot: String,
    /// Time of the first change in seconds since 1970.
    since: u64,
    /// The host was OFF and was switched ON.
    pub host: bool,
    /// Blocks that restore settings, in the order of the changes: `@CTSK TASK=01`.
    pub back: Vec<String>,
    /// Motion that was started: `jog` or `program`.
    pub moving: Option<String>,
}

impl Owed {
    /// Whether all changes are restored.
    pub fn is_nothing(&self) -> bool {
        !self.host && self.back.is_empty() && self.moving.is_none()
    }
}

/// Journal of one link.
#[derive(Debug, Default)]
pub struct Debts {
    /// Folder of the entries; `None` for a simulator in this process.
    folder: Option<PathBuf>,
    owed: Owed,
    file: Option<(File, PathBuf)>,
}

/// Journal entry of a process that has ended.
#[derive(Debug)]
pub struct Left {
    /// Changes that the process did not restore.
    pub owed: Owed,
    path: PathBuf,
}

/// Size limit of an entry.
const MOST: u64 = 16 * 1024;
/// Entries older than this are deleted, because the robot has been used since.
const OLD: Duration = Duration::from_secs(30 * 24 * 3600);

impl Debts {
    /// Journal of a link to a robot.
    pub fn of(robot: &str) -> Self {
        Self::within(state_folder().map(|folder| folder.join("toyo-changes")), robot)
    }

    /// Journal without files, for a simulator in this process and for dry runs.
    pub fn without_notes() -> Self {
        Self::default()
    }

    fn within(folder: Option<PathBuf>, robot: &str) -> Self {
        Self { folder, owed: Owed { robot: robot.to_owned(), ..Owed::default() }, file: None }
    }

    /// Records that the host is switched ON, or OFF again.
    pub fn host(&mut self, is_taken: bool) {
        self.change(|owed| owed.host = is_taken);
    }

    /// Records a change that the block `back` restores.
    pub fn push(&mut self, back: &str) {
        self.change(|owed| owed.back.push(back.to_owned()));
    }

    /// Removes the last change that the block `back` restores.
    pub fn pop(&mut self, back: &str) {
        self.change(|owed| {
            if let Some(last) = owed.back.iter().rposition(|other| other == back) {
                owed.back.remove(last);
            }
        });
    }

    /// Records the start or the end of a motion.
    pub fn moving(&mut self, moving: Option<Moving>) {
        let word = |moving| if moving == Moving::Jog { "jog" } else { "program" }.to_owned();
        self.change(|owed| owed.moving = moving.map(word));
    }

    /// A journal that cannot be written must not prevent the command.
    fn change(&mut self, change: impl FnOnce(&mut Owed)) {
        let before = self.owed.clone();
        change(&mut self.owed);
        if before != self.owed {
            self.keep().unwrap_or_default();
        }
    }

    fn keep(&mut self) -> std::io::Result<()> {
        let Some(folder) = &self.folder else { return Ok(()) };
        if self.owed.is_nothing() {
            if let Some((_, path)) = self.file.take() {
                fs::remove_file(path)?;
            }
            return Ok(());
        }
        if self.file.is_none() {
            self.owed.since = now();
            fs::create_dir_all(folder)?;
            let path = folder.join(format!("{:016x}.json", fastrand::u64(..)));
            let file = OpenOptions::new().create_new(true).write(true).open(&path)?;
            lock(&file);
            self.file = Some((file, path));
        }
        if let Some((file, _)) = &mut self.file {
            let text = serde_json::to_vec(&self.owed)?;
            file.rewind()?;
            file.write_all(&text)?;
            file.set_len(text.len() as u64)?;
        }
        Ok(())
    }

    /// Changes of this process.
    pub fn owed(&self) -> &Owed {
        &self.owed
    }

    /// Entries of ended processes for the same robot.
    pub fn left(&self) -> Vec<Left> {
        let left = self.notes().filter_map(|path| Some(Left { owed: abandoned(&path)?, path }));
        left.filter(|left| left.owed.robot == self.owed.robot).collect()
    }

    /// Whether other running processes have changed settings of the same robot.
    pub fn others_owe(&self) -> bool {
        let own = self.file.as_ref().map(|(_, path)| path);
        let others = self.notes().filter(|path| Some(path) != own);
        let mut living = others.filter(|path| {
            let (file, about) = (files::open(path), fs::symlink_metadata(path));
            file.is_ok_and(|file| about.is_ok_and(|about| about.is_file() && !is_free(&file, &about)))
        });
        living.any(|path| owed(&path).is_some_and(|owed| owed.robot == self.owed.robot))
    }

    /// Paths of all entries.
    fn notes(&self) -> impl Iterator<Item = PathBuf> {
        let entries = self.folder.as_ref().and_then(|folder| fs::read_dir(folder).ok()).into_iter().flatten().flatten();
        entries.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|ending| ending == "json"))
    }
}

impl Left {
    /// Deletes the entry, because all changes are restored.
    pub fn settled(&self) {
        fs::remove_file(&self.path).unwrap_or_default();
    }

    /// Time of the first change as text.
    pub fn since(&self) -> String {
        let seconds = i64::try_from(self.owed.since).unwrap_or_default();
        jiff::Timestamp::from_second(seconds).map_or_else(|_| "?".to_owned(), |time| time.to_string())
    }
}

/// The entry in a file, unless the process that wrote it is still running.
fn abandoned(path: &Path) -> Option<Owed> {
    let about = fs::symlink_metadata(path).ok().filter(|about| about.is_file() && about.len() <= MOST)?;
    let file = files::open(path).ok()?;
    if !is_free(&file, &about) {
        return None;
    }
    if about.modified().ok().and_then(|time| time.elapsed().ok()).is_some_and(|age| age > OLD) {
        fs::remove_file(path).unwrap_or_default();
        return None;
    }
    owed(path)
}

/// The entry in a file.
fn owed(path: &Path) -> Option<Owed> {
    serde_json::from_slice(&files::read(path, MOST).ok()?).ok()
}

fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs())
}

#[cfg(unix)]
fn lock(file: &File) {
    rustix::fs::flock(file, rustix::fs::FlockOperation::NonBlockingLockExclusive).unwrap_or_default();
}

#[cfg(unix)]
fn is_free(file: &File, _: &fs::Metadata) -> bool {
    rustix::fs::flock(file, rustix::fs::FlockOperation::NonBlockingLockShared).is_ok()
}

#[cfg(not(unix))]
fn lock(_: &File) {}

/// Without file locks, an entry belongs to an ended process after the longest time that a command can take.
#[cfg(not(unix))]
fn is_free(_: &File, about: &fs::Metadata) -> bool {
    let age = about.modified().ok().and_then(|time| time.elapsed().ok());
    age.is_some_and(|age| age > Duration::from_secs(3600))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_note_is_there_as_long_as_something_is_changed() {
        let folder = tempfile::tempdir().unwrap();
        let left = || fs::read_dir(folder.path()).unwrap().count();
        let notes = || Debts::within(Some(folder.path().to_owned()), "tcp://cell");
        let mut debts = notes();
        debts.host(true);
        debts.push("@CTSK TASK=01");
        debts.moving(Some(Moving::Jog));
        assert_eq!(left(), 1);
        // The process that wrote it is still running.
        #[cfg(unix)]
        assert!(notes().left().is_empty() && notes().others_owe() && !debts.others_owe());
        debts.moving(None);
        debts.pop("@CTSK TASK=01");
        assert_eq!(left(), 1);
        debts.host(false);
        assert_eq!(left(), 0);
    }

    #[cfg(unix)]
    #[test]
    fn what_a_dead_process_has_left_is_found_until_it_is_settled() {
        let folder = tempfile::tempdir().unwrap();
        let notes = |robot| Debts::within(Some(folder.path().to_owned()), robot);
        let mut debts = notes("tcp://cell");
        debts.host(true);
        debts.push("@CTSK TASK=01");
        // The lock ends with the process, and nothing is restored.
        drop(debts);
        fs::write(folder.path().join("odd.json"), "{").unwrap();
        assert!(notes("tcp://other").left().is_empty() && !notes("tcp://cell").others_owe());
        let left = notes("tcp://cell").left();
        assert_eq!(left.len(), 1);
        assert!(left[0].owed.host && left[0].owed.back == ["@CTSK TASK=01"] && left[0].owed.moving.is_none());
        left[0].settled();
        assert!(notes("tcp://cell").left().is_empty());
    }
}
