//! Records on disk, the oldest first, in files of a folder of its own.
//!
//! A file is written by one process from its beginning to its end, and goes once all of its records have arrived. Each
//! record stands behind its length and a checksum: what a process was writing when it was killed, and what a disk has
//! spoilt, is recognised, and damages nothing else. Which records of the first file have arrived is not written down:
//! after a kill they are told once more.

use std::collections::VecDeque;
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use sha2::{Digest as _, Sha256};

use super::outbox::Record;
use crate::files;

/// Largest record, in bytes.
const LARGEST: usize = 1 << 20;
/// Largest file, unless less is allowed in all.
const SEGMENT: u64 = 1 << 20;
/// Files of the least disk.
const SEGMENTS: u64 = 8;
/// How the first file of a folder is called, so that others can come before it.
const FIRST: u64 = 1 << 40;
const SUFFIX: &str = "spool";
/// Length and checksum.
const HEAD: usize = 12;
/// Kind, time, length of the key.
const FIELDS: usize = 11;

/// Why a record is not on disk.
#[derive(Debug)]
pub enum SpoolError {
    /// As much is there as is allowed.
    Full,
    /// The disk.
    Io(io::Error),
}

/// A file.
#[derive(Debug)]
struct Segment {
    number: u64,
    bytes: u64,
    /// Records that were read and have not arrived.
    outstanding: usize,
    is_read: bool,
}

/// The folder.
#[derive(Debug)]
pub struct Spool {
    folder: PathBuf,
    /// Most bytes of all files.
    most: u64,
    segments: VecDeque<Segment>,
    /// The number of the next file.
    next: u64,
    writer: Option<File>,
    /// Records of the file that is being read.
    read: VecDeque<Record>,
    damaged: u64,
    _lock: files::Claim,
}

impl Spool {
    /// Opens a folder, or makes it. What others have left there is told first.
    ///
    /// # Errors
    /// [`ErrorKind::WouldBlock`] if another process has it.
    pub fn open(folder: &Path, most: u64) -> io::Result<Self> {
        make_folder(folder)?;
        let lock = files::claim(folder)?;
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
            most,
            segments: segments.into(),
            next,
            writer: None,
            read: VecDeque::new(),
            damaged: 0,
            _lock: lock,
        })
    }

    /// Bytes of all files.
    pub fn bytes(&self) -> u64 {
        self.segments.iter().map(|segment| segment.bytes).sum()
    }

    /// Whether there are records that were not read.
    pub fn has_more(&self) -> bool {
        !self.read.is_empty() || self.segments.iter().any(|segment| !segment.is_read)
    }

    /// Records that could not be read, since this was asked last; of a file that cannot be read at all, one.
    pub fn take_damaged(&mut self) -> u64 {
        std::mem::take(&mut self.damaged)
    }

    /// Writes a record behind all others.
    ///
    /// # Errors
    /// Nothing of it is there then.
    pub fn append(&mut self, record: &Record) -> Result<(), SpoolError> {
        let bytes = encode(record);
        let len = u64::try_from(bytes.len()).unwrap_or(u64::MAX);
        if bytes.len() > LARGEST || self.bytes() + len > self.most {
            return Err(SpoolError::Full);
        }
        let is_full = self.segments.back().is_some_and(|last| last.bytes + len > self.largest_segment());
        if self.writer.is_none() || is_full {
            let number = self.next;
            if let Some(last) = self.writer.take() {
                // The next one begins: this one is there as a whole, whatever happens to the machine.
                last.sync_data().map_err(SpoolError::Io)?;
            }
            self.writer = Some(self.create(number).map_err(SpoolError::Io)?);
            self.next += 1;
            self.segments.push_back(Segment { number, bytes: 0, outstanding: 0, is_read: false });
        }
        let (Some(writer), Some(segment)) = (&mut self.writer, self.segments.back_mut()) else {
            return Err(SpoolError::Io(io::Error::other("no file is open")));
        };
        match writer.write_all(&bytes) {
            Ok(()) => {
                segment.bytes += len;
                Ok(())
            }
            Err(error) => {
                // A piece of it may be there: it must not stand before the next one.
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

    /// The next record, with the file that it is in until [`Spool::release`].
    pub fn read(&mut self) -> Option<(u64, Record)> {
        loop {
            if let Some(record) = self.read.pop_front() {
                let segment = self.segments.iter_mut().rfind(|segment| segment.is_read)?;
                return Some((segment.number, record));
            }
            let at = self.segments.iter().position(|segment| !segment.is_read)?;
            if at + 1 == self.segments.len() {
                // What comes goes into the next one, so that this one is read once.
                self.writer = None;
            }
            let number = self.segments[at].number;
            let (records, damaged) =
                match files::read(&self.path(number), SEGMENT + u64::try_from(LARGEST).unwrap_or(0)) {
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

    /// A record of a file has arrived, or was given up.
    pub fn release(&mut self, number: u64) {
        let Some(at) = self.segments.iter().position(|segment| segment.number == number) else { return };
        let segment = &mut self.segments[at];
        segment.outstanding = segment.outstanding.saturating_sub(1);
        if segment.outstanding == 0 {
            self.segments.remove(at);
            self.remove(number);
        }
    }

    /// Writes records before all others, the newest of them that have room; says how many had none.
    pub fn prepend(&mut self, records: &[Record]) -> (u64, Option<io::Error>) {
        let mut room = self.most.saturating_sub(self.bytes());
        let mut kept = 0;
        let mut chunks: Vec<Vec<u8>> = Vec::new();
        let largest = usize::try_from(self.largest_segment()).unwrap_or(usize::MAX);
        for record in records.iter().rev() {
            let bytes = encode(record);
            let len = u64::try_from(bytes.len()).unwrap_or(u64::MAX);
            if bytes.len() > LARGEST || len > room {
                break;
            }
            room -= len;
            kept += 1;
            match chunks.last_mut().filter(|chunk| chunk.len() + bytes.len() <= largest) {
                Some(chunk) => chunk.splice(..0, bytes).for_each(drop),
                None => chunks.push(bytes),
            }
        }
        let all = u64::try_from(records.len()).unwrap_or(u64::MAX);
        // The newest first: each goes before the one that was written last.
        let mut number = self.segments.front().map_or(self.next, |first| first.number).saturating_sub(1);
        for chunk in chunks {
            let written = self.create(number).and_then(|mut file| {
                file.write_all(&chunk)?;
                file.sync_data()
            });
            if let Err(error) = written {
                self.remove(number);
                return (all, Some(error));
            }
            number = number.saturating_sub(1);
        }
        (all - kept, None)
    }

    fn largest_segment(&self) -> u64 {
        SEGMENT.min(self.most / SEGMENTS)
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
        // One that stays is told once more by the next process, which removes it then.
        let _gone = fs::remove_file(self.path(number));
    }
}

/// What robots say is for whoever runs this.
fn make_folder(folder: &Path) -> io::Result<()> {
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

/// Length of what follows the checksum, checksum; kind, time, length of the key, key, body. Numbers begin with their lowest
/// byte.
fn encode(record: &Record) -> Vec<u8> {
    let Record { kind, time_ms, key, body, .. } = record;
    let mut fields = Vec::with_capacity(FIELDS + key.len() + body.len());
    fields.push(*kind);
    fields.extend(time_ms.to_le_bytes());
    fields.extend(u16::try_from(key.len()).unwrap_or(u16::MAX).to_le_bytes());
    fields.extend(key.bytes());
    fields.extend(body);
    let mut bytes = Vec::with_capacity(HEAD + fields.len());
    bytes.extend(u32::try_from(fields.len()).unwrap_or(u32::MAX).to_le_bytes());
    bytes.extend(checksum(&fields));
    bytes.extend(fields);
    bytes
}

/// All records up to the first one that is cut or spoilt, and whether there is one.
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
    let len = usize::try_from(u32::from_le_bytes(*len)).ok().filter(|len| *len <= LARGEST)?;
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

/// Whether a folder is somebody else's at present.
pub fn is_taken(error: &io::Error) -> bool {
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
    fn a_write_that_was_cut_at_any_byte_damages_nothing_that_was_complete() {
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
            // The next process writes into a file of its own.
            spool.append(&record(9)).unwrap();
            let complete = u64::try_from(len / one).unwrap();
            assert_eq!(all(&mut spool), (1..=complete).chain([9]).collect::<Vec<_>>(), "{len}");
            assert_eq!(spool.take_damaged(), u64::from(len % one != 0), "{len}");
            assert_eq!(files_in(folder.path()), Vec::<PathBuf>::new());
        }
    }

    #[test]
    fn one_folder_is_for_one_process() {
        let folder = TempDir::new().unwrap();
        let _first = Spool::open(folder.path(), 1 << 20).unwrap();
        assert!(!cfg!(unix) || is_taken(&Spool::open(folder.path(), 1 << 20).unwrap_err()));
    }

    #[test]
    fn what_is_parked_comes_first() {
        let folder = TempDir::new().unwrap();
        let mut spool = Spool::open(folder.path(), 64 << 10).unwrap();
        (100..=110).for_each(|number| spool.append(&record(number)).unwrap());
        let records: Vec<Record> = (1..=99).map(record).collect();
        assert!(matches!(spool.prepend(&records), (0, None)));
        drop(spool);
        let mut spool = Spool::open(folder.path(), 64 << 10).unwrap();
        assert_eq!(all(&mut spool), (1..=110).collect::<Vec<_>>());
        // Where there is no room for all, the oldest go.
        drop(spool);
        let mut spool = Spool::open(folder.path(), 1 << 10).unwrap();
        let (dropped, None) = spool.prepend(&records) else { panic!("the disk") };
        drop(spool);
        let mut spool = Spool::open(folder.path(), 1 << 10).unwrap();
        assert_eq!(all(&mut spool), (dropped + 1..=99).collect::<Vec<_>>());
    }

    proptest! {
        #[test]
        fn no_bytes_make_it_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            let (records, _) = decode_all(&bytes);
            prop_assert!(records.len() <= bytes.len());
        }

        #[test]
        fn records_round_trip(kind: u8, time_ms: u64, key in "\\PC{0,20}", body in prop::collection::vec(any::<u8>(), 0..99)) {
            let record = Record { kind, time_ms, key, body, epoch: 0 };
            let bytes = encode(&record);
            let (decoded, rest) = decode(&bytes).unwrap();
            prop_assert_eq!(decoded, record);
            prop_assert!(rest.is_empty());
        }
    }
}
