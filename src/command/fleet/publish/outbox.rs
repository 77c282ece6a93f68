//! What is to be told and is not told yet, in order: first in memory, then on disk, both bounded. It knows no broker and no
//! clock.
//!
//! A record leaves once it is acknowledged. Those in memory are older than those on disk. Where nothing has room any more,
//! the oldest that is not under way goes, and is counted.

use std::collections::VecDeque;
use std::io;

use super::spool::{Spool, SpoolError};

/// Something to be told.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Record {
    /// What it is, for whoever tells it.
    pub kind: u8,
    /// When it was so, in milliseconds since 1970.
    pub time_ms: u64,
    /// What it is about: a topic, a device.
    pub key: String,
    /// What is told.
    pub body: Vec<u8>,
    /// The birth that it came after; 0 where it was read from disk.
    pub epoch: u64,
}

/// What a record takes in memory beside its texts.
const BESIDE: usize = 128;

impl Record {
    fn size(&self) -> usize {
        self.key.len() + self.body.len() + BESIDE
    }
}

/// Tells one record from all others.
pub type Ticket = u64;

/// A record in memory.
#[derive(Debug)]
struct Held {
    ticket: Ticket,
    record: Record,
    state: State,
    /// The file that it was read from, where it still is.
    segment: Option<u64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Waiting,
    Sent,
}

/// What had no room.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Dropped {
    /// For want of room.
    pub for_room: u64,
    /// On disk, and not readable any more.
    pub damaged: u64,
}

/// The records, the oldest first.
#[derive(Debug)]
pub struct Outbox {
    memory: VecDeque<Held>,
    bytes: usize,
    /// Most bytes in memory.
    most: usize,
    spool: Option<Spool>,
    next: Ticket,
    dropped: Dropped,
    /// What the disk said last, once.
    trouble: Option<io::Error>,
    is_troubled: bool,
}

impl Outbox {
    /// With so many bytes of memory, and a disk or none.
    pub fn new(most: usize, spool: Option<Spool>) -> Self {
        Self {
            memory: VecDeque::new(),
            bytes: 0,
            most,
            spool,
            next: 1,
            dropped: Dropped::default(),
            trouble: None,
            is_troubled: false,
        }
    }

    /// Takes a record.
    pub fn push(&mut self, record: Record) {
        let size = record.size();
        if size > self.most {
            self.dropped.for_room += 1;
            return;
        }
        loop {
            if !self.has_more_on_disk() && self.bytes + size <= self.most {
                self.hold(record, None);
                return;
            }
            let has_room = self.spool.as_mut().map(|spool| (spool.append(&record), spool.bytes()));
            match has_room {
                Some((Ok(()), _)) => {
                    self.is_troubled = false;
                    return;
                }
                Some((Err(error), bytes)) => {
                    if let SpoolError::Io(error) = error
                        && !std::mem::replace(&mut self.is_troubled, true)
                    {
                        self.trouble = Some(error);
                    }
                    // A file goes as a whole: once that has room again, the disk is asked again.
                    if !self.make_room(size, bytes) {
                        self.dropped.for_room += 1;
                        return;
                    }
                }
                None => {
                    if !self.drop_oldest() {
                        self.dropped.for_room += 1;
                        return;
                    }
                }
            }
        }
    }

    /// Drops the oldest until a file on disk is gone, or memory has room and nothing is on disk; `false` if nothing can go.
    fn make_room(&mut self, size: usize, bytes: u64) -> bool {
        loop {
            self.refill();
            let has_room = !self.has_more_on_disk() && self.bytes + size <= self.most;
            if has_room || self.spool.as_ref().is_some_and(|spool| spool.bytes() < bytes) {
                return true;
            }
            if !self.drop_oldest() {
                return false;
            }
        }
    }

    /// The next record that is to be told, if there is one. It counts as sent.
    pub fn take_next(&mut self) -> Option<(Ticket, Record)> {
        self.refill();
        let held = self.memory.iter_mut().find(|held| held.state == State::Waiting)?;
        held.state = State::Sent;
        Some((held.ticket, held.record.clone()))
    }

    /// A record has arrived, or is nothing that could arrive.
    pub fn done(&mut self, ticket: Ticket) {
        // They are in order of their tickets.
        if let Ok(at) = self.memory.binary_search_by_key(&ticket, |held| held.ticket) {
            self.remove(at);
        }
    }

    /// The connection is gone: what was sent and is not acknowledged is sent again.
    pub fn lost(&mut self) {
        for held in &mut self.memory {
            if held.state == State::Sent {
                held.state = State::Waiting;
            }
        }
    }

    /// Whether nothing is left to be told.
    pub fn is_empty(&self) -> bool {
        self.memory.is_empty() && !self.has_more_on_disk()
    }

    /// How many wait or are under way, in memory; and the bytes on disk.
    pub fn waiting(&self) -> (usize, u64) {
        (self.memory.len(), self.spool.as_ref().map_or(0, Spool::bytes))
    }

    /// What was dropped since this was asked last.
    pub fn take_dropped(&mut self) -> Dropped {
        let damaged = self.spool.as_mut().map_or(0, Spool::take_damaged);
        let dropped = std::mem::take(&mut self.dropped);
        Dropped { damaged: dropped.damaged + damaged, ..dropped }
    }

    /// What is wrong with the disk, told once until it works again.
    pub fn take_trouble(&mut self) -> Option<io::Error> {
        self.trouble.take()
    }

    /// Writes what is in memory alone to the disk, before what is there, for the next one who comes; says how many records
    /// have found no place.
    pub fn park(mut self) -> (u64, Option<io::Error>) {
        let alone = self.memory.drain(..).filter(|held| held.segment.is_none());
        let records: Vec<Record> = alone.map(|held| held.record).collect();
        let count = u64::try_from(records.len()).unwrap_or(u64::MAX);
        match &mut self.spool {
            None => (count, None),
            Some(spool) => spool.prepend(&records),
        }
    }

    fn has_more_on_disk(&self) -> bool {
        self.spool.as_ref().is_some_and(Spool::has_more)
    }

    fn hold(&mut self, record: Record, segment: Option<u64>) {
        self.bytes += record.size();
        self.memory.push_back(Held { ticket: self.next, record, state: State::Waiting, segment });
        self.next += 1;
    }

    /// Brings records from disk into memory, while half of that is free.
    fn refill(&mut self) {
        while self.bytes <= self.most / 2
            && let Some(spool) = &mut self.spool
            && let Some((segment, record)) = spool.read()
        {
            self.hold(record, Some(segment));
        }
    }

    /// Drops the oldest record that is not under way, or the oldest one; `false` if there is none.
    fn drop_oldest(&mut self) -> bool {
        let waiting = self.memory.iter().position(|held| held.state == State::Waiting);
        let Some(at) = waiting.or((!self.memory.is_empty()).then_some(0)) else { return false };
        self.remove(at);
        self.dropped.for_room += 1;
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

    /// Bytes of memory for so many records.
    fn memory(records: usize) -> usize {
        records * record(0).size()
    }

    fn on_disk(folder: &Path, records: usize, disk: u64) -> Outbox {
        Outbox::new(memory(records), Some(Spool::open(folder, disk).unwrap()))
    }

    /// All that is left, told and acknowledged one by one.
    fn drained(outbox: &mut Outbox) -> Vec<u64> {
        std::iter::from_fn(|| {
            let (ticket, record) = outbox.take_next()?;
            outbox.done(ticket);
            Some(record.time_ms)
        })
        .collect()
    }

    #[test]
    fn what_is_not_acknowledged_is_told_again_in_order() {
        let mut outbox = Outbox::new(memory(10), None);
        (1..=4).for_each(|number| outbox.push(record(number)));
        let (first, _) = outbox.take_next().unwrap();
        let (second, _) = outbox.take_next().unwrap();
        let (_, third) = outbox.take_next().unwrap();
        assert_eq!(third.time_ms, 3);
        // Acknowledgements may come in any order.
        outbox.done(second);
        assert_eq!(outbox.waiting().0, 3);
        outbox.done(first);
        assert_eq!(outbox.waiting().0, 2);
        outbox.lost();
        assert_eq!(drained(&mut outbox), [3, 4]);
        assert!(outbox.is_empty());
    }

    #[test]
    fn the_oldest_goes_first_and_is_counted() {
        let mut outbox = Outbox::new(memory(3), None);
        (1..=3).for_each(|number| outbox.push(record(number)));
        let (under_way, _) = outbox.take_next().unwrap();
        outbox.push(record(4));
        outbox.push(record(5));
        assert_eq!(outbox.take_dropped(), Dropped { for_room: 2, damaged: 0 });
        assert_eq!(outbox.take_dropped(), Dropped::default());
        outbox.done(under_way);
        assert_eq!(drained(&mut outbox), [4, 5]);
        // One that never has room drops nothing else.
        outbox.push(record(6));
        outbox.push(Record { body: vec![0; memory(4)], ..record(7) });
        assert_eq!(outbox.take_dropped().for_room, 1);
        assert_eq!(drained(&mut outbox), [6]);
    }

    #[test]
    fn the_disk_takes_what_memory_has_no_room_for_and_order_stays() {
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
    fn a_full_disk_drops_the_oldest() {
        let folder = TempDir::new().unwrap();
        let mut outbox = on_disk(folder.path(), 10, 8 << 10);
        (1..=500).for_each(|number| outbox.push(record(number)));
        assert!(outbox.waiting().1 <= 8 << 10, "{:?}", outbox.waiting());
        let dropped = outbox.take_dropped().for_room;
        let left = drained(&mut outbox);
        assert_eq!(left, (dropped + 1..=500).collect::<Vec<_>>());
        assert!(left.len() > 40, "{}", left.len());
    }

    #[test]
    fn a_process_that_dies_leaves_what_is_on_disk_and_one_that_ends_leaves_all() {
        let folder = TempDir::new().unwrap();
        let mut outbox = on_disk(folder.path(), 10, 1 << 20);
        (1..=50).for_each(|number| outbox.push(record(number)));
        drop(outbox);
        let mut outbox = on_disk(folder.path(), 10, 1 << 20);
        let (ticket, first) = outbox.take_next().unwrap();
        assert_eq!(first.time_ms, 11, "ten were in memory alone");
        outbox.done(ticket);
        // Read into memory, and not told: they are still there.
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
        outbox.done(ticket);
        assert!(matches!(outbox.park(), (0, None)));
        assert_eq!(drained(&mut on_disk(folder.path(), 10, 1 << 20)), (2..=50).collect::<Vec<_>>());
    }

    #[test]
    fn without_a_disk_what_is_left_is_counted() {
        let mut outbox = Outbox::new(memory(10), None);
        (1..=3).for_each(|number| outbox.push(record(number)));
        assert!(matches!(outbox.park(), (3, None)));
    }

    #[derive(Debug, Clone)]
    enum Step {
        Push,
        Send,
        Acknowledge(usize),
        Lose,
    }

    proptest! {
        /// Whatever happens, records come in order, none is lost but those that are counted, and none stays.
        #[test]
        fn nothing_is_lost_uncounted(
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
                        outbox.done(ticket);
                        arrived.push(record.time_ms);
                    }
                    Step::Acknowledge(_) => {}
                    Step::Lose => {
                        under_way.clear();
                        outbox.lost();
                    }
                }
                prop_assert!(outbox.bytes <= outbox.most);
            }
            outbox.lost();
            let rest = drained(&mut outbox);
            prop_assert!(rest.is_sorted(), "{rest:?}");
            arrived.extend(rest);
            arrived.sort_unstable();
            arrived.dedup();
            let dropped = outbox.take_dropped().for_room;
            // One that was under way may have arrived although its place was needed.
            prop_assert!(u64::try_from(arrived.len()).unwrap() + dropped >= pushed, "{} and {dropped} of {pushed}", arrived.len());
            prop_assert!(outbox.is_empty() && outbox.waiting() == (0, 0));
        }
    }
}
