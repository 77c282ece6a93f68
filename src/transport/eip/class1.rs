//! Producer and consumer of a class 1 (cyclic) data stream.

use std::time::Duration;

use super::Now;
use super::settings::FIRST_PACKET;
use super::wire::Cyclic;

/// Sender with a fixed interval.
#[derive(Debug, Clone)]
pub(super) struct Producer {
    id: u32,
    interval: Duration,
    due: Now,
    sequence: u32,
    count: u16,
    pub(super) sent: u64,
    /// Number of datagrams that were omitted, because a whole interval was missed.
    pub(super) skipped: u64,
}

impl Producer {
    pub(super) const fn new(id: u32, interval: Duration, now: Now) -> Self {
        Self { id, interval, due: now, sequence: 0, count: 0, sent: 0, skipped: 0 }
    }

    /// Time of the next datagram.
    pub(super) const fn due(&self) -> Now {
        self.due
    }

    /// Returns the datagram that is due at `now`. The next datagram is due one interval after the due time of this
    /// datagram, so there is no drift. Missed intervals are omitted, so there is no burst.
    pub(super) fn produce(&mut self, now: Now, header: Option<u32>, image: &[u8]) -> Vec<u8> {
        self.sequence = self.sequence.wrapping_add(1);
        self.count = self.count.wrapping_add(1);
        self.sent += 1;
        let interval = self.interval.as_nanos().max(1);
        let missed = now.saturating_sub(self.due).as_nanos() / interval;
        let missed = u32::try_from(missed).unwrap_or(u32::MAX);
        self.skipped += u64::from(missed);
        self.due = self.due.saturating_add(self.interval.saturating_mul(missed.saturating_add(1)));
        Cyclic { id: self.id, sequence: self.sequence, count: self.count, body: image }.emit(header)
    }
}

/// Result of a received datagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DatagramResult<'a> {
    // A new image. If the stream has no run/idle header, the run bit is always `true`.
    Image { run: bool, image: &'a [u8] },
    // A datagram without an image: a heartbeat, or a datagram of a sender that has no data. It restarts the timeout.
    Alive,
    // An old or a duplicate datagram.
    Stale,
    // A datagram whose size is not the agreed size.
    WrongSize,
}

/// Receiver with a watchdog.
#[derive(Debug, Clone)]
pub(super) struct Consumer {
    id: u32,
    size: usize,
    header: bool,
    interval: Duration,
    timeout: Duration,
    until: Now,
    last: Option<(u32, Now)>,
    /// Number of valid datagrams that were received.
    pub(super) received: u64,
    /// Number of sequence numbers that were never received.
    pub(super) lost: u64,
    /// Number of datagrams that arrived more than half an interval late.
    pub(super) late: u64,
    /// Number of old and duplicate datagrams.
    pub(super) stale: u64,
    /// Number of datagrams with a wrong size.
    pub(super) size_error: u64,
}

impl Consumer {
    /// Creates a receiver that starts at `now`. The timeout of the first datagram is [`FIRST_PACKET`], or the normal
    /// timeout if that is longer.
    pub(super) fn new(id: u32, size: usize, header: bool, interval: Duration, intervals: u32, now: Now) -> Self {
        let timeout = interval.saturating_mul(intervals);
        Self {
            id,
            size,
            header,
            interval,
            timeout,
            until: now.saturating_add(timeout.max(FIRST_PACKET)),
            last: None,
            received: 0,
            lost: 0,
            late: 0,
            stale: 0,
            size_error: 0,
        }
    }

    pub(super) const fn id(&self) -> u32 {
        self.id
    }

    /// Time when the stream times out.
    pub(super) const fn until(&self) -> Now {
        self.until
    }

    /// Timeout that applies to the next datagram.
    pub(super) fn patience(&self) -> Duration {
        if self.last.is_some() { self.timeout } else { self.timeout.max(FIRST_PACKET) }
    }

    pub(super) fn take<'a>(&mut self, now: Now, datagram: &Cyclic<'a>) -> DatagramResult<'a> {
        if let Some((last, _)) = self.last
            && !is_newer(datagram.sequence, last)
        {
            self.stale += 1;
            return DatagramResult::Stale;
        }
        let body = datagram.body;
        let (run, image) = match body.split_first_chunk::<4>() {
            _ if !self.header || body.is_empty() => (true, body),
            Some((header, image)) => (header[0] & 1 == 1, image),
            None => return self.size_errors(),
        };
        if image.len() != self.size && !body.is_empty() {
            return self.size_errors();
        }
        if let Some((last, at)) = self.last {
            self.lost += u64::from(datagram.sequence.wrapping_sub(last).saturating_sub(1));
            self.late += u64::from(now.saturating_sub(at) > self.interval.saturating_mul(3) / 2);
        }
        self.received += 1;
        self.last = Some((datagram.sequence, now));
        self.until = now.saturating_add(self.timeout);
        if image.is_empty() { DatagramResult::Alive } else { DatagramResult::Image { run, image } }
    }

    const fn size_errors(&mut self) -> DatagramResult<'static> {
        self.size_error += 1;
        DatagramResult::WrongSize
    }
}

/// Whether `one` comes after `other`. Sequence numbers wrap around, so the comparison uses serial number arithmetic.
const fn is_newer(one: u32, other: u32) -> bool {
    let ahead = one.wrapping_sub(other);
    ahead != 0 && ahead < 1 << 31
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    fn number(bytes: &[u8]) -> (u32, u16) {
        let datagram = Cyclic::parse(bytes).unwrap();
        (datagram.sequence, datagram.count)
    }

    #[test]
    fn a_producer_neither_drifts_nor_bursts() {
        let mut producer = Producer::new(1, 10 * MS, 100 * MS);
        assert_eq!(number(&producer.produce(103 * MS, None, &[])), (1, 1));
        assert_eq!(producer.due(), 110 * MS, "3 ms late moves nothing");
        producer.produce(147 * MS, None, &[]);
        assert_eq!((producer.due(), producer.skipped), (150 * MS, 3));
        assert_eq!(number(&producer.produce(150 * MS, None, &[])), (3, 3));
        assert_eq!((producer.due(), producer.sent), (160 * MS, 3));
    }

    #[test]
    fn sequence_numbers_wrap() {
        let mut producer = Producer::new(1, 10 * MS, Now::ZERO);
        (producer.sequence, producer.count) = (u32::MAX, u16::MAX);
        assert_eq!(number(&producer.produce(Now::ZERO, None, &[])), (0, 0));
        assert!(is_newer(0, u32::MAX) && is_newer(5, 4) && !is_newer(4, 4) && !is_newer(4, 5));
        assert!(!is_newer(1 << 31, 0));
    }

    fn consumer() -> Consumer {
        Consumer::new(1, 2, true, 10 * MS, 16, Now::ZERO)
    }

    fn datagram(sequence: u32, body: &[u8]) -> Cyclic<'_> {
        Cyclic { id: 1, sequence, count: 0, body }
    }

    #[test]
    fn first_datagram_has_a_timeout_of_ten_seconds() {
        let mut consumer = consumer();
        assert_eq!((consumer.until(), consumer.patience()), (10_000 * MS, 10_000 * MS));
        consumer.take(50 * MS, &datagram(9, &[1, 0, 0, 0, 5, 6]));
        assert_eq!((consumer.until(), consumer.patience()), (210 * MS, 160 * MS));
        let slow = Consumer::new(1, 2, true, 1000 * MS, 16, Now::ZERO);
        assert_eq!(slow.until(), 16_000 * MS);
    }

    #[test]
    fn old_repeated_and_invalid_datagrams_do_not_reset_the_watchdog() {
        let mut consumer = consumer();
        let image = [1, 0, 0, 0, 5, 6];
        assert_eq!(consumer.take(10 * MS, &datagram(9, &image)), DatagramResult::Image { run: true, image: &[5, 6] });
        assert_eq!(consumer.take(20 * MS, &datagram(9, &image)), DatagramResult::Stale);
        assert_eq!(consumer.take(20 * MS, &datagram(8, &image)), DatagramResult::Stale);
        assert_eq!(consumer.take(20 * MS, &datagram(10, &image[..5])), DatagramResult::WrongSize);
        assert_eq!(consumer.take(20 * MS, &datagram(10, &[0; 7])), DatagramResult::WrongSize);
        assert_eq!(consumer.take(20 * MS, &datagram(10, &[5, 6])), DatagramResult::WrongSize, "no header");
        assert_eq!(consumer.until(), 170 * MS);
        let idle = [0, 0, 0, 0, 5, 6];
        assert_eq!(consumer.take(30 * MS, &datagram(13, &idle)), DatagramResult::Image { run: false, image: &[5, 6] });
        assert_eq!(consumer.take(40 * MS, &datagram(14, &[])), DatagramResult::Alive);
        assert_eq!(consumer.until(), 200 * MS);
        assert_eq!((consumer.received, consumer.lost, consumer.late), (3, 3, 1));
        assert_eq!((consumer.stale, consumer.size_error), (2, 3));
    }
}
