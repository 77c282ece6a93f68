//! Safe access to local files. Only regular files up to a size limit are read, because a read of a device or a pipe may
//! block or never end. A file is written to a temporary draft next to it, and the draft then replaces the file. Drafts
//! that a killed process left are removed later.

mod program;

use std::collections::HashSet;
use std::fs::File;
use std::io::{self, ErrorKind, Read, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};

use tempfile::NamedTempFile;

pub use self::program::{own_command, this_program, was_started_by_itself};

/// Size limit of files that users write: inventories, command files, simulator states.
pub const SETTINGS: u64 = 16 << 20;

/// Opens a regular file for reading.
///
/// # Errors
/// `IsADirectory` for a folder, `Unsupported` for any other file that is not regular.
pub fn open(path: &Path) -> io::Result<File> {
    // The type is checked before the open, because opening a device or a pipe may have effects or block.
    check_regular(&path.metadata()?)?;
    let file = open_nonblocking(path)?;
    // The type is checked again, because the path may lead to another file now.
    check_regular(&file.metadata()?)?;
    Ok(file)
}

/// Formats a system error without its number. The number does not help a technician.
pub fn plain(error: &io::Error) -> String {
    error.to_string().split(" (os error").next().unwrap_or_default().to_owned()
}

/// Reads a regular file of at most `limit` bytes.
///
/// # Errors
/// The errors of [`open`]; `FileTooLarge` above the limit.
pub fn read(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    read_limited(open(path)?, limit)
}

/// Reads a text file of at most `most` bytes.
///
/// # Errors
/// The errors of [`read`]; `InvalidData` if the file is not UTF-8.
pub fn text(path: &Path, most: u64) -> io::Result<String> {
    String::from_utf8(read(path, most)?).map_err(|_| io::Error::new(ErrorKind::InvalidData, "the text is not UTF-8"))
}

/// Reads stdin, up to a limit. The bytes are kept in memory: a command that asks for confirmation is planned first, and
/// therefore reads its input twice.
///
/// # Errors
/// `FileTooLarge` above the limit.
pub fn stdin(most: u64) -> io::Result<Vec<u8>> {
    static CACHED_INPUT: Mutex<Option<Vec<u8>>> = Mutex::new(None);
    let mut cached_input = CACHED_INPUT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(bytes) = &*cached_input {
        return read_limited(&**bytes, most);
    }
    let bytes = read_limited(io::stdin().lock(), most)?;
    *cached_input = Some(bytes.clone());
    Ok(bytes)
}

/// Reads a regular file up to a limit. With the path `-`, reads stdin instead.
///
/// # Errors
/// The errors of [`read`] and [`stdin`].
pub fn input(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    if path == Path::new("-") { stdin(most) } else { read(path, most) }
}

fn read_limited(from: impl Read, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if u64::try_from(bytes.len()).unwrap_or(u64::MAX) > most {
        return Err(io::Error::new(ErrorKind::FileTooLarge, format!("it is larger than {}", size(most))));
    }
    Ok(bytes)
}

fn check_regular(found: &std::fs::Metadata) -> io::Result<()> {
    match found.file_type() {
        kind if kind.is_file() => Ok(()),
        kind if kind.is_dir() => Err(ErrorKind::IsADirectory.into()),
        _ => Err(io::Error::new(
            ErrorKind::Unsupported,
            "it is not a regular file; devices, pipes and sockets are not read",
        )),
    }
}

/// Opens a path without blocking. The path may have become a pipe after it was checked.
#[cfg(unix)]
fn open_nonblocking(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt as _;

    let flags = i32::try_from(rustix::fs::OFlags::NONBLOCK.bits()).unwrap_or_default();
    std::fs::OpenOptions::new().read(true).custom_flags(flags).open(path)
}

#[cfg(windows)]
fn open_nonblocking(path: &Path) -> io::Result<File> {
    File::open(path)
}

/// Prefix and suffix of draft names.
const DRAFT: (&str, &str) = (".armctl-", ".part");
/// Number of attempts to create a draft, if another process removes it at the same time.
const MAX_TRIES: u32 = 10;

/// Function that is called before each draft is created.
static DRAFT_HOOK: OnceLock<fn()> = OnceLock::new();

/// Sets a function that is called before each draft of this process. With it, the program ensures that a signal does
/// not end the process while a draft exists. Only the first call has an effect.
pub fn set_draft_hook(prepare: fn()) {
    DRAFT_HOOK.get_or_init(|| prepare);
}

/// Paths of the drafts of this process.
static DRAFTS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes the drafts of this process. The program calls this function directly before it exits.
pub fn remove_drafts() {
    for path in DRAFTS.lock().unwrap_or_else(PoisonError::into_inner).drain(..) {
        // An error is ignored: the draft may have replaced its file already.
        let _ = std::fs::remove_file(path);
    }
}

/// Creates a draft, which is locked while it exists. The draft has the permissions of a normal new file, not those of a
/// private file.
pub fn draft_in(folder: &Path) -> io::Result<NamedTempFile> {
    static SWEPT_FOLDERS: Mutex<Option<HashSet<PathBuf>>> = Mutex::new(None);

    let is_new = {
        let mut swept = SWEPT_FOLDERS.lock().unwrap_or_else(PoisonError::into_inner);
        swept.get_or_insert_default().insert(folder.to_owned())
    };
    if is_new {
        sweep(folder);
    }
    if let Some(prepare) = DRAFT_HOOK.get() {
        prepare();
    }
    let mut tries = 0;
    loop {
        let mut builder = tempfile::Builder::new();
        builder.prefix(DRAFT.0).suffix(DRAFT.1);
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.tempfile_in(folder)?;
        tries += 1;
        {
            let mut drafts = DRAFTS.lock().unwrap_or_else(PoisonError::into_inner);
            // Drafts that no longer exist have replaced their files.
            drafts.retain(|path| path.exists());
            drafts.push(file.path().to_owned());
        }
        // Another process may have removed the draft as abandoned before it was locked. In this case, a new draft is
        // created.
        if (lock(file.as_file()) && is_linked(file.as_file())) || tries >= MAX_TRIES {
            return Ok(file);
        }
    }
}

/// Removes the drafts of killed processes. No process has locked these drafts. Returns how many drafts were removed,
/// and how many could not be removed.
pub fn sweep(folder: &Path) -> (usize, usize) {
    let (mut removed, mut left) = (0, 0);
    for path in std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let is_draft = name.strip_prefix(DRAFT.0).is_some_and(|rest| rest.ends_with(DRAFT.1))
            && path.symlink_metadata().is_ok_and(|found| found.is_file());
        // The lock lasts until the draft is removed, so a process that has just created the draft cannot lock it in
        // between, and creates another one.
        if let Some(_lock) = is_draft.then(|| lock_abandoned(&path)).flatten() {
            match std::fs::remove_file(&path) {
                Err(error) if error.kind() != ErrorKind::NotFound => left += 1,
                _ => removed += 1,
            }
        }
    }
    (removed, left)
}

/// Replaces the content of a file. Creates the file and its folder if they do not exist. An existing file keeps its
/// permissions, and a symbolic link stays a link.
pub fn replace(path: &Path, content: &[u8]) -> io::Result<()> {
    let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let folder = folder_of(&path);
    std::fs::create_dir_all(&folder)?;
    let mut file = draft_in(&folder)?;
    if let Ok(found) = path.metadata() {
        file.as_file().set_permissions(found.permissions())?;
    }
    file.write_all(content)?;
    file.as_file().sync_all()?;
    file.persist(&path)?;
    Ok(())
}

/// Flushes the names of new files in a folder, so that the files exist after a power failure.
pub fn sync_folder(folder: &Path) -> io::Result<()> {
    // Windows has no such call. There, the file system flushes the name together with the file.
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}

/// Returns the folder of a path. For a name without a folder, this is `.`.
pub fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// Exclusive access to a file, from reading the file to replacing it. The access ends when the lock is dropped.
#[derive(Debug)]
pub struct FileLock {
    _folder: Option<File>,
}

/// Waits for exclusive access to a file. The function locks the folder of the file, so that no lock file remains. If
/// the folder cannot be locked, as on some network drives, the access is not exclusive.
pub fn lock_file(path: &Path) -> io::Result<FileLock> {
    let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let folder = folder_of(&path);
    std::fs::create_dir_all(&folder)?;
    Ok(FileLock { _folder: lock_folder(&folder) })
}

#[cfg(unix)]
fn lock_folder(folder: &Path) -> Option<File> {
    let folder = File::open(folder).ok()?;
    rustix::fs::flock(&folder, rustix::fs::FlockOperation::LockExclusive).ok()?;
    Some(folder)
}

#[cfg(windows)]
fn lock_folder(folder: &Path) -> Option<File> {
    loop {
        match exclusive::lock_in(folder) {
            Err(error) if error.kind() == ErrorKind::WouldBlock => std::thread::sleep(exclusive::RETRY_PAUSE),
            locked => return locked.ok(),
        }
    }
}

/// Exclusive use of a folder. It ends when the lock is dropped.
#[derive(Debug)]
pub struct FolderLock {
    _folder: Option<File>,
}

/// Locks a folder for this process. If the folder cannot be locked, as on some network drives, every process gets the
/// folder.
///
/// # Errors
/// [`ErrorKind::WouldBlock`] if another process has locked the folder.
#[cfg(unix)]
pub fn claim_folder(folder: &Path) -> io::Result<FolderLock> {
    let file = File::open(folder)?;
    match rustix::fs::flock(&file, rustix::fs::FlockOperation::NonBlockingLockExclusive) {
        Ok(()) => Ok(FolderLock { _folder: Some(file) }),
        Err(error) if io::Error::from(error).kind() == ErrorKind::WouldBlock => Err(ErrorKind::WouldBlock.into()),
        Err(_) => Ok(FolderLock { _folder: None }),
    }
}

/// Locks a folder for this process. If the folder cannot be locked, as on some network drives, every process gets the
/// folder.
///
/// # Errors
/// [`ErrorKind::WouldBlock`] if another process has locked the folder, or the folder does not exist.
#[cfg(windows)]
pub fn claim_folder(folder: &Path) -> io::Result<FolderLock> {
    folder.metadata()?;
    match exclusive::lock_in(folder) {
        Ok(file) => Ok(FolderLock { _folder: Some(file) }),
        Err(error) if error.kind() == ErrorKind::WouldBlock => Err(error),
        Err(_) => Ok(FolderLock { _folder: None }),
    }
}

/// Files that only one process has open. On Windows, this replaces file locks, which also block readers.
#[cfg(windows)]
mod exclusive {
    use std::fs::{File, OpenOptions};
    use std::io::{self, ErrorKind};
    use std::os::windows::fs::OpenOptionsExt as _;
    use std::path::Path;
    use std::time::Duration;

    /// Interval of the attempts to lock a folder.
    pub const RETRY_PAUSE: Duration = Duration::from_millis(5);
    /// Name of the file that locks its folder.
    const LOCK_FILE: &str = ".armctl.lock";
    const FILE_FLAG_DELETE_ON_CLOSE: u32 = 0x0400_0000;
    const ERROR_SHARING_VIOLATION: i32 = 32;

    /// Locks a folder with a file in it. Windows removes the file at the end of the lock, or of the process.
    ///
    /// # Errors
    /// `WouldBlock` if another process has locked the folder.
    pub fn lock_in(folder: &Path) -> io::Result<File> {
        let mut options = OpenOptions::new();
        options.write(true).create(true).truncate(true).share_mode(0).custom_flags(FILE_FLAG_DELETE_ON_CLOSE);
        options.open(folder.join(LOCK_FILE)).map_err(|error| {
            if error.raw_os_error() == Some(ERROR_SHARING_VIOLATION) { ErrorKind::WouldBlock.into() } else { error }
        })
    }

    /// Opens a file that no process has open for writing.
    pub fn open_free(path: &Path) -> io::Result<File> {
        const FILE_SHARE_READ: u32 = 1;
        const FILE_SHARE_DELETE: u32 = 4;

        OpenOptions::new().read(true).share_mode(FILE_SHARE_READ | FILE_SHARE_DELETE).open(path)
    }
}

/// Marks a file that is open for writing as a file of this process, until the file is closed. Returns `false` if another
/// process has marked it.
#[cfg(unix)]
pub fn lock(file: &File) -> bool {
    rustix::fs::flock(file, rustix::fs::FlockOperation::NonBlockingLockExclusive).is_ok()
}

/// Does nothing: a file that is open for writing is a file of its process.
#[cfg(windows)]
pub fn lock(_: &File) -> bool {
    true
}

/// Whether the process that marked a file with [`lock`] has ended. `false` if the file cannot be opened.
pub fn is_abandoned(path: &Path) -> bool {
    lock_abandoned(path).is_some()
}

/// Locks a file whose process has ended, until the returned file is closed. `None` if the process is running, or the
/// file cannot be opened.
#[cfg(unix)]
fn lock_abandoned(path: &Path) -> Option<File> {
    // A shared lock, so that two processes can check at the same time.
    open(path).ok().filter(|file| rustix::fs::flock(file, rustix::fs::FlockOperation::NonBlockingLockShared).is_ok())
}

/// Opens a file whose process has ended. Until the returned file is closed, no process can open it for writing. `None`
/// if the process is running, or the file cannot be opened.
#[cfg(windows)]
fn lock_abandoned(path: &Path) -> Option<File> {
    exclusive::open_free(path).ok()
}

/// Whether an open file still has a name in a folder.
#[cfg(unix)]
fn is_linked(file: &File) -> bool {
    file.metadata().is_ok_and(|found| std::os::unix::fs::MetadataExt::nlink(&found) > 0)
}

/// Always `true`: an open file cannot lose its name.
#[cfg(windows)]
fn is_linked(_: &File) -> bool {
    true
}

/// Formats a size, for example `16 MiB`.
fn size(bytes: u64) -> String {
    match bytes {
        bytes if bytes >= 1 << 20 => format!("{} MiB", bytes >> 20),
        bytes if bytes >= 1 << 10 => format!("{} KiB", bytes >> 10),
        bytes => format!("{bytes} bytes"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_a_file_up_to_its_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        std::fs::write(&path, "12345").unwrap();
        assert_eq!(read(&path, 5).unwrap(), b"12345");
        let error = read(&path, 4).unwrap_err();
        assert_eq!(
            (error.kind(), error.to_string()),
            (ErrorKind::FileTooLarge, "it is larger than 4 bytes".to_owned())
        );
        std::fs::write(&path, b"\xff").unwrap();
        assert_eq!(text(&path, 5).unwrap_err().kind(), ErrorKind::InvalidData);
        assert_eq!(read(folder.path(), 5).unwrap_err().kind(), ErrorKind::IsADirectory);
        assert_eq!(read(&folder.path().join("no"), 5).unwrap_err().kind(), ErrorKind::NotFound);
    }

    #[test]
    fn sweeps_only_drafts_of_dead_processes() {
        let folder = tempfile::tempdir().unwrap();
        let names = || std::fs::read_dir(folder.path()).unwrap().count();
        let living = draft_in(folder.path()).unwrap();
        let kept = [".armctl-mine.txt", "x.armctl-1.part"];
        for name in kept.iter().chain(&[".armctl-dead.part"]) {
            std::fs::write(folder.path().join(name), "half").unwrap();
        }
        assert_eq!(sweep(folder.path()), (1, 0));
        assert_eq!(names(), 3);
        assert!(living.path().exists() && !folder.path().join(".armctl-dead.part").exists());
        drop(living);
        assert_eq!(names(), 2);
    }

    #[cfg(unix)]
    #[test]
    fn a_draft_that_a_sweep_is_removing_cannot_be_locked() {
        let draft = NamedTempFile::new().unwrap();
        let sweeping = lock_abandoned(draft.path()).unwrap();
        assert!(!lock(draft.as_file()));
        drop(sweeping);
        assert!(lock(draft.as_file()) && lock_abandoned(draft.path()).is_none());
    }

    #[test]
    fn a_folder_has_one_user() {
        let folder = tempfile::tempdir().unwrap();
        let lock = claim_folder(folder.path()).unwrap();
        assert_eq!(claim_folder(folder.path()).unwrap_err().kind(), ErrorKind::WouldBlock);
        drop(lock);
        drop(claim_folder(folder.path()).unwrap());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[cfg(unix)]
    #[test]
    fn replace_keeps_permissions_and_link() {
        use std::os::unix::fs::PermissionsExt as _;

        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        std::fs::write(&file, "old").unwrap();
        std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink("file", &link).unwrap();
        replace(&link, b"new").unwrap();
        assert!(link.is_symlink());
        assert_eq!(std::fs::read(&file).unwrap(), b"new");
        assert_eq!(file.metadata().unwrap().permissions().mode() & 0o777, 0o640);
        replace(&folder.path().join("deep/new"), b"new").unwrap();
        assert_eq!(std::fs::read(folder.path().join("deep/new")).unwrap(), b"new");
    }

    #[cfg(unix)]
    #[test]
    fn rejects_devices_pipes_and_sockets() {
        let folder = tempfile::tempdir().unwrap();
        let (link, socket) = (folder.path().join("link"), folder.path().join("socket"));
        std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
        let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        for path in [Path::new("/dev/zero"), Path::new("/dev/null"), &link, &socket] {
            assert_eq!(read(path, 5).unwrap_err().kind(), ErrorKind::Unsupported, "{}", path.display());
        }
    }
}
