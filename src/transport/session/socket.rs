//! System functions for sessions: private sockets, lock files, background processes.

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

/// Read half of a socket.
pub type ReadHalf = unix::OwnedReadHalf;
/// Write half of a socket.
pub type WriteHalf = unix::OwnedWriteHalf;

/// Returns the folder of the sockets. It is in the runtime folder of the user, or a private folder in the temporary
/// folder.
pub fn folder() -> PathBuf {
    let runtime = std::env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from);
    match runtime.filter(|folder| folder.is_absolute() && folder.is_dir()) {
        Some(folder) => folder.join("armctl"),
        None => std::env::temp_dir().join(format!("armctl-{}", geteuid().as_raw())),
    }
}

/// Creates a private folder. Has no effect if the folder exists.
pub fn make_private(folder: &Path) -> io::Result<()> {
    match DirBuilder::new().mode(0o700).create(folder) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(()),
        made => made,
    }
}

/// Checks that a folder or socket is private to this user. If it is not private, the inner error is the reason.
///
/// # Errors
/// `NotFound` if the folder or socket does not exist.
pub fn check_private(path: &Path, is_folder: bool) -> io::Result<Result<(), &'static str>> {
    let found = path.symlink_metadata()?;
    let fits = if is_folder { found.is_dir() } else { found.file_type().is_socket() };
    Ok(if !fits {
        Err(if is_folder { "it is not a folder" } else { "it is not a socket" })
    } else if found.uid() != geteuid().as_raw() {
        Err("it belongs to another user")
    } else if found.mode() & 0o077 != 0 {
        Err("other users have access to it")
    } else {
        Ok(())
    })
}

/// A lock file. Only one process at a time can lock it. The lock ends when the process ends.
#[derive(Debug)]
pub struct Lock {
    _file: File,
}

impl Lock {
    /// Locks the file, and writes `text` into it. Returns `None` if another process has locked it.
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

/// Whether a process listens on the socket.
pub fn answers(path: &Path) -> bool {
    std::os::unix::net::UnixStream::connect(path).is_ok()
}

/// Listener that accepts clients.
#[derive(Debug)]
pub struct Listener(UnixListener);

impl Listener {
    /// Listens on a path. The path must not exist yet.
    pub fn bind(path: &Path) -> io::Result<Self> {
        let listener = UnixListener::bind(path)?;
        std::fs::set_permissions(path, Permissions::from_mode(0o600))?;
        Ok(Self(listener))
    }

    /// Waits for the next client of the same user. Returns the socket, and the process id of the client if the system
    /// reports it. The future is cancel safe.
    pub async fn accept(&mut self) -> io::Result<(ReadHalf, WriteHalf, Option<u32>)> {
        loop {
            let (stream, _) = self.0.accept().await?;
            // An error means that the client has already disconnected.
            let Ok(peer) = stream.peer_cred() else { continue };
            if peer.uid() == geteuid().as_raw() {
                let (read, write) = stream.into_split();
                return Ok((read, write, peer.pid().and_then(|pid| u32::try_from(pid).ok())));
            }
        }
    }
}

/// Connects to a socket; `None` if no process listens there.
pub async fn connect(path: &Path) -> io::Result<Option<(ReadHalf, WriteHalf)>> {
    match UnixStream::connect(path).await {
        Ok(stream) => Ok(Some(stream.into_split())),
        Err(error) if matches!(error.kind(), io::ErrorKind::ConnectionRefused | io::ErrorKind::NotFound) => Ok(None),
        Err(error) => Err(error),
    }
}

/// Writes the last bytes of a client.
pub fn write_last(to: &WriteHalf, bytes: &[u8]) {
    // An error is ignored: the host is gone.
    let _ = to.try_write(bytes);
}

/// A background process of this program.
#[derive(Debug)]
pub struct Detached {
    pid: u32,
    stdout: BufReader<ChildStdout>,
}

/// Starts this program in the background with other arguments. The stderr of the process is appended to a private log
/// file.
pub fn detach(arguments: impl Iterator<Item = std::ffi::OsString>, log: &Path) -> io::Result<Detached> {
    let log = OpenOptions::new().append(true).create(true).mode(0o600).open(log)?;
    let mut child = Command::new(crate::this_program()?)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(log)
        .spawn()?;
    let stdout = child.stdout.take().ok_or_else(|| io::Error::other("no pipe"))?;
    Ok(Detached { pid: child.id(), stdout: BufReader::new(stdout) })
}

impl Detached {
    /// Process id.
    pub fn pid(&self) -> u32 {
        self.pid
    }

    /// Waits for the next line of the output of the process. The line is empty at the end of the output.
    pub fn line(&mut self) -> io::Result<String> {
        let mut line = String::new();
        self.stdout.read_line(&mut line)?;
        Ok(line)
    }
}

/// File to which this background process writes its start message. `None`: it writes the message to stdout.
pub fn start_file() -> Option<PathBuf> {
    None
}

/// Ends a process. Returns whether the process existed.
pub fn terminate(pid: u32) -> bool {
    let pid = i32::try_from(pid).ok().and_then(Pid::from_raw);
    pid.is_some_and(|pid| kill_process(pid, Signal::TERM).is_ok())
}

/// Starts a new session of the operating system. This detaches the process from its terminal and its process group.
pub fn leave_terminal() -> io::Result<()> {
    setsid().map(|_| ()).map_err(io::Error::from)
}
