//! Manifest entries of a Toyo backup.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parts::Part;
use armctl_frame::backup::manifest;
use armctl_frame::backup::manifest::{About, Entry};
use armctl_frame::settings::target::Family;

/// Manifest of a backup.
pub type Manifest = manifest::Manifest<Controller>;

/// Controller from which a backup comes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Controller {
    /// Robot type, six digits.
    pub robot_type: String,
    /// Version of the controller, such as `3.36`.
    pub version: String,
    /// Axes of the tasks, one digit for each task (parameter E19), such as `2000`.
    pub task_axes: String,
    /// Letters of the axes (parameter E01), such as `X Y Z R`; null if the controller refused to report them, or if an
    /// older armctl made the backup.
    #[serde(default)]
    pub axis_letters: Option<String>,
    /// Number of steps of each task (parameter E22).
    pub task_steps: [u16; 4],
    /// Speed override; null if the controller refused to report it.
    pub speed_override_percent: Option<u8>,
}

impl About for Controller {
    const FAMILY: Option<Family> = Some(Family::Toyo);

    fn check(&self) -> Result<(), String> {
        match self.speed_override_percent {
            Some(percent) if !(1..=100).contains(&percent) => Err(format!("an override of {percent} % is not valid")),
            _ => Ok(()),
        }
    }

    fn check_entry(entry: &Entry) -> Result<(), String> {
        let name = &entry.name;
        let part: Part = name.parse()?;
        if part.to_string() != *name {
            return Err(format!("'{name}' must be written as {part}"));
        }
        match &entry.copy {
            Some(copy) if copy.file != part.file() => {
                Err(format!("'{name}' is in {}, not in '{}'", part.file(), copy.file))
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_frame::backup::manifest::Saved;

    #[test]
    fn a_part_is_in_its_own_file() {
        let entry = |name: &str, file: &str| {
            let copy = Some(Saved { file: file.into(), ..Saved::default() });
            Controller::check_entry(&Entry { name: name.into(), copy, ..Entry::default() })
        };
        assert_eq!(entry("points-1", "points-1.csv"), Ok(()));
        for (name, file) in [
            ("points-1", "points-2.csv"),
            ("points", "points-1.csv"),
            ("palletizing-3", "palletizing-03.csv"),
            ("pictures", "pictures.csv"),
        ] {
            assert!(entry(name, file).is_err(), "{name}");
        }
    }

    #[test]
    fn an_override_is_a_percentage() {
        let controller = |percent| Controller {
            robot_type: "000000".into(),
            version: "4.00".into(),
            task_axes: "5000".into(),
            axis_letters: None,
            task_steps: [2000, 0, 0, 0],
            speed_override_percent: Some(percent),
        };
        assert!(controller(100).check().is_ok());
        assert!(controller(101).check().is_err());
    }
}
