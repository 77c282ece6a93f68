//! Replacement for `socket` on systems without private local sockets. Opening a session returns an error.

use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};

use tokio::io::DuplexStream;

/// Read half of a socket.
pub type ReadHalf = DuplexStream;

fn absent<T>() -> io::Result<T> {
    Err(io::Error::new(io::ErrorKind::Unsupported, "sessions need Unix sockets, but this system has none"))
}

/// Write half of a socket. It cannot be created.
#[derive(Debug)]
pub enum WriteHalf {}

impl WriteHalf {
    /// Same as in `socket`.
    pub fn try_write(&self, _bytes: &[u8]) -> io::Result<usize> {
        match *self {}
    }

    /// Same as in `socket`.
    #[expect(clippy::unused_async, reason = "as in the version with a socket")]
    pub async fn writable(&self) -> io::Result<()> {
        match *self {}
    }
}

/// Folder of the sockets.
pub fn folder() -> PathBuf {
    std::env::temp_dir().join("armctl")
}

/// Returns an error: not supported on this system.
pub fn make_private(_folder: &Path) -> io::Result<()> {
    absent()
}

/// Always returns `false`.
pub fn answers(_path: &Path) -> bool {
    false
}

/// Always returns `NotFound`.
pub fn check_private(_path: &Path, _is_folder: bool) -> io::Result<Result<(), &'static str>> {
    Err(io::ErrorKind::NotFound.into())
}

/// A lock file. It cannot be created.
#[derive(Debug)]
pub enum Lock {}

impl Lock {
    /// Returns an error: not supported on this system.
    pub fn take(_path: &Path, _text: &[u8]) -> io::Result<Option<Self>> {
        absent()
    }
}

/// A listener. It cannot be created.
#[derive(Debug)]
pub enum Listener {}

impl Listener {
    /// Returns an error: not supported on this system.
    pub fn bind(_path: &Path) -> io::Result<Self> {
        absent()
    }

    /// Same as in `socket`.
    #[expect(clippy::unused_async, reason = "as in the version with a socket")]
    pub async fn accept(&self) -> io::Result<(ReadHalf, WriteHalf, Option<u32>)> {
        match *self {}
    }
}

/// Always returns `None`.
#[expect(clippy::unused_async, reason = "as in the version with a socket")]
pub async fn connect(_path: &Path) -> io::Result<Option<(ReadHalf, WriteHalf)>> {
    Ok(None)
}

/// A background process. It cannot be created.
#[derive(Debug)]
pub enum Detached {}

/// Returns an error: not supported on this system.
pub fn detach(_arguments: impl Iterator<Item = OsString>, _log: &Path) -> io::Result<Detached> {
    absent()
}

impl Detached {
    /// Process id.
    pub fn pid(&self) -> u32 {
        match *self {}
    }

    /// Next line of the output of the process.
    pub fn line(&mut self) -> io::Result<String> {
        match *self {}
    }
}

/// Does nothing.
pub fn terminate(_pid: u32) {}

/// Returns an error: not supported on this system.
pub fn leave_terminal() -> io::Result<()> {
    absent()
}
