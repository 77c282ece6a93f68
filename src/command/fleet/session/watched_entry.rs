//! Inventory entry of a robot during an open session.

use std::path::PathBuf;
use std::time::SystemTime;

use armctl_frame::settings::inventory::{Inventory, Location};
use armctl_frame::settings::{Robot, Sources};

/// Inventory entry that is read again after each change of the file. Once the robot is read-only, it stays read-only.
pub struct WatchedEntry {
    robot: Robot,
    /// Version of the file that was read last.
    version: Option<(SystemTime, u64)>,
}

impl WatchedEntry {
    pub fn new(robot: &Robot) -> Self {
        Self { robot: robot.clone(), version: None }
    }

    /// Whether the robot is read-only now.
    ///
    /// # Errors
    /// A text, if the file cannot be read. The error is returned once per version of the file.
    pub fn is_read_only(&mut self) -> Result<bool, String> {
        let Some(path) = self.robot.inventory.clone().filter(|_| !self.robot.read_only.value) else {
            return Ok(self.robot.read_only.value);
        };
        let file = std::fs::metadata(&path).ok();
        let version = file.and_then(|file| Some((file.modified().ok()?, file.len())));
        if version != self.version {
            self.version = version;
            self.update(path)?;
        }
        Ok(self.robot.read_only.value)
    }

    fn update(&mut self, path: PathBuf) -> Result<(), String> {
        // A deleted file changes nothing.
        let inventory = Inventory::load(&Location::Default(path)).map_err(|failure| {
            format!("armctl could not check again whether {} is read-only: {failure}", self.robot.name)
        })?;
        let sources = Sources { inventory, ..Sources::default() };
        self.robot.read_only.value =
            sources.read_only(self.robot.family).any(|(_, entry)| entry.name == self.robot.name);
        sources.apply_read_only(&mut self.robot);
        Ok(())
    }
}
