//! The list that a backup keeps of itself: what came from where, how large it is, its hash, and what did not come.

use std::fs;
use std::io::{ErrorKind, Read as _};
use std::path::Path;

use jiff::Timestamp;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use super::name::exact;
use crate::command::local::{Target, is_plain_file_name};
use crate::controller::text::{hex, unhex};
use crate::controller::yerc::files::FileName;
use crate::failure::Failure;
use crate::output::escape;

/// Name of the list in the folder of a backup. No file of a controller has this ending.
pub const MANIFEST: &str = "manifest.json";

/// What the folder holds, for programs that come across it.
const FORMAT: &str = "armctl yerc backup";
/// Raised when old programs would misread a new list.
const VERSION: u32 = 1;
/// Larger lists are not read: no controller has so many files.
const MAX_LIST: u64 = 64 << 20;

/// The list of a backup.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// [`FORMAT`].
    pub format: String,
    /// [`VERSION`].
    pub version: u32,
    /// Name of the robot.
    pub robot: String,
    /// Its URL.
    pub target: String,
    /// `fs100` or `dx200`.
    pub model: String,
    /// Encoding in which names are shown.
    pub encoding: String,
    /// When the backup began.
    pub started: Timestamp,
    /// When it was last worked on.
    pub updated: Timestamp,
    /// Types asked for, in lower case.
    pub types: Vec<String>,
    /// Whether every file of these types is here.
    pub complete: bool,
    /// Every file that was asked for so far.
    pub files: Vec<Entry>,
}

/// One file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Entry {
    /// Its name on the controller, to read.
    pub name: String,
    /// The same in bytes: this is the name that counts.
    pub name_hex: String,
    /// `jbi` and so on.
    #[serde(rename = "type")]
    pub file_type: String,
    /// The copy, if there is one.
    #[serde(flatten)]
    pub copy: Option<Saved>,
    /// Why there is none.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub error: Option<Reason>,
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

impl Manifest {
    /// The list of a backup that begins.
    pub fn new(robot: String, target: String, model: String, encoding: String, types: Vec<String>) -> Self {
        let now = Timestamp::now();
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            robot,
            target,
            model,
            encoding,
            started: now,
            updated: now,
            types,
            complete: false,
            files: Vec::new(),
        }
    }

    /// Reads the list in `folder`; `None` if there is none.
    pub fn read(folder: &Path) -> Result<Option<Self>, Failure> {
        let path = folder.join(MANIFEST);
        let mut text = String::new();
        let file = match fs::File::open(&path) {
            Ok(file) => file,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(Failure::io(path.display(), &error)),
        };
        let size =
            file.take(MAX_LIST).read_to_string(&mut text).map_err(|error| Failure::io(path.display(), &error))?;
        let wrong = |why: String| {
            Failure::local(format!("{}: {why}", path.display()))
                .hint("this is no whole list of a backup; make a new one")
        };
        if size as u64 == MAX_LIST {
            return Err(wrong("too large".to_owned()));
        }
        let manifest: Self = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
        manifest.check().map_err(wrong)?;
        Ok(Some(manifest))
    }

    /// Writes the list into `folder`, whole or not at all.
    pub fn write(&mut self, folder: &Path) -> Result<(), Failure> {
        self.updated = Timestamp::now();
        let mut text = escape::json_pretty(self).map_err(|error| Failure::local(format!("{MANIFEST}: {error}")))?;
        text.push('\n');
        let mut draft = Target::new(folder.join(MANIFEST), true)?.begin()?;
        draft.write(text.as_bytes())?;
        draft.commit()
    }

    /// What was asked for under this name.
    pub fn entry(&self, name: &[u8]) -> Option<&Entry> {
        let digits = hex(name);
        self.files.iter().find(|entry| entry.name_hex == digits)
    }

    fn check(&self) -> Result<(), String> {
        if self.format != FORMAT {
            return Err(format!("it says to be of '{}', not '{FORMAT}'", self.format));
        }
        if self.version > VERSION {
            return Err(format!("it has version {}, and this program reads up to {VERSION}", self.version));
        }
        let mut names = std::collections::HashSet::new();
        let mut copies = std::collections::HashSet::new();
        for entry in &self.files {
            if unhex(&entry.name_hex).is_none() || !names.insert(entry.name_hex.to_lowercase()) {
                return Err(format!("'{}' has no name_hex of its own", entry.name));
            }
            let Some(copy) = &entry.copy else {
                if entry.error.is_none() {
                    return Err(format!("'{}' has neither file, bytes and sha256 nor an error", entry.name));
                }
                continue;
            };
            if !is_plain_file_name(&copy.file) {
                return Err(format!("'{}' is no file in this folder", copy.file));
            }
            if !copies.insert(&copy.file) {
                return Err(format!("'{}' is there for two files", copy.file));
            }
        }
        Ok(())
    }
}

impl Entry {
    /// The file on the controller.
    pub fn controller_file(&self) -> Result<FileName, Failure> {
        exact(unhex(&self.name_hex).unwrap_or_default())
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

/// What a folder that a backup shall go to holds already.
#[derive(Debug)]
pub enum Found {
    /// Nothing, or it is not there.
    Nothing,
    /// A backup.
    Backup(Box<Manifest>),
}

impl Found {
    /// Looks into `folder`; anything but a backup must not be mixed with one.
    pub fn look(folder: &Path) -> Result<Self, Failure> {
        let mut entries = match fs::read_dir(folder) {
            Ok(entries) => entries,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Self::Nothing),
            Err(error) => return Err(Failure::io(folder.display(), &error)),
        };
        if let Some(manifest) = Manifest::read(folder)? {
            return Ok(Self::Backup(Box::new(manifest)));
        }
        match entries.next() {
            None => Ok(Self::Nothing),
            Some(_) => Err(Failure::local(format!("{} holds other files", folder.display()))
                .hint("a backup takes an empty folder, or makes a new one")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::failure::Kind;

    fn manifest() -> Manifest {
        let mut manifest =
            Manifest::new("cell3".into(), "udp://h".into(), "dx200".into(), "shift_jis".into(), vec!["jbi".into()]);
        let copy = Saved {
            file: "A.JBI".into(),
            bytes: 3,
            sha256: "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad".into(),
        };
        let entry = |name: &[u8], copy, error| Entry {
            name: name.escape_ascii().to_string(),
            name_hex: hex(name),
            file_type: "jbi".into(),
            copy,
            error,
        };
        manifest.files.push(entry(b"A.JBI", Some(copy), None));
        let reason = Reason { code: Some("0xE29C".into()), message: "no".into() };
        manifest.files.push(entry(b"\x83\x5c.JBI", None, Some(reason)));
        manifest
    }

    #[test]
    fn a_list_is_read_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        assert!(Manifest::read(folder.path()).unwrap().is_none());
        let mut written = manifest();
        written.write(folder.path()).unwrap();
        assert_eq!(Manifest::read(folder.path()).unwrap().unwrap(), written);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(written.entry(b"\x83\x5c.JBI").unwrap().copy.is_none());
        assert_eq!(written.files[0].controller_file().unwrap().as_bytes(), b"A.JBI");
    }

    #[test]
    fn a_list_that_was_tampered_with_is_no_list() {
        let spoil: [fn(&mut Manifest); 7] = [
            |m| m.files[0].copy.as_mut().unwrap().file = "../A.JBI".into(),
            |m| m.files[0].name_hex = "4".into(),
            |m| m.files[1].name_hex = m.files[0].name_hex.clone(),
            |m| m.files[1].copy = m.files[0].copy.clone(),
            |m| m.files[1].error = None,
            |m| m.version = 2,
            |m| m.format = "else".into(),
        ];
        for spoil in spoil {
            let folder = tempfile::tempdir().unwrap();
            let mut spoilt = manifest();
            spoil(&mut spoilt);
            spoilt.write(folder.path()).unwrap();
            assert_eq!(Manifest::read(folder.path()).unwrap_err().kind, Kind::Local);
        }
    }

    #[test]
    fn a_changed_copy_is_found_out() {
        let folder = tempfile::tempdir().unwrap();
        let copy = manifest().files[0].copy.clone().unwrap();
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

    #[test]
    fn only_an_empty_folder_or_a_backup_takes_a_backup() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(Found::look(&folder.path().join("new")).unwrap(), Found::Nothing));
        assert!(matches!(Found::look(folder.path()).unwrap(), Found::Nothing));
        fs::write(folder.path().join("letter.txt"), "x").unwrap();
        assert_eq!(Found::look(folder.path()).unwrap_err().kind, Kind::Local);
        manifest().write(folder.path()).unwrap();
        assert!(matches!(Found::look(folder.path()).unwrap(), Found::Backup(_)));
    }
}
