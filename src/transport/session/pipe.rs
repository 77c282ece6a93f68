//! System functions for sessions on Windows: named pipes, lock files, background processes.
//!
//! Each session has its own pipe, with a random name. A file in the profile of the user contains this name. Other users
//! cannot use the session, because:
//! - Windows gives other users no access to the profile folder.
//! - The default access rights of a pipe allow only its owner, administrators and the system to write to it. Another
//!   user can only open the pipe for reading. The host sends nothing to a client that has not sent a Hello, and removes
//!   this client after a few seconds.
//! - The host creates the first instance of its pipe, or fails. A pipe with the same name cannot exist before.
//! - The pipe rejects clients on other computers.
//! - A client connects only while the host holds the file open. After the end of the host, the name is not used again.
//! - The process of the host cannot act in the name of its client (`SECURITY_IDENTIFICATION`).

use std::ffi::OsString;
use std::fs::{DirBuilder, File, OpenOptions};
use std::io::{self, ErrorKind, Write as _};
use std::os::windows::fs::OpenOptionsExt as _;
use std::path::{Path, PathBuf};
use std::pin::Pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll, ready};
use std::thread;
use std::time::{Duration, Instant};

use tokio::io::{AsyncRead, ReadBuf};
use tokio::net::windows::named_pipe::{ClientOptions, NamedPipeClient, NamedPipeServer, ServerOptions};
use tokio::runtime::{Builder, Handle};
use winsafe::{CreateProcess, HPROCESS, STARTUPINFO, co, guard::CloseHandlePiGuard};

use super::command_line::command_line;
use armctl_files as files;

/// Start of the names of all pipes.
const PIPES: &str = r"\\.\pipe\armctl-";
/// Size limit of the file with the name of a pipe.
const MAX_NAME_BYTES: u64 = 200;

/// Rights of other processes while a file is open.
const SHARE_READ: u32 = 1;
const SHARE_DELETE: u32 = 4;
/// Impersonation level: a server may read who its client is, but cannot act in the client's name.
const SECURITY_IDENTIFICATION: u32 = 0x1_0000;

/// Error codes of Windows without a stable `ErrorKind`.
const ERROR_SHARING_VIOLATION: i32 = 32;
const ERROR_PIPE_BUSY: i32 = 231;
const ERROR_NO_DATA: i32 = 232;
const ERROR_PIPE_NOT_CONNECTED: i32 = 233;

/// Time limit for a free instance of a pipe, for a new file, and for the last bytes of a client.
const FREE_WITHIN: Duration = Duration::from_secs(3);
const CREATED_WITHIN: Duration = Duration::from_millis(500);
const LAST_BYTES_WITHIN: Duration = Duration::from_millis(300);
/// Interval of the attempts.
const RETRY_PAUSE: Duration = Duration::from_millis(2);

/// Returns the folder of the files with the names of the pipes, in the profile of the user.
pub fn folder() -> PathBuf {
    let profile = std::env::var_os("LOCALAPPDATA").map(PathBuf::from).filter(|folder| folder.is_absolute());
    profile.unwrap_or_else(std::env::temp_dir).join("armctl").join("sessions")
}

/// Creates a folder. It inherits the access rights of the profile.
pub fn make_private(folder: &Path) -> io::Result<()> {
    DirBuilder::new().recursive(true).create(folder)
}

/// Checks the type of a folder or file. If it has another type, the inner error is the reason.
///
/// # Errors
/// `NotFound` if the folder or file does not exist.
pub fn check_private(path: &Path, is_folder: bool) -> io::Result<Result<(), &'static str>> {
    let found = path.symlink_metadata()?;
    Ok(match is_folder {
        true if !found.is_dir() => Err("it is not a folder"),
        false if !found.is_file() => Err("it is not a file"),
        _ => Ok(()),
    })
}

/// A lock file. One process at a time can open it for writing. The lock ends with the process.
#[derive(Debug)]
pub struct Lock {
    _file: File,
}

impl Lock {
    /// Locks the file, and writes this text into it. `None` if another process has locked it.
    pub fn take(path: &Path, text: &[u8]) -> io::Result<Option<Self>> {
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false).share_mode(SHARE_READ);
        let mut file = match options.open(path) {
            Ok(file) => file,
            Err(error) if has_code(&error, ERROR_SHARING_VIOLATION) => return Ok(None),
            Err(error) => return Err(error),
        };
        file.set_len(0)?;
        file.write_all(text)?;
        Ok(Some(Self { _file: file }))
    }
}

fn has_code(error: &io::Error, code: i32) -> bool {
    error.raw_os_error() == Some(code)
}

/// Returns the name of the pipe of a running host; `None` without a host.
fn pipe_name(path: &Path) -> Option<String> {
    // Without a host, no process has the file open for writing.
    let probe = OpenOptions::new().read(true).share_mode(SHARE_READ | SHARE_DELETE).open(path);
    if !probe.is_err_and(|error| has_code(&error, ERROR_SHARING_VIOLATION)) {
        return None;
    }
    let name = files::text(path, MAX_NAME_BYTES).ok()?;
    let is_own = name.strip_prefix(PIPES).is_some_and(|rest| rest.bytes().all(|byte| byte.is_ascii_hexdigit()));
    is_own.then_some(name)
}

/// Whether a process listens at this location.
pub fn answers(path: &Path) -> bool {
    pipe_name(path).is_some_and(|name| {
        let opened = OpenOptions::new().read(true).write(true).security_qos_flags(SECURITY_IDENTIFICATION).open(name);
        opened.map_or_else(|error| has_code(&error, ERROR_PIPE_BUSY), |_| true)
    })
}

/// Listener that accepts clients.
#[derive(Debug)]
pub struct Listener {
    name: String,
    /// Instance of the pipe for the next client.
    next: NamedPipeServer,
    /// File with the name of the pipe. As long as it is open for writing, the host lives.
    _file: File,
}

impl Listener {
    /// Creates a pipe, and writes its name to a path. The path must not exist yet.
    pub fn bind(path: &Path) -> io::Result<Self> {
        let name = format!("{PIPES}{:016x}{:016x}", fastrand::u64(..), fastrand::u64(..));
        let mut file = create(path)?;
        let next = instance(&name, true)?;
        file.write_all(name.as_bytes())?;
        Ok(Self { name, next, _file: file })
    }

    /// Waits for the next client. Windows reports the process id of a client only to unsafe code, so the id comes from
    /// the Hello. Cancel safe.
    pub async fn accept(&mut self) -> io::Result<(ReadHalf, WriteHalf, Option<u32>)> {
        let connected = self.next.connect().await;
        // The next instance exists before this client is served, so that a second client finds it.
        match connected.and_then(|()| instance(&self.name, false)) {
            Ok(next) => {
                let (read, write) = halves(Pipe::Server(std::mem::replace(&mut self.next, next)));
                Ok((read, write, None))
            }
            Err(error) => {
                // The same instance waits for another client. An error is ignored: there is no client.
                let _ = self.next.disconnect();
                Err(error)
            }
        }
    }
}

/// Creates a file that only this process can write.
fn create(path: &Path) -> io::Result<File> {
    let deadline = Instant::now() + CREATED_WITHIN;
    loop {
        let mut options = OpenOptions::new();
        options.write(true).create_new(true).share_mode(SHARE_READ | SHARE_DELETE);
        match options.open(path) {
            // An earlier file of this name is still being deleted, because another process has it open.
            Err(error) if error.kind() != ErrorKind::NotFound && Instant::now() < deadline => {
                thread::sleep(RETRY_PAUSE)
            }
            opened => return opened,
        }
    }
}

fn instance(name: &str, is_first: bool) -> io::Result<NamedPipeServer> {
    let runtime = pipe_runtime()?;
    let _context = runtime.enter();
    ServerOptions::new().first_pipe_instance(is_first).reject_remote_clients(true).create(name)
}

/// Returns the runtime of all pipes, which has its own thread. A write is completed by the runtime of its pipe. A client
/// that ends writes its last frame after its own runtime has stopped.
fn pipe_runtime() -> io::Result<Handle> {
    static RUNTIME: Mutex<Option<Handle>> = Mutex::new(None);

    let mut started = RUNTIME.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(handle) = &*started {
        return Ok(handle.clone());
    }
    let runtime = Builder::new_current_thread().enable_io().build()?;
    let handle = runtime.handle().clone();
    thread::Builder::new().name("pipes".to_owned()).spawn(move || runtime.block_on(std::future::pending::<()>()))?;
    Ok(started.insert(handle).clone())
}

/// Connects to the pipe of a host; `None` if no process listens there.
pub async fn connect(path: &Path) -> io::Result<Option<(ReadHalf, WriteHalf)>> {
    let deadline = Instant::now() + FREE_WITHIN;
    loop {
        let Some(name) = pipe_name(path) else { return Ok(None) };
        match open(&name) {
            Ok(client) => return Ok(Some(halves(Pipe::Client(client)))),
            // The host creates the instance for the next client.
            Err(error) if has_code(&error, ERROR_PIPE_BUSY) && Instant::now() < deadline => {}
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(error),
        }
        tokio::time::sleep(RETRY_PAUSE).await;
    }
}

fn open(name: &str) -> io::Result<NamedPipeClient> {
    let runtime = pipe_runtime()?;
    let _context = runtime.enter();
    ClientOptions::new().security_qos_flags(SECURITY_IDENTIFICATION).open(name)
}

/// One end of a connection.
#[derive(Debug)]
enum Pipe {
    Server(NamedPipeServer),
    Client(NamedPipeClient),
}

impl Pipe {
    fn poll_read_ready(&self, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        match self {
            Self::Server(pipe) => pipe.poll_read_ready(context),
            Self::Client(pipe) => pipe.poll_read_ready(context),
        }
    }

    fn try_read(&self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Server(pipe) => pipe.try_read(buffer),
            Self::Client(pipe) => pipe.try_read(buffer),
        }
    }
}

fn halves(pipe: Pipe) -> (ReadHalf, WriteHalf) {
    let pipe = Arc::new(pipe);
    (ReadHalf(Arc::clone(&pipe)), WriteHalf(pipe))
}

/// Read half of a connection.
#[derive(Debug)]
pub struct ReadHalf(Arc<Pipe>);

impl AsyncRead for ReadHalf {
    fn poll_read(self: Pin<&mut Self>, context: &mut Context<'_>, buffer: &mut ReadBuf<'_>) -> Poll<io::Result<()>> {
        loop {
            ready!(self.0.poll_read_ready(context))?;
            return Poll::Ready(match self.0.try_read(buffer.initialize_unfilled()) {
                Ok(length) => {
                    buffer.advance(length);
                    Ok(())
                }
                Err(error) if error.kind() == ErrorKind::WouldBlock => continue,
                // The other end is closed.
                Err(error)
                    if error.kind() == ErrorKind::BrokenPipe
                        || has_code(&error, ERROR_NO_DATA)
                        || has_code(&error, ERROR_PIPE_NOT_CONNECTED) =>
                {
                    Ok(())
                }
                Err(error) => Err(error),
            });
        }
    }
}

/// Write half of a connection.
#[derive(Debug)]
pub struct WriteHalf(Arc<Pipe>);

impl WriteHalf {
    /// Writes as many bytes as the pipe accepts now. The pipe accepts no bytes until the previous write is complete.
    ///
    /// # Errors
    /// `WouldBlock` if the pipe accepts no bytes now.
    pub fn try_write(&self, bytes: &[u8]) -> io::Result<usize> {
        match &*self.0 {
            Pipe::Server(pipe) => pipe.try_write(bytes),
            Pipe::Client(pipe) => pipe.try_write(bytes),
        }
    }

    /// Waits until the pipe accepts bytes, or is closed.
    pub async fn writable(&self) -> io::Result<()> {
        match &*self.0 {
            Pipe::Server(pipe) => pipe.writable().await,
            Pipe::Client(pipe) => pipe.writable().await,
        }
    }
}

/// Writes the last bytes of a client. Waits a short time, because the previous write may not be complete.
pub fn write_last(to: &WriteHalf, bytes: &[u8]) {
    let deadline = Instant::now() + LAST_BYTES_WITHIN;
    let mut rest = bytes;
    while !rest.is_empty() && Instant::now() < deadline {
        match to.try_write(rest) {
            Ok(written) => rest = &rest[written..],
            Err(error) if error.kind() == ErrorKind::WouldBlock => thread::sleep(RETRY_PAUSE),
            // The host is gone.
            Err(_) => return,
        }
    }
}

/// A background process of this program.
pub struct Detached {
    process: CloseHandlePiGuard,
    /// File for the start message of the process.
    start: PathBuf,
}

impl std::fmt::Debug for Detached {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Detached").field("start", &self.start).finish_non_exhaustive()
    }
}

/// Starts this program in the background with other arguments, without a window. The process inherits no handles.
/// Otherwise a program that reads the output of this process would wait for the end of the background process. The
/// process itself writes its log file.
pub fn detach(arguments: impl Iterator<Item = OsString>, _log: &Path) -> io::Result<Detached> {
    let program = crate::this_program()?;
    let program = program.to_str().ok_or_else(|| not_unicode(program.as_os_str()))?;
    let arguments: Vec<String> =
        arguments.map(|word| word.into_string().map_err(|word| not_unicode(&word))).collect::<io::Result<_>>()?;
    // The program takes its subcommand from its name, but these arguments contain the subcommand.
    let line = command_line("armctl", &arguments);
    let flags = co::CREATE::NO_WINDOW | co::CREATE::NEW_PROCESS_GROUP;
    let mut startup = STARTUPINFO::default();
    let process = CreateProcess(Some(program), Some(&line), None, None, false, flags, &[], None, &mut startup)
        .map_err(os_error)?;
    let start = start_file_of(process.dwProcessId);
    // An earlier process with the same id may have left its message.
    let _ = std::fs::remove_file(&start);
    Ok(Detached { process, start })
}

fn not_unicode(word: &std::ffi::OsStr) -> io::Error {
    io::Error::new(ErrorKind::InvalidInput, format!("{} is not valid Unicode", word.display()))
}

fn os_error(error: co::ERROR) -> io::Error {
    io::Error::from_raw_os_error(i32::try_from(error.raw()).unwrap_or_default())
}

fn start_file_of(pid: u32) -> PathBuf {
    folder().join(format!("{pid}.start"))
}

/// File to which this background process writes its start message.
pub fn start_file() -> Option<PathBuf> {
    Some(start_file_of(std::process::id()))
}

/// Interval of the checks for the start message.
const START_POLL_MS: u32 = 10;

impl Detached {
    /// Process id.
    pub fn pid(&self) -> u32 {
        self.process.dwProcessId
    }

    /// Waits for the start message of the process. The message is empty if the process has ended without it.
    pub fn line(&mut self) -> io::Result<String> {
        loop {
            let has_ended = self.process.hProcess.WaitForSingleObject(Some(START_POLL_MS)).map_err(os_error)?;
            match files::text(&self.start, files::SETTINGS) {
                Ok(line) => {
                    // An error is ignored: the file does no harm.
                    let _ = std::fs::remove_file(&self.start);
                    return Ok(line);
                }
                Err(_) if has_ended == co::WAIT::OBJECT_0 => return Ok(String::new()),
                Err(error) if error.kind() == ErrorKind::NotFound || has_code(&error, ERROR_SHARING_VIOLATION) => {}
                Err(error) => return Err(error),
            }
        }
    }
}

/// Ends a process. Returns whether the process existed.
pub fn terminate(pid: u32) -> bool {
    let process = HPROCESS::OpenProcess(co::PROCESS::TERMINATE, false, pid);
    process.is_ok_and(|process| process.TerminateProcess(1).is_ok())
}

/// Does nothing: the process was started without a console window.
pub fn leave_terminal() -> io::Result<()> {
    Ok(())
}
