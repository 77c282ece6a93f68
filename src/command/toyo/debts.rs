//! What a command changes for a while, written down before it is done: the host, the current task, the mode, what moves.
//!
//! A command puts it all back. One that is killed cannot; so the next one finds the note, looks whether it is still so, and
//! says how to undo it. A note belongs to a process as long as that holds the lock of its file.

use std::fs::{self, File, OpenOptions};
use std::io::{Seek as _, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::client::toyo::Moving;
use crate::command::frame::local::state_folder;
use crate::files;

/// What is changed and not put back.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Owed {
    /// The target of the robot.
    robot: String,
    /// Seconds since 1970.
    since: u64,
    /// The host was switched ON, and was OFF before.
    pub host: bool,
    /// The blocks that put things back, the last change at the end: `@CTSK TASK=01`.
    pub back: Vec<String>,
    /// What was set in motion: `jog` or `program`.
    pub moving: Option<String>,
}

impl Owed {
    /// Whether nothing is left to put back.
    pub fn is_nothing(&self) -> bool {
        !self.host && self.back.is_empty() && self.moving.is_none()
    }
}

/// The note of one link.
#[derive(Debug, Default)]
pub struct Debts {
    /// Where notes are, for a robot whose state outlives this process.
    folder: Option<PathBuf>,
    owed: Owed,
    file: Option<(File, PathBuf)>,
}

/// A note that another process has left behind.
#[derive(Debug)]
pub struct Left {
    /// What it says.
    pub owed: Owed,
    path: PathBuf,
}

/// Notes are small; anything larger is none.
const MOST: u64 = 16 * 1024;
/// A robot that nobody has asked for so long is another one now, and its note goes.
const OLD: Duration = Duration::from_secs(30 * 24 * 3600);

impl Debts {
    /// Of a link to a robot.
    pub fn of(robot: &str) -> Self {
        Self::within(state_folder().map(|folder| folder.join("toyo-changes")), robot)
    }

    /// Of a link that lasts as long as what it changes.
    pub fn without_notes() -> Self {
        Self::default()
    }

    fn within(folder: Option<PathBuf>, robot: &str) -> Self {
        Self { folder, owed: Owed { robot: robot.to_owned(), ..Owed::default() }, file: None }
    }

    /// The host is switched ON, or OFF again.
    pub fn host(&mut self, is_taken: bool) {
        self.change(|owed| owed.host = is_taken);
    }

    /// Something is changed that this block puts back.
    pub fn push(&mut self, back: &str) {
        self.change(|owed| owed.back.push(back.to_owned()));
    }

    /// The last that this block puts back was put back, or never changed.
    pub fn pop(&mut self, back: &str) {
        self.change(|owed| {
            if let Some(last) = owed.back.iter().rposition(|other| other == back) {
                owed.back.remove(last);
            }
        });
    }

    /// Something moves, or nothing more.
    pub fn moving(&mut self, moving: Option<Moving>) {
        let word = |moving| if moving == Moving::Jog { "jog" } else { "program" }.to_owned();
        self.change(|owed| owed.moving = moving.map(word));
    }

    /// What could not be written is an aid less, and no reason to leave an order undone.
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

    /// What is changed now.
    pub fn owed(&self) -> &Owed {
        &self.owed
    }

    /// What others have left behind on the same robot.
    pub fn left(&self) -> Vec<Left> {
        let left = self.notes().filter_map(|path| Some(Left { owed: abandoned(&path)?, path }));
        left.filter(|left| left.owed.robot == self.owed.robot).collect()
    }

    /// Whether other processes that live have changed something on the same robot.
    pub fn others_owe(&self) -> bool {
        let own = self.file.as_ref().map(|(_, path)| path);
        let others = self.notes().filter(|path| Some(path) != own);
        let mut living = others.filter(|path| {
            let (file, about) = (files::open(path), fs::symlink_metadata(path));
            file.is_ok_and(|file| about.is_ok_and(|about| about.is_file() && !is_free(&file, &about)))
        });
        living.any(|path| owed(&path).is_some_and(|owed| owed.robot == self.owed.robot))
    }

    /// The notes of all.
    fn notes(&self) -> impl Iterator<Item = PathBuf> {
        let entries = self.folder.as_ref().and_then(|folder| fs::read_dir(folder).ok()).into_iter().flatten().flatten();
        entries.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|ending| ending == "json"))
    }
}

impl Left {
    /// All of it was put back, by whomever.
    pub fn settled(&self) {
        fs::remove_file(&self.path).unwrap_or_default();
    }

    /// When it was changed.
    pub fn since(&self) -> String {
        let seconds = i64::try_from(self.owed.since).unwrap_or_default();
        jiff::Timestamp::from_second(seconds).map_or_else(|_| "?".to_owned(), |time| time.to_string())
    }
}

/// The note in a file, unless the process that wrote it lives.
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

/// The note in a file.
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

/// Without locks, what was not touched for longer than any command takes is abandoned.
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
        // The process that wrote it lives.
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
        // Its lock goes with it, and nothing is put back.
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
