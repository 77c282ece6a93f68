//! Where the sockets of sessions are, and whose they are.

use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use sha2::{Digest as _, Sha256};
use thiserror::Error;
use tokio::time::{Instant, sleep};

use super::socket::{self, Lock};
use super::wire::Info;
use armctl_files as files;

/// Most that a lock file says about its owner.
const LONGEST_LOCK: u64 = 1 << 16;

/// Why there is no place for sessions.
#[derive(Debug, Error)]
pub enum PlaceError {
    /// Somebody else could be behind it.
    #[error("{path} is not to be trusted: {why}")]
    Unsafe {
        /// What.
        path: PathBuf,
        /// Why not.
        why: &'static str,
    },
    /// Anything else.
    #[error("{path}: {error}")]
    Io {
        /// What.
        path: PathBuf,
        /// Why not.
        error: io::Error,
    },
}

fn failed(path: &Path) -> impl FnOnce(io::Error) -> PlaceError {
    move |error| PlaceError::Io { path: path.to_owned(), error }
}

/// What a session is named by: the same for everybody who means this device.
pub fn key(family: &str, target: &str) -> String {
    let digest = Sha256::digest(format!("{family} {target}"));
    digest.iter().take(8).map(|byte| format!("{byte:02x}")).collect()
}

/// The folder with the sockets of this user's sessions.
#[derive(Debug)]
pub struct Place {
    folder: PathBuf,
}

impl Place {
    /// The folder if it is there, and this user's alone.
    pub fn find() -> Result<Option<Self>, PlaceError> {
        let folder = socket::folder();
        match socket::check_private(&folder, true) {
            Ok(Ok(())) => Ok(Some(Self { folder })),
            Ok(Err(why)) => Err(PlaceError::Unsafe { path: folder, why }),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(failed(&folder)(error)),
        }
    }

    /// The folder, made if it is not there.
    pub fn make() -> Result<Self, PlaceError> {
        let folder = socket::folder();
        socket::make_private(&folder).map_err(failed(&folder))?;
        Self::find()?.ok_or_else(|| failed(&folder)(io::ErrorKind::NotFound.into()))
    }

    /// Where the session of this key is.
    pub fn spot(&self, key: &str) -> Spot {
        Spot { stem: self.folder.join(key) }
    }

    /// Where sessions are, or were.
    pub fn spots(&self) -> Result<Vec<Spot>, PlaceError> {
        let entries = std::fs::read_dir(&self.folder).and_then(Iterator::collect::<io::Result<Vec<_>>>);
        let entries = entries.map_err(failed(&self.folder))?;
        let sockets = entries.iter().map(std::fs::DirEntry::path);
        let sockets = sockets.filter(|path| path.extension().is_some_and(|extension| extension == SOCKET));
        let mut spots: Vec<Spot> = sockets.map(|path| Spot { stem: path.with_extension("") }).collect();
        spots.sort_by(|one, other| one.stem.cmp(&other.stem));
        Ok(spots)
    }
}

const SOCKET: &str = "sock";

/// Where one session is: its socket, its lock, its log.
#[derive(Debug, Clone)]
pub struct Spot {
    stem: PathBuf,
}

impl Spot {
    /// Somewhere of one's own: the socket, lock and log begin with this path.
    pub fn at(stem: PathBuf) -> Self {
        Self { stem }
    }

    /// Where clients connect.
    pub fn socket(&self) -> PathBuf {
        self.stem.with_extension(SOCKET)
    }

    /// What the session is named by.
    pub fn key(&self) -> String {
        self.stem.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Whether somebody listens there, and nobody but this user can.
    pub fn is_open(&self) -> bool {
        self.check().is_ok_and(|is_there| is_there && socket::answers(&self.socket()))
    }

    /// Where a host in the background writes what happens.
    pub fn log(&self) -> PathBuf {
        self.stem.with_extension("log")
    }

    fn lock(&self) -> PathBuf {
        self.stem.with_extension("lock")
    }

    /// Makes the spot this process's own; `None` if a living process has it. What a dead one left is removed.
    pub fn claim(&self, info: &Info) -> Result<Option<Claim>, PlaceError> {
        let text = serde_json::to_vec(info).unwrap_or_default();
        let Some(lock) = Lock::take(&self.lock(), &text).map_err(failed(&self.lock()))? else { return Ok(None) };
        self.remove_socket()?;
        Ok(Some(Claim { spot: self.clone(), _lock: lock }))
    }

    /// Makes the spot this process's own as soon as whoever has it gives it back, who is not waited for long.
    pub async fn turn(&self, info: &Info) -> Result<Turn, PlaceError> {
        let until = Instant::now() + TURN_WITHIN;
        loop {
            if let Some(claim) = self.claim(info)? {
                return Ok(Turn::Mine(claim));
            }
            // Whoever has it may be a command, which ends, or a session that is just being opened.
            if self.is_open() {
                return Ok(Turn::Session);
            }
            if Instant::now() >= until {
                return Ok(Turn::Taken);
            }
            sleep(TURN_EVERY).await;
        }
    }

    /// Who has it, or had it.
    pub fn owner(&self) -> Option<Info> {
        serde_json::from_slice(&files::read(&self.lock(), LONGEST_LOCK).ok()?).ok()
    }

    /// Removes what a dead session left; nothing if a living process has it.
    pub fn clear(&self) -> Result<(), PlaceError> {
        match self.owner() {
            Some(info) => self.claim(&info).map(|_| ()),
            None => Ok(()),
        }
    }

    fn remove_socket(&self) -> Result<(), PlaceError> {
        match std::fs::remove_file(self.socket()) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(failed(&self.socket())(error)),
            _ => Ok(()),
        }
    }

    /// Whether a socket of this user's alone is there.
    pub(super) fn check(&self) -> Result<bool, PlaceError> {
        let path = self.socket();
        match socket::check_private(&path, false) {
            Ok(Ok(())) => Ok(true),
            Ok(Err(why)) => Err(PlaceError::Unsafe { path, why }),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
            Err(error) => Err(failed(&path)(error)),
        }
    }
}

/// How long a spot is waited for, and from look to look.
const TURN_WITHIN: Duration = Duration::from_secs(3);
const TURN_EVERY: Duration = Duration::from_millis(10);

/// Whose a spot is.
#[derive(Debug)]
pub enum Turn {
    /// This process's.
    Mine(Claim),
    /// That of a session, which lets clients in.
    Session,
    /// That of a process which has not given it back in time.
    Taken,
}

/// A spot that is this process's own, until it is dropped.
#[derive(Debug)]
pub struct Claim {
    spot: Spot,
    _lock: Lock,
}

impl Claim {
    /// Where it is.
    pub fn spot(&self) -> &Spot {
        &self.spot
    }

    /// Listens for clients.
    pub(super) fn listen(&self) -> io::Result<socket::Listener> {
        socket::Listener::bind(&self.spot.socket())
    }

    /// Removes the socket, so that nobody new comes.
    pub(super) fn hide(&self) {
        // What cannot be removed is stale from now on, and found to be.
        let _ = self.spot.remove_socket();
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        self.hide();
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use std::os::unix::fs::{PermissionsExt as _, symlink};

    use super::*;

    fn info() -> Info {
        Info { pid: 7, ..Info::own("cell1", "yrcx", "sim:", "armctl status") }
    }

    fn spot(folder: &Path) -> Spot {
        Spot::at(folder.join(key("yrcx", "sim:")))
    }

    #[test]
    fn a_device_has_a_name_of_its_own() {
        assert_eq!(key("yrcx", "sim:").len(), 16);
        assert_ne!(key("yrcx", "sim:"), key("yerc", "sim:"));
    }

    #[test]
    fn one_process_has_a_spot() {
        let folder = tempfile::tempdir().unwrap();
        let spot = spot(folder.path());
        assert!(spot.owner().is_none());
        let claim = spot.claim(&info()).unwrap().unwrap();
        assert!(spot.owner() == Some(info()));
        // Locks are of open files: the second one of this process is as another's.
        assert!(spot.claim(&info()).unwrap().is_none());
        drop(claim);
        assert!(spot.claim(&info()).unwrap().is_some());
    }

    #[tokio::test]
    async fn what_lives_is_not_cleared() {
        let folder = tempfile::tempdir().unwrap();
        let spot = spot(folder.path());
        let claim = spot.claim(&info()).unwrap().unwrap();
        let _listener = claim.listen().unwrap();
        spot.clear().unwrap();
        assert!(spot.check().unwrap());
        drop(claim);
        assert!(!spot.check().unwrap());
    }

    #[test]
    fn what_others_could_be_behind_is_not_trusted() {
        let folder = tempfile::tempdir().unwrap();
        let private = folder.path().join("armctl");
        socket::make_private(&private).unwrap();
        assert_eq!(socket::check_private(&private, true).unwrap(), Ok(()));
        std::fs::set_permissions(&private, std::fs::Permissions::from_mode(0o755)).unwrap();
        assert!(socket::check_private(&private, true).unwrap().is_err());
        let link = folder.path().join("link");
        symlink(folder.path(), &link).unwrap();
        assert_eq!(socket::check_private(&link, true).unwrap(), Err("it is not a folder"));
        let spot = spot(folder.path());
        std::fs::write(spot.socket(), "").unwrap();
        assert!(matches!(spot.check(), Err(PlaceError::Unsafe { why: "it is not a socket", .. })));
    }
}
