//! Settings that the user chose to keep: the host ON, the current task.
//!
//! A controller does not report which client switched its host ON. A setting that the user did not choose on this
//! computer comes from another client.

use serde::Deserialize;

use crate::prelude::basics::*;
use armctl_frame::local_names::state_folder;

/// Choices for one robot.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Choice {
    /// Whether the user switched the host ON with `toyo host on`. False again after the host is OFF.
    pub host: bool,
    /// Task that the user selected with `toyo task set`. `None` again after the controller has another current task.
    pub task: Option<u8>,
}

/// Choices of this user. One file contains the choices for all robots.
#[derive(Debug, Default)]
pub struct UserChoices {
    /// Path of the file; `None` for a simulator in this process.
    path: Option<PathBuf>,
    robot: String,
}

/// Maximum size of the file.
const MAX_SIZE: u64 = 1 << 20;

impl UserChoices {
    /// Opens the choices for a robot.
    pub fn of(robot: &str) -> Self {
        Self { path: state_folder().map(|folder| folder.join("toyo-chosen.json")), robot: robot.to_owned() }
    }

    /// Choices without a file, for a simulator in this process.
    pub fn without_file() -> Self {
        Self::default()
    }

    /// The choices for this robot; `None` without a file.
    pub fn get(&self) -> Option<Choice> {
        self.path.is_some().then(|| self.all().get(&self.robot).copied().unwrap_or_default())
    }

    /// Changes the choices. If the file cannot be written, an unnecessary notice may be printed later; there is no
    /// other effect.
    pub fn change(&self, change: impl FnOnce(&mut Choice)) {
        let Some(path) = &self.path else { return };
        let mut all = self.all();
        let old = all.get(&self.robot).copied().unwrap_or_default();
        let mut choice = old;
        change(&mut choice);
        if choice == old {
            return;
        }
        if choice == Choice::default() {
            all.remove(&self.robot);
        } else {
            all.insert(self.robot.clone(), choice);
        }
        std::fs::create_dir_all(files::folder_of(path)).unwrap_or_default();
        if let Ok(text) = serde_json::to_vec(&all) {
            files::replace(path, &text).unwrap_or_default();
        }
    }

    fn all(&self) -> BTreeMap<String, Choice> {
        let text = self.path.as_ref().and_then(|path| files::read(path, MAX_SIZE).ok());
        text.and_then(|text| serde_json::from_slice(&text).ok()).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_choice_is_stored_for_its_robot_until_it_is_undone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state").join("chosen.json");
        let choices_of = |robot: &str| UserChoices { path: Some(path.clone()), robot: robot.to_owned() };
        assert_eq!(choices_of("tcp://a").get(), Some(Choice::default()));
        choices_of("tcp://a").change(|choice| choice.host = true);
        choices_of("tcp://b").change(|choice| choice.task = Some(2));
        assert_eq!(choices_of("tcp://a").get(), Some(Choice { host: true, task: None }));
        assert_eq!(choices_of("tcp://b").get(), Some(Choice { host: false, task: Some(2) }));
        choices_of("tcp://a").change(|choice| choice.host = false);
        assert!(!std::fs::read_to_string(&path).unwrap().contains("tcp://a"));
        std::fs::write(&path, "{").unwrap();
        assert_eq!(choices_of("tcp://b").get(), Some(Choice::default()), "an invalid file counts as empty");
        assert_eq!(UserChoices::without_file().get(), None);
    }
}
