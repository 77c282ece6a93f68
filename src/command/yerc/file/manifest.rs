//! The list that a backup keeps of itself: what came from where, how large it is, its hash, and what did not come.

use std::path::Path;

use jiff::Timestamp;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::name::exact;
use crate::command::local::is_plain_file_name;
use crate::command::manifest::{self, List, Reason, Saved};
use crate::controller::text::{hex, unhex};
use crate::controller::yerc::files::FileName;
use crate::failure::Failure;

/// The list of a backup.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// [`List::FORMAT`].
    pub format: String,
    /// [`List::VERSION`].
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

impl Manifest {
    /// The list of a backup that begins.
    pub fn new(robot: String, target: String, model: String, encoding: String, types: Vec<String>) -> Self {
        let now = Timestamp::now();
        Self {
            format: Self::FORMAT.to_owned(),
            version: Self::VERSION,
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

    /// Writes the list into `folder`, whole or not at all.
    pub fn write(&mut self, folder: &Path) -> Result<(), Failure> {
        self.updated = Timestamp::now();
        manifest::write(folder, self)
    }

    /// What was asked for under this name.
    pub fn entry(&self, name: &[u8]) -> Option<&Entry> {
        let digits = hex(name);
        self.files.iter().find(|entry| entry.name_hex == digits)
    }
}

impl List for Manifest {
    const FORMAT: &'static str = "armctl yerc backup";
    const VERSION: u32 = 1;

    fn head(&self) -> (&str, u32) {
        (&self.format, self.version)
    }

    fn state(&self) -> (&str, &str, bool) {
        (&self.robot, &self.target, self.complete)
    }

    fn check(&self) -> Result<(), String> {
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

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::failure::Kind;

    fn look(folder: &Path) -> Result<Option<Manifest>, Failure> {
        manifest::look(folder)
    }

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
        assert!(manifest::read::<Manifest>(folder.path()).unwrap().is_none());
        let mut written = manifest();
        written.write(folder.path()).unwrap();
        assert_eq!(manifest::read::<Manifest>(folder.path()).unwrap().unwrap(), written);
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
            assert_eq!(manifest::read::<Manifest>(folder.path()).unwrap_err().kind, Kind::Local);
        }
    }

    #[test]
    fn only_an_empty_folder_or_a_backup_takes_a_backup() {
        let folder = tempfile::tempdir().unwrap();
        assert!(look(&folder.path().join("new")).unwrap().is_none());
        assert!(look(folder.path()).unwrap().is_none());
        fs::write(folder.path().join("letter.txt"), "x").unwrap();
        assert_eq!(look(folder.path()).unwrap_err().kind, Kind::Local);
        manifest().write(folder.path()).unwrap();
        assert!(look(folder.path()).unwrap().is_some());
    }
}
