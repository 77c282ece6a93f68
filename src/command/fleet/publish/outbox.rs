//! Queue of unsent records, in order, in memory and on disk, both limited. It has no broker and no clock.
//!
//! While the broker acknowledges, records are only in memory. While the broker is away, each record is written to disk
//! first, and the records that are in memory are written before it. With [`SyncPolicy::Never`], the disk is used only
//! when the memory is full.
//!
//! A record is removed after its acknowledgement. Records in memory are older than those that are only on disk. When
//! both are full, the oldest record that is not in transit is dropped and counted.

use std::collections::VecDeque;
use std::fs::File;
use std::io;
use std::time::Duration;

use super::spool::{Spool, SpoolError, SyncPolicy};

/// A record to publish.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Record {
    /// Type of the record; the message format defines the meaning.
    pub kind: u8,
    /// Time of the data, in ms since 1970.
    pub time_ms: u64,
    /// Topic or device.
    pub key: String,
    /// Content.
    pub body: Vec<u8>,
    /// Number of the Sparkplug birth message before the record; 0 if an earlier process has written the record.
    pub epoch: u64,
}

/// Interval of the attempts to write records after a disk error, if each record is flushed at once.
const RETRY_INTERVAL: Duration = Duration::from_secs(1);

/// Memory overhead of a record.
const RECORD_OVERHEAD: usize = 128;

impl Record {
    fn size(&self) -> usize {
        self.key.len() + self.body.len() + RECORD_OVERHEAD
    }
}

/// Unique number of a record.
pub type Ticket = u64;

/// A record in memory.
#[derive(Debug)]
struct QueuedRecord {
    ticket: Ticket,
    record: Record,
    state: State,
    copy: DiskCopy,
}

/// Whether a record in memory is also on disk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum DiskCopy {
    /// It is not on disk. Its place there is before this segment.
    Missing(u64),
    /// This segment contains it.
    In(u64),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Waiting,
    Sent,
}

/// Counts of dropped records.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Dropped {
    /// Dropped because the queue was full.
    pub overflow: u64,
    /// Damaged on disk.
    pub damaged: u64,
}

/// The queue, oldest record first.
#[derive(Debug)]
pub struct Outbox {
    memory: VecDeque<QueuedRecord>,
    bytes: usize,
    /// Memory limit in bytes.
    memory_limit: usize,
    spool: Option<Spool>,
    /// Whether the broker is away, so that records are written to disk first.
    is_away: bool,
    /// Whether the disk limit was reached since the broker is away. The oldest records are then only in memory, and
    /// stay there, because each room on disk is for the newest records.
    is_disk_full: bool,
    next: Ticket,
    dropped: Dropped,
    /// Last disk error, until it is reported.
    disk_error: Option<io::Error>,
    has_disk_error: bool,
}

impl Outbox {
    /// Creates a queue with a memory limit, with or without a disk spool.
    pub fn new(memory_limit: usize, spool: Option<Spool>) -> Self {
        Self {
            memory: VecDeque::new(),
            bytes: 0,
            memory_limit,
            spool,
            is_away: false,
            is_disk_full: false,
            next: 1,
            dropped: Dropped::default(),
            disk_error: None,
            has_disk_error: false,
        }
    }

    /// Adds records.
    pub fn extend(&mut self, records: Vec<Record>) {
        for record in records {
            self.push(record);
        }
    }

    /// Adds a record.
    pub fn push(&mut self, record: Record) {
        let size = record.size();
        if size > self.memory_limit {
            self.dropped.overflow += 1;
            return;
        }
        loop {
            let fits_memory = !self.has_more_on_disk() && self.bytes + size <= self.memory_limit;
            if fits_memory && !(self.is_away && self.writes_early()) {
                self.load_new_record(record);
                return;
            }
            let has_room = self.spool.as_mut().map(|spool| (spool.append(&record), spool.bytes()));
            match has_room {
                Some((Ok(()), _)) => {
                    self.has_disk_error = false;
                    return;
                }
                Some((Err(error), bytes)) => {
                    if let SpoolError::Io(error) = error {
                        self.note_disk_error(error);
                    }
                    if fits_memory {
                        self.load_new_record(record);
                        return;
                    }
                    // A segment is deleted as a whole. If that makes room, try the disk again.
                    if !self.make_room(size, bytes) {
                        self.dropped.overflow += 1;
                        return;
                    }
                }
                None => {
                    if !self.drop_oldest() {
                        self.dropped.overflow += 1;
                        return;
                    }
                }
            }
        }
    }

    /// Makes room until a disk segment is free, or memory has room and the disk is empty; `false` if nothing can be
    /// dropped. First, the oldest records stay only in memory. If the memory is full, the oldest records are dropped.
    fn make_room(&mut self, size: usize, bytes: u64) -> bool {
        loop {
            self.refill();
            let has_room = !self.has_more_on_disk() && self.bytes + size <= self.memory_limit;
            if has_room || self.spool.as_ref().is_some_and(|spool| spool.bytes() < bytes) {
                return true;
            }
            let has_detached = self.writes_early() && self.detach_oldest();
            if !has_detached && !self.drop_oldest() {
                return false;
            }
        }
    }

    /// Deletes the oldest disk segment whose records are all in memory.
    fn detach_oldest(&mut self) -> bool {
        let Some(spool) = &mut self.spool else { return false };
        let oldest = self.memory.iter().find_map(|held| match held.copy {
            DiskCopy::In(segment) => Some(segment),
            DiskCopy::Missing(_) => None,
        });
        let Some(segment) = oldest.filter(|segment| spool.detach(*segment)) else { return false };
        for held in self.memory.iter_mut().filter(|held| held.copy == DiskCopy::In(segment)) {
            // The number of the deleted segment is free again.
            held.copy = DiskCopy::Missing(segment + 1);
        }
        self.is_disk_full = true;
        true
    }

    /// Whether the broker is away.
    pub fn is_away(&self) -> bool {
        self.is_away
    }

    /// Records whether the broker is away. While it is away, all records are written to disk: the waiting records now,
    /// and later records when they are added.
    pub fn set_away(&mut self, is_away: bool) {
        self.is_away = is_away;
        self.is_disk_full &= is_away;
        if is_away && self.writes_early() && !self.is_disk_full {
            self.save_memory();
        }
    }

    /// Interval at which the written records must be flushed, and failed ones written again; `None` if there is no
    /// early write.
    pub fn sync_interval(&self) -> Option<Duration> {
        match self.spool.as_ref()?.sync() {
            SyncPolicy::Every(interval) => Some(interval),
            SyncPolicy::Always => Some(RETRY_INTERVAL),
            SyncPolicy::Never => None,
        }
    }

    /// File that must be flushed now. The caller does so in another thread, because a flush can take long on a slow disk.
    pub fn take_unflushed(&mut self) -> Option<File> {
        let file = self.spool.as_mut()?.take_unflushed();
        file.unwrap_or_else(|error| {
            self.note_disk_error(error);
            None
        })
    }

    /// Records an error of the disk, until [`take_disk_error`](Self::take_disk_error) reports it.
    pub fn note_disk_error(&mut self, error: io::Error) {
        if !std::mem::replace(&mut self.has_disk_error, true) {
            self.disk_error = Some(error);
        }
    }

    /// Returns the next record to send, and marks it as sent.
    pub fn take_next(&mut self) -> Option<(Ticket, Record)> {
        self.refill();
        let queued = self.memory.iter_mut().find(|held| held.state == State::Waiting)?;
        queued.state = State::Sent;
        Some((queued.ticket, queued.record.clone()))
    }

    /// Removes and returns a record that has arrived or can never be sent.
    pub fn acknowledge(&mut self, ticket: Ticket) -> Option<Record> {
        // Records are sorted by ticket.
        let at = self.memory.binary_search_by_key(&ticket, |held| held.ticket).ok()?;
        self.remove(at)
    }

    /// Handles the loss of the connection. Unacknowledged records will be sent again.
    pub fn requeue(&mut self) {
        for held in &mut self.memory {
            if held.state == State::Sent {
                held.state = State::Waiting;
            }
        }
    }

    /// Whether the queue is empty.
    pub fn is_empty(&self) -> bool {
        self.memory.is_empty() && !self.has_more_on_disk()
    }

    /// Number of records that are only in memory, and bytes on disk.
    pub fn waiting(&self) -> (usize, u64) {
        (self.only_in_memory(), self.spool.as_ref().map_or(0, Spool::bytes))
    }

    /// Records dropped since the last call.
    pub fn take_dropped(&mut self) -> Dropped {
        let damaged = self.spool.as_mut().map_or(0, Spool::take_damaged);
        let dropped = std::mem::take(&mut self.dropped);
        Dropped { damaged: dropped.damaged + damaged, ..dropped }
    }

    /// The last disk error; reported once until the disk works again.
    pub fn take_disk_error(&mut self) -> Option<io::Error> {
        self.disk_error.take()
    }

    /// Writes the records that are only in memory to the disk. The next process sends them. Returns the number of
    /// records that did not fit, and the disk error.
    pub fn save_all(mut self) -> (u64, Option<io::Error>) {
        self.has_disk_error = false;
        self.save_memory();
        if let Some(Err(error)) = self.spool.as_mut().map(Spool::flush) {
            self.note_disk_error(error);
        }
        (u64::try_from(self.only_in_memory()).unwrap_or(u64::MAX), self.disk_error)
    }

    /// Writes the records that are only in memory to the disk, each at its place in the order, the newest first.
    fn save_memory(&mut self) {
        let Some(spool) = &mut self.spool else { return };
        let mut end = self.memory.len();
        let mut failed = None;
        while let Some(last) = end.checked_sub(1) {
            let copy = self.memory[last].copy;
            let DiskCopy::Missing(before) = copy else {
                end = last;
                continue;
            };
            let start = self.memory.range(..end).rposition(|held| held.copy != copy).map_or(0, |at| at + 1);
            let records: Vec<&Record> = self.memory.range(start..end).map(|held| &held.record).collect();
            let (written, error) = spool.insert(before, &records);
            for (segment, count) in written {
                let first = end - count;
                self.memory.range_mut(first..end).for_each(|held| held.copy = DiskCopy::In(segment));
                end = first;
            }
            failed = error;
            if end > start {
                // The rest does not fit. Its place is before the records that were written.
                if let Some(DiskCopy::In(first)) = self.memory.get(end).map(|held| held.copy) {
                    let rest = self.memory.range_mut(start..end);
                    rest.for_each(|held| held.copy = DiskCopy::Missing(first));
                }
                break;
            }
        }
        if let Some(error) = failed {
            self.note_disk_error(error);
        }
    }

    /// Whether records are written to disk before the memory is full.
    fn writes_early(&self) -> bool {
        self.spool.as_ref().is_some_and(|spool| spool.sync() != SyncPolicy::Never)
    }

    fn only_in_memory(&self) -> usize {
        self.memory.iter().filter(|held| matches!(held.copy, DiskCopy::Missing(_))).count()
    }

    fn has_more_on_disk(&self) -> bool {
        self.spool.as_ref().is_some_and(Spool::has_more)
    }

    fn load_new_record(&mut self, record: Record) {
        let before = self.spool.as_ref().map_or(0, Spool::next_segment);
        self.load_record(record, DiskCopy::Missing(before));
    }

    fn load_record(&mut self, record: Record, copy: DiskCopy) {
        self.bytes += record.size();
        self.memory.push_back(QueuedRecord { ticket: self.next, record, state: State::Waiting, copy });
        self.next += 1;
    }

    /// Reads records from disk while half of the memory is free.
    fn refill(&mut self) {
        while self.bytes <= self.memory_limit / 2
            && let Some(spool) = &mut self.spool
            && let Some((segment, record)) = spool.read()
        {
            self.load_record(record, DiskCopy::In(segment));
        }
    }

    /// Drops the oldest record that is not in transit; if all records are in transit, the oldest one. Returns `false`
    /// if the queue is empty.
    fn drop_oldest(&mut self) -> bool {
        let waiting = self.memory.iter().position(|held| held.state == State::Waiting);
        let at = waiting.unwrap_or(0);
        let is_dropped = self.remove(at).is_some();
        self.dropped.overflow += u64::from(is_dropped);
        is_dropped
    }

    fn remove(&mut self, at: usize) -> Option<Record> {
        let held = self.memory.remove(at)?;
        self.bytes -= held.record.size();
        if let (DiskCopy::In(segment), Some(spool)) = (held.copy, &mut self.spool) {
            spool.release(segment);
        }
        Some(held.record)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use proptest::prelude::*;
    use tempfile::TempDir;

    use super::*;

    fn record(number: u64) -> Record {
        Record { kind: 0, time_ms: number, key: format!("t{}", number % 3), body: vec![7; 40], epoch: 0 }
    }

    /// Memory for a number of records.
    fn memory(records: usize) -> usize {
        records * record(0).size()
    }

    fn on_disk(folder: &Path, records: usize, disk: u64) -> Outbox {
        with_policy(folder, records, disk, SyncPolicy::Never)
    }

    fn with_policy(folder: &Path, records: usize, disk: u64, sync: SyncPolicy) -> Outbox {
        Outbox::new(memory(records), Some(Spool::open(folder, disk, sync).unwrap()))
    }

    /// Sends and acknowledges all records one by one.
    fn drained(outbox: &mut Outbox) -> Vec<u64> {
        std::iter::from_fn(|| {
            let (ticket, record) = outbox.take_next()?;
            outbox.acknowledge(ticket);
            Some(record.time_ms)
        })
        .collect()
    }

    #[test]
    fn resends_unacknowledged_records_in_order() {
        let mut outbox = Outbox::new(memory(10), None);
        (1..=4).for_each(|number| outbox.push(record(number)));
        let (first, _) = outbox.take_next().unwrap();
        let (second, _) = outbox.take_next().unwrap();
        let (_, third) = outbox.take_next().unwrap();
        assert_eq!(third.time_ms, 3);
        // Acknowledgements can come in any order.
        outbox.acknowledge(second);
        assert_eq!(outbox.waiting().0, 3);
        outbox.acknowledge(first);
        assert_eq!(outbox.waiting().0, 2);
        outbox.requeue();
        assert_eq!(drained(&mut outbox), [3, 4]);
        assert!(outbox.is_empty());
    }

    #[test]
    fn drops_and_counts_the_oldest_record_first() {
        let mut outbox = Outbox::new(memory(3), None);
        (1..=3).for_each(|number| outbox.push(record(number)));
        let (under_way, _) = outbox.take_next().unwrap();
        outbox.push(record(4));
        outbox.push(record(5));
        assert_eq!(outbox.take_dropped(), Dropped { overflow: 2, damaged: 0 });
        assert_eq!(outbox.take_dropped(), Dropped::default());
        outbox.acknowledge(under_way);
        assert_eq!(drained(&mut outbox), [4, 5]);
        // A record that is too large does not displace others.
        outbox.push(record(6));
        outbox.push(Record { body: vec![0; memory(4)], ..record(7) });
        assert_eq!(outbox.take_dropped().overflow, 1);
        assert_eq!(drained(&mut outbox), [6]);
    }

    #[test]
    fn spills_to_disk_in_order() {
        let folder = TempDir::new().unwrap();
        let mut outbox = on_disk(folder.path(), 10, 1 << 20);
        (1..=500).for_each(|number| outbox.push(record(number)));
        assert_eq!(outbox.waiting().0, 10);
        assert_eq!(drained(&mut outbox), (1..=500).collect::<Vec<_>>());
        assert_eq!((outbox.take_dropped(), outbox.waiting()), (Dropped::default(), (0, 0)));
        (501..=503).for_each(|number| outbox.push(record(number)));
        assert_eq!(drained(&mut outbox), [501, 502, 503]);
    }

    #[test]
    fn drops_the_oldest_record_when_the_disk_is_full() {
        let folder = TempDir::new().unwrap();
        let mut outbox = on_disk(folder.path(), 10, 8 << 10);
        (1..=500).for_each(|number| outbox.push(record(number)));
        assert!(outbox.waiting().1 <= 8 << 10, "{:?}", outbox.waiting());
        let dropped = outbox.take_dropped().overflow;
        let left = drained(&mut outbox);
        assert_eq!(left, (dropped + 1..=500).collect::<Vec<_>>());
        assert!(left.len() > 40, "{}", left.len());
    }

    #[test]
    fn keeps_spooled_records_after_a_crash_and_all_after_an_exit() {
        let folder = TempDir::new().unwrap();
        let mut outbox = on_disk(folder.path(), 10, 1 << 20);
        (1..=50).for_each(|number| outbox.push(record(number)));
        drop(outbox);
        let mut outbox = on_disk(folder.path(), 10, 1 << 20);
        let (ticket, first) = outbox.take_next().unwrap();
        assert_eq!(first.time_ms, 11, "ten were in memory alone");
        outbox.acknowledge(ticket);
        // Records that were read into memory but not sent are still on disk.
        drop(outbox);
        let mut outbox = on_disk(folder.path(), 10, 1 << 20);
        assert_eq!(outbox.take_next().unwrap().1.time_ms, 11);
        let kept = drained(&mut outbox).len();
        assert_eq!(kept, 39);
        drop(outbox);

        let folder = TempDir::new().unwrap();
        let mut outbox = on_disk(folder.path(), 10, 1 << 20);
        (1..=50).for_each(|number| outbox.push(record(number)));
        let (ticket, _) = outbox.take_next().unwrap();
        outbox.acknowledge(ticket);
        assert!(matches!(outbox.save_all(), (0, None)));
        assert_eq!(drained(&mut on_disk(folder.path(), 10, 1 << 20)), (2..=50).collect::<Vec<_>>());
    }

    #[test]
    fn counts_undelivered_records_without_a_disk() {
        let mut outbox = Outbox::new(memory(10), None);
        (1..=3).for_each(|number| outbox.push(record(number)));
        assert!(matches!(outbox.save_all(), (3, None)));
    }

    #[test]
    fn writes_every_record_while_the_broker_is_away() {
        let folder = TempDir::new().unwrap();
        let open = || with_policy(folder.path(), 100, 1 << 20, SyncPolicy::Always);
        let mut outbox = open();
        // While the broker acknowledges, nothing is written.
        (1..=5).for_each(|number| outbox.push(record(number)));
        let (first, _) = outbox.take_next().unwrap();
        outbox.acknowledge(first);
        outbox.take_next().unwrap();
        assert_eq!(outbox.waiting(), (4, 0));
        outbox.requeue();
        outbox.set_away(true);
        (6..=50).for_each(|number| outbox.push(record(number)));
        assert_eq!(outbox.waiting().0, 0, "all are on disk");
        drop(outbox);
        let mut outbox = open();
        outbox.set_away(true);
        // The broker returns for a moment.
        outbox.set_away(false);
        let (ticket, record_2) = outbox.take_next().unwrap();
        assert_eq!(record_2.time_ms, 2);
        outbox.acknowledge(ticket);
        (51..=60).for_each(|number| outbox.push(record(number)));
        outbox.set_away(true);
        drop(outbox);
        // Acknowledgements are not stored, so a record can arrive twice.
        let mut outbox = open();
        assert_eq!(drained(&mut outbox), (2..=60).collect::<Vec<_>>());
        assert_eq!((outbox.take_dropped(), outbox.waiting()), (Dropped::default(), (0, 0)));
        (61..=63).for_each(|number| outbox.push(record(number)));
        assert_eq!(outbox.waiting(), (3, 0), "only in memory again");
    }

    #[test]
    fn full_disk_leaves_the_oldest_records_in_memory() {
        let folder = TempDir::new().unwrap();
        let mut outbox = with_policy(folder.path(), 200, 8 << 10, SyncPolicy::Always);
        outbox.set_away(true);
        (1..=150).for_each(|number| outbox.push(record(number)));
        assert_eq!(outbox.take_dropped(), Dropped::default());
        let (memory, disk) = outbox.waiting();
        assert!(memory > 20 && (7 << 10..=8 << 10).contains(&disk), "{memory} {disk}");
        // When the broker returns and is lost again, what fits is written again at its place.
        outbox.set_away(false);
        outbox.set_away(true);
        assert_eq!(drained(&mut outbox), (1..=150).collect::<Vec<_>>());
    }

    #[test]
    fn saves_records_at_their_place_in_the_order() {
        let folder = TempDir::new().unwrap();
        let mut outbox = on_disk(folder.path(), 10, 1 << 20);
        (1..=15).for_each(|number| outbox.push(record(number)));
        // Half of the memory is free, so the records are read from disk. Later records are only in memory.
        for _ in 1..=11 {
            let (ticket, _) = outbox.take_next().unwrap();
            outbox.acknowledge(ticket);
        }
        (16..=20).for_each(|number| outbox.push(record(number)));
        assert!(matches!(outbox.save_all(), (0, None)));
        // The whole segment is sent again.
        assert_eq!(drained(&mut on_disk(folder.path(), 10, 1 << 20)), (11..=20).collect::<Vec<_>>());
    }

    /// Size of a record on disk.
    const ENCODED_SIZE: u64 = 73;

    #[derive(Debug, Clone)]
    enum Step {
        Push,
        Send,
        Acknowledge(usize),
        Lose,
        Away(bool),
        Kill,
    }

    fn steps() -> impl Strategy<Value = Vec<Step>> {
        let step = prop_oneof![
            8 => Just(Step::Push),
            6 => Just(Step::Send),
            6 => (0_usize..4).prop_map(Step::Acknowledge),
            2 => Just(Step::Lose),
            1 => any::<bool>().prop_map(Step::Away),
            1 => Just(Step::Kill),
        ];
        prop::collection::vec(step, 0..300)
    }

    proptest! {
        /// In any sequence of events, with a kill at any point, records arrive in order, every lost record is counted, no
        /// record remains, and a kill loses no record that was written by policy.
        #[test]
        fn counts_every_lost_record(
            steps in steps(),
            room in 1_usize..12,
            disk in prop::option::of((512_u64..8192, any::<bool>())),
        ) {
            let folder = TempDir::new().unwrap();
            let open = || {
                let sync = |is_early| if is_early { SyncPolicy::Every(Duration::from_secs(1)) } else { SyncPolicy::Never };
                let spool = disk.map(|(disk, is_early)| Spool::open(folder.path(), disk, sync(is_early)).unwrap());
                Outbox::new(memory(room), spool)
            };
            let mut outbox = open();
            let (mut pushed, mut arrived, mut under_way) = (0, Vec::new(), Vec::new());
            let (mut dropped, mut lost) = (0, 0);
            for step in steps {
                match step {
                    Step::Push => {
                        pushed += 1;
                        outbox.push(record(pushed));
                    }
                    Step::Send => under_way.extend(outbox.take_next()),
                    Step::Acknowledge(at) if at < under_way.len() => {
                        let (ticket, record): (Ticket, Record) = under_way.remove(at);
                        outbox.acknowledge(ticket);
                        arrived.push(record.time_ms);
                    }
                    Step::Acknowledge(_) => {}
                    Step::Lose => {
                        under_way.clear();
                        outbox.requeue();
                    }
                    Step::Away(is_away) => outbox.set_away(is_away),
                    Step::Kill => {
                        under_way.clear();
                        let in_memory = outbox.waiting().0;
                        let is_full = outbox.waiting().1 + ENCODED_SIZE > disk.map_or(0, |(disk, _)| disk);
                        prop_assert!(
                            in_memory == 0 || is_full || outbox.is_disk_full || !outbox.is_away || !outbox.writes_early(),
                            "{in_memory} records are not on disk"
                        );
                        lost += u64::try_from(in_memory).unwrap();
                        dropped += outbox.take_dropped().overflow;
                        // The process that is killed holds its lock until its end.
                        drop(std::mem::replace(&mut outbox, Outbox::new(0, None)));
                        outbox = open();
                    }
                }
                prop_assert!(outbox.bytes <= outbox.memory_limit);
                prop_assert!(outbox.waiting().1 <= disk.map_or(0, |(disk, _)| disk));
                prop_assert!(outbox.take_disk_error().is_none());
            }
            outbox.requeue();
            let rest = drained(&mut outbox);
            prop_assert!(rest.is_sorted(), "{rest:?}");
            arrived.extend(rest);
            arrived.sort_unstable();
            arrived.dedup();
            let last_dropped = outbox.take_dropped();
            prop_assert_eq!(last_dropped.damaged, 0);
            dropped += last_dropped.overflow;
            // A dropped record that was in transit can have arrived as well.
            prop_assert!(
                u64::try_from(arrived.len()).unwrap() + dropped + lost >= pushed,
                "{} and {dropped} and {lost} of {pushed}", arrived.len()
            );
            prop_assert!(outbox.is_empty() && outbox.waiting() == (0, 0));
        }
    }
}
