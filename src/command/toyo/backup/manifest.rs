//! The list that a backup keeps of itself.

use std::path::Path;

use jiff::Timestamp;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parts::Part;
use crate::command::local::is_plain_file_name;
use crate::command::manifest::{self, List, Reason, Saved};
use crate::failure::Failure;

/// The list of a backup.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// [`List::FORMAT`].
    pub format: String,
    /// [`List::VERSION`].
    pub version: u32,
    /// The version of armctl that wrote it.
    pub armctl: String,
    /// Name of the robot.
    pub robot: String,
    /// Its URL.
    pub target: String,
    /// What kind of controller it is.
    pub controller: Controller,
    /// When the backup began.
    pub started: Timestamp,
    /// When it was last worked on.
    pub updated: Timestamp,
    /// Whether nothing is missing.
    pub complete: bool,
    /// Everything that was asked for so far.
    pub parts: Vec<Entry>,
}

/// What a controller is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Controller {
    /// Six digits.
    pub robot_type: String,
    /// Of the controller: `3.36`.
    pub version: String,
    /// A digit for the axes of each task (E19): `2000`.
    pub task_axes: String,
    /// Steps of each task (E22).
    pub task_steps: [u16; 4],
    /// Null if the controller refused to tell.
    pub override_percent: Option<u8>,
}

/// A part of the controller.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Entry {
    /// `points-1`.
    pub part: String,
    /// The file, if there is one.
    #[serde(flatten)]
    pub copy: Option<Saved>,
    /// What is not in it.
    #[serde(default)]
    pub left_out: Vec<LeftOut>,
    /// Why there is no file.
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

impl Manifest {
    /// The list of a backup that begins.
    pub fn new(robot: String, target: String, controller: Controller) -> Self {
        let now = Timestamp::now();
        Self {
            format: Self::FORMAT.to_owned(),
            version: Self::VERSION,
            armctl: env!("CARGO_PKG_VERSION").to_owned(),
            robot,
            target,
            controller,
            started: now,
            updated: now,
            complete: false,
            parts: Vec::new(),
        }
    }

    /// Writes the list into `folder`, whole or not at all.
    pub fn write(&mut self, folder: &Path) -> Result<(), Failure> {
        self.updated = Timestamp::now();
        manifest::write(folder, self)
    }

    /// What it says of a part.
    pub fn entry(&self, part: Part) -> Option<&Entry> {
        let name = part.to_string();
        self.parts.iter().find(|entry| entry.part == name)
    }
}

impl List for Manifest {
    const FORMAT: &'static str = "armctl toyo backup";
    const VERSION: u32 = 1;

    fn head(&self) -> (&str, u32) {
        (&self.format, self.version)
    }

    fn state(&self) -> (&str, &str, bool) {
        (&self.robot, &self.target, self.complete)
    }

    fn check(&self) -> Result<(), String> {
        let mut seen = Vec::new();
        for Entry { part: name, copy, error, .. } in &self.parts {
            let part: Part = name.parse()?;
            if part.to_string() != *name || seen.contains(&part) {
                return Err(format!("'{name}' is there twice"));
            }
            seen.push(part);
            match copy {
                Some(copy) if copy.file != part.file() || !is_plain_file_name(&copy.file) => {
                    return Err(format!("'{name}' is in {}, not in '{}'", part.file(), copy.file));
                }
                None if error.is_none() => {
                    return Err(format!("'{name}' has neither file, bytes and sha256 nor an error"));
                }
                _ => {}
            }
        }
        match self.controller.override_percent {
            Some(percent) if !(1..=100).contains(&percent) => Err(format!("an override of {percent} % is none")),
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn manifest() -> Manifest {
        let controller = Controller {
            robot_type: "000000".into(),
            version: "4.00".into(),
            task_axes: "5000".into(),
            task_steps: [2000, 0, 0, 0],
            override_percent: Some(100),
        };
        let mut manifest = Manifest::new("cell3".into(), "tcp://h:1".into(), controller);
        let copy = Saved { file: "points-1.csv".into(), bytes: 3, sha256: "ab".into() };
        let (left_out, error) = (Vec::new(), Some(Reason { code: None, message: "no".into() }));
        manifest.parts = vec![
            Entry { part: "points-1".into(), copy: Some(copy), left_out: left_out.clone(), error: None },
            Entry { part: "program-1".into(), copy: None, left_out, error },
        ];
        manifest
    }

    #[test]
    fn a_list_is_read_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let mut written = manifest();
        written.write(folder.path()).unwrap();
        assert_eq!(manifest::read::<Manifest>(folder.path()).unwrap().unwrap(), written);
        assert!(written.entry(Part::Points(1)).unwrap().copy.is_some());
        assert!(written.entry(Part::Points(2)).is_none());
    }

    #[test]
    fn a_list_that_was_tampered_with_is_no_list() {
        let spoil: [fn(&mut Manifest); 7] = [
            |m| m.parts[0].copy.as_mut().unwrap().file = "../points-1.csv".into(),
            |m| m.parts[0].copy.as_mut().unwrap().file = "points-2.csv".into(),
            |m| m.parts[1].part = "points-1".into(),
            |m| m.parts[1].error = None,
            |m| m.parts[1].part = "pictures".into(),
            |m| m.controller.override_percent = Some(101),
            |m| m.version = 2,
        ];
        for spoil in spoil {
            let folder = tempfile::tempdir().unwrap();
            let mut spoilt = manifest();
            spoil(&mut spoilt);
            spoilt.write(folder.path()).unwrap();
            assert!(manifest::read::<Manifest>(folder.path()).is_err());
        }
    }
}
