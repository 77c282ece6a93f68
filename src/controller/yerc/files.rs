//! File services: names, lists, and transfer frames (FS and DX 3.4, 3.2.3 to 3.2.6).

use crate::refuse_if;
use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use super::request::Request;
use super::table::{BATCH_BACKUP_PATH, service};
use super::wire::{Division, MAX_DATA, RequestFrame};

/// Maximum length in bytes of a job name, without `.JBI`.
pub const MAX_JOB_NAME: usize = 32;

/// Types of files on a controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FileType {
    /// Jobs.
    Jbi,
    /// Data: tools, variables, user coordinates.
    Dat,
    /// Conditions.
    Cnd,
    /// Parameters.
    Prm,
    /// System data.
    Sys,
    /// Lists, for example the I/O ladder.
    Lst,
}

impl FileType {
    /// All types, in the order of the manual.
    pub const ALL: [Self; 6] = [Self::Jbi, Self::Dat, Self::Cnd, Self::Prm, Self::Sys, Self::Lst];

    /// Extension without the point.
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Jbi => "JBI",
            Self::Dat => "DAT",
            Self::Cnd => "CND",
            Self::Prm => "PRM",
            Self::Sys => "SYS",
            Self::Lst => "LST",
        }
    }

    /// Filter of a list request, for example `*.JBI`.
    pub fn filter(self) -> String {
        format!("*.{}", self.extension())
    }

    /// Type of a file name, by its extension.
    pub fn from_name(name: &[u8]) -> Option<Self> {
        let point = name.iter().rposition(|&byte| byte == b'.')?;
        Self::ALL.into_iter().find(|kind| name[point + 1..].eq_ignore_ascii_case(kind.extension().as_bytes()))
    }
}

impl FromStr for FileType {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|kind| kind.extension().eq_ignore_ascii_case(text))
            .ok_or_else(|| format!("unknown file type '{text}'; known: jbi, dat, cnd, prm, sys and lst"))
    }
}

impl fmt::Display for FileType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.extension())
    }
}

/// Why a file name or filter is invalid.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum FileNameError {
    /// The name is empty, or has only an extension.
    #[error("the file name is empty")]
    Empty,
    /// The name is longer than the data of a frame.
    #[error("the file name has {len} bytes; a frame can have at most {MAX_DATA}")]
    TooLong {
        /// Length in bytes.
        len: usize,
    },
    /// The name contains a NUL. Names are sent without a NUL, and controllers refuse a name with a NUL (added status
    /// E49D).
    #[error("the file name '{name}' contains a NUL byte")]
    Nul {
        /// The name, escaped.
        name: String,
    },
    /// The name is a path, but controllers have no folders.
    #[error("the file name '{name}' contains a path separator")]
    Separator {
        /// The name, escaped.
        name: String,
    },
    /// The name contains a control character. CR or LF would split a list of names. The other control characters cannot
    /// be typed on a pendant.
    #[error("the file name '{name}' contains a control character")]
    Control {
        /// The name, escaped.
        name: String,
    },
    /// The name has no extension.
    #[error("the file name '{name}' needs an extension, for example TESTJOB.JBI")]
    Extension {
        /// The name, escaped.
        name: String,
    },
    /// The extension is not one of the six extensions of files that a client can send.
    #[error("the file name '{name}' must have the extension JBI, DAT, CND, PRM, SYS or LST to be sent")]
    Type {
        /// The name, escaped.
        name: String,
    },
    /// The job name is longer than 32 bytes.
    #[error("the job name '{name}' has {len} bytes in the controller's encoding; it can have at most {MAX_JOB_NAME}")]
    JobName {
        /// The name, escaped.
        name: String,
        /// Length in bytes without extension.
        len: usize,
    },
    /// The filter is not in the manual.
    #[error("unknown filter '{filter}'; known: none, *.*, *.JBI, *.DAT, *.CND, *.PRM, *.SYS, *.LST")]
    Filter {
        /// The filter, escaped.
        filter: String,
    },
}

/// The name of a file on a controller, in the controller's encoding.
#[derive(Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileName(Vec<u8>);

impl FileName {
    /// Checks a name and creates the file name.
    pub fn new(name: impl Into<Vec<u8>>) -> Result<Self, FileNameError> {
        let name = name.into();
        if name == BATCH_BACKUP_PATH {
            return Err(FileNameError::Separator { name: name.escape_ascii().to_string() });
        }
        check_name(&name)?;
        Ok(Self(name))
    }

    /// Bytes of the name as sent.
    pub fn as_bytes(&self) -> &[u8] {
        &self.0
    }

    /// Type by extension; `None` if the extension is not in the manuals.
    pub fn file_type(&self) -> Option<FileType> {
        FileType::from_name(&self.0)
    }

    /// Checks the additional rules for a file that is sent to the controller.
    pub fn check_load(&self) -> Result<(), FileNameError> {
        check_load_name(&self.0)
    }

    /// Request that deletes the file.
    pub fn delete(&self) -> Request {
        Request::file(service::DELETE, self.0.clone())
    }

    /// Request that starts sending the file to the controller.
    pub fn load(&self) -> Request {
        Request::file(service::LOAD, self.0.clone())
    }

    /// Request that starts fetching the file from the controller.
    pub fn save(&self) -> Request {
        Request::file(service::SAVE, self.0.clone())
    }
}

impl fmt::Debug for FileName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\"{}\"", self.0.escape_ascii())
    }
}

/// Request for the names of all files of one type.
pub fn list(kind: FileType) -> Request {
    Request::file(service::LIST, kind.filter())
}

/// Request for the names that match a filter of the manuals. An empty filter is allowed; the controller decides what it
/// means.
pub fn list_by(filter: &str) -> Result<Request, FileNameError> {
    check_filter(filter.as_bytes())?;
    Ok(Request::file(service::LIST, filter))
}

/// Request that creates the batch backup, which takes about ten minutes. The same request also fetches the created
/// backup.
pub fn batch_backup() -> Request {
    Request::file(service::SAVE, BATCH_BACKUP_PATH)
}

/// A file block to the controller: a frame with the ACK flag and with data.
///
/// # Panics
/// If `data` is longer than 479 bytes.
pub fn data_frame(id: u8, block: u32, data: &[u8]) -> Vec<u8> {
    transfer_frame(id, service::LOAD, block, data)
}

/// A frame that acknowledges a block from the controller. `block` is the received number with its last-block bit.
pub fn ack_frame(id: u8, service: u8, block: u32) -> Vec<u8> {
    transfer_frame(id, service, block, &[])
}

fn transfer_frame(id: u8, service: u8, block: u32, data: &[u8]) -> Vec<u8> {
    RequestFrame {
        division: Division::File,
        ack: true,
        id,
        block,
        command: 0,
        instance: 0,
        attribute: 0,
        service,
        data,
    }
    .emit()
}

/// A line of a list that is longer than any name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("line {line} of the list has {len} bytes; a frame can have at most {MAX_DATA}")]
pub struct ListError {
    /// Line number, from 1.
    pub line: usize,
    /// Length in bytes.
    pub len: usize,
}

/// Splits the data of a list into names. In the manuals, each name ends with CR LF. A single CR or LF, NULs and
/// trailing blanks also separate names. None of these bytes can be part of a multi-byte character.
pub fn split_list(data: &[u8]) -> Result<Vec<&[u8]>, ListError> {
    let lines = data.split(|byte| matches!(byte, b'\r' | b'\n' | 0)).map(<[u8]>::trim_ascii_end);
    let mut names = Vec::new();
    for name in lines.filter(|line| !line.is_empty()) {
        refuse_if(name.len() > MAX_DATA, ListError { line: names.len() + 1, len: name.len() })?;
        names.push(name);
    }
    Ok(names)
}

/// Checks the rules for names in requests. The path of the batch backup is also allowed.
pub fn check_name(name: &[u8]) -> Result<(), FileNameError> {
    if name == BATCH_BACKUP_PATH {
        return Ok(());
    }
    refuse_if(name.len() > MAX_DATA, FileNameError::TooLong { len: name.len() })?;
    let shown = || name.escape_ascii().to_string();
    if name.contains(&0) {
        return Err(FileNameError::Nul { name: shown() });
    }
    if has_separator(name) {
        return Err(FileNameError::Separator { name: shown() });
    }
    if name.iter().any(u8::is_ascii_control) {
        return Err(FileNameError::Control { name: shown() });
    }
    let stem = stem_len(name);
    refuse_if(stem == 0, FileNameError::Empty)?;
    if stem + 1 >= name.len() { Err(FileNameError::Extension { name: shown() }) } else { Ok(()) }
}

/// Checks the rules for a file to be sent: [`check_name`], an extension of the manuals, and the maximum length of a job
/// name.
pub fn check_load_name(name: &[u8]) -> Result<(), FileNameError> {
    check_name(name)?;
    let stem = stem_len(name);
    match FileType::from_name(name) {
        None => Err(FileNameError::Type { name: name.escape_ascii().to_string() }),
        Some(FileType::Jbi) if stem > MAX_JOB_NAME => {
            Err(FileNameError::JobName { name: name[..stem].escape_ascii().to_string(), len: stem })
        }
        Some(_) => Ok(()),
    }
}

/// Length in bytes without the extension.
fn stem_len(name: &[u8]) -> usize {
    name.iter().rposition(|&byte| byte == b'.').unwrap_or(name.len())
}

/// Checks that a filter is in the manuals (3.4.4).
pub fn check_filter(filter: &[u8]) -> Result<(), FileNameError> {
    let known = filter.is_empty()
        || filter == b"*.*"
        || FileType::ALL.into_iter().any(|kind| kind.filter().as_bytes().eq_ignore_ascii_case(filter));
    if known { Ok(()) } else { Err(FileNameError::Filter { filter: filter.escape_ascii().to_string() }) }
}

/// Whether a name contains `/`, or a backslash that is not the second byte of a full-width character: `ソ` is 83 5C in
/// `Shift_JIS`.
fn has_separator(name: &[u8]) -> bool {
    let mut bytes = name.iter();
    while let Some(&byte) = bytes.next() {
        match byte {
            b'/' | b'\\' => return true,
            0x81..=0x9F | 0xE0..=0xFC => match bytes.clone().next() {
                Some(b'/') | None => {}
                Some(_) => {
                    bytes.next();
                }
            },
            _ => {}
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checks_names_before_sending() {
        assert!(check_name(b"TESTJOB.JBI").is_ok());
        assert!(check_name(b"\x83\x5c.JBI").is_ok());
        assert!(check_name(b"/SPDRV/CMOSBK.BIN").is_ok());
        assert!(FileName::new(*b"/SPDRV/CMOSBK.BIN").is_err());
        assert!(check_name(&[b'A'; 32].iter().copied().chain(*b".JBI").collect::<Vec<_>>()).is_ok());
        let long: Vec<u8> = [b'A'; 33].iter().copied().chain(*b".JBI").collect();
        assert!(check_name(&long).is_ok());
        assert!(matches!(check_load_name(&long), Err(FileNameError::JobName { len: 33, .. })));
        assert_eq!(check_name(b""), Err(FileNameError::Empty));
        assert_eq!(check_name(b".JBI"), Err(FileNameError::Empty));
        assert!(matches!(check_name(b"A.JBI\0"), Err(FileNameError::Nul { .. })));
        assert!(matches!(check_name(b"../A.JBI"), Err(FileNameError::Separator { .. })));
        assert!(matches!(check_name(b"\x83/A.JBI"), Err(FileNameError::Separator { .. })));
        assert!(matches!(check_name(b"C:\\A.JBI"), Err(FileNameError::Separator { .. })));
        assert!(matches!(check_name(b"A\r\n.JBI"), Err(FileNameError::Control { .. })));
        assert!(check_name(b"A.EXE").is_ok());
        assert!(check_name(&[&[b'A'; MAX_DATA - 2][..], b".X"].concat()).is_ok());
        assert!(matches!(check_load_name(b"A.EXE"), Err(FileNameError::Type { .. })));
        assert!(matches!(check_name(b"A"), Err(FileNameError::Extension { .. })));
        assert!(matches!(check_name(b"A."), Err(FileNameError::Extension { .. })));
        assert!(matches!(check_name(&[b'A'; 480]), Err(FileNameError::TooLong { len: 480 })));
    }

    #[test]
    fn parses_lists_with_other_line_ends_and_padding() {
        let names = |data: &'static [u8]| split_list(data).unwrap();
        assert_eq!(names(b"1.JBI\r\n22.JBI\r\n"), [&b"1.JBI"[..], b"22.JBI"]);
        assert_eq!(names(b"A.JBI\nB.JBI\rC.JBI\0D.JBI"), [&b"A.JBI"[..], b"B.JBI", b"C.JBI", b"D.JBI"]);
        assert_eq!(names(b"A.JBI  \r\n\r\n \r\nB C.JBI\r\n\0\0"), [&b"A.JBI"[..], b"B C.JBI"]);
        assert!(names(b"").is_empty());
    }

    #[test]
    fn rejects_a_line_longer_than_a_frame() {
        let longest = [b'A'; MAX_DATA];
        assert_eq!(split_list(&longest).unwrap(), [longest]);
        let longer = [&b"A.JBI\r\n"[..], &[b'A'; MAX_DATA + 1]].concat();
        assert_eq!(split_list(&longer), Err(ListError { line: 2, len: MAX_DATA + 1 }));
    }

    #[test]
    fn names_carry_their_bytes_and_type() {
        let name = FileName::new(*b"\x83\x5c.jbi").unwrap();
        assert_eq!((name.as_bytes(), name.file_type()), (&b"\x83\x5c.jbi"[..], Some(FileType::Jbi)));
        assert_eq!(format!("{name:?}"), "\"\\x83\\\\.jbi\"");
        assert_eq!((FileType::Cnd.filter(), FileType::Prm.to_string()), ("*.CND".to_owned(), "PRM".to_owned()));
        assert_eq!(FileName::new(*b"A.EXE").unwrap().file_type(), None);
        assert!(matches!(FileName::new(*b"A.EXE").unwrap().check_load(), Err(FileNameError::Type { .. })));
    }
}
