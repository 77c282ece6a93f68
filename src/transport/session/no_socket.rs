//! Sessions where the system has no sockets of a user's alone: there are none, and to open one fails with that reason.

use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};

use tokio::io::DuplexStream;

/// The half that is read from.
pub type ReadHalf = DuplexStream;

fn absent<T>() -> io::Result<T> {
    Err(io::Error::new(io::ErrorKind::Unsupported, "sessions need Unix sockets, which this system has not"))
}

/// The half that is written to; there is none.
#[derive(Debug)]
pub enum WriteHalf {}

impl WriteHalf {
    /// As of a socket.
    pub fn try_write(&self, _bytes: &[u8]) -> io::Result<usize> {
        match *self {}
    }

    /// As of a socket.
    #[expect(clippy::unused_async, reason = "as of a socket")]
    pub async fn writable(&self) -> io::Result<()> {
        match *self {}
    }
}

/// Where sockets would be.
pub fn folder() -> PathBuf {
    std::env::temp_dir().join("armctl")
}

/// Says that there are no sessions.
pub fn make_private(_folder: &Path) -> io::Result<()> {
    absent()
}

/// There are no sockets.
pub fn answers(_path: &Path) -> bool {
    false
}

/// Nothing is there.
pub fn check_private(_path: &Path, _is_folder: bool) -> io::Result<Result<(), &'static str>> {
    Err(io::ErrorKind::NotFound.into())
}

/// A file that one process at a time would have.
#[derive(Debug)]
pub enum Lock {}

impl Lock {
    /// Says that there are no sessions.
    pub fn take(_path: &Path, _text: &[u8]) -> io::Result<Option<Self>> {
        absent()
    }
}

/// Where clients would come in.
#[derive(Debug)]
pub enum Listener {}

impl Listener {
    /// Says that there are no sessions.
    pub fn bind(_path: &Path) -> io::Result<Self> {
        absent()
    }

    /// Nobody comes.
    #[expect(clippy::unused_async, reason = "as of a socket")]
    pub async fn accept(&self) -> io::Result<(ReadHalf, WriteHalf, Option<u32>)> {
        match *self {}
    }
}

/// Nobody listens.
#[expect(clippy::unused_async, reason = "as of a socket")]
pub async fn connect(_path: &Path) -> io::Result<Option<(ReadHalf, WriteHalf)>> {
    Ok(None)
}

/// This program again, in the background; never.
#[derive(Debug)]
pub enum Detached {}

/// Says that there are no sessions.
pub fn detach(_arguments: impl Iterator<Item = OsString>, _log: &Path) -> io::Result<Detached> {
    absent()
}

impl Detached {
    /// The process.
    pub fn pid(&self) -> u32 {
        match *self {}
    }

    /// What it would print.
    pub fn line(&mut self) -> io::Result<String> {
        match *self {}
    }
}

/// There is no such process.
pub fn terminate(_pid: u32) {}

/// Says that there are no sessions.
pub fn leave_terminal() -> io::Result<()> {
    absent()
}
