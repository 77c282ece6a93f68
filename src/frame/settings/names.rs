//! Names of a robot: from its inventory entry, and from files that armctl read from the controller.
//!
//! Names from a controller are cached in the state folder of the user. There is one cache file per controller address.
//! It contains the time and the hashes of the controller's files. If the controller at the address now has other
//! software, the cached names are not used. A simulator has no cache; its names are built in.

use std::fmt::Write as _;
use std::io::ErrorKind;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use jiff::Timestamp;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use super::model::ModelCache;
use super::target::{Address, Family};
use crate::failure::{Failure, plain};
use armctl_controller::names::{Grammar, Name, Names, Source};
use armctl_controller::text::Encoding;
use armctl_controller::{toyo, yerc, yrcx};
use armctl_files as files;

/// Value of the format field in a cache file. Other files do not have this value.
const FORMAT: &str = "armctl-names";
const VERSION: u64 = 1;
/// Size limit of a cache file.
const SIZE_LIMIT: u64 = 32 << 20;

/// Returns the grammar of addresses in a family.
pub fn grammar(family: Family) -> Grammar {
    match family {
        Family::Yerc => yerc::names::GRAMMAR,
        Family::Yrcx => yrcx::names::GRAMMAR,
        Family::Toyo => toyo::names::GRAMMAR,
    }
}

/// Names of a robot. They are read at the first lookup.
#[derive(Debug, Clone, Default)]
pub struct RobotNames {
    entry_names: Arc<[Name]>,
    cache: Option<CacheFile>,
    models: Option<ModelCache>,
    is_simulated: bool,
    all: Arc<OnceLock<AllNames>>,
}

/// The names of robots with the same entries are equal, whatever the cache contains.
impl PartialEq for RobotNames {
    fn eq(&self, other: &Self) -> bool {
        self.entry_names == other.entry_names && self.cache == other.cache && self.is_simulated == other.is_simulated
    }
}

/// All names of a robot.
#[derive(Debug, Clone, Default)]
pub struct AllNames {
    /// Names from all sources.
    pub names: Names,
    /// Cached names of the robot's controller.
    pub kept: Option<CachedNames>,
    /// Error of the cache file, if it could not be read.
    pub damage: Option<Failure>,
}

impl RobotNames {
    /// Creates the names from an entry, with the cache for an address.
    pub fn new(entry_names: Arc<[Name]>, family: Family, address: &Address) -> Self {
        let is_yerc = family == Family::Yerc;
        let cache = if is_yerc { CacheFile::of(address) } else { None };
        let models = cache.as_ref().and_then(|_| ModelCache::of_user());
        let is_simulated = is_yerc && *address == Address::Simulated;
        Self { entry_names, cache, models, is_simulated, all: Arc::default() }
    }

    /// Names from the inventory entry of the robot.
    pub fn entry_names(&self) -> &[Name] {
        &self.entry_names
    }

    /// Location of the cache; `None` for controllers that have no names.
    pub fn cache_file(&self) -> Option<&CacheFile> {
        self.cache.as_ref()
    }

    /// Reads the cache. The result is an error if the controller has reported other software in the meantime.
    fn read(&self, place: &CacheFile) -> Result<Option<CachedNames>, Failure> {
        let cached = place.read()?;
        let told = self.models.as_ref().and_then(|models| models.find_by_key(&place.address));
        if let (Some(kept), Some(told)) = (&cached, told) {
            kept.check(told.software())?;
        }
        Ok(cached)
    }

    /// All names.
    pub fn all(&self) -> &AllNames {
        self.all.get_or_init(|| {
            let (kept, damage) = match self.cache.as_ref().map_or(Ok(None), |place| self.read(place)) {
                Ok(kept) => (kept, None),
                Err(failure) => (None, Some(failure)),
            };
            let of_controller = kept.iter().flat_map(CachedNames::names);
            let simulated = if self.is_simulated { simulated() } else { Vec::new() };
            let names = self.entry_names.iter().cloned().chain(of_controller).chain(simulated);
            AllNames { names: Names::new(names.collect()), kept, damage }
        })
    }
}

/// Returns the built-in names of a simulator.
fn simulated() -> Vec<Name> {
    let files = yerc::simulator::name_files();
    let read = |(file, bytes): (&str, Vec<u8>)| yerc::names::read(file, &bytes, Encoding::ShiftJis);
    files.into_iter().filter_map(|file| read(file).ok()).flat_map(|found| found.names).collect()
}

/// Path of the cache file of a controller.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CacheFile {
    path: PathBuf,
    address: String,
}

/// Cached names of a controller.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CachedNames {
    format: String,
    version: u64,
    /// Address of the controller.
    address: String,
    /// Time when the names were read.
    pub read_at: Timestamp,
    /// Encoding of the files.
    pub encoding: String,
    /// System software of the controller at that time, if the controller reported it.
    #[serde(default)]
    software: Option<String>,
    /// Files that contain the names.
    pub files: Vec<KeptFile>,
    names: Vec<KeptName>,
}

/// A file of the controller that contains names.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct KeptFile {
    /// Name of the file on the controller.
    pub file: String,
    /// Size of the file in bytes.
    pub bytes: u64,
    /// SHA-256 of the file content.
    pub sha256: String,
    /// Number of names in the file.
    pub names: usize,
}

#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct KeptName {
    address: String,
    name: String,
    file: String,
}

impl KeptFile {
    /// Creates the record of a file.
    pub fn new(file: &str, bytes: &[u8], names: usize) -> Self {
        let sha256 = Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
            // Writing to a string cannot fail.
            let _ = write!(text, "{byte:02x}");
            text
        });
        Self { file: file.to_owned(), bytes: bytes.len() as u64, sha256, names }
    }
}

impl CachedNames {
    /// Creates a cache with names that were just read from a controller with this software.
    pub fn new(
        place: &CacheFile,
        encoding: Encoding,
        software: Option<String>,
        (files, names): (Vec<KeptFile>, &[Name]),
    ) -> Self {
        let now = Timestamp::now();
        let kept = |name: &Name| KeptName {
            address: name.address.clone(),
            name: name.name.clone(),
            file: name.source.to_string(),
        };
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            address: place.address.clone(),
            read_at: now.round(jiff::Unit::Second).unwrap_or(now),
            encoding: encoding.label().to_owned(),
            software,
            files,
            names: names.iter().map(kept).collect(),
        }
    }

    /// Number of names.
    pub fn count(&self) -> usize {
        self.names.len()
    }

    /// Returns an error if the names were read from a controller with other software.
    pub fn check(&self, software: &str) -> Result<(), Failure> {
        match self.software.as_deref().filter(|then| *then != software) {
            None => Ok(()),
            Some(then) => Err(Failure::local(format!(
                "the stored names for this address are from a controller with software {then}; this controller has \
                 software {software}"
            ))
            .hint(
                "read the names of this controller with `armctl yerc names get`, or delete the stored names with \
                 `armctl yerc names forget`",
            )),
        }
    }

    /// Returns the names. Names with an invalid address are skipped.
    fn names(&self) -> impl Iterator<Item = Name> {
        self.names.iter().filter_map(|kept| {
            let (kind, address) = (yerc::names::GRAMMAR.address)(&kept.address)?;
            Some(Name { kind, address, name: kept.name.clone(), source: Source::File(kept.file.clone()) })
        })
    }
}

impl CacheFile {
    /// Returns the location for a controller on the network; `None` if the user has no state folder.
    fn of(address: &Address) -> Option<Self> {
        let address = address.key()?;
        let plain = |c: char| if c.is_ascii_alphanumeric() || ".-".contains(c) { c } else { '_' };
        let name: String = address.chars().map(plain).take(100).collect();
        // The digest makes the file name unique: different addresses can have the same text after characters are
        // replaced.
        let digest = &KeptFile::new("", address.as_bytes(), 0).sha256[..8];
        let path = super::state_folder()?.join("names").join(format!("{name}-{digest}.json"));
        Some(Self { path, address })
    }

    /// Reads the cache; `None` if the file does not exist.
    pub fn read(&self) -> Result<Option<CachedNames>, Failure> {
        let damaged = |why: String| {
            Failure::local(format!("the stored names in {} cannot be used: {why}", self.path.display())).hint(
                "read the names again with `armctl yerc names get`, or delete them with `armctl yerc names forget`",
            )
        };
        let text = match files::text(&self.path, SIZE_LIMIT) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(damaged(plain(&error))),
        };
        let kept: CachedNames = serde_json::from_str(&text).map_err(|error| damaged(error.to_string()))?;
        if kept.format != FORMAT || kept.version != VERSION || kept.address != self.address {
            return Err(damaged("the file belongs to another controller".to_owned()));
        }
        Ok(Some(kept))
    }

    /// Replaces the cache file.
    pub fn write(&self, kept: &CachedNames) -> Result<(), Failure> {
        let failed = |error: &std::io::Error| Failure::io(self.path.display(), error);
        let text = serde_json::to_vec(kept)
            .map_err(|error| Failure::local(format!("cannot write the names as JSON: {error}")))?;
        std::fs::create_dir_all(files::folder_of(&self.path)).map_err(|error| failed(&error))?;
        files::replace(&self.path, &text).map_err(|error| failed(&error))
    }

    /// Removes the cache file. Returns whether it existed.
    pub fn forget(&self) -> Result<bool, Failure> {
        match std::fs::remove_file(&self.path) {
            Ok(()) => Ok(true),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
            Err(error) => Err(Failure::io(self.path.display(), &error)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::model::ReportedModel;
    use crate::settings::target::Target;
    use armctl_controller::names::{Kind, NameMatch};
    use armctl_controller::yerc::Model;

    #[test]
    fn reads_stored_names_and_reports_damage() {
        let folder = tempfile::tempdir().unwrap();
        let place = CacheFile { path: folder.path().join("names").join("a.json"), address: "udp h 10040".to_owned() };
        assert_eq!(place.read().unwrap(), None);
        assert!(!place.forget().unwrap());
        let name = |address: &str, kind| Name {
            kind,
            address: address.to_owned(),
            name: "扉".to_owned(),
            source: Source::File("IONAME.DAT".to_owned()),
        };
        let names = [name("#00010", Kind::Signal), name("B5", Kind::Variable)];
        let kept =
            CachedNames::new(&place, Encoding::ShiftJis, None, (vec![KeptFile::new("IONAME.DAT", b"x", 2)], &names));
        place.write(&kept).unwrap();
        let read = place.read().unwrap().unwrap();
        assert_eq!(read, kept);
        assert_eq!(read.names().collect::<Vec<_>>(), names);
        let robot = RobotNames { cache: Some(place.clone()), ..RobotNames::default() };
        assert!(
            matches!(robot.all().names.find(&[Kind::Variable], "扉"), NameMatch::One(found) if found.address == "B5")
        );
        std::fs::write(&place.path, "{}").unwrap();
        assert!(place.read().unwrap_err().hint.unwrap().contains("forget"));
        let robot = RobotNames { cache: Some(place.clone()), ..RobotNames::default() };
        assert!(robot.all().damage.is_some() && robot.all().names.is_empty());
        assert!(place.forget().unwrap());
    }

    #[test]
    fn ignores_names_of_another_controller_at_the_same_address() {
        let folder = tempfile::tempdir().unwrap();
        let address = "udp://192.0.2.1".parse::<Target>().unwrap().address();
        let place = CacheFile { path: folder.path().join("a.json"), address: address.key().unwrap() };
        let models = ModelCache::at(folder.path().join("models.json"));
        let robot = || RobotNames { cache: Some(place.clone()), models: Some(models.clone()), ..RobotNames::default() };
        let software = "YAS2.80.00A(EN)-00".to_owned();
        place.write(&CachedNames::new(&place, Encoding::ShiftJis, Some(software.clone()), (Vec::new(), &[]))).unwrap();
        assert!(robot().all().damage.is_none(), "nobody knows better");
        models.store(&address, ReportedModel::now(Model::Yrc1000, software)).unwrap();
        assert!(robot().all().damage.is_none());
        models.store(&address, ReportedModel::now(Model::Dx200, "DN2.07.00A(EN)-00".to_owned())).unwrap();
        let damage = robot().all().damage.clone().unwrap();
        assert!(
            damage.message.contains("YAS2.80") && damage.message.contains("this controller has software DN2.07"),
            "{damage}"
        );
    }

    #[test]
    fn simulator_has_the_names_of_its_files() {
        let robot = RobotNames::new(Arc::default(), Family::Yerc, &Address::Simulated);
        assert!(
            matches!(robot.all().names.find(&[Kind::Signal], "gripper"), NameMatch::One(found) if found.address == "#10010")
        );
        let other = RobotNames::new(Arc::default(), Family::Toyo, &Address::Simulated);
        assert!(other.all().names.is_empty());
    }
}
