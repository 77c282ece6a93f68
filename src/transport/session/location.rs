//! Locations of sessions. A location has a socket, a lock file and an owner.

use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use sha2::{Digest as _, Sha256};
use thiserror::Error;
use tokio::time::{Instant, sleep};

use super::socket::{self, Lock};
use super::wire::Info;
use armctl_files as files;

/// Maximum size of a lock file in bytes.
const MAX_LOCK_BYTES: u64 = 1 << 16;

/// Error of a session location.
#[derive(Debug, Error)]
pub enum LocationError {
    /// The folder or socket is not safe: it may belong to another user.
    #[error("{path} is not safe: {why}")]
    Unsafe {
        /// Path of the folder or socket.
        path: PathBuf,
        /// Reason.
        why: &'static str,
    },
    /// Any other error.
    #[error("{path}: {error}")]
    Io {
        /// Path of the folder or socket.
        path: PathBuf,
        /// I/O error.
        error: io::Error,
    },
}

fn io_error(path: &Path) -> impl FnOnce(io::Error) -> LocationError {
    move |error| LocationError::Io { path: path.to_owned(), error }
}

/// Returns the key of a session. If a device has several names, all of them have the same key.
pub fn key(family: &str, target: &str) -> String {
    let digest = Sha256::digest(format!("{family} {target}"));
    digest.iter().take(8).map(|byte| format!("{byte:02x}")).collect()
}

/// Folder with the session sockets of this user.
#[derive(Debug)]
pub struct SessionFolder {
    folder: PathBuf,
}

impl SessionFolder {
    /// Finds the folder; `None` if it does not exist. The folder must be private to this user.
    pub fn find() -> Result<Option<Self>, LocationError> {
        let folder = socket::folder();
        match socket::check_private(&folder, true) {
            Ok(Ok(())) => Ok(Some(Self { folder })),
            Ok(Err(why)) => Err(LocationError::Unsafe { path: folder, why }),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(io_error(&folder)(error)),
        }
    }

    /// Finds or creates the folder.
    pub fn create() -> Result<Self, LocationError> {
        let folder = socket::folder();
        socket::make_private(&folder).map_err(io_error(&folder))?;
        Self::find()?.ok_or_else(|| io_error(&folder)(io::ErrorKind::NotFound.into()))
    }

    /// Returns the location of the session with this key.
    pub fn location(&self, key: &str) -> SessionPath {
        SessionPath { stem: self.folder.join(key) }
    }

    /// Returns the locations of all sessions. Some of these sessions may have ended.
    pub fn locations(&self) -> Result<Vec<SessionPath>, LocationError> {
        let entries = std::fs::read_dir(&self.folder).and_then(Iterator::collect::<io::Result<Vec<_>>>);
        let entries = entries.map_err(io_error(&self.folder))?;
        let sockets = entries.iter().map(std::fs::DirEntry::path);
        let sockets = sockets.filter(|path| path.extension().is_some_and(|extension| extension == SOCKET));
        let mut locations: Vec<SessionPath> =
            sockets.map(|path| SessionPath { stem: path.with_extension("") }).collect();
        locations.sort_by(|one, other| one.stem.cmp(&other.stem));
        Ok(locations)
    }
}

const SOCKET: &str = "sock";

/// Location of one session: socket, lock file and log file.
#[derive(Debug, Clone)]
pub struct SessionPath {
    stem: PathBuf,
}

impl SessionPath {
    /// Creates a custom location. The paths of socket, lock file and log file start with `stem`.
    pub fn at(stem: PathBuf) -> Self {
        Self { stem }
    }

    /// Path of the socket.
    pub fn socket(&self) -> PathBuf {
        self.stem.with_extension(SOCKET)
    }

    /// Key of the session.
    pub fn key(&self) -> String {
        self.stem.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Whether a session listens at this location, and the socket is private to this user.
    pub fn is_open(&self) -> bool {
        self.check().is_ok_and(|is_there| is_there && socket::answers(&self.socket()))
    }

    /// Path of the log file of a background host.
    pub fn log(&self) -> PathBuf {
        self.stem.with_extension("log")
    }

    fn lock(&self) -> PathBuf {
        self.stem.with_extension("lock")
    }

    /// Locks the location for this process. Returns `None` if another running process has locked it. If the last owner
    /// ended without cleanup, its socket is removed.
    pub fn claim(&self, info: &Info) -> Result<Option<Claim>, LocationError> {
        let text = serde_json::to_vec(info).unwrap_or_default();
        let Some(lock) = Lock::take(&self.lock(), &text).map_err(io_error(&self.lock()))? else { return Ok(None) };
        self.remove_socket()?;
        Ok(Some(Claim { location: self.clone(), _lock: lock }))
    }

    /// Locks the location. If another process has locked it, waits a short time until that process releases it.
    pub async fn lock_or_attach(&self, info: &Info) -> Result<LockResult, LocationError> {
        let until = Instant::now() + LOCK_TIMEOUT;
        loop {
            if let Some(claim) = self.claim(info)? {
                return Ok(LockResult::Locked(claim));
            }
            // If no session listens, the owner may be a short command, or a session that is just opening.
            if self.is_open() {
                return Ok(LockResult::Session);
            }
            if Instant::now() >= until {
                return Ok(LockResult::Busy);
            }
            sleep(LOCK_INTERVAL).await;
        }
    }

    /// Process that has locked the location, or that locked it last.
    pub fn owner(&self) -> Option<Info> {
        serde_json::from_slice(&files::read(&self.lock(), MAX_LOCK_BYTES).ok()?).ok()
    }

    /// Removes the socket of a session that ended without cleanup. Has no effect while a running process has locked the
    /// location.
    pub fn clear(&self) -> Result<(), LocationError> {
        match self.owner() {
            Some(info) => self.claim(&info).map(|_| ()),
            None => Ok(()),
        }
    }

    fn remove_socket(&self) -> Result<(), LocationError> {
        match std::fs::remove_file(self.socket()) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(io_error(&self.socket())(error)),
            _ => Ok(()),
        }
    }

    /// Whether a socket exists at this location. The socket must be private to this user.
    pub(super) fn check(&self) -> Result<bool, LocationError> {
        let path = self.socket();
        match socket::check_private(&path, false) {
            Ok(Ok(())) => Ok(true),
            Ok(Err(why)) => Err(LocationError::Unsafe { path, why }),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
            Err(error) => Err(io_error(&path)(error)),
        }
    }
}

/// Time limit for locking a location. The constant below is the interval of the attempts.
const LOCK_TIMEOUT: Duration = Duration::from_secs(3);
const LOCK_INTERVAL: Duration = Duration::from_millis(10);

/// Result of an attempt to lock a location.
#[derive(Debug)]
pub enum LockResult {
    /// This process has locked the location.
    Locked(Claim),
    /// A session that accepts clients has locked the location.
    Session,
    /// Another process did not release the location in time.
    Busy,
}

/// A locked location. Dropping the claim releases the lock.
#[derive(Debug)]
pub struct Claim {
    location: SessionPath,
    _lock: Lock,
}

impl Claim {
    /// The location that is locked.
    pub fn location(&self) -> &SessionPath {
        &self.location
    }

    /// Listens for clients.
    pub(super) fn listen(&self) -> io::Result<socket::Listener> {
        socket::Listener::bind(&self.location.socket())
    }

    /// Removes the socket, so that no new client connects.
    pub(super) fn hide(&self) {
        // An error is ignored: a client that finds the socket detects that no session listens on it.
        let _ = self.location.remove_socket();
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        self.hide();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn info() -> Info {
        Info { pid: 7, ..Info::own("cell1", "yrcx", "sim:", "armctl status") }
    }

    fn location(folder: &Path) -> SessionPath {
        SessionPath::at(folder.join(key("yrcx", "sim:")))
    }

    #[test]
    fn a_device_has_a_name_of_its_own() {
        assert_eq!(key("yrcx", "sim:").len(), 16);
        assert_ne!(key("yrcx", "sim:"), key("yerc", "sim:"));
    }

    #[test]
    fn one_process_owns_a_location() {
        let folder = tempfile::tempdir().unwrap();
        let location = location(folder.path());
        assert!(location.owner().is_none());
        let claim = location.claim(&info()).unwrap().unwrap();
        assert!(location.owner() == Some(info()));
        // A lock belongs to an open file, so a second lock in the same process also conflicts.
        assert!(location.claim(&info()).unwrap().is_none());
        drop(claim);
        assert!(location.claim(&info()).unwrap().is_some());
    }

    #[tokio::test]
    async fn does_not_clear_a_live_session() {
        let folder = tempfile::tempdir().unwrap();
        let location = location(folder.path());
        let claim = location.claim(&info()).unwrap().unwrap();
        let _listener = claim.listen().unwrap();
        location.clear().unwrap();
        assert!(location.check().unwrap());
        drop(claim);
        assert!(!location.check().unwrap());
    }

    #[cfg(unix)]
    #[test]
    fn does_not_trust_files_of_other_users() {
        use std::os::unix::fs::{PermissionsExt as _, symlink};

        let folder = tempfile::tempdir().unwrap();
        let private = folder.path().join("armctl");
        socket::make_private(&private).unwrap();
        assert_eq!(socket::check_private(&private, true).unwrap(), Ok(()));
        std::fs::set_permissions(&private, std::fs::Permissions::from_mode(0o755)).unwrap();
        assert!(socket::check_private(&private, true).unwrap().is_err());
        let link = folder.path().join("link");
        symlink(folder.path(), &link).unwrap();
        assert_eq!(socket::check_private(&link, true).unwrap(), Err("it is not a folder"));
        let location = location(folder.path());
        std::fs::write(location.socket(), "").unwrap();
        assert!(matches!(location.check(), Err(LocationError::Unsafe { why: "it is not a socket", .. })));
    }
}
