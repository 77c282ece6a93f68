//! Files of the controller: jobs, data, parameters, system and list files, batch backup.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::job::Program;
use super::name_lists;
use super::variable_file;
use super::world::{Refusal, World, code};
use crate::refuse_if;
use crate::yerc::Model;
use crate::yerc::table::BATCH_BACKUP_PATH;

/// Extensions that can be listed, in the order of the manual (DX 3.4.4).
const EXTENSIONS: [&[u8]; 6] = [JOB, b".DAT", b".CND", b".PRM", b".SYS", b".LST"];
const JOB: &[u8] = b".JBI";
/// Extensions of files that only the controller writes.
const READ_ONLY_EXTENSIONS: [&[u8]; 2] = [b".SYS", b".LST"];
/// Maximum length of a job name in bytes. The constant below is the maximum length of a path.
const NAME_LEN: usize = 32;
const PATH_LEN: usize = 64;

/// Content of a file. Large content is generated on demand.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Content {
    Bytes(Arc<[u8]>),
    // Bytes that are generated from a seed.
    Generated { seed: u64, size: u64 },
}

impl Content {
    pub(super) fn size(&self) -> u64 {
        match self {
            Self::Bytes(bytes) => bytes.len() as u64,
            Self::Generated { size, .. } => *size,
        }
    }

    /// At most `len` bytes from `offset`.
    pub(super) fn piece(&self, offset: u64, len: usize) -> Vec<u8> {
        match self {
            Self::Bytes(bytes) => {
                let from = usize::try_from(offset).unwrap_or(usize::MAX).min(bytes.len());
                bytes[from..bytes.len().min(from.saturating_add(len))].to_vec()
            }
            Self::Generated { seed, size } => {
                let end = offset.saturating_add(len as u64).min(*size);
                (offset..end).map(|at| scrambled(*seed, at / 8)[usize::from(at.to_le_bytes()[0] % 8)]).collect()
            }
        }
    }
}

impl From<Vec<u8>> for Content {
    fn from(bytes: Vec<u8>) -> Self {
        Self::Bytes(bytes.into())
    }
}

/// Returns eight bytes for an offset (SplitMix64). All byte values occur, including NUL and line ends.
fn scrambled(seed: u64, word: u64) -> [u8; 8] {
    let mut x = seed.wrapping_add(word.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    x = (x ^ x >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ x >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    (x ^ x >> 31).to_le_bytes()
}

/// A file, and whether clients may delete it.
#[derive(Debug, Clone)]
struct File {
    content: Content,
    protected: bool,
}

/// All files by name, in the encoding of the pendant.
#[derive(Debug, Clone)]
pub(super) struct Storage {
    files: BTreeMap<Vec<u8>, File>,
    /// Batch backup on the RAM disk; `None` before the first backup.
    pub(super) backup: Option<Content>,
    /// Total size limit in bytes.
    pub(super) capacity: u64,
    /// Whether a loaded job replaces a job with the same name. If not, the load is refused with code 4030.
    pub(super) replace_jobs: bool,
    /// Whether the ACK of the last block of a load has no block number.
    pub(super) plain_last_ack: bool,
}

impl Storage {
    pub(super) fn new(capacity: u64, replace_jobs: bool, plain_last_ack: bool) -> Self {
        Self { files: BTreeMap::new(), backup: None, capacity, replace_jobs, plain_last_ack }
    }

    /// Adds a file of the start state. Clients can delete it later only if it is a job.
    pub(super) fn install(&mut self, name: &[u8], content: Content) {
        let protected = !name.ends_with(JOB);
        self.files.insert(name.to_vec(), File { content, protected });
    }

    pub(super) fn get(&self, name: &[u8]) -> Option<&Content> {
        self.files.get(name).map(|file| &file.content)
    }

    /// A job by its name without extension.
    pub(super) fn program(&self, name: &[u8]) -> Option<Program> {
        let file = self.get(&[name, JOB].concat())?;
        // Storage contains only valid jobs.
        Program::parse(name, &file.piece(0, usize::try_from(file.size()).ok()?)).ok()
    }

    /// Free bytes.
    pub(super) fn free(&self) -> u64 {
        self.capacity.saturating_sub(self.files.values().map(|file| file.content.size()).sum())
    }

    /// Names that match a filter, each followed by CR LF; `None` if the filter is invalid.
    fn list(&self, filter: &[u8]) -> Option<Vec<u8>> {
        let extension = match filter {
            b"" | b"*.*" => JOB,
            _ => filter.strip_prefix(b"*").filter(|extension| EXTENSIONS.contains(extension))?,
        };
        let names = self.files.keys().filter(|name| name.ends_with(extension));
        Some(names.flat_map(|name| [name, &b"\r\n"[..]].concat()).collect())
    }
}

/// Result of a request for a list or a file.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum FileContent {
    /// The answer contains these bytes.
    Content(Content),
    /// The answer contains no bytes. Its status is good, with this added status.
    Nothing(u16),
}

impl World {
    /// Lists the names of files (service 0x32).
    pub(super) fn list_files(&self, filter: &[u8]) -> Result<FileContent, Refusal> {
        let names = self.files.list(filter).ok_or(Refusal::Added(code::PATH))?;
        match (names.is_empty(), self.model) {
            (false, _) => Ok(FileContent::Content(names.into())),
            (true, Model::Fs100) => Err(Refusal::Added(code::NO_SUCH_FILE)),
            (true, _) => Ok(FileContent::Nothing(code::NO_MATCH)),
        }
    }

    /// Reads a file (service 0x16), except the batch backup.
    pub(super) fn read_file(&self, name: &[u8]) -> Result<FileContent, Refusal> {
        check_stored_name(name)?;
        if name == variable_file::NAME && self.files.get(name).is_some() {
            return Ok(FileContent::Content(variable_file::written(&self.memory).into()));
        }
        if self.files.get(name).is_some()
            && let Some(list) = name_lists::written(&self.files, name)
        {
            return Ok(FileContent::Content(list.into()));
        }
        match (self.files.get(name), self.model) {
            (Some(content), _) if content.size() > 0 => Ok(FileContent::Content(content.clone())),
            (None, Model::Fs100) if name.ends_with(JOB) => Err(Refusal::Added(code::NO_SUCH_JOB)),
            (_, Model::Fs100) => Err(Refusal::Added(code::NO_SUCH_FILE)),
            _ => Ok(FileContent::Nothing(code::NO_DATA)),
        }
    }

    /// Deletes a file (service 0x09).
    pub(super) fn delete_file(&mut self, name: &[u8]) -> Result<(), Refusal> {
        self.may_change_files()?;
        if name == BATCH_BACKUP_PATH {
            return self.files.backup.take().map(drop).ok_or(Refusal::Added(code::NO_SUCH_FILE));
        }
        check_name(name)?;
        let stem = name.strip_suffix(JOB);
        match self.files.files.get(name) {
            Some(File { protected: true, .. }) => return Err(Refusal::Added(code::NO_DELETE)),
            Some(_) => {}
            None if stem.is_some() => return Err(Refusal::Added(code::NO_SUCH_JOB)),
            None => return Err(Refusal::Added(code::NO_SUCH_FILE)),
        }
        self.files.files.remove(name);
        if let Some(stem) = stem {
            self.player.forget(stem);
        }
        Ok(())
    }

    /// Whether a client may load a file with this name (service 0x15). The content is not known at this time.
    pub(super) fn may_load(&self, name: &[u8]) -> Result<(), Refusal> {
        self.may_change_files()?;
        check_name(name)?;
        if name.ends_with(JOB) && !self.files.replace_jobs && self.files.get(name).is_some() {
            return Err(Refusal::Added(code::JOB_EXISTS));
        }
        if READ_ONLY_EXTENSIONS.iter().any(|extension| name.ends_with(extension)) {
            let code = match self.model {
                Model::Fs100 => code::NOT_LOADED,
                _ => code::NO_OVERWRITE,
            };
            return Err(Refusal::Added(code));
        }
        Ok(())
    }

    /// Stores a loaded file. A job must be valid.
    pub(super) fn load_file(&mut self, name: &[u8], bytes: Vec<u8>) -> Result<(), Refusal> {
        self.may_load(name)?;
        if let Some(stem) = name.strip_suffix(JOB) {
            Program::parse(stem, &bytes).map_err(Refusal::Added)?;
            self.player.forget(stem);
        }
        if name == variable_file::NAME && !variable_file::load(&mut self.memory, &bytes) {
            return Err(Refusal::Added(code::NOT_LOADED));
        }
        let protected = self.files.files.get(name).is_some_and(|file| file.protected);
        self.files.files.insert(name.to_vec(), File { content: bytes.into(), protected });
        Ok(())
    }

    fn may_change_files(&self) -> Result<(), Refusal> {
        self.may_command()?;
        refuse_if(self.switches.editing, Refusal::Added(code::EDITING))?;
        refuse_if(self.is_running(), Refusal::Added(code::MOVING))
    }

    /// Whether a batch backup is possible now (DX 3.4.5).
    pub(super) fn may_back_up(&self) -> Result<(), Refusal> {
        if !self.switches.remote {
            return Err(Refusal::Added(match self.model {
                Model::Fs100 => code::MODE,
                _ => code::BACKUP_MODE,
            }));
        }
        refuse_if(self.is_running(), Refusal::Added(code::OPERATING))
    }
}

/// Checks a name. It must have a known extension, and no folder or NUL. A controller treats a name with a NUL as empty.
pub(super) fn check_name(name: &[u8]) -> Result<(), Refusal> {
    let refuse = |is_refused, code| refuse_if(is_refused, Refusal::Added(code));
    refuse(name.is_empty() || name.contains(&0), code::DATA_SIZE_ZERO)?;
    refuse(name.len() > PATH_LEN, code::PATH_LENGTH)?;
    let extension = EXTENSIONS.into_iter().find(|extension| name.ends_with(extension));
    let extension = extension.ok_or(Refusal::Added(code::PATH))?;
    let stem = &name[..name.len() - extension.len()];
    // 0x5C may be the second byte of a Shift_JIS character, so a backslash does not count as a separator.
    refuse(stem.is_empty() || stem.contains(&b'/') || stem.contains(&b':'), code::PATH)?;
    let invalid = |byte: &u8| *byte < b' ' || *byte == 0x7F || b"\"*?<>|,".contains(byte);
    refuse(stem.len() > NAME_LEN || stem.iter().any(invalid), code::JOB_NAME)
}

/// Checks the name of a stored file. Any extension is allowed, because a controller also has files that cannot be
/// loaded.
pub(super) fn check_stored_name(name: &[u8]) -> Result<(), Refusal> {
    let other = name.iter().rposition(|&byte| byte == b'.').filter(|&point| point > 0 && point + 1 < name.len());
    match check_name(name) {
        Err(Refusal::Added(code::PATH)) if other.is_some() && !name.iter().any(|byte| b"/:".contains(byte)) => Ok(()),
        checked => checked,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn generated_content_does_not_depend_on_the_piece_size() {
        let content = Content::Generated { seed: 7, size: 1000 };
        let whole = content.piece(0, 5000);
        assert_eq!(whole.len(), 1000);
        let pieces: Vec<u8> = (0..3).flat_map(|block| content.piece(block * 479, 479)).collect();
        assert_eq!(pieces, whole);
        assert_ne!(whole[..100], whole[100..200]);
    }

    #[test]
    fn rejects_invalid_file_names() {
        let code = |name: &[u8]| check_name(name).err();
        assert_eq!(code(b"A.JBI"), None);
        assert_eq!(code(b"\x83e\x83X\x83g.JBI"), None);
        assert_eq!(code(b"A.JBI\0"), Some(Refusal::Added(code::DATA_SIZE_ZERO)));
        assert_eq!(code(b"A.TXT"), Some(Refusal::Added(code::PATH)));
        assert_eq!(code(b"../A.JBI"), Some(Refusal::Added(code::PATH)));
        assert_eq!(code(&[b'A'; 70]), Some(Refusal::Added(code::PATH_LENGTH)));
        assert_eq!(code(b"A*.JBI"), Some(Refusal::Added(code::JOB_NAME)));
    }
}
