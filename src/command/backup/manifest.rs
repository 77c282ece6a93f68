//! The list that a backup keeps of itself, the same for all families: of which robot it is, which files belong to it with
//! size and hash, what is in them, and what did not come.

use std::collections::HashSet;
use std::fs;
use std::io::{ErrorKind, Read as _};
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use jiff::Timestamp;
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest as _, Sha256};

use crate::command::frame::local::{Target, is_plain_file_name};
use crate::controller::text::{hex, unhex};
use crate::failure::{Failure, Kind};
use crate::files;
use crate::output::escape;
use crate::settings::Robot;
use crate::settings::target::Family;

/// Name of the list in the folder of a backup. No file of a controller has this ending.
pub const MANIFEST: &str = "manifest.json";

/// What the folder holds, for programs that come across it.
const FORMAT: &str = "armctl backup";
/// Raised when old programs would misread a new list.
const VERSION: u32 = 1;
/// Larger lists are not read: no controller has so many files.
const MAX_LIST: u64 = 64 << 20;

/// The list of a backup; `C` tells what kind of controller it is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest<C = Value> {
    /// Always the same; see there.
    format: String,
    version: u32,
    /// The version of armctl that wrote it.
    armctl: String,
    /// `yerc`, `yrcx` or `toyo`.
    pub family: String,
    /// Name of the robot.
    pub robot: String,
    /// Its URL.
    pub target: String,
    /// Model and versions.
    pub controller: C,
    /// What was asked for, where that is not everything: types of files, ranges of numbers, patterns of names.
    pub scope: Vec<String>,
    /// When the backup began.
    pub taken_at: Timestamp,
    /// When it was last worked on.
    updated_at: Timestamp,
    /// Whether nothing is missing of what was asked for.
    pub complete: bool,
    /// Everything that was asked for so far.
    pub files: Vec<Entry>,
}

/// A file of the controller, or a part of what it stores.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Entry {
    /// Its name on the controller, or the name of the part: `TESTJOB.JBI`, `points-1`.
    pub name: String,
    /// The name in bytes, where names have an encoding: this is the one that counts.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub name_hex: Option<String>,
    /// What it holds: `jbi`, `program`, `points 0..999`.
    pub holds: String,
    /// The copy, if there is one.
    #[serde(flatten)]
    pub copy: Option<Saved>,
    /// What is not in it.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub left_out: Vec<LeftOut>,
    /// Why there is no copy.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub error: Option<Reason>,
}

/// Something that is not in a file, or not on a controller.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct LeftOut {
    /// `P05`, `T2.7`.
    pub key: String,
    /// Why.
    pub why: String,
}

/// What a list says of the controller, as its family knows it.
pub trait About: Serialize + DeserializeOwned {
    /// The family; `None` where it may be any.
    const FAMILY: Option<Family>;

    /// Whether what is said of the controller can be true.
    fn check(&self) -> Result<(), String> {
        Ok(())
    }

    /// Whether the family has such a file.
    fn check_entry(_entry: &Entry) -> Result<(), String> {
        Ok(())
    }
}

impl About for Value {
    const FAMILY: Option<Family> = None;
}

impl<C: About> Manifest<C> {
    /// The list of a backup that begins.
    pub fn new(robot: &Robot, controller: C, scope: Vec<String>) -> Self {
        let now = Timestamp::now();
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            armctl: env!("CARGO_PKG_VERSION").to_owned(),
            family: robot.family.name().to_owned(),
            robot: robot.name.clone(),
            target: robot.target.value.url().to_owned(),
            controller,
            scope,
            taken_at: now,
            updated_at: now,
            complete: false,
            files: Vec::new(),
        }
    }

    /// Writes the list into `folder`, whole or not at all.
    pub fn write(&mut self, folder: &Path) -> Result<(), Failure> {
        self.updated_at = Timestamp::now();
        let mut text = escape::json_pretty(self).map_err(|error| Failure::local(format!("{MANIFEST}: {error}")))?;
        text.push('\n');
        let mut draft = Target::new(folder.join(MANIFEST), true)?.begin()?;
        draft.write(text.as_bytes())?;
        draft.commit()
    }

    /// What it says of a name.
    pub fn entry(&self, name: &str) -> Option<&Entry> {
        self.files.iter().find(|entry| entry.name == name)
    }

    /// What it says of a name in bytes.
    pub fn entry_of(&self, name: &[u8]) -> Option<&Entry> {
        let digits = hex(name);
        self.files.iter().find(|entry| entry.name_hex.as_ref().is_some_and(|own| own.eq_ignore_ascii_case(&digits)))
    }

    fn check(&self) -> Result<(), String> {
        if let Some(family) = C::FAMILY
            && family.name() != self.family
        {
            return Err(format!("it is of family {}, not {}", self.family, family.name()));
        }
        let (mut names, mut copies) = (HashSet::new(), HashSet::new());
        for entry in &self.files {
            let Entry { name, name_hex, copy, error, .. } = entry;
            if name_hex.as_ref().is_some_and(|digits| unhex(digits).is_none()) {
                return Err(format!("the name_hex of '{name}' is not a valid name"));
            }
            if !names.insert(name_hex.as_ref().unwrap_or(name).to_lowercase()) {
                return Err(format!("'{name}' is there twice"));
            }
            match copy {
                Some(copy) if !is_plain_file_name(&copy.file) || copy.file == MANIFEST => {
                    return Err(format!("'{}' is not a file of a backup in this folder", copy.file));
                }
                Some(copy) if !copies.insert(copy.file.to_lowercase()) => {
                    return Err(format!("'{}' is there for two names", copy.file));
                }
                None if error.is_none() => {
                    return Err(format!("'{name}' has neither file, bytes and sha256 nor an error"));
                }
                _ => {}
            }
            C::check_entry(entry)?;
        }
        self.controller.check()
    }
}

/// Reads the list in `folder`; `None` if there is none.
pub fn read<C: About>(folder: &Path) -> Result<Option<Manifest<C>>, Failure> {
    /// What every list begins with.
    #[derive(Deserialize)]
    struct Head {
        format: String,
        version: u32,
        #[serde(default)]
        family: Option<String>,
    }

    let path = folder.join(MANIFEST);
    let text = match files::text(&path, MAX_LIST) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        text => text.with_context(|| path.display().to_string())?,
    };
    let wrong = |why: String| {
        Failure::local(format!("{}: {why}", path.display()))
            .hint("this is not a whole list of a backup; make a new one")
    };
    match serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))? {
        Head { format, .. } if format != FORMAT => {
            return Err(wrong(format!("it says to be of '{format}', not '{FORMAT}'")));
        }
        Head { version, .. } if version > VERSION => {
            return Err(wrong(format!("it has version {version}, and this program reads up to {VERSION}")));
        }
        Head { family: Some(family), .. } if C::FAMILY.is_some_and(|own| own.name() != family) => {
            let own = C::FAMILY.map_or("this", Family::name);
            let message = format!("{} is a backup of a {family} controller, not of a {own} one", folder.display());
            return Err(Failure::usage(message).hint(format!("name a backup of a {own} controller")));
        }
        Head { .. } => {}
    }
    let list: Manifest<C> = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
    list.check().map_err(wrong)?;
    Ok(Some(list))
}

/// Reads the list in `folder`, which must be there.
pub fn existing<C: About>(folder: &Path) -> Result<Manifest<C>, Failure> {
    read(folder)?.ok_or_else(|| {
        let failure = Failure::local(format!("{} holds no {MANIFEST}", folder.display()));
        match folders_in(folder).first() {
            Some(one) => failure.hint(format!("the backups are in its folders: name one, as in {}", one.display())),
            None => failure.hint("name the folder of a backup; `armctl backup` makes one"),
        }
    })
}

/// The folders of backups in a folder, one a robot.
pub fn folders_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut found: Vec<PathBuf> = entries.filter(|path| path.join(MANIFEST).exists()).collect();
    found.sort();
    found
}

/// Looks into a folder that a backup shall go to: the backup that it holds, if it holds one. Anything else must not be
/// mixed with a backup.
pub fn look<C: About>(folder: &Path) -> Result<Option<Manifest<C>>, Failure> {
    // Of a backup that was killed.
    files::sweep(folder);
    let mut entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        entries => entries.with_context(|| folder.display().to_string())?,
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

/// The backup in a folder that a new one goes on with, if any: with `resume`, one of the same target and of what was asked
/// for then; `scope` is what is asked for now, nothing if nobody says. With `force` a new one takes its place.
pub fn earlier<C: About>(
    folder: &Path,
    robot: &Robot,
    scope: Option<&[String]>,
    resume: bool,
    force: bool,
) -> Result<Option<Manifest<C>>, Failure> {
    let Some(earlier) = look::<Value>(folder)?.filter(|_| !force) else { return Ok(None) };
    let name = &earlier.robot;
    if !resume {
        let state = if earlier.complete { "a backup" } else { "a backup that is not whole" };
        return Err(Failure::local(format!("{} holds {state} of {name}", folder.display()))
            .hint("--resume goes on with it, --force makes a new one over it; or choose another folder"));
    }
    if earlier.target != robot.target.value.url() || earlier.family != robot.family.name() {
        return Err(Failure::usage(format!("{} is a backup of {name} ({})", folder.display(), earlier.target))
            .hint("choose another folder for this robot"));
    }
    if scope.is_some_and(|scope| scope != earlier.scope) {
        let asked = if earlier.scope.is_empty() { "everything".to_owned() } else { earlier.scope.join(", ") };
        return Err(Failure::usage(format!(
            "{} is a backup of {asked}, and this asks for something else",
            folder.display()
        ))
        .hint("--resume alone goes on with what was asked for; choose another folder for something else"));
    }
    read(folder)
}

/// Whether what a backup is of may be written to this robot: unless `force`, to the robot it is of, or to a simulator.
pub fn check_origin(manifest: &Manifest, robot: &Robot, force: bool) -> Result<(), Failure> {
    let Manifest { family, robot: name, target, .. } = manifest;
    if *family != robot.family.name() {
        return Err(Failure::usage(format!(
            "the backup is of a {family} controller, {} is {}",
            robot.label(),
            robot.family
        ))
        .hint("name the robot that the backup is of"));
    }
    if force || robot.target.value.is_simulated() || *target == robot.target.value.url() {
        return Ok(());
    }
    Err(Failure::new(Kind::Rejected, format!("the backup is of {name} ({target}), not of {}", robot.label()))
        .hint("name the robot that the backup is of; --force takes it for this one all the same"))
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
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
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
        let mut file = match files::open(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return damaged("it is missing".to_owned()),
            file => file.with_context(|| path.display().to_string())?,
        };
        let mut hash = Hash::default();
        let mut buffer = vec![0; 1 << 16];
        loop {
            match file.read(&mut buffer) {
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                read => match read.with_context(|| path.display().to_string())? {
                    0 => break,
                    read => hash.take(buffer.get(..read).unwrap_or_default()),
                },
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

    fn manifest() -> Manifest {
        let sources = crate::settings::Sources {
            selection: crate::settings::Selection { sim: true, ..Default::default() },
            ..Default::default()
        };
        let robot = sources.robots(Some(Family::Yerc)).unwrap().remove(0);
        let mut manifest = Manifest::new(&robot, Value::Null, vec!["jbi".into()]);
        let copy = Saved { file: "A.JBI".into(), bytes: 3, sha256: "ab".into() };
        let error = Some(Reason { code: Some("0xE29C".into()), message: "no".into() });
        manifest.files = vec![
            Entry { name: "A.JBI".into(), name_hex: Some("41".into()), copy: Some(copy), ..Entry::default() },
            Entry { name: "B.JBI".into(), name_hex: Some("835c".into()), error, ..Entry::default() },
        ];
        manifest
    }

    #[test]
    fn a_list_is_read_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        assert!(read::<Value>(folder.path()).unwrap().is_none());
        assert_eq!(existing::<Value>(folder.path()).unwrap_err().kind, Kind::Local);
        let mut written = manifest();
        written.write(folder.path()).unwrap();
        assert_eq!(read::<Value>(folder.path()).unwrap().unwrap(), written);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(written.entry_of(b"\x83\x5c").unwrap().copy.is_none());
        assert!(written.entry("A.JBI").unwrap().copy.is_some());
    }

    #[test]
    fn a_list_that_was_tampered_with_is_no_list() {
        let spoil: [fn(&mut Manifest); 9] = [
            |m| m.files[0].copy.as_mut().unwrap().file = "../A.JBI".into(),
            |m| m.files[0].copy.as_mut().unwrap().file = MANIFEST.into(),
            |m| m.files[0].name_hex = Some("4".into()),
            |m| m.files[1].name_hex = m.files[0].name_hex.clone(),
            |m| m.files[1].copy = Some(Saved { file: "a.jbi".into(), ..Saved::default() }),
            |m| m.files[1].error = None,
            |m| (m.files[1].name_hex, m.files[1].name) = (None, "41".into()),
            |m| m.version = 2,
            |m| m.format = "else".into(),
        ];
        for spoil in spoil {
            let folder = tempfile::tempdir().unwrap();
            let mut spoilt = manifest();
            spoil(&mut spoilt);
            spoilt.write(folder.path()).unwrap();
            assert_eq!(read::<Value>(folder.path()).unwrap_err().kind, Kind::Local);
        }
    }

    #[test]
    fn only_an_empty_folder_or_a_backup_takes_a_backup() {
        let folder = tempfile::tempdir().unwrap();
        let look = || look::<Value>(folder.path());
        assert!(look().unwrap().is_none());
        fs::write(folder.path().join("letter.txt"), "x").unwrap();
        assert_eq!(look().unwrap_err().kind, Kind::Local);
        manifest().write(folder.path()).unwrap();
        assert!(look().unwrap().is_some());
    }

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
