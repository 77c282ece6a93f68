//! Controller model in the settings, and a cache of the models that controllers reported.
//!
//! If the settings contain no model, armctl reads the software version of the controller once. The answer is cached by
//! address in the state folder of the user. No file that the user wrote is changed. Without the cache, armctl reads the
//! version again.

use std::collections::BTreeMap;
use std::fmt;
use std::io;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use super::state_folder;
use super::target::Address;
use armctl_controller::yerc::Model;
use armctl_files as files;

/// Model setting.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ModelSetting {
    /// Read the model from the controller.
    #[default]
    Auto,
    /// Use this model.
    Is(Model),
}

impl ModelSetting {
    /// Text of the setting [`Self::Auto`].
    pub const AUTO: &str = "auto";

    /// The model, if the setting contains one.
    pub const fn named(self) -> Option<Model> {
        match self {
            Self::Auto => None,
            Self::Is(model) => Some(model),
        }
    }
}

impl fmt::Display for ModelSetting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.named().map_or(Self::AUTO, Model::name))
    }
}

impl FromStr for ModelSetting {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.eq_ignore_ascii_case(Self::AUTO) {
            return Ok(Self::Auto);
        }
        text.parse().map(Self::Is).map_err(|error: String| error.replace("known: ", "known: auto, "))
    }
}

/// Model that a controller reported, with the time of the report.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ReportedModel {
    #[serde(with = "by_name")]
    model: Model,
    software: String,
    /// When the controller reported the model, in seconds since 1970.
    at: u64,
}

/// Time for which a cached answer is valid.
const VALIDITY: Duration = Duration::from_secs(24 * 3600);
/// Age at which an answer is removed from the cache file.
const RETENTION: Duration = Duration::from_secs(90 * 24 * 3600);
/// Size limit of the cache file.
const SIZE_LIMIT: u64 = 1 << 20;

impl ReportedModel {
    /// Creates an answer with the current time.
    pub fn now(model: Model, software: String) -> Self {
        Self { model, software, at: now() }
    }

    /// The model.
    pub const fn model(&self) -> Model {
        self.model
    }

    /// Version of the system software.
    pub fn software(&self) -> &str {
        &self.software
    }

    /// Whether model and software of both answers are equal.
    pub fn is_same_as(&self, other: &Self) -> bool {
        (self.model, &self.software) == (other.model, &other.software)
    }

    /// Time since the controller reported the model.
    pub fn age(&self) -> Duration {
        Duration::from_secs(now().saturating_sub(self.at))
    }

    /// Whether the answer is still valid. An answer with a time in the future is not valid; the clock was changed then.
    pub fn is_fresh(&self) -> bool {
        self.at <= now() && self.age() < VALIDITY
    }
}

/// Cache of models, by address.
#[derive(Debug, Clone)]
pub struct ModelCache {
    path: PathBuf,
}

impl ModelCache {
    /// Returns the cache of this user; `None` without a home folder.
    pub fn of_user() -> Option<Self> {
        state_folder().map(|folder| Self { path: folder.join("models.json") })
    }

    /// Returns the cache in this file.
    #[cfg(test)]
    pub fn at(path: PathBuf) -> Self {
        Self { path }
    }

    /// Returns the last answer of the controller at an address.
    pub fn find(&self, address: &Address) -> Option<ReportedModel> {
        self.find_by_key(&address.key()?)
    }

    /// Returns the last answer for the key of an address.
    pub fn find_by_key(&self, key: &str) -> Option<ReportedModel> {
        self.read().remove(key)
    }

    /// Stores an answer.
    pub fn store(&self, address: &Address, told: ReportedModel) -> io::Result<()> {
        let Some(key) = address.key() else { return Ok(()) };
        std::fs::create_dir_all(files::folder_of(&self.path))?;
        let _turn = files::lock_file(&self.path)?;
        let mut all = self.read();
        all.retain(|_, told| told.age() < RETENTION);
        all.insert(key, told);
        self.write(&all)
    }

    /// Removes an answer.
    pub fn forget(&self, address: &Address) -> io::Result<()> {
        let Some(key) = address.key() else { return Ok(()) };
        let _turn = files::lock_file(&self.path)?;
        let mut all = self.read();
        if all.remove(&key).is_some() { self.write(&all) } else { Ok(()) }
    }

    fn write(&self, all: &BTreeMap<String, ReportedModel>) -> io::Result<()> {
        files::replace(&self.path, serde_json::to_string_pretty(all)?.as_bytes())
    }

    /// Reads all answers. The result is empty if the file is missing or not valid.
    fn read(&self) -> BTreeMap<String, ReportedModel> {
        let text = files::text(&self.path, SIZE_LIMIT).unwrap_or_default();
        serde_json::from_str(&text).unwrap_or_default()
    }
}

fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs())
}

/// Serialization of a model by name.
mod by_name {
    use serde::{Deserialize as _, Deserializer, Serializer, de};

    use super::Model;

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands references")]
    pub fn serialize<S: Serializer>(model: &Model, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(model.name())
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Model, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::target::Target;

    fn address(url: &str) -> Address {
        url.parse::<Target>().unwrap().address()
    }

    #[test]
    fn caches_models_by_address() {
        let folder = tempfile::tempdir().unwrap();
        let store = ModelCache::at(folder.path().join("new").join("models.json"));
        let [one, other] = ["udp://192.0.2.1", "udp://192.0.2.2"].map(address);
        assert_eq!(store.find(&one), None);
        let told = ReportedModel::now(Model::Yrc1000, "YAS2.02".to_owned());
        store.store(&one, told.clone()).unwrap();
        assert_eq!(store.find(&address("udp://192.0.2.1:10040?model=auto")), Some(told.clone()));
        assert!(told.is_fresh());
        assert_eq!(store.find(&other), None);
        store.store(&other, ReportedModel { at: 1, ..told.clone() }).unwrap();
        assert!(!store.find(&other).unwrap().is_fresh());
        store.store(&one, ReportedModel { at: u64::MAX, ..told.clone() }).unwrap();
        assert!(!store.find(&one).unwrap().is_fresh(), "a clock that went back");
        assert_eq!(store.find(&other), None, "too old to be kept any longer");
    }

    #[test]
    fn ignores_a_damaged_file() {
        let folder = tempfile::tempdir().unwrap();
        let store = ModelCache::at(folder.path().join("models.json"));
        let one = address("udp://192.0.2.1");
        for text in ["", "{", "[]", "{\"udp 192.0.2.1 10040\": {\"model\": \"x\", \"software\": \"\", \"at\": 1}}"] {
            std::fs::write(&store.path, text).unwrap();
            assert_eq!(store.find(&one), None, "{text}");
        }
        store.store(&one, ReportedModel::now(Model::Dx100, String::new())).unwrap();
        assert_eq!(store.find(&one).map(|told| told.model()), Some(Model::Dx100));
    }

    #[test]
    fn parses_model_settings() {
        assert_eq!("auto".parse(), Ok(ModelSetting::Auto));
        assert_eq!("YRC1000".parse(), Ok(ModelSetting::Is(Model::Yrc1000)));
        let error = "xrc".parse::<ModelSetting>().unwrap_err();
        assert_eq!(error, "unknown model 'xrc'; known: auto, fs100, dx100, dx200 and yrc1000");
        assert_eq!(ModelSetting::Is(Model::Fs100).to_string(), "fs100");
    }
}
