//! The list that a backup keeps of itself, as far as all families have it in common: where it is, which files belong to it
//! with size and hash, and what did not come.

use std::fs;
use std::io::{ErrorKind, Read as _};
use std::path::Path;

use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use super::local::Target;
use crate::controller::text::hex;
use crate::failure::Failure;
use crate::output::escape;

/// Name of the list in the folder of a backup. No file of a controller has this ending.
pub const MANIFEST: &str = "manifest.json";

/// Larger lists are not read: no controller has so many files.
const MAX_LIST: u64 = 64 << 20;

/// The list of a backup of one family.
pub trait List: Serialize + DeserializeOwned {
    /// What the folder holds, for programs that come across it.
    const FORMAT: &'static str;
    /// Raised when old programs would misread a new list.
    const VERSION: u32;

    /// Format and version that it says to have.
    fn head(&self) -> (&str, u32);
    /// The name and the target URL of the robot, and whether it is whole.
    fn state(&self) -> (&str, &str, bool);
    /// Whether what it says can be true.
    fn check(&self) -> Result<(), String>;
}

/// Reads the list in `folder`; `None` if there is none.
pub fn read<L: List>(folder: &Path) -> Result<Option<L>, Failure> {
    let path = folder.join(MANIFEST);
    let mut text = String::new();
    let file = match fs::File::open(&path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(Failure::io(path.display(), &error)),
    };
    let size = file.take(MAX_LIST).read_to_string(&mut text).map_err(|error| Failure::io(path.display(), &error))?;
    let wrong = |why: String| {
        Failure::local(format!("{}: {why}", path.display())).hint("this is no whole list of a backup; make a new one")
    };
    if size as u64 == MAX_LIST {
        return Err(wrong("too large".to_owned()));
    }
    let list: L = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
    match list.head() {
        (format, _) if format != L::FORMAT => {
            return Err(wrong(format!("it says to be of '{format}', not '{}'", L::FORMAT)));
        }
        (_, version) if version > L::VERSION => {
            return Err(wrong(format!("it has version {version}, and this program reads up to {}", L::VERSION)));
        }
        _ => {}
    }
    list.check().map_err(wrong)?;
    Ok(Some(list))
}

/// Writes the list into `folder`, whole or not at all.
pub fn write(folder: &Path, list: &impl List) -> Result<(), Failure> {
    let mut text = escape::json_pretty(list).map_err(|error| Failure::local(format!("{MANIFEST}: {error}")))?;
    text.push('\n');
    let mut draft = Target::new(folder.join(MANIFEST), true)?.begin()?;
    draft.write(text.as_bytes())?;
    draft.commit()
}

/// Looks into a folder that a backup shall go to: the backup that it holds, if it holds one. Anything else must not be
/// mixed with a backup.
pub fn look<L: List>(folder: &Path) -> Result<Option<L>, Failure> {
    let mut entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(Failure::io(folder.display(), &error)),
    };
    if let Some(list) = read(folder)? {
        return Ok(Some(list));
    }
    match entries.next() {
        None => Ok(None),
        Some(_) => Err(Failure::local(format!("{} holds other files", folder.display()))
            .hint("a backup takes an empty folder, or makes a new one")),
    }
}

/// The backup in a folder that a new one goes on with, if any: with `resume`, one of the same target. With `force` a new one
/// takes its place.
pub fn earlier<L: List>(folder: &Path, target: &str, resume: bool, force: bool) -> Result<Option<L>, Failure> {
    let Some(earlier) = look::<L>(folder)?.filter(|_| !force) else { return Ok(None) };
    let (name, its, is_whole) = earlier.state();
    if !resume {
        let state = if is_whole { "a backup" } else { "a backup that is not whole" };
        return Err(Failure::local(format!("{} holds {state} of {name}", folder.display()))
            .hint("--resume goes on with it, --force makes a new one over it; or choose another folder"));
    }
    if its != target {
        return Err(Failure::usage(format!("{} is a backup of {name} ({its})", folder.display()))
            .hint("choose another folder for this robot"));
    }
    Ok(Some(earlier))
}

/// How far one part of a backup, or a transfer of many files, got.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// It was done now.
    Done,
    /// It had been done before.
    Kept,
    /// It failed; see `error`.
    Failed,
    /// An earlier failure ended the work.
    NotTried,
}

/// A file in the folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Saved {
    /// Its name in the folder.
    pub file: String,
    /// Its size.
    pub bytes: u64,
    /// Its SHA-256 in hexadecimal.
    pub sha256: String,
}

/// Why a file did not come.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Reason {
    /// The controller's code.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub code: Option<String>,
    /// In words.
    pub message: String,
}

impl From<&Failure> for Reason {
    fn from(failure: &Failure) -> Self {
        Self { code: failure.code.clone(), message: failure.message.clone() }
    }
}

impl Saved {
    /// Whether the file in `folder` is what was fetched; otherwise says what is wrong with it.
    pub fn check(&self, folder: &Path) -> Result<(), Failure> {
        let path = folder.join(&self.file);
        let damaged = |why: String| {
            Err(Failure::local(format!("{}: {why}", path.display()))
                .hint("the file is not what was backed up; take it from another copy of the backup, or leave it out"))
        };
        let mut file = match fs::File::open(&path) {
            Ok(file) => file,
            Err(error) if error.kind() == ErrorKind::NotFound => return damaged("it is missing".to_owned()),
            Err(error) => return Err(Failure::io(path.display(), &error)),
        };
        let mut hash = Hash::default();
        let mut buffer = vec![0; 1 << 16];
        loop {
            match file.read(&mut buffer) {
                Ok(0) => break,
                Ok(read) => hash.take(buffer.get(..read).unwrap_or_default()),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(Failure::io(path.display(), &error)),
            }
        }
        if hash.bytes != self.bytes {
            return damaged(format!("it has {} bytes instead of {}", hash.bytes, self.bytes));
        }
        if !hash.hex().eq_ignore_ascii_case(&self.sha256) {
            return damaged("its content was changed (SHA-256)".to_owned());
        }
        Ok(())
    }
}

/// Size and SHA-256 of what passes by.
#[derive(Debug, Default)]
pub struct Hash {
    sha256: Sha256,
    /// Bytes so far.
    pub bytes: u64,
}

impl Hash {
    /// The next bytes.
    pub fn take(&mut self, bytes: &[u8]) {
        self.sha256.update(bytes);
        self.bytes = self.bytes.saturating_add(bytes.len() as u64);
    }

    /// The hash in lower-case hexadecimal.
    pub fn hex(self) -> String {
        hex(&self.sha256.finalize())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_copy_is_found_out() {
        let folder = tempfile::tempdir().unwrap();
        let copy = Saved {
            file: "A.JBI".into(),
            bytes: 3,
            sha256: "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad".into(),
        };
        let path = folder.path().join("A.JBI");
        let problem = || copy.check(folder.path()).unwrap_err().message;
        assert!(problem().ends_with("it is missing"));
        fs::write(&path, "abd").unwrap();
        assert!(problem().ends_with("(SHA-256)"));
        fs::write(&path, "abcd").unwrap();
        assert!(problem().ends_with("it has 4 bytes instead of 3"));
        fs::write(&path, "abc").unwrap();
        copy.check(folder.path()).unwrap();
    }
}
