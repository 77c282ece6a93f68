//! Which robots there are: those that were named, as the inventory says them now.

use std::future::pending;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use tokio::time::{Instant, sleep_until};

use crate::command::families;
use crate::command::frame::attach::identify;
use crate::failure::Failure;
use crate::settings::inventory::{Inventory, Location};
use crate::settings::{Robot, Sources};

/// Time between two looks at the file. One that has changed is read when it was the same twice: then nobody is still
/// writing it.
const LOOK: Duration = Duration::from_secs(1);

/// The robots, and where they come from.
#[derive(Debug)]
pub(super) struct Roster {
    robots: Vec<Robot>,
    sources: Option<Sources>,
    /// The inventory that is followed; nothing where the robots stay as they are.
    file: Option<PathBuf>,
    /// How the file was when it was read, and when it was looked at last.
    read: Option<Stamp>,
    seen: Option<Stamp>,
    next: Instant,
}

impl Roster {
    /// Those that are named, at least one.
    pub fn new(sources: Sources) -> Result<Self, Failure> {
        // Before it is read, so that no change is missed.
        let file = sources.inventory.path.as_deref().filter(|_| sources.follows_inventory());
        let file = file.map(Path::to_owned);
        let stamp = file.as_deref().and_then(Stamp::of);
        let robots = sources.robots(None)?;
        Ok(Self { sources: Some(sources), file, read: stamp.clone(), seen: stamp, ..Self::fixed(robots) })
    }

    /// These, whatever files say.
    pub fn fixed(robots: Vec<Robot>) -> Self {
        Self { robots, sources: None, file: None, read: None, seen: None, next: Instant::now() + LOOK }
    }

    /// The robots now.
    pub fn robots(&self) -> &[Robot] {
        &self.robots
    }

    /// A robot with its other addresses, where a session may have been opened with one of them.
    pub fn identified(&self, robot: &Robot) -> Robot {
        let mut robot = robot.clone();
        if let Some(sources) = &self.sources {
            // One that does not answer is looked at, and found to be silent, as it is.
            let _ = identify(sources, families::of(robot.family).driver(), &mut robot, false);
        }
        robot
    }

    /// Waits until the file has changed, and reads it. When it cannot be read, the robots stay as they are. May be
    /// dropped while it waits.
    pub async fn changed(&mut self) -> Result<(), Failure> {
        loop {
            let Some(path) = self.file.clone() else { return pending().await };
            sleep_until(self.next).await;
            self.next = Instant::now() + LOOK;
            let now = Stamp::of(&path);
            if now == self.read {
                self.seen = now;
            } else if now == self.seen {
                self.read = now;
                return self.read(&path);
            } else {
                self.seen = now;
            }
        }
    }

    fn read(&mut self, path: &Path) -> Result<(), Failure> {
        let inventory = Inventory::load(&Location::Named(path.to_owned()))?;
        if let Some(sources) = &mut self.sources {
            let now = Sources { inventory, ..sources.clone() };
            self.robots = now.robots_left()?;
            *sources = now;
        }
        Ok(())
    }
}

/// What tells that a file is not the one that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Stamp {
    modified: Option<SystemTime>,
    length: u64,
    inode: u64,
}

impl Stamp {
    /// That of a file; nothing where there is none.
    fn of(path: &Path) -> Option<Self> {
        let found = std::fs::metadata(path).ok()?;
        #[cfg(unix)]
        let inode = std::os::unix::fs::MetadataExt::ino(&found);
        #[cfg(not(unix))]
        let inode = 0;
        Some(Self { modified: found.modified().ok(), length: found.len(), inode })
    }
}
