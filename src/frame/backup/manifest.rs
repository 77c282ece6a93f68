//! Manifest of a backup, common to all families: robot, files with size and hash, their content, and missing data.

use std::collections::HashSet;
use std::fs;
use std::io::{ErrorKind, Read as _};

use jiff::Timestamp;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Map;
use sha2::{Digest as _, Sha256};

use crate::local_names::{Target, is_plain_file_name};
use crate::output::escape;
use crate::prelude::basics::*;
use crate::settings::Origin;
use crate::settings::inventory::named;
pub use crate::settings::target::MANIFEST;
use crate::settings::target::MAX_MANIFEST;
use armctl_controller::names::Name;
use armctl_controller::text::{hex, unhex};

/// Format name, for programs that find the folder.
const FORMAT: &str = "armctl backup";
/// Incremented if older programs would misread a newer manifest.
const VERSION: u32 = 1;

/// Manifest of a backup; `C` describes the controller.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest<C = Value> {
    /// Format name, always the same.
    format: String,
    version: u32,
    /// Version of armctl that wrote the manifest.
    armctl: String,
    /// `yerc`, `yrcx` or `toyo`.
    pub family: String,
    /// Name of the robot.
    pub robot: String,
    /// URL of the robot.
    pub target: String,
    /// Settings of the robot's inventory entry, with the keys of `robots.toml`, and `default` if it is the default
    /// robot. Empty in a backup of an address, and in a backup of an older armctl.
    #[serde(skip_serializing_if = "Map::is_empty", default)]
    pub inventory: Map<String, Value>,
    /// Model and versions.
    pub controller: C,
    /// Selection, if the backup does not include everything: file types, number ranges, name patterns.
    pub scope: Vec<String>,
    /// Start of the backup.
    pub taken_at: Timestamp,
    /// Last change of the backup.
    updated_at: Timestamp,
    /// Whether all selected data is present.
    pub complete: bool,
    /// All entries requested so far.
    pub files: Vec<Entry>,
}

/// A file of the controller, or a part of its data.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Entry {
    /// Name on the controller, or name of the part: `TESTJOB.JBI`, `points-1`.
    pub name: String,
    /// Bytes of the name in hexadecimal, if names of the family have an encoding. They have priority over `name`.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub name_hex: Option<String>,
    /// Content: `jbi`, `program`, `points 0..999`.
    pub holds: String,
    /// Copy, if there is one.
    #[serde(flatten)]
    pub copy: Option<Saved>,
    /// Items that are not in the copy.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub left_out: Vec<LeftOut>,
    /// Reason why there is no copy.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub error: Option<Reason>,
}

/// An item that is not in a file, or not on a controller.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct LeftOut {
    /// Name of the item, for example `P05` or `T2.7`.
    pub key: String,
    /// Reason.
    pub why: String,
}

/// Family-specific controller data of a manifest.
pub trait About: Serialize + DeserializeOwned {
    /// Family; `None` for any family.
    const FAMILY: Option<Family>;

    /// Validates the controller data.
    fn check(&self) -> Result<(), String> {
        Ok(())
    }

    /// Validates an entry.
    fn check_entry(_entry: &Entry) -> Result<(), String> {
        Ok(())
    }
}

impl About for Value {
    const FAMILY: Option<Family> = None;
}

impl<C: About> Manifest<C> {
    /// Names in the settings of the inventory entry. Names that are not valid any more are left out.
    pub fn names(&self) -> Vec<Name> {
        let (Some(family), Some(Value::Object(names))) = (C::FAMILY, self.inventory.get("names")) else {
            return Vec::new();
        };
        let name = |(name, address): (&String, &Value)| named(family, name, address.as_str()?).ok();
        names.iter().filter_map(name).collect()
    }

    /// Manifest of a new backup.
    pub fn new(robot: &Robot, controller: C, scope: Vec<String>) -> Self {
        let now = Timestamp::now();
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            armctl: env!("CARGO_PKG_VERSION").to_owned(),
            family: robot.family.name().to_owned(),
            robot: robot.name.clone(),
            target: robot.target.value.url().to_owned(),
            inventory: inventory_settings(robot),
            controller,
            scope,
            taken_at: now,
            updated_at: now,
            complete: false,
            files: Vec::new(),
        }
    }

    /// Writes the manifest to `folder` atomically.
    pub fn write(&mut self, folder: &Path) -> Result<()> {
        self.updated_at = Timestamp::now();
        let mut text = escape::json_pretty(self).map_err(|error| Failure::local(format!("{MANIFEST}: {error}")))?;
        text.push('\n');
        let mut draft = Target::new(folder.join(MANIFEST), true)?.begin()?;
        draft.write(text.as_bytes())?;
        draft.commit()
    }

    /// Entry for a name.
    pub fn entry(&self, name: &str) -> Option<&Entry> {
        self.files.iter().find(|entry| entry.name == name)
    }

    /// Entry for a name in bytes.
    pub fn entry_of(&self, name: &[u8]) -> Option<&Entry> {
        let digits = hex(name);
        self.files.iter().find(|entry| entry.name_hex.as_ref().is_some_and(|own| own.eq_ignore_ascii_case(&digits)))
    }

    fn check(&self) -> Result<(), String> {
        if let Some(family) = C::FAMILY
            && family.name() != self.family
        {
            return Err(format!("the family is {}, not {}", self.family, family.name()));
        }
        let (mut names, mut copies) = (HashSet::new(), HashSet::new());
        for entry in &self.files {
            let Entry { name, name_hex, copy, error, .. } = entry;
            if name_hex.as_ref().is_some_and(|digits| unhex(digits).is_none()) {
                return Err(format!("the name_hex of '{name}' is not a valid name"));
            }
            if !names.insert(name_hex.as_ref().unwrap_or(name).to_lowercase()) {
                return Err(format!("'{name}' is listed twice"));
            }
            match copy {
                Some(copy) if !is_plain_file_name(&copy.file) || copy.file == MANIFEST => {
                    return Err(format!("'{}' is not a file of a backup in this folder", copy.file));
                }
                Some(copy) if !copies.insert(copy.file.to_lowercase()) => {
                    return Err(format!("'{}' is used for two names", copy.file));
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

/// Key in the settings of the inventory entry: whether the robot is the default robot.
pub const DEFAULT: &str = "default";

/// Settings of the inventory entry that describe the robot and protect it. The settings of its connection are not
/// among them.
fn inventory_settings(robot: &Robot) -> Map<String, Value> {
    let mut settings = Map::new();
    if robot.target.origin != Origin::Robot {
        return settings;
    }
    let mut set = |key: &str, is_set: bool, value: Value| {
        if is_set {
            settings.insert(key.to_owned(), value);
        }
    };
    set(DEFAULT, robot.is_default, json!(true));
    set("tags", !robot.tags.is_empty(), json!(robot.tags));
    for (key, value) in robot.place.levels() {
        set(key, value.is_some(), json!(value));
    }
    let names = robot.names.entry_names();
    let names: Map<_, _> = names.iter().map(|name| (name.name.clone(), json!(name.address))).collect();
    set("names", !names.is_empty(), names.into());
    set("read_only", robot.read_only.value, json!(true));
    set("hold", robot.hold.value, json!(true));
    set("encoding", robot.encoding.origin != Origin::BuiltIn, json!(robot.encoding.value.to_string()));
    set("pulses_per_degree", !robot.pulses_per_degree.is_empty(), json!(robot.pulses_per_degree));
    settings
}

/// Reads the manifest in `folder`; `None` if there is none.
pub fn read<C: About>(folder: &Path) -> Result<Option<Manifest<C>>> {
    /// Common first fields of every manifest.
    #[derive(Deserialize)]
    struct Head {
        format: String,
        version: u32,
        #[serde(default)]
        family: Option<String>,
    }

    let path = folder.join(MANIFEST);
    let text = match files::text(&path, MAX_MANIFEST) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        text => text.with_context(|| path.display().to_string())?,
    };
    let invalid = |why: String| {
        Failure::local(format!("{}: {why}", path.display()))
            .hint("create a new backup, because the manifest is damaged")
    };
    match serde_json::from_str(&text).map_err(|error| invalid(error.to_string()))? {
        Head { format, .. } if format != FORMAT => {
            return Err(invalid(format!("the format is '{format}', not '{FORMAT}'")));
        }
        Head { version, .. } if version > VERSION => {
            return Err(invalid(format!("the version is {version}; this armctl supports up to {VERSION}")));
        }
        Head { family: Some(family), .. } if C::FAMILY.is_some_and(|own| own.name() != family) => {
            let own = C::FAMILY.map_or("this", Family::name);
            let message =
                format!("{} is a backup of a {family} controller, not of a {own} controller", folder.display());
            return Err(Failure::usage(message).hint(format!("use a backup of a {own} controller")));
        }
        Head { .. } => {}
    }
    let list: Manifest<C> = serde_json::from_str(&text).map_err(|error| invalid(error.to_string()))?;
    list.check().map_err(invalid)?;
    Ok(Some(list))
}

/// Reads the manifest in `folder`, which must exist.
pub fn open_existing<C: About>(folder: &Path) -> Result<Manifest<C>> {
    read(folder)?.ok_or_else(|| {
        let shown = folder.display();
        let failure = Failure::local(if folder.exists() {
            format!("{shown} contains no {MANIFEST}")
        } else {
            format!("there is no folder {shown}")
        });
        failure.hint(subfolder_hint::<C>(folder, "use the folder of a backup; create one with `armctl backup`"))
    })
}

/// Hint to use a subfolder of a fleet backup, one of the family if there is one, or another hint.
pub fn subfolder_hint<C: About>(folder: &Path, otherwise: &str) -> String {
    let folders = folders_in(folder);
    let has_family = |one: &&PathBuf| read::<C>(one).is_ok();
    match folders.iter().find(has_family).or(folders.first()) {
        Some(one) => format!("select a subfolder, such as {}: the backups are in the subfolders", one.display()),
        None => otherwise.to_owned(),
    }
}

/// Backup subfolders of a folder, one per robot.
pub fn folders_in(folder: &Path) -> Vec<PathBuf> {
    folders_with(folder, &[MANIFEST])
}

/// Subfolders of a folder that contain at least one of these files.
pub fn folders_with(folder: &Path, files: &[&str]) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_there = |path: &PathBuf| files.iter().any(|file| path.join(file).exists());
    let mut found: Vec<PathBuf> = entries.filter(is_there).collect();
    found.sort();
    found
}

/// Reads the existing backup in a target folder, if any. Other files must not be mixed with a backup.
pub fn inspect_folder<C: About>(folder: &Path) -> Result<Option<Manifest<C>>> {
    // Leftovers of a killed backup.
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
        Some(_) => {
            Err(Failure::local(format!("{} contains other files", folder.display()))
                .hint("use an empty or a new folder"))
        }
    }
}

/// Earlier backup in a folder, if there is one that the new backup continues. With `resume`, the earlier backup must
/// have the same target and scope. `scope` is the new selection; `None` if the user gave none. With `force`, the new
/// backup replaces the earlier backup.
pub fn find_earlier_backup<C: About>(
    folder: &Path,
    robot: &Robot,
    scope: Option<&[String]>,
    resume: bool,
    force: bool,
) -> Result<Option<Manifest<C>>> {
    let Some(earlier) = inspect_folder::<Value>(folder)?.filter(|_| !force) else { return Ok(None) };
    let name = &earlier.robot;
    if !resume {
        let state = if earlier.complete { "a backup" } else { "an incomplete backup" };
        return Err(Failure::local(format!("{} contains {state} of {name}", folder.display()))
            .hint("add --resume to continue the backup or --force to replace it, or use another folder"));
    }
    if earlier.target != robot.target.value.url() || earlier.family != robot.family.name() {
        return Err(Failure::usage(format!("{} is a backup of {name} ({})", folder.display(), earlier.target))
            .hint("use another folder for this robot"));
    }
    if scope.is_some_and(|scope| scope != earlier.scope) {
        let asked = if earlier.scope.is_empty() { "everything".to_owned() } else { earlier.scope.join(", ") };
        return Err(Failure::usage(format!(
            "{} is a backup of {asked}, but this command selects other data",
            folder.display()
        ))
        .hint("use only --resume to continue the earlier selection, or use another folder"));
    }
    read(folder)
}

/// Checks whether a backup may be written to this robot: to the same robot or to a simulator, unless `force` is set.
pub fn check_origin(manifest: &Manifest, robot: &Robot, force: bool) -> Result<()> {
    let Manifest { family, robot: name, target, .. } = manifest;
    if *family != robot.family.name() {
        return Err(Failure::usage(format!(
            "the backup is from a {family} controller, but {} is a {} controller",
            robot.label(),
            robot.family
        ))
        .hint("select the robot of the backup"));
    }
    if force || robot.target.value.is_simulated() || *target == robot.target.value.url() {
        return Ok(());
    }
    Err(Failure::new(Kind::Rejected, format!("the backup is from {name} ({target}), not from {}", robot.label()))
        .hint("select the robot of the backup, or add --force to use this robot anyway"))
}

/// A file in the folder.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Saved {
    /// Name in the folder.
    pub file: String,
    /// Size of the file.
    pub bytes: u64,
    /// SHA-256 of the file in hexadecimal.
    pub sha256: String,
}

/// Reason why a file is missing.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Reason {
    /// Error code of the controller.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub code: Option<String>,
    /// Message.
    pub message: String,
}

impl From<&Failure> for Reason {
    fn from(failure: &Failure) -> Self {
        Self { code: failure.code.clone(), message: failure.message.clone() }
    }
}

impl Saved {
    /// Checks that the file in `folder` is unchanged since the backup.
    pub fn check(&self, folder: &Path) -> Result<()> {
        let path = folder.join(&self.file);
        let damaged = |why: String| {
            Err(Failure::local(format!("{}: {why}", path.display()))
                .hint("use another copy of the backup, or exclude the file; the file has changed since the backup"))
        };
        let mut file = match files::open(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return damaged("file missing".to_owned()),
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
            return damaged(format!("{} bytes instead of {}", hash.bytes, self.bytes));
        }
        if !hash.hex().eq_ignore_ascii_case(&self.sha256) {
            return damaged("content changed (SHA-256)".to_owned());
        }
        Ok(())
    }
}

/// Size and SHA-256 of a stream.
#[derive(Debug, Default)]
pub struct Hash {
    sha256: Sha256,
    /// Number of bytes so far.
    pub bytes: u64,
}

impl Hash {
    /// Hash of a text.
    pub fn of(bytes: &[u8]) -> Self {
        let mut hash = Self::default();
        hash.take(bytes);
        hash
    }

    /// Adds bytes.
    pub fn take(&mut self, bytes: &[u8]) {
        self.sha256.update(bytes);
        self.bytes = self.bytes.saturating_add(bytes.len() as u64);
    }

    /// Hash in lower-case hexadecimal.
    pub fn hex(self) -> String {
        hex(&self.sha256.finalize())
    }

    /// Manifest data of a file with this content.
    pub fn saved(self, file: String) -> Saved {
        Saved { file, bytes: self.bytes, sha256: self.hex() }
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
    fn reads_a_manifest_as_written() {
        let folder = tempfile::tempdir().unwrap();
        assert!(read::<Value>(folder.path()).unwrap().is_none());
        assert_eq!(open_existing::<Value>(folder.path()).unwrap_err().kind, Kind::Local);
        let mut written = manifest();
        written.write(folder.path()).unwrap();
        assert_eq!(read::<Value>(folder.path()).unwrap().unwrap(), written);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(written.entry_of(b"\x83\x5c").unwrap().copy.is_none());
        assert!(written.entry("A.JBI").unwrap().copy.is_some());
    }

    #[test]
    fn rejects_a_changed_manifest() {
        let corrupt: [fn(&mut Manifest); 9] = [
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
        for spoil in corrupt {
            let folder = tempfile::tempdir().unwrap();
            let mut corrupted = manifest();
            spoil(&mut corrupted);
            corrupted.write(folder.path()).unwrap();
            assert_eq!(read::<Value>(folder.path()).unwrap_err().kind, Kind::Local);
        }
    }

    #[test]
    fn saves_only_into_an_empty_folder_or_a_backup() {
        let folder = tempfile::tempdir().unwrap();
        let look = || inspect_folder::<Value>(folder.path());
        assert!(look().unwrap().is_none());
        fs::write(folder.path().join("letter.txt"), "x").unwrap();
        assert_eq!(look().unwrap_err().kind, Kind::Local);
        manifest().write(folder.path()).unwrap();
        assert!(look().unwrap().is_some());
    }

    #[test]
    fn finds_a_changed_copy() {
        let folder = tempfile::tempdir().unwrap();
        let copy = Saved {
            file: "A.JBI".into(),
            bytes: 3,
            sha256: "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad".into(),
        };
        let path = folder.path().join("A.JBI");
        let problem = || copy.check(folder.path()).unwrap_err().message;
        assert!(problem().ends_with("file missing"));
        fs::write(&path, "abd").unwrap();
        assert!(problem().ends_with("(SHA-256)"));
        fs::write(&path, "abcd").unwrap();
        assert!(problem().ends_with("4 bytes instead of 3"));
        fs::write(&path, "abc").unwrap();
        copy.check(folder.path()).unwrap();
    }
}
