//! Queue of unsent records, in order: first in memory, then on disk, both limited. It has no broker and no clock.
//!
//! A record is removed after its acknowledgement. Records in memory are older than those on disk. When both are full,
//! the oldest record that is not in transit is dropped and counted.

use std::collections::VecDeque;
use std::io;

use super::spool::{Spool, SpoolError};

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
    /// Number of the Sparkplug birth message before the record; 0 if the record was read from disk.
    pub epoch: u64,
}

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
    /// Disk segment that still contains the record.
    segment: Option<u64>,
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
            next: 1,
            dropped: Dropped::default(),
            disk_error: None,
            has_disk_error: false,
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
            if !self.has_more_on_disk() && self.bytes + size <= self.memory_limit {
                self.load_record(record, None);
                return;
            }
            let has_room = self.spool.as_mut().map(|spool| (spool.append(&record), spool.bytes()));
            match has_room {
                Some((Ok(()), _)) => {
                    self.has_disk_error = false;
                    return;
                }
                Some((Err(error), bytes)) => {
                    if let SpoolError::Io(error) = error
                        && !std::mem::replace(&mut self.has_disk_error, true)
                    {
                        self.disk_error = Some(error);
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

    /// Drops the oldest records until a disk segment is free, or memory has room and the disk is empty; `false` if
    /// nothing can be dropped.
    fn make_room(&mut self, size: usize, bytes: u64) -> bool {
        loop {
            self.refill();
            let has_room = !self.has_more_on_disk() && self.bytes + size <= self.memory_limit;
            if has_room || self.spool.as_ref().is_some_and(|spool| spool.bytes() < bytes) {
                return true;
            }
            if !self.drop_oldest() {
                return false;
            }
        }
    }

    /// Returns the next record to send, and marks it as sent.
    pub fn take_next(&mut self) -> Option<(Ticket, Record)> {
        self.refill();
        let queued = self.memory.iter_mut().find(|held| held.state == State::Waiting)?;
        queued.state = State::Sent;
        Some((queued.ticket, queued.record.clone()))
    }

    /// Removes a record that has arrived or can never be sent.
    pub fn acknowledge(&mut self, ticket: Ticket) {
        // Records are sorted by ticket.
        if let Ok(at) = self.memory.binary_search_by_key(&ticket, |held| held.ticket) {
            self.remove(at);
        }
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

    /// Number of records in memory, and bytes on disk.
    pub fn waiting(&self) -> (usize, u64) {
        (self.memory.len(), self.spool.as_ref().map_or(0, Spool::bytes))
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

    /// Writes the records that are only in memory to the disk, before the records that are already there. The next
    /// process sends them. Returns the number of records that did not fit.
    pub fn save_all(mut self) -> (u64, Option<io::Error>) {
        let only_memory = self.memory.drain(..).filter(|held| held.segment.is_none());
        let records: Vec<Record> = only_memory.map(|held| held.record).collect();
        let count = u64::try_from(records.len()).unwrap_or(u64::MAX);
        match &mut self.spool {
            None => (count, None),
            Some(spool) => spool.prepend(&records),
        }
    }

    fn has_more_on_disk(&self) -> bool {
        self.spool.as_ref().is_some_and(Spool::has_more)
    }

    fn load_record(&mut self, record: Record, segment: Option<u64>) {
        self.bytes += record.size();
        self.memory.push_back(QueuedRecord { ticket: self.next, record, state: State::Waiting, segment });
        self.next += 1;
    }

    /// Reads records from disk while half of the memory is free.
    fn refill(&mut self) {
        while self.bytes <= self.memory_limit / 2
            && let Some(spool) = &mut self.spool
            && let Some((segment, record)) = spool.read()
        {
            self.load_record(record, Some(segment));
        }
    }

    /// Drops the oldest record that is not in transit; if all records are in transit, the oldest one. Returns `false`
    /// if the queue is empty.
    fn drop_oldest(&mut self) -> bool {
        let waiting = self.memory.iter().position(|held| held.state == State::Waiting);
        let Some(at) = waiting.or((!self.memory.is_empty()).then_some(0)) else { return false };
        self.remove(at);
        self.dropped.overflow += 1;
        true
    }

    fn remove(&mut self, at: usize) {
        let Some(held) = self.memory.remove(at) else { return };
        self.bytes -= held.record.size();
        if let (Some(segment), Some(spool)) = (held.segment, &mut self.spool) {
            spool.release(segment);
        }
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
        Outbox::new(memory(records), Some(Spool::open(folder, disk).unwrap()))
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

    #[derive(Debug, Clone)]
    enum Step {
        Push,
        Send,
        Acknowledge(usize),
        Lose,
    }

    proptest! {
        /// In any sequence of events, records arrive in order, every lost record is counted, and no record remains.
        #[test]
        fn counts_every_lost_record(
            steps in prop::collection::vec(
                prop_oneof![
                    4 => Just(Step::Push),
                    3 => Just(Step::Send),
                    3 => (0_usize..4).prop_map(Step::Acknowledge),
                    1 => Just(Step::Lose),
                ],
                0..300,
            ),
            room in 1_usize..12,
            disk in prop::option::of(512_u64..8192),
        ) {
            let folder = TempDir::new().unwrap();
            let spool = disk.map(|disk| Spool::open(folder.path(), disk).unwrap());
            let mut outbox = Outbox::new(memory(room), spool);
            let (mut pushed, mut arrived, mut under_way) = (0, Vec::new(), Vec::new());
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
                }
                prop_assert!(outbox.bytes <= outbox.memory_limit);
            }
            outbox.requeue();
            let rest = drained(&mut outbox);
            prop_assert!(rest.is_sorted(), "{rest:?}");
            arrived.extend(rest);
            arrived.sort_unstable();
            arrived.dedup();
            let dropped = outbox.take_dropped().overflow;
            // A dropped record that was in transit can have arrived as well.
            prop_assert!(u64::try_from(arrived.len()).unwrap() + dropped >= pushed, "{} and {dropped} of {pushed}", arrived.len());
            prop_assert!(outbox.is_empty() && outbox.waiting() == (0, 0));
        }
    }
}
