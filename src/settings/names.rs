//! The names of a robot: those of its entry in the inventory, and those that were read from its controller and kept.
//!
//! What a controller says is kept in the state folder of the user, by the address of the controller: a file each, with
//! when it was read and the hashes of what was read. Another controller may have that address by now: names that were read
//! of one with other software are not used. A simulator of this process keeps nothing: its names are those that its files
//! begin with.

use std::fmt::Write as _;
use std::io::ErrorKind;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use jiff::Timestamp;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use super::model::ToldModels;
use super::target::{Address, Family};
use crate::controller::names::{Grammar, Name, Names, Source};
use crate::controller::text::Encoding;
use crate::controller::{toyo, yerc, yrcx};
use crate::failure::{Failure, plain};
use crate::files;

/// What a file of kept names begins with, so that another file is not taken for one.
const FORMAT: &str = "armctl-names";
const VERSION: u64 = 1;
/// A file of kept names has at most some thousand names.
const MOST: u64 = 32 << 20;

/// What the addresses of a family look like.
pub fn grammar(family: Family) -> Grammar {
    match family {
        Family::Yerc => yerc::names::GRAMMAR,
        Family::Yrcx => yrcx::names::GRAMMAR,
        Family::Toyo => toyo::names::GRAMMAR,
    }
}

/// The names of a robot, read when the first one is looked up.
#[derive(Debug, Clone, Default)]
pub struct RobotNames {
    own: Arc<[Name]>,
    kept: Option<Place>,
    models: Option<ToldModels>,
    is_simulated: bool,
    all: Arc<OnceLock<AllNames>>,
}

/// Two robots with the same entries have the same names, whatever was read of them by now.
impl PartialEq for RobotNames {
    fn eq(&self, other: &Self) -> bool {
        self.own == other.own && self.kept == other.kept && self.is_simulated == other.is_simulated
    }
}

/// All names of a robot, as far as they can be read.
#[derive(Debug, Clone, Default)]
pub struct AllNames {
    /// The names.
    pub names: Names,
    /// What was kept of its controller.
    pub kept: Option<Kept>,
    /// Why that could not be read.
    pub damage: Option<Failure>,
}

impl RobotNames {
    /// Those of an entry, and what is kept for an address.
    pub fn new(own: Arc<[Name]>, family: Family, address: &Address) -> Self {
        let is_yerc = family == Family::Yerc;
        let kept = if is_yerc { Place::of(address) } else { None };
        let models = kept.as_ref().and_then(|_| ToldModels::of_user());
        let is_simulated = is_yerc && *address == Address::Simulated;
        Self { own, kept, models, is_simulated, all: Arc::default() }
    }

    /// Where those of the controller are kept, if it is one whose names can be.
    pub fn place(&self) -> Option<&Place> {
        self.kept.as_ref()
    }

    /// What is kept, unless the controller has told of other software since.
    fn read(&self, place: &Place) -> Result<Option<Kept>, Failure> {
        let kept = place.read()?;
        let told = self.models.as_ref().and_then(|models| models.find_by_key(&place.address));
        if let (Some(kept), Some(told)) = (&kept, told) {
            kept.check(told.software())?;
        }
        Ok(kept)
    }

    /// All of them.
    pub fn all(&self) -> &AllNames {
        self.all.get_or_init(|| {
            let (kept, damage) = match self.kept.as_ref().map_or(Ok(None), |place| self.read(place)) {
                Ok(kept) => (kept, None),
                Err(failure) => (None, Some(failure)),
            };
            let of_controller = kept.iter().flat_map(Kept::names);
            let simulated = if self.is_simulated { simulated() } else { Vec::new() };
            let names = self.own.iter().cloned().chain(of_controller).chain(simulated);
            AllNames { names: Names::new(names.collect()), kept, damage }
        })
    }
}

/// What the files of a simulator begin with.
fn simulated() -> Vec<Name> {
    let files = yerc::simulator::name_files();
    let read = |(file, bytes): (&str, Vec<u8>)| yerc::names::read(file, &bytes, Encoding::ShiftJis);
    files.into_iter().filter_map(|file| read(file).ok()).flat_map(|found| found.names).collect()
}

/// The file of a controller.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    path: PathBuf,
    address: String,
}

/// Names that were read from a controller.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Kept {
    format: String,
    version: u64,
    /// The address they are of.
    address: String,
    /// When they were read.
    pub read_at: Timestamp,
    /// In which encoding.
    pub encoding: String,
    /// The system software of the controller then, if it told.
    #[serde(default)]
    software: Option<String>,
    /// The files they were in.
    pub files: Vec<KeptFile>,
    names: Vec<KeptName>,
}

/// A file of names.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct KeptFile {
    /// Its name on the controller.
    pub file: String,
    /// Its size.
    pub bytes: u64,
    /// Of its bytes.
    pub sha256: String,
    /// How many names it has.
    pub names: usize,
}

#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct KeptName {
    address: String,
    name: String,
    file: String,
}

impl KeptFile {
    /// Of its content.
    pub fn new(file: &str, bytes: &[u8], names: usize) -> Self {
        let sha256 = Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
            // Nothing fails when text is written to a string.
            let _ = write!(text, "{byte:02x}");
            text
        });
        Self { file: file.to_owned(), bytes: bytes.len() as u64, sha256, names }
    }
}

impl Kept {
    /// What was read just now, of a controller with this software.
    pub fn new(
        place: &Place,
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

    /// How many names there are.
    pub fn count(&self) -> usize {
        self.names.len()
    }

    /// Refuses names of a controller that had other software.
    pub fn check(&self, software: &str) -> Result<(), Failure> {
        match self.software.as_deref().filter(|then| *then != software) {
            None => Ok(()),
            Some(then) => Err(Failure::local(format!(
                "the names kept for this address are of a controller with software {then}; this one has {software}"
            ))
            .hint("`armctl yerc names get` reads those of this one, `armctl yerc names forget` removes the others")),
        }
    }

    /// The names; what is no address of the family is none.
    fn names(&self) -> impl Iterator<Item = Name> {
        self.names.iter().filter_map(|kept| {
            let (kind, address) = (yerc::names::GRAMMAR.address)(&kept.address)?;
            Some(Name { kind, address, name: kept.name.clone(), source: Source::File(kept.file.clone()) })
        })
    }
}

impl Place {
    /// For a controller on the network, where the user has a folder to keep things in.
    fn of(address: &Address) -> Option<Self> {
        let address = address.key()?;
        let plain = |c: char| if c.is_ascii_alphanumeric() || ".-".contains(c) { c } else { '_' };
        let name: String = address.chars().map(plain).take(100).collect();
        // Two addresses that are alike but for such characters.
        let mark = &KeptFile::new("", address.as_bytes(), 0).sha256[..8];
        let path = super::state_folder()?.join("names").join(format!("{name}-{mark}.json"));
        Some(Self { path, address })
    }

    /// What is kept; nothing where nothing was read yet.
    pub fn read(&self) -> Result<Option<Kept>, Failure> {
        let damaged = |why: String| {
            Failure::local(format!("the names kept in {} cannot be used: {why}", self.path.display()))
                .hint("`armctl yerc names get` reads them anew, `armctl yerc names forget` removes them")
        };
        let text = match files::text(&self.path, MOST) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(damaged(plain(&error))),
        };
        let kept: Kept = serde_json::from_str(&text).map_err(|error| damaged(error.to_string()))?;
        if kept.format != FORMAT || kept.version != VERSION || kept.address != self.address {
            return Err(damaged("it is another file".to_owned()));
        }
        Ok(Some(kept))
    }

    /// Keeps names instead of what was kept before.
    pub fn write(&self, kept: &Kept) -> Result<(), Failure> {
        let failed = |error: &std::io::Error| Failure::io(self.path.display(), error);
        let text = serde_json::to_vec(kept).map_err(|error| Failure::local(format!("names as JSON: {error}")))?;
        std::fs::create_dir_all(files::folder_of(&self.path)).map_err(|error| failed(&error))?;
        files::replace(&self.path, &text).map_err(|error| failed(&error))
    }

    /// Removes what is kept, and says whether there was something.
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
    use crate::controller::names::{Found, Kind};
    use crate::controller::yerc::Model;
    use crate::settings::model::ToldModel;
    use crate::settings::target::Target;

    #[test]
    fn what_is_kept_comes_back_and_what_is_damaged_says_so() {
        let folder = tempfile::tempdir().unwrap();
        let place = Place { path: folder.path().join("names").join("a.json"), address: "udp h 10040".to_owned() };
        assert_eq!(place.read().unwrap(), None);
        assert!(!place.forget().unwrap());
        let name = |address: &str, kind| Name {
            kind,
            address: address.to_owned(),
            name: "扉".to_owned(),
            source: Source::File("IONAME.DAT".to_owned()),
        };
        let names = [name("#00010", Kind::Signal), name("B5", Kind::Variable)];
        let kept = Kept::new(&place, Encoding::ShiftJis, None, (vec![KeptFile::new("IONAME.DAT", b"x", 2)], &names));
        place.write(&kept).unwrap();
        let read = place.read().unwrap().unwrap();
        assert_eq!(read, kept);
        assert_eq!(read.names().collect::<Vec<_>>(), names);
        let robot = RobotNames { kept: Some(place.clone()), ..RobotNames::default() };
        assert!(matches!(robot.all().names.find(&[Kind::Variable], "扉"), Found::One(found) if found.address == "B5"));
        std::fs::write(&place.path, "{}").unwrap();
        assert!(place.read().unwrap_err().hint.unwrap().contains("forget"));
        let robot = RobotNames { kept: Some(place.clone()), ..RobotNames::default() };
        assert!(robot.all().damage.is_some() && robot.all().names.is_empty());
        assert!(place.forget().unwrap());
    }

    #[test]
    fn names_of_another_controller_at_the_same_address_are_not_used() {
        let folder = tempfile::tempdir().unwrap();
        let address = "udp://192.0.2.1".parse::<Target>().unwrap().address();
        let place = Place { path: folder.path().join("a.json"), address: address.key().unwrap() };
        let models = ToldModels::at(folder.path().join("models.json"));
        let robot = || RobotNames { kept: Some(place.clone()), models: Some(models.clone()), ..RobotNames::default() };
        let software = "YAS2.80.00A(EN)-00".to_owned();
        place.write(&Kept::new(&place, Encoding::ShiftJis, Some(software.clone()), (Vec::new(), &[]))).unwrap();
        assert!(robot().all().damage.is_none(), "nobody knows better");
        models.keep(&address, ToldModel::now(Model::Yrc1000, software)).unwrap();
        assert!(robot().all().damage.is_none());
        models.keep(&address, ToldModel::now(Model::Dx200, "DN2.07.00A(EN)-00".to_owned())).unwrap();
        let damage = robot().all().damage.clone().unwrap();
        assert!(damage.message.contains("YAS2.80") && damage.message.contains("this one has DN2.07"), "{damage}");
    }

    #[test]
    fn a_simulator_has_the_names_of_its_files() {
        let robot = RobotNames::new(Arc::default(), Family::Yerc, &Address::Simulated);
        assert!(
            matches!(robot.all().names.find(&[Kind::Signal], "gripper"), Found::One(found) if found.address == "#10010")
        );
        let other = RobotNames::new(Arc::default(), Family::Toyo, &Address::Simulated);
        assert!(other.all().names.is_empty());
    }
}
