//! Disk spool: records in segment files of a private folder, oldest first.
//!
//! One process writes a segment from start to end. The segment is deleted when all its records have arrived. Each
//! record has a length and a checksum, so that an incomplete write and disk damage are detected without effect on other
//! records. Acknowledgements are not stored: after a kill, the records of the first segment are sent again.
//!
//! A spool belongs to one node, and to one broker or one list of brokers, so that data never leaves by another broker
//! ([`folder_name`]).

use std::collections::VecDeque;
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write as _};
use std::str::FromStr;

use sha2::{Digest as _, Sha256};

use super::broker::Url;
use super::outbox::Record;
use armctl_frame::prelude::*;

/// Size limit of a record in bytes.
const MAX_RECORD_SIZE: usize = 1 << 20;
/// Size limit of a segment, unless the total limit is smaller.
const SEGMENT: u64 = 1 << 20;
/// Number of segments at the smallest total limit.
const SEGMENTS: u64 = 8;
/// Number of the first segment, and distance between the numbers of two segments. Between them is room for segments
/// with records that were in memory.
const FIRST: u64 = 1 << 40;
const STRIDE: u64 = 1 << 24;
const SUFFIX: &str = "spool";
/// Length and checksum.
const HEADER_SIZE: usize = 12;
/// Type, time, epoch, key length.
const FIELDS: usize = 19;

/// When the disk gets the records that wait.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SyncPolicy {
    /// At once: a record is flushed before the next record is accepted.
    Always,
    /// Each record is written at once, and flushed after this time.
    Every(Duration),
    /// Only when the memory is full.
    Never,
}

impl FromStr for SyncPolicy {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "always" => Ok(Self::Always),
            "never" => Ok(Self::Never),
            _ => match duration::parse_some(text) {
                Ok(interval) if interval >= MIN_SYNC_INTERVAL => Ok(Self::Every(interval)),
                _ => Err("write always, never, or a time of 100ms or more, such as 1s".to_owned()),
            },
        }
    }
}

/// Minimum interval of flushes. Below it, `always` costs the same and keeps more.
const MIN_SYNC_INTERVAL: Duration = Duration::from_millis(100);

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
    /// Whether this process has written the segment.
    is_own: bool,
}

/// The spool.
#[derive(Debug)]
pub struct Spool {
    folder: PathBuf,
    /// Size limit of all segments in bytes.
    limit: u64,
    sync: SyncPolicy,
    segments: VecDeque<Segment>,
    /// Number of the next segment.
    next: u64,
    writer: Option<File>,
    /// Whether the writer has written records that are not flushed.
    is_unsynced: bool,
    /// Records of the segment that is being read, and its number.
    read: VecDeque<Record>,
    reading: u64,
    damaged: u64,
    _lock: files::FolderLock,
}

impl Spool {
    /// Opens or creates a folder. Records of earlier processes are sent first.
    ///
    /// # Errors
    /// [`ErrorKind::WouldBlock`] if another process uses the folder.
    pub fn open(folder: &Path, most: u64, sync: SyncPolicy) -> io::Result<Self> {
        let lock = claim_folder(folder)?;
        let mut segments = Vec::new();
        for entry in fs::read_dir(folder)? {
            let entry = entry?;
            let name = entry.file_name();
            let number = name.to_str().and_then(|name| name.strip_suffix(SUFFIX)?.strip_suffix('.')?.parse().ok());
            let found = entry.metadata()?;
            if let (Some(number), true) = (number, found.is_file()) {
                segments.push(Segment { number, bytes: found.len(), outstanding: 0, is_read: false, is_own: false });
            }
        }
        segments.sort_unstable_by_key(|segment| segment.number);
        let next = segments.last().map_or(FIRST, |last| last.number.saturating_add(STRIDE));
        Ok(Self {
            folder: folder.to_owned(),
            limit: most,
            sync,
            segments: segments.into(),
            next,
            writer: None,
            is_unsynced: false,
            read: VecDeque::new(),
            reading: 0,
            damaged: 0,
            _lock: lock,
        })
    }

    /// Total size in bytes.
    pub fn bytes(&self) -> u64 {
        self.segments.iter().map(|segment| segment.bytes).sum()
    }

    /// When records are written.
    pub fn sync(&self) -> SyncPolicy {
        self.sync
    }

    /// Number of the next segment. All records that are written later have this number or a higher one.
    pub fn next_segment(&self) -> u64 {
        self.next
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
            self.next = self.next.saturating_add(STRIDE);
            self.segments.push_back(Segment { number, bytes: 0, outstanding: 0, is_read: false, is_own: true });
        }
        let (Some(writer), Some(segment)) = (&mut self.writer, self.segments.back_mut()) else {
            return Err(SpoolError::Io(io::Error::other("no open file")));
        };
        let mut written = writer.write_all(&bytes);
        if self.sync == SyncPolicy::Always {
            written = written.and_then(|()| writer.sync_data());
        }
        match written {
            Ok(()) => {
                segment.bytes += len;
                self.is_unsynced = self.sync != SyncPolicy::Always;
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
                return Some((self.reading, record));
            }
            let at = self.segments.iter().position(|segment| !segment.is_read)?;
            if at + 1 == self.segments.len() {
                // New records go to the next segment, so that this segment is read only once. If the flush fails, the
                // records are in memory from now on, and a failing disk is reported with the next record.
                let _flushed = self.flush();
                self.writer = None;
            }
            let number = self.segments[at].number;
            let (mut records, damaged) =
                match files::read(&self.path(number), SEGMENT + u64::try_from(MAX_RECORD_SIZE).unwrap_or(0)) {
                    Ok(bytes) => decode_all(&bytes),
                    Err(_) => (VecDeque::new(), 1),
                };
            self.damaged += damaged;
            let segment = &mut self.segments[at];
            if !segment.is_own {
                for record in &mut records {
                    record.epoch = 0;
                }
            }
            segment.is_read = true;
            segment.outstanding = records.len();
            if records.is_empty() {
                self.segments.remove(at);
                self.remove(number);
            }
            (self.read, self.reading) = (records, number);
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

    /// File with records that were written since the last flush, for a flush in another thread.
    ///
    /// # Errors
    /// The system has no more file handles.
    pub fn take_unflushed(&mut self) -> io::Result<Option<File>> {
        let Some(writer) = &self.writer else { return Ok(None) };
        if self.sync == SyncPolicy::Never || !std::mem::take(&mut self.is_unsynced) {
            return Ok(None);
        }
        writer.try_clone().map(Some)
    }

    /// Flushes the records that were written since the last flush.
    ///
    /// # Errors
    /// The records can be lost at a power failure.
    pub fn flush(&mut self) -> io::Result<()> {
        self.take_unflushed()?.map_or(Ok(()), |file| file.sync_data())
    }

    /// Writes records that are in memory to segments directly before the segment `before`, a value of
    /// [`Spool::next_segment`]. The new segments count as read. If there is not enough room, only the newest records are
    /// written. Returns each segment with its number of records, newest first, and the error that ended the writing.
    pub fn insert(&mut self, before: u64, records: &[&Record]) -> (Vec<(u64, usize)>, Option<io::Error>) {
        let mut room = self.limit.saturating_sub(self.bytes());
        // Each chunk with its encoded records, newest first.
        let mut chunks: Vec<(u64, Vec<Vec<u8>>)> = Vec::new();
        for record in records.iter().rev() {
            let bytes = encode(record);
            let len = u64::try_from(bytes.len()).unwrap_or(u64::MAX);
            if bytes.len() > MAX_RECORD_SIZE || len > room {
                break;
            }
            room -= len;
            match chunks.last_mut().filter(|(size, _)| size + len <= self.largest_segment()) {
                Some((size, chunk)) => {
                    *size += len;
                    chunk.push(bytes);
                }
                None => chunks.push((len, vec![bytes])),
            }
        }
        let mut written = Vec::with_capacity(chunks.len());
        for ((bytes, chunk), number) in chunks.into_iter().zip((0..before).rev()) {
            let mut file = match self.create(number) {
                Ok(file) => file,
                Err(error) => return (written, Some(error)),
            };
            let content: Vec<u8> = chunk.iter().rev().flatten().copied().collect();
            if let Err(error) = file.write_all(&content).and_then(|()| file.sync_data()) {
                self.remove(number);
                return (written, Some(error));
            }
            let at = self.segments.partition_point(|segment| segment.number < number);
            self.segments.insert(at, Segment { number, bytes, outstanding: chunk.len(), is_read: true, is_own: true });
            self.next = self.next.max(before.saturating_add(STRIDE));
            written.push((number, chunk.len()));
        }
        (written, None)
    }

    /// Deletes a segment whose records are all in memory. Returns `false` if the segment is not completely read.
    pub fn detach(&mut self, number: u64) -> bool {
        if !self.read.is_empty() && self.reading == number {
            return false;
        }
        self.segments.retain(|segment| segment.number != number);
        self.remove(number);
        true
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
        let file = options.open(self.path(number))?;
        if self.sync != SyncPolicy::Never
            && let Err(error) = files::sync_folder(&self.folder)
        {
            self.remove(number);
            return Err(error);
        }
        Ok(file)
    }

    fn remove(&self, number: u64) {
        // If this fails, the next process sends the records again and deletes the file.
        let _gone = fs::remove_file(self.path(number));
    }
}

/// Length of the names of brokers above which a folder of several brokers gets a short name.
const MAX_BROKER_NAMES: usize = 150;

/// Name of the spool folder of a node at a broker, or at a list of brokers in any order. A host has no `@` and no `+`, a
/// node has no `+`, and a Sparkplug group has no `+`, so two different names never have the same folder.
pub fn folder_name(brokers: &[Url], group: Option<&str>, node: &str) -> String {
    let group = group.map(|group| format!("spB+{group}+")).unwrap_or_default();
    let mut keys: Vec<String> = brokers.iter().map(Url::key).collect();
    keys.sort_unstable();
    let mut list = keys.join("+");
    if keys.len() > 1 && list.len() > MAX_BROKER_NAMES {
        let digits = checksum(list.as_bytes()).iter().fold(String::new(), |all, byte| format!("{all}{byte:02x}"));
        list = format!("mqtt-list-{digits}");
    }
    let mut name = String::new();
    for c in format!("{group}{node}@{list}").chars() {
        // Windows does not allow these characters in file names. `%` in a node is already encoded.
        match c {
            '\\' | ':' | '*' | '?' | '"' | '<' | '>' | '|' => name.push_str(&format!("%{:02X}", u32::from(c))),
            c => name.push(c),
        }
    }
    name
}

/// Folders in `root`, or `root` itself, with records of an earlier version of armctl. That version did not store to
/// which broker its records belong, so they are never sent.
pub fn folders_without_broker(root: &Path) -> Vec<PathBuf> {
    let has_broker = |folder: &PathBuf| {
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        name.rsplit_once('@').is_some_and(|(_, broker)| broker.starts_with("mqtt"))
    };
    let inner = fs::read_dir(root).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut folders: Vec<PathBuf> = inner.filter(|folder| !has_broker(folder)).chain([root.to_owned()]).collect();
    folders.retain(|folder| has_records(folder));
    folders.sort();
    folders
}

/// Whether a folder contains records.
pub fn has_records(folder: &Path) -> bool {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).any(|path| path.extension().is_some_and(|suffix| suffix == SUFFIX))
}

/// Creates and locks a folder. Robot data is private to the user of this process.
///
/// # Errors
/// [`ErrorKind::WouldBlock`] if another process uses the folder.
pub fn claim_folder(folder: &Path) -> io::Result<files::FolderLock> {
    if !folder.is_dir() {
        let mut builder = fs::DirBuilder::new();
        builder.recursive(true);
        #[cfg(unix)]
        std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
        builder.create(folder)?;
        files::sync_folder(&files::folder_of(folder))?;
    }
    files::claim_folder(folder)
}

fn checksum(bytes: &[u8]) -> [u8; 8] {
    let mut sum = [0; 8];
    sum.copy_from_slice(&Sha256::digest(bytes)[..8]);
    sum
}

/// Format: length of the data, checksum, and then the data: type, time, epoch, length of the key, key, body. Numbers are
/// little-endian.
fn encode(record: &Record) -> Vec<u8> {
    let Record { kind, time_ms, key, body, epoch } = record;
    let mut fields = Vec::with_capacity(FIELDS + key.len() + body.len());
    fields.push(*kind);
    fields.extend(time_ms.to_le_bytes());
    fields.extend(epoch.to_le_bytes());
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
    let (epoch, fields) = fields.split_first_chunk()?;
    let (key, fields) = fields.split_first_chunk()?;
    let (key, body) = fields.split_at_checked(u16::from_le_bytes(*key).into())?;
    let key = std::str::from_utf8(key).ok()?.to_owned();
    let (time_ms, epoch) = (u64::from_le_bytes(*time), u64::from_le_bytes(*epoch));
    let record = Record { kind: *kind, time_ms, key, body: body.to_vec(), epoch };
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
        let mut spool = Spool::open(folder.path(), 1 << 20, SyncPolicy::Never).unwrap();
        (1..=3).for_each(|number| spool.append(&record(number)).unwrap());
        drop(spool);
        let [file] = &files_in(folder.path())[..] else { panic!("one file") };
        let whole = fs::read(file).unwrap();
        let one = whole.len() / 3;
        for len in 0..=whole.len() {
            fs::write(file, &whole[..len]).unwrap();
            let mut spool = Spool::open(folder.path(), 1 << 20, SyncPolicy::Never).unwrap();
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
        let _first = Spool::open(folder.path(), 1 << 20, SyncPolicy::Never).unwrap();
        assert!(is_locked(&Spool::open(folder.path(), 1 << 20, SyncPolicy::Never).unwrap_err()));
    }

    #[test]
    fn reads_inserted_records_in_their_order() {
        let folder = TempDir::new().unwrap();
        let mut spool = Spool::open(folder.path(), 64 << 10, SyncPolicy::Always).unwrap();
        let records: Vec<Record> = (0..300).map(record).collect();
        let some = |range: std::ops::Range<usize>| records[range].iter().collect::<Vec<_>>();
        let first = spool.next_segment();
        records[100..110].iter().for_each(|record| spool.append(record).unwrap());
        assert_eq!(std::iter::from_fn(|| spool.read()).count(), 10);
        let second = spool.next_segment();
        records[200..210].iter().for_each(|record| spool.append(record).unwrap());
        let count = |(written, error): (Vec<(u64, usize)>, Option<io::Error>)| {
            assert!(error.is_none(), "{error:?}");
            written.iter().map(|(_, count)| count).sum::<usize>()
        };
        assert_eq!(count(spool.insert(second, &some(110..200))), 90);
        assert_eq!(count(spool.insert(first, &some(1..100))), 99);
        // Inserted records count as read: they are in memory.
        assert_eq!(spool.read().unwrap().1.time_ms, 200);
        drop(spool);
        let mut spool = Spool::open(folder.path(), 64 << 10, SyncPolicy::Always).unwrap();
        assert_eq!(all(&mut spool), (1..210).collect::<Vec<_>>());
        // If there is not enough room, the oldest are not written.
        drop(spool);
        let mut spool = Spool::open(folder.path(), 1 << 10, SyncPolicy::Never).unwrap();
        let written = count(spool.insert(spool.next_segment(), &some(0..300)));
        assert!((1..300).contains(&written));
        drop(spool);
        let mut spool = Spool::open(folder.path(), 1 << 10, SyncPolicy::Never).unwrap();
        let first = u64::try_from(300 - written).unwrap();
        assert_eq!(all(&mut spool), (first..300).collect::<Vec<_>>());
    }

    #[test]
    fn epoch_is_valid_only_in_its_process() {
        let folder = TempDir::new().unwrap();
        for expected in [3, 0] {
            let mut spool = Spool::open(folder.path(), 1 << 20, SyncPolicy::Always).unwrap();
            if expected == 3 {
                spool.append(&Record { epoch: 3, ..record(1) }).unwrap();
            }
            assert_eq!(spool.read().unwrap().1.epoch, expected);
        }
    }

    #[test]
    fn each_broker_and_node_has_its_folder() {
        let name = |urls: &str, group, node| {
            let urls: Vec<Url> = urls.split(' ').map(|url| url.parse().unwrap()).collect();
            folder_name(&urls, group, node)
        };
        let names = [
            name("mqtt://Plant-A", None, "cell7"),
            name("mqtts://plant-a", None, "cell7"),
            name("mqtt://plant-a:1884", None, "cell7"),
            name("mqtt://[::1]", None, "cell7"),
            name("mqtt://plant", None, "cell7@mqtt-plant-a-1883"),
            name("mqtt://plant-a", None, ".."),
            name("mqtt://plant-a", Some("Plant"), "cell7"),
            name("mqtt://plant-a", None, "spB-Plant-cell7"),
            name("mqtt://plant-a mqtt://plant-b", None, "cell7"),
            name(&format!("mqtt://{} mqtt://b", "a".repeat(200)), None, "cell7"),
        ];
        assert_eq!(names[0], "cell7@mqtt-plant-a-1883");
        assert_eq!(names[3], "cell7@mqtt-%3A%3A1-1883");
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len());
        for same in ["tcp://plant-a:1883/", "mqtt://PLANT-A", "mqtt://plant-a:01883"] {
            assert_eq!(name(same, None, "cell7"), names[0]);
        }
        // The order of a list is only a preference.
        assert_eq!(name("mqtt://PLANT-B tcp://plant-a", None, "cell7"), names[8]);
        assert_eq!(names[8], "cell7@mqtt-plant-a-1883+mqtt-plant-b-1883");
        assert!(names[9].starts_with("cell7@mqtt-list-") && names[9].len() < 40);
    }

    #[test]
    fn finds_spools_without_a_broker() {
        let root = TempDir::new().unwrap();
        for folder in ["armctl-cell7", "a@b-cell7", "cell7@mqtt-plant-1883", "spB-Plant-Cell7", "empty"] {
            fs::create_dir(root.path().join(folder)).unwrap();
            if folder != "empty" {
                fs::write(root.path().join(folder).join("00000000001.spool"), b"x").unwrap();
            }
        }
        let expected = ["a@b-cell7", "armctl-cell7", "spB-Plant-Cell7"].map(|folder| root.path().join(folder));
        assert_eq!(folders_without_broker(root.path()), expected);
        fs::write(root.path().join("00000000001.spool"), b"x").unwrap();
        assert_eq!(folders_without_broker(root.path())[0], root.path());
    }

    #[test]
    fn parses_the_flush_policy() {
        for (text, sync) in [
            ("always", SyncPolicy::Always),
            ("never", SyncPolicy::Never),
            ("1s", SyncPolicy::Every(Duration::from_secs(1))),
        ] {
            assert_eq!(text.parse(), Ok(sync));
        }
        for wrong in ["0s", "10ms", "sometimes", ""] {
            assert!(wrong.parse::<SyncPolicy>().is_err(), "{wrong}");
        }
    }

    proptest! {
        #[test]
        fn never_panics_on_any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            let (records, _) = decode_all(&bytes);
            prop_assert!(records.len() <= bytes.len());
        }

        #[test]
        fn round_trips_records(kind: u8, time_ms: u64, key in "\\PC{0,20}", body in prop::collection::vec(any::<u8>(), 0..99), epoch: u64) {
            let record = Record { kind, time_ms, key, body, epoch };
            let bytes = encode(&record);
            let (decoded, rest) = decode(&bytes).unwrap();
            prop_assert_eq!(decoded, record);
            prop_assert!(rest.is_empty());
        }
    }
}
