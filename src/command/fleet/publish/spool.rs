//! Disk spool: records in segment files of a private folder, oldest first.
//!
//! One process writes a segment from start to end. The segment is deleted when all its records have arrived. Each
//! record has a length and a checksum, so that an incomplete write and disk damage are detected without effect on other
//! records. Acknowledgements are not stored: after a kill, the records of the first segment are sent again.

use std::collections::VecDeque;
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use sha2::{Digest as _, Sha256};

use super::outbox::Record;
use armctl_files as files;

/// Size limit of a record in bytes.
const MAX_RECORD_SIZE: usize = 1 << 20;
/// Size limit of a segment, unless the total limit is smaller.
const SEGMENT: u64 = 1 << 20;
/// Number of segments at the smallest total limit.
const SEGMENTS: u64 = 8;
/// Number of the first segment. It is high, so that other segments can be placed before the first one.
const FIRST: u64 = 1 << 40;
const SUFFIX: &str = "spool";
/// Length and checksum.
const HEADER_SIZE: usize = 12;
/// Type, time, key length.
const FIELDS: usize = 11;

/// Reason why a record could not be written.
#[derive(Debug)]
pub enum SpoolError {
    /// The size limit is reached.
    Full,
    /// Disk error.
    Io(io::Error),
}

#[derive(Debug)]
struct Segment {
    number: u64,
    bytes: u64,
    /// Records that were read but have not arrived.
    outstanding: usize,
    is_read: bool,
}

/// The spool.
#[derive(Debug)]
pub struct Spool {
    folder: PathBuf,
    /// Size limit of all segments in bytes.
    limit: u64,
    segments: VecDeque<Segment>,
    /// Number of the next segment.
    next: u64,
    writer: Option<File>,
    /// Records of the segment that is being read.
    read: VecDeque<Record>,
    damaged: u64,
    _lock: files::FolderLock,
}

impl Spool {
    /// Opens or creates a folder. Records of earlier processes are sent first.
    ///
    /// # Errors
    /// [`ErrorKind::WouldBlock`] if another process uses the folder.
    pub fn open(folder: &Path, most: u64) -> io::Result<Self> {
        create_folder(folder)?;
        let lock = files::claim_folder(folder)?;
        let mut segments = Vec::new();
        for entry in fs::read_dir(folder)? {
            let entry = entry?;
            let name = entry.file_name();
            let number = name.to_str().and_then(|name| name.strip_suffix(SUFFIX)?.strip_suffix('.')?.parse().ok());
            let found = entry.metadata()?;
            if let (Some(number), true) = (number, found.is_file()) {
                segments.push(Segment { number, bytes: found.len(), outstanding: 0, is_read: false });
            }
        }
        segments.sort_unstable_by_key(|segment| segment.number);
        let next = segments.last().map_or(FIRST, |last| last.number.saturating_add(1));
        Ok(Self {
            folder: folder.to_owned(),
            limit: most,
            segments: segments.into(),
            next,
            writer: None,
            read: VecDeque::new(),
            damaged: 0,
            _lock: lock,
        })
    }

    /// Total size in bytes.
    pub fn bytes(&self) -> u64 {
        self.segments.iter().map(|segment| segment.bytes).sum()
    }

    /// Whether there are unread records.
    pub fn has_more(&self) -> bool {
        !self.read.is_empty() || self.segments.iter().any(|segment| !segment.is_read)
    }

    /// Number of unreadable records since the last call. An unreadable segment counts as one record.
    pub fn take_damaged(&mut self) -> u64 {
        std::mem::take(&mut self.damaged)
    }

    /// Appends a record.
    ///
    /// # Errors
    /// Nothing of the record was written.
    pub fn append(&mut self, record: &Record) -> Result<(), SpoolError> {
        let bytes = encode(record);
        let len = u64::try_from(bytes.len()).unwrap_or(u64::MAX);
        if bytes.len() > MAX_RECORD_SIZE || self.bytes() + len > self.limit {
            return Err(SpoolError::Full);
        }
        let is_full = self.segments.back().is_some_and(|last| last.bytes + len > self.largest_segment());
        if self.writer.is_none() || is_full {
            let number = self.next;
            if let Some(last) = self.writer.take() {
                // The complete segment is flushed, so that a power failure does not damage it.
                last.sync_data().map_err(SpoolError::Io)?;
            }
            self.writer = Some(self.create(number).map_err(SpoolError::Io)?);
            self.next += 1;
            self.segments.push_back(Segment { number, bytes: 0, outstanding: 0, is_read: false });
        }
        let (Some(writer), Some(segment)) = (&mut self.writer, self.segments.back_mut()) else {
            return Err(SpoolError::Io(io::Error::other("no open file")));
        };
        match writer.write_all(&bytes) {
            Ok(()) => {
                segment.bytes += len;
                Ok(())
            }
            Err(error) => {
                // Removes an incomplete record, so that the next record is readable.
                if writer.set_len(segment.bytes).is_err() {
                    self.writer = None;
                }
                if segment.bytes == 0 {
                    self.writer = None;
                    let number = segment.number;
                    self.segments.pop_back();
                    self.remove(number);
                }
                Err(SpoolError::Io(error))
            }
        }
    }

    /// Reads the next record, with its segment for [`Spool::release`].
    pub fn read(&mut self) -> Option<(u64, Record)> {
        loop {
            if let Some(record) = self.read.pop_front() {
                let segment = self.segments.iter_mut().rfind(|segment| segment.is_read)?;
                return Some((segment.number, record));
            }
            let at = self.segments.iter().position(|segment| !segment.is_read)?;
            if at + 1 == self.segments.len() {
                // New records go to the next segment, so that this segment is read only once.
                self.writer = None;
            }
            let number = self.segments[at].number;
            let (records, damaged) =
                match files::read(&self.path(number), SEGMENT + u64::try_from(MAX_RECORD_SIZE).unwrap_or(0)) {
                    Ok(bytes) => decode_all(&bytes),
                    Err(_) => (VecDeque::new(), 1),
                };
            self.damaged += damaged;
            let segment = &mut self.segments[at];
            segment.is_read = true;
            segment.outstanding = records.len();
            if records.is_empty() {
                self.segments.remove(at);
                self.remove(number);
            }
            self.read = records;
        }
    }

    /// Records that a record of a segment has arrived or was dropped.
    pub fn release(&mut self, number: u64) {
        let Some(at) = self.segments.iter().position(|segment| segment.number == number) else { return };
        let segment = &mut self.segments[at];
        segment.outstanding = segment.outstanding.saturating_sub(1);
        if segment.outstanding == 0 {
            self.segments.remove(at);
            self.remove(number);
        }
    }

    /// Writes records before all others. If there is not enough room, only the newest records are written. Returns the
    /// number of records that were not written, and the error that ended the writing.
    pub fn prepend(&mut self, records: &[Record]) -> (u64, Option<io::Error>) {
        let mut room = self.limit.saturating_sub(self.bytes());
        // Each chunk with its number of records.
        let mut chunks: Vec<(u64, Vec<u8>)> = Vec::new();
        let largest = usize::try_from(self.largest_segment()).unwrap_or(usize::MAX);
        for record in records.iter().rev() {
            let bytes = encode(record);
            let len = u64::try_from(bytes.len()).unwrap_or(u64::MAX);
            if bytes.len() > MAX_RECORD_SIZE || len > room {
                break;
            }
            room -= len;
            match chunks.last_mut().filter(|(_, chunk)| chunk.len() + bytes.len() <= largest) {
                Some((count, chunk)) => {
                    chunk.splice(..0, bytes).for_each(drop);
                    *count += 1;
                }
                None => chunks.push((1, bytes)),
            }
        }
        let mut missing = u64::try_from(records.len()).unwrap_or(u64::MAX);
        // Writes the newest chunk first. Each chunk gets a lower file number than the chunk that was written before it.
        let mut number = self.segments.front().map_or(self.next, |first| first.number).saturating_sub(1);
        for (count, chunk) in chunks {
            let written = self.create(number).and_then(|mut file| {
                file.write_all(&chunk)?;
                file.sync_data()
            });
            if let Err(error) = written {
                self.remove(number);
                return (missing, Some(error));
            }
            missing -= count;
            number = number.saturating_sub(1);
        }
        (missing, None)
    }

    fn largest_segment(&self) -> u64 {
        SEGMENT.min(self.limit / SEGMENTS)
    }

    fn path(&self, number: u64) -> PathBuf {
        self.folder.join(format!("{number:020}.{SUFFIX}"))
    }

    fn create(&self, number: u64) -> io::Result<File> {
        let mut options = OpenOptions::new();
        options.append(true).create_new(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        options.open(self.path(number))
    }

    fn remove(&self, number: u64) {
        // If this fails, the next process sends the records again and deletes the file.
        let _gone = fs::remove_file(self.path(number));
    }
}

/// Robot data is private to the user of this process.
fn create_folder(folder: &Path) -> io::Result<()> {
    if folder.is_dir() {
        return Ok(());
    }
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(folder)
}

fn checksum(bytes: &[u8]) -> [u8; 8] {
    let mut sum = [0; 8];
    sum.copy_from_slice(&Sha256::digest(bytes)[..8]);
    sum
}

/// Format: length of the data, checksum, and then the data: type, time, length of the key, key, body. Numbers are
/// little-endian.
fn encode(record: &Record) -> Vec<u8> {
    let Record { kind, time_ms, key, body, .. } = record;
    let mut fields = Vec::with_capacity(FIELDS + key.len() + body.len());
    fields.push(*kind);
    fields.extend(time_ms.to_le_bytes());
    fields.extend(u16::try_from(key.len()).unwrap_or(u16::MAX).to_le_bytes());
    fields.extend(key.bytes());
    fields.extend(body);
    let mut bytes = Vec::with_capacity(HEADER_SIZE + fields.len());
    bytes.extend(u32::try_from(fields.len()).unwrap_or(u32::MAX).to_le_bytes());
    bytes.extend(checksum(&fields));
    bytes.extend(fields);
    bytes
}

/// Decodes all records up to the first damaged record. Also returns 1 if there is a damaged record.
fn decode_all(mut bytes: &[u8]) -> (VecDeque<Record>, u64) {
    let mut records = VecDeque::new();
    while !bytes.is_empty() {
        let Some((record, rest)) = decode(bytes) else { return (records, 1) };
        records.push_back(record);
        bytes = rest;
    }
    (records, 0)
}

fn decode(bytes: &[u8]) -> Option<(Record, &[u8])> {
    let (len, rest) = bytes.split_first_chunk()?;
    let (sum, rest) = rest.split_first_chunk::<8>()?;
    let len = usize::try_from(u32::from_le_bytes(*len)).ok().filter(|len| *len <= MAX_RECORD_SIZE)?;
    let (fields, rest) = rest.split_at_checked(len)?;
    if checksum(fields) != *sum {
        return None;
    }
    let (kind, fields) = fields.split_first()?;
    let (time, fields) = fields.split_first_chunk()?;
    let (key, fields) = fields.split_first_chunk()?;
    let (key, body) = fields.split_at_checked(u16::from_le_bytes(*key).into())?;
    let key = std::str::from_utf8(key).ok()?.to_owned();
    let record = Record { kind: *kind, time_ms: u64::from_le_bytes(*time), key, body: body.to_vec(), epoch: 0 };
    Some((record, rest))
}

/// Whether the error means that another process uses the folder.
pub fn is_locked(error: &io::Error) -> bool {
    error.kind() == ErrorKind::WouldBlock
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use tempfile::TempDir;

    use super::*;

    fn record(number: u64) -> Record {
        Record { kind: 2, time_ms: number, key: "press".to_owned(), body: b"body".to_vec(), epoch: 0 }
    }

    fn files_in(folder: &Path) -> Vec<PathBuf> {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let mut files: Vec<_> = entries.filter(|path| path.extension().is_some_and(|name| name == SUFFIX)).collect();
        files.sort();
        files
    }

    fn all(spool: &mut Spool) -> Vec<u64> {
        std::iter::from_fn(|| {
            let (number, record) = spool.read()?;
            spool.release(number);
            Some(record.time_ms)
        })
        .collect()
    }

    #[test]
    fn truncated_write_keeps_complete_records() {
        let folder = TempDir::new().unwrap();
        let mut spool = Spool::open(folder.path(), 1 << 20).unwrap();
        (1..=3).for_each(|number| spool.append(&record(number)).unwrap());
        drop(spool);
        let [file] = &files_in(folder.path())[..] else { panic!("one file") };
        let whole = fs::read(file).unwrap();
        let one = whole.len() / 3;
        for len in 0..=whole.len() {
            fs::write(file, &whole[..len]).unwrap();
            let mut spool = Spool::open(folder.path(), 1 << 20).unwrap();
            // The next process starts a new segment.
            spool.append(&record(9)).unwrap();
            let complete = u64::try_from(len / one).unwrap();
            assert_eq!(all(&mut spool), (1..=complete).chain([9]).collect::<Vec<_>>(), "{len}");
            assert_eq!(spool.take_damaged(), u64::from(len % one != 0), "{len}");
            assert_eq!(files_in(folder.path()), Vec::<PathBuf>::new());
        }
    }

    #[test]
    fn locks_the_folder_for_one_process() {
        let folder = TempDir::new().unwrap();
        let _first = Spool::open(folder.path(), 1 << 20).unwrap();
        assert!(is_locked(&Spool::open(folder.path(), 1 << 20).unwrap_err()));
    }

    #[test]
    fn reads_prepended_records_first() {
        let folder = TempDir::new().unwrap();
        let mut spool = Spool::open(folder.path(), 64 << 10).unwrap();
        (100..=110).for_each(|number| spool.append(&record(number)).unwrap());
        let records: Vec<Record> = (1..=99).map(record).collect();
        assert!(matches!(spool.prepend(&records), (0, None)));
        drop(spool);
        let mut spool = Spool::open(folder.path(), 64 << 10).unwrap();
        assert_eq!(all(&mut spool), (1..=110).collect::<Vec<_>>());
        // If there is not enough room, the oldest are dropped.
        drop(spool);
        let mut spool = Spool::open(folder.path(), 1 << 10).unwrap();
        let (dropped, None) = spool.prepend(&records) else { panic!("the disk") };
        drop(spool);
        let mut spool = Spool::open(folder.path(), 1 << 10).unwrap();
        assert_eq!(all(&mut spool), (dropped + 1..=99).collect::<Vec<_>>());
    }

    proptest! {
        #[test]
        fn never_panics_on_any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            let (records, _) = decode_all(&bytes);
            prop_assert!(records.len() <= bytes.len());
        }

        #[test]
        fn round_trips_records(kind: u8, time_ms: u64, key in "\\PC{0,20}", body in prop::collection::vec(any::<u8>(), 0..99)) {
            let record = Record { kind, time_ms, key, body, epoch: 0 };
            let bytes = encode(&record);
            let (decoded, rest) = decode(&bytes).unwrap();
            prop_assert_eq!(decoded, record);
            prop_assert!(rest.is_empty());
        }
    }
}
