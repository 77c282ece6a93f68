//! Roster: the selected robots, updated from the inventory.

use std::future::pending;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use tokio::time::{Instant, sleep_until};

use crate::command::families;
use armctl_frame::failure::Failure;
use armctl_frame::session_client::identify;
use armctl_frame::settings::inventory::{Inventory, Location};
use armctl_frame::settings::{Robot, Sources};

/// Interval of the file check. A changed file is read after two equal checks, so that it is complete.
const CHECK_INTERVAL: Duration = Duration::from_secs(1);

/// Robots to poll: fixed, or read again when their inventory file changes.
#[derive(Debug)]
pub(super) struct Roster {
    robots: Vec<Robot>,
    sources: Option<Sources>,
    /// Inventory file to follow; `None` if the robots are fixed.
    file: Option<PathBuf>,
    /// State of the file when it was last read. `last_stamp` is the state at the last check.
    read: Option<Stamp>,
    last_stamp: Option<Stamp>,
    next: Instant,
}

impl Roster {
    /// The selected robots; at least one.
    pub fn new(sources: Sources) -> Result<Self, Failure> {
        // The file state is read before the inventory, so that no change is missed.
        let file = sources.inventory.path.as_deref().filter(|_| sources.follows_inventory());
        let file = file.map(Path::to_owned);
        let stamp = file.as_deref().and_then(Stamp::of);
        let robots = sources.robots(None)?;
        Ok(Self { sources: Some(sources), file, read: stamp.clone(), last_stamp: stamp, ..Self::from_robots(robots) })
    }

    /// A fixed list of robots.
    pub fn from_robots(robots: Vec<Robot>) -> Self {
        Self { robots, sources: None, file: None, read: None, last_stamp: None, next: Instant::now() + CHECK_INTERVAL }
    }

    /// Current robots.
    pub fn robots(&self) -> &[Robot] {
        &self.robots
    }

    /// Adds other addresses of the robot, because a session can use one of them.
    pub fn identify(&self, robot: &Robot) -> Robot {
        let mut robot = robot.clone();
        if let Some(sources) = &self.sources {
            // A robot that does not answer is polled without other addresses, and the poll reports the failure.
            let _ = identify(sources, families::driver(&robot), &mut robot, false);
        }
        robot
    }

    /// Waits until the file has changed, and reads it. After an error the robots stay the same. Cancel safe.
    pub async fn changed(&mut self) -> Result<(), Failure> {
        loop {
            let Some(path) = self.file.clone() else { return pending().await };
            sleep_until(self.next).await;
            self.next = Instant::now() + CHECK_INTERVAL;
            let now = Stamp::of(&path);
            if now == self.read {
                self.last_stamp = now;
            } else if now == self.last_stamp {
                self.read = now;
                return self.read(&path);
            } else {
                self.last_stamp = now;
            }
        }
    }

    fn read(&mut self, path: &Path) -> Result<(), Failure> {
        let inventory = Inventory::load(&Location::Named(path.to_owned()))?;
        if let Some(sources) = &mut self.sources {
            let now = Sources { inventory, ..sources.clone() };
            self.robots = now.remaining_robots()?;
            *sources = now;
        }
        Ok(())
    }
}

/// File state, to detect changes.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Stamp {
    modified: Option<SystemTime>,
    length: u64,
    inode: u64,
}

impl Stamp {
    /// State of a file; `None` if it does not exist.
    fn of(path: &Path) -> Option<Self> {
        let found = std::fs::metadata(path).ok()?;
        #[cfg(unix)]
        let inode = std::os::unix::fs::MetadataExt::ino(&found);
        #[cfg(not(unix))]
        let inode = 0;
        Some(Self { modified: found.modified().ok(), length: found.len(), inode })
    }
}
