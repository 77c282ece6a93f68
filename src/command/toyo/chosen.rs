//! What somebody at this computer chose to stay as it is: the host ON, the current task.
//!
//! A controller does not tell who switched its host ON. Whatever is so and was not chosen here, somebody else has left, or is
//! at work now.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::command::frame::local::state_folder;
use crate::files;

/// What was chosen for one robot.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Choice {
    /// `toyo host on`, until it is OFF.
    pub host: bool,
    /// `toyo task set`, until another is found.
    pub task: Option<u8>,
}

/// The choices for one robot, among those for all.
#[derive(Debug, Default)]
pub struct Chosen {
    /// Where they are, for a robot whose state outlives this process.
    path: Option<PathBuf>,
    robot: String,
}

/// What is larger is none that was written here.
const MOST: u64 = 1 << 20;

impl Chosen {
    /// For a robot.
    pub fn of(robot: &str) -> Self {
        Self { path: state_folder().map(|folder| folder.join("toyo-chosen.json")), robot: robot.to_owned() }
    }

    /// For a robot that lasts as long as its link: nobody else has left anything.
    pub fn without_notes() -> Self {
        Self::default()
    }

    /// What was chosen; `None` where that cannot be known.
    pub fn get(&self) -> Option<Choice> {
        self.path.is_some().then(|| self.all().get(&self.robot).copied().unwrap_or_default())
    }

    /// Something else is chosen, or nothing any more. What could not be written is a word too many the next time.
    pub fn change(&self, change: impl FnOnce(&mut Choice)) {
        let Some(path) = &self.path else { return };
        let mut all = self.all();
        let before = all.get(&self.robot).copied().unwrap_or_default();
        let mut choice = before;
        change(&mut choice);
        if choice == before {
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
        let read = self.path.as_ref().and_then(|path| files::read(path, MOST).ok());
        read.and_then(|text| serde_json::from_slice(&text).ok()).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_choice_is_kept_for_its_robot_until_it_is_undone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state").join("chosen.json");
        let of = |robot: &str| Chosen { path: Some(path.clone()), robot: robot.to_owned() };
        assert_eq!(of("tcp://a").get(), Some(Choice::default()));
        of("tcp://a").change(|choice| choice.host = true);
        of("tcp://b").change(|choice| choice.task = Some(2));
        assert_eq!(of("tcp://a").get(), Some(Choice { host: true, task: None }));
        assert_eq!(of("tcp://b").get(), Some(Choice { host: false, task: Some(2) }));
        of("tcp://a").change(|choice| choice.host = false);
        assert!(!std::fs::read_to_string(&path).unwrap().contains("tcp://a"));
        std::fs::write(&path, "{").unwrap();
        assert_eq!(of("tcp://b").get(), Some(Choice::default()), "what makes no sense is nothing");
        assert_eq!(Chosen::without_notes().get(), None);
    }
}
