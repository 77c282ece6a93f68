//! The one way to read local files: only regular ones, and never more than there is room for. A device or a pipe may be
//! endless, or never say anything; a file that is too large is none that was meant.

use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Room for settings and lists that people write: inventories, files of commands, states of simulators.
pub const SETTINGS: u64 = 16 << 20;

/// Opens a regular file to be read.
///
/// # Errors
/// `IsADirectory` for a folder, `Unsupported` for anything else that is no regular file.
pub fn open(path: &Path) -> io::Result<File> {
    // Looked at before: to open a device or a pipe may already do something, or wait.
    regular(&path.metadata()?)?;
    let file = waiting_for_nobody(path)?;
    // What is at a path may have become something else since.
    regular(&file.metadata()?)?;
    Ok(file)
}

/// The bytes of a regular file of at most so many.
///
/// # Errors
/// As [`open`]; `FileTooLarge` if there are more.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    bounded(open(path)?, most)
}

/// The text of a regular file of at most so many bytes.
///
/// # Errors
/// As [`read`]; `InvalidData` if it is not UTF-8.
pub fn text(path: &Path, most: u64) -> io::Result<String> {
    String::from_utf8(read(path, most)?).map_err(|_| io::Error::new(ErrorKind::InvalidData, "this is not UTF-8"))
}

/// What stands on stdin, whatever that is, up to so many bytes.
///
/// # Errors
/// `FileTooLarge` if there are more.
pub fn stdin(most: u64) -> io::Result<Vec<u8>> {
    bounded(io::stdin().lock(), most)
}

fn bounded(from: impl Read, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if u64::try_from(bytes.len()).unwrap_or(u64::MAX) > most {
        return Err(io::Error::new(ErrorKind::FileTooLarge, format!("it is larger than {}", size(most))));
    }
    Ok(bytes)
}

fn regular(found: &std::fs::Metadata) -> io::Result<()> {
    match found.file_type() {
        kind if kind.is_file() => Ok(()),
        kind if kind.is_dir() => Err(ErrorKind::IsADirectory.into()),
        _ => Err(io::Error::new(ErrorKind::Unsupported, "it is not a regular file")),
    }
}

/// Opens a path; should it have become a pipe meanwhile, without waiting for its other end.
#[cfg(unix)]
fn waiting_for_nobody(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt as _;

    let flags = i32::try_from(rustix::fs::OFlags::NONBLOCK.bits()).unwrap_or_default();
    std::fs::OpenOptions::new().read(true).custom_flags(flags).open(path)
}

#[cfg(not(unix))]
fn waiting_for_nobody(path: &Path) -> io::Result<File> {
    File::open(path)
}

/// `16 MiB`.
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
    fn a_file_is_read_up_to_its_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        std::fs::write(&path, "12345").unwrap();
        assert_eq!(read(&path, 5).unwrap(), b"12345");
        let error = read(&path, 4).unwrap_err();
        assert_eq!((error.kind(), error.to_string()), (ErrorKind::FileTooLarge, "it is larger than 4 bytes".to_owned()));
        std::fs::write(&path, b"\xff").unwrap();
        assert_eq!(text(&path, 5).unwrap_err().kind(), ErrorKind::InvalidData);
        assert_eq!(read(folder.path(), 5).unwrap_err().kind(), ErrorKind::IsADirectory);
        assert_eq!(read(&folder.path().join("no"), 5).unwrap_err().kind(), ErrorKind::NotFound);
    }

    #[cfg(unix)]
    #[test]
    fn devices_pipes_and_sockets_are_no_files() {
        let folder = tempfile::tempdir().unwrap();
        let (link, socket) = (folder.path().join("link"), folder.path().join("socket"));
        std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
        let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        for path in [Path::new("/dev/zero"), Path::new("/dev/null"), &link, &socket] {
            assert_eq!(read(path, 5).unwrap_err().kind(), ErrorKind::Unsupported, "{}", path.display());
        }
    }
}
