//! Manifest entries of a Yaskawa backup.

use serde::Deserialize;

use super::name::exact;
use crate::prelude::*;
use armctl_controller::text::unhex;
use armctl_controller::yerc::query::{ReadSystemInfo, SystemPart};
use armctl_frame::backup::manifest;
use armctl_frame::backup::manifest::{About, Entry};

/// Manifest of a backup.
pub type Manifest = manifest::Manifest<Controller>;

/// Controller that a backup comes from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Controller {
    /// `fs100`, `dx100`, `dx200` or `yrc1000`.
    pub model: String,
    /// Version of the system software; null if the controller refused to report it.
    pub software: Option<String>,
    /// Model of robot R1; null if the controller refused to report it.
    pub robot_model: Option<String>,
    /// Encoding of the file names as text.
    pub encoding: String,
}

impl Controller {
    /// Reads the description from the controller.
    pub async fn ask(link: &mut Link) -> Result<Self> {
        let question = Self::question()?;
        let info = match link.ask(&question).await {
            Ok(info) => Some(info),
            Err(failure) if failure.kind == Kind::Refused => None,
            Err(failure) => return Err(failure),
        };
        let encoding = link.encoding;
        let text = |bytes: &[u8]| Some(encoding.decode(bytes)).filter(|text| !text.is_empty());
        Ok(Self {
            model: link.model().await?.to_string(),
            software: info.as_ref().and_then(|info| text(info.version.as_bytes())),
            robot_model: info.as_ref().and_then(|info| text(info.name.as_bytes())),
            encoding: encoding.label().to_owned(),
        })
    }

    /// Model according to the software version; otherwise the stored model. Old versions of armctl stored every model
    /// except FS100 as a DX200.
    pub fn description_of(&self) -> &str {
        let reported = self.software.as_ref().and_then(|software| Model::from_software(software.as_bytes()));
        match reported {
            Some(model) => model.name(),
            None => &self.model,
        }
    }

    /// Request that [`ask`](Self::ask) sends.
    pub fn question() -> Result<ReadSystemInfo> {
        // The request is the same for each model, and its answer also identifies the model.
        ReadSystemInfo::new(Model::Dx200, SystemPart::Group(Group::R1))
            .map_err(|error| Failure::local(error.to_string()))
    }
}

impl About for Controller {
    const FAMILY: Option<Family> = Some(Family::Yerc);

    fn check_entry(entry: &Entry) -> Result<(), String> {
        entry.name_hex.as_ref().map(|_| ()).ok_or_else(|| format!("'{}' has no name_hex", entry.name))
    }
}

/// Name on the controller of the file of an entry.
pub fn controller_file(entry: &Entry) -> Result<FileName> {
    exact(entry.name_hex.as_deref().and_then(unhex).unwrap_or_default())
}
