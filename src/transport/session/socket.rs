//! What of sessions is the system's: a socket of this user's alone, a lock, a process without a terminal.

use std::fs::{DirBuilder, File, OpenOptions, Permissions};
use std::io::{self, BufRead as _, BufReader};
use std::os::unix::fs::{
    DirBuilderExt as _, FileTypeExt as _, MetadataExt as _, OpenOptionsExt as _, PermissionsExt as _,
};
use std::path::{Path, PathBuf};
use std::process::{ChildStdout, Command, Stdio};

use rustix::fs::{FlockOperation, flock};
use rustix::process::{Pid, Signal, geteuid, kill_process, setsid};
use tokio::net::{UnixListener, UnixStream, unix};

/// The half that is read from.
pub type ReadHalf = unix::OwnedReadHalf;
/// The half that is written to.
pub type WriteHalf = unix::OwnedWriteHalf;

/// Where sockets are: the user's runtime folder, or a folder of his own beside the temporary files.
pub fn folder() -> PathBuf {
    let runtime = std::env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from);
    match runtime.filter(|folder| folder.is_absolute() && folder.is_dir()) {
        Some(folder) => folder.join("armctl"),
        None => std::env::temp_dir().join(format!("armctl-{}", geteuid().as_raw())),
    }
}

/// Makes a folder for this user alone, unless it is there.
pub fn make_private(folder: &Path) -> io::Result<()> {
    match DirBuilder::new().mode(0o700).create(folder) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(()),
        made => made,
    }
}

/// Whether what is there is this user's alone: a folder, or a socket. What is wrong with it otherwise.
///
/// # Errors
/// `NotFound` if nothing is there.
pub fn check_private(path: &Path, is_folder: bool) -> io::Result<Result<(), &'static str>> {
    let found = path.symlink_metadata()?;
    let fits = if is_folder { found.is_dir() } else { found.file_type().is_socket() };
    Ok(if !fits {
        Err(if is_folder { "it is not a folder" } else { "it is not a socket" })
    } else if found.uid() != geteuid().as_raw() {
        Err("it is another user's")
    } else if found.mode() & 0o077 != 0 {
        Err("other users may use it")
    } else {
        Ok(())
    })
}

/// A file that one process at a time has; the lock goes with the process.
#[derive(Debug)]
pub struct Lock {
    _file: File,
}

impl Lock {
    /// Takes the lock, and puts this text into the file; `None` if another process has it.
    pub fn take(path: &Path, text: &[u8]) -> io::Result<Option<Self>> {
        use io::{Seek as _, Write as _};

        let mut file = OpenOptions::new().read(true).write(true).create(true).truncate(false).mode(0o600).open(path)?;
        match flock(&file, FlockOperation::NonBlockingLockExclusive) {
            Ok(()) => {}
            Err(error) if error == rustix::io::Errno::WOULDBLOCK => return Ok(None),
            Err(error) => return Err(error.into()),
        }
        file.set_len(0)?;
        file.rewind()?;
        file.write_all(text)?;
        Ok(Some(Self { _file: file }))
    }
}

/// Whether somebody listens there.
pub fn answers(path: &Path) -> bool {
    std::os::unix::net::UnixStream::connect(path).is_ok()
}

/// Where clients come in.
#[derive(Debug)]
pub struct Listener(UnixListener);

impl Listener {
    /// Listens on a path where nothing is.
    pub fn bind(path: &Path) -> io::Result<Self> {
        let listener = UnixListener::bind(path)?;
        std::fs::set_permissions(path, Permissions::from_mode(0o600))?;
        Ok(Self(listener))
    }

    /// The next client of this user's, with the number of its process where the system tells. The future may be dropped.
    pub async fn accept(&self) -> io::Result<(ReadHalf, WriteHalf, Option<u32>)> {
        loop {
            let (stream, _) = self.0.accept().await?;
            // Someone who is gone already needs no answer.
            let Ok(peer) = stream.peer_cred() else { continue };
            if peer.uid() == geteuid().as_raw() {
                let (read, write) = stream.into_split();
                return Ok((read, write, peer.pid().and_then(|pid| u32::try_from(pid).ok())));
            }
        }
    }
}

/// Connects to a socket; `None` if nobody listens there any more.
pub async fn connect(path: &Path) -> io::Result<Option<(ReadHalf, WriteHalf)>> {
    match UnixStream::connect(path).await {
        Ok(stream) => Ok(Some(stream.into_split())),
        Err(error) if matches!(error.kind(), io::ErrorKind::ConnectionRefused | io::ErrorKind::NotFound) => Ok(None),
        Err(error) => Err(error),
    }
}

/// This program again, in the background.
#[derive(Debug)]
pub struct Detached {
    pid: u32,
    stdout: BufReader<ChildStdout>,
}

/// Starts this program again with other arguments; what it says on stderr goes to the end of a file of this user's alone.
pub fn detach(arguments: impl Iterator<Item = std::ffi::OsString>, log: &Path) -> io::Result<Detached> {
    let log = OpenOptions::new().append(true).create(true).mode(0o600).open(log)?;
    let mut child = Command::new(crate::this_program()?)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(log)
        .spawn()?;
    let stdout = child.stdout.take().ok_or_else(|| io::Error::other("there is no pipe"))?;
    Ok(Detached { pid: child.id(), stdout: BufReader::new(stdout) })
}

impl Detached {
    /// The process.
    pub fn pid(&self) -> u32 {
        self.pid
    }

    /// Waits for the next line that it prints; empty at its end.
    pub fn line(&mut self) -> io::Result<String> {
        let mut line = String::new();
        self.stdout.read_line(&mut line)?;
        Ok(line)
    }
}

/// Asks a process to end.
pub fn terminate(pid: u32) {
    // One that has ended already is as good.
    if let Some(pid) = i32::try_from(pid).ok().and_then(Pid::from_raw) {
        let _ = kill_process(pid, Signal::TERM);
    }
}

/// Leaves the terminal and everybody who is asked to end with it.
pub fn leave_terminal() -> io::Result<()> {
    setsid().map(|_| ()).map_err(io::Error::from)
}
