//! TCP reassembly per direction: returns the bytes in order, without duplicates, and the length of each gap.

use std::collections::{BTreeMap, HashMap};
use std::net::SocketAddr;
use std::time::Duration;

use super::layers::Segment;

/// Key of one direction of a stream: section of the file, sender, receiver. The section is included, because each
/// section is a separate recording with its own sequence numbers.
pub type StreamKey = (usize, SocketAddr, SocketAddr);
/// Packet that delivered the bytes: its number, its time, and whether it was cut.
pub type Origin = (u64, Duration, bool);

/// The next bytes of a stream.
#[derive(Debug, Clone, Copy)]
pub struct StreamPiece<'a> {
    /// Stream and direction.
    pub key: StreamKey,
    /// Packet that delivered the bytes.
    pub origin: Origin,
    /// Whether these are the first bytes of a stream whose opening is in the file.
    pub begins: bool,
    /// Number of bytes that are missing before these bytes.
    pub lost: u32,
    /// The bytes.
    pub bytes: &'a [u8],
}

/// Maximum number of waiting segments per direction. If more segments wait, the missing bytes before them count as
/// lost.
const MAX_WAITING_SEGMENTS: usize = 64;

/// Maximum number of streams. The constant below is the maximum number of waiting bytes. Above a limit, all missing
/// bytes count as lost, and each stream starts again.
const MAX_STREAMS: usize = 1 << 16;
const MAX_HELD_BYTES: usize = 32 << 20;

/// TCP reassembly of all streams in a file.
#[derive(Debug, Default)]
pub struct Streams {
    streams: HashMap<StreamKey, Stream>,
    repeated: u64,
    /// Number of waiting bytes of all streams.
    held_bytes: usize,
}

/// One direction of a stream.
#[derive(Debug, Default)]
struct Stream {
    /// Next expected sequence number.
    next: Option<u32>,
    begins: bool,
    /// Segments that arrived before the bytes in front of them, by their position in the stream.
    waiting: BTreeMap<u64, (Origin, Vec<u8>)>,
    /// Number of bytes that were delivered or lost. Positions count from the start of the stream, because sequence
    /// numbers wrap around.
    consumed: u64,
    /// Number of waiting bytes.
    held_bytes: usize,
}

impl Streams {
    /// Adds a segment, and delivers the bytes that are now in order.
    pub fn take(
        &mut self,
        key: StreamKey,
        segment: &Segment<'_>,
        origin: Origin,
        deliver: &mut impl FnMut(&StreamPiece<'_>),
    ) {
        if self.held_bytes > MAX_HELD_BYTES || self.streams.len() >= MAX_STREAMS {
            self.finish(deliver);
            self.streams.clear();
            self.held_bytes = 0;
        }
        let held_bytes = self.streams.get(&key).map_or(0, |stream| stream.held_bytes);
        self.add_segment(key, segment, origin, deliver);
        self.held_bytes = self.held_bytes + self.streams.get(&key).map_or(0, |stream| stream.held_bytes) - held_bytes;
    }

    fn add_segment(
        &mut self,
        key: StreamKey,
        segment: &Segment<'_>,
        origin: Origin,
        deliver: &mut impl FnMut(&StreamPiece<'_>),
    ) {
        let stream = self.streams.entry(key).or_default();
        if segment.opens {
            stream.skip(key, deliver);
            *stream = Stream { next: Some(segment.sequence.wrapping_add(1)), begins: true, ..Stream::default() };
            return;
        }
        if segment.bytes.is_empty() {
            return;
        }
        let next = *stream.next.get_or_insert(segment.sequence);
        let ahead = segment.sequence.wrapping_sub(next);
        if ahead == 0 || ahead > u32::MAX / 2 {
            let known = usize::try_from(next.wrapping_sub(segment.sequence)).unwrap_or(usize::MAX);
            match segment.bytes.get(known..).filter(|new| !new.is_empty()) {
                Some(new) => stream.deliver((key, origin), 0, new, deliver),
                None => self.repeated += 1,
            }
            self.repeated += stream.drain(key, deliver);
        } else {
            let at = stream.consumed + u64::from(ahead);
            stream.waiting.entry(at).or_insert_with(|| {
                stream.held_bytes += segment.bytes.len();
                (origin, segment.bytes.to_vec())
            });
            if stream.waiting.len() > MAX_WAITING_SEGMENTS {
                stream.jump(key, deliver);
                self.repeated += stream.drain(key, deliver);
            }
        }
    }

    /// Delivers all waiting segments, and the lengths of the gaps before them.
    pub fn finish(&mut self, deliver: &mut impl FnMut(&StreamPiece<'_>)) {
        let mut left: Vec<_> = self.streams.iter_mut().filter(|(_, stream)| !stream.waiting.is_empty()).collect();
        left.sort_by_key(|(key, _)| **key);
        for (key, stream) in left {
            stream.skip(*key, deliver);
        }
    }

    /// Number of segments without new bytes.
    pub fn repeated(&self) -> u64 {
        self.repeated
    }
}

impl Stream {
    fn deliver(
        &mut self,
        (key, origin): (StreamKey, Origin),
        lost: u32,
        bytes: &[u8],
        deliver: &mut impl FnMut(&StreamPiece<'_>),
    ) {
        let len = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        self.next = self.next.map(|next| next.wrapping_add(lost).wrapping_add(len));
        self.consumed += u64::from(lost) + u64::from(len);
        deliver(&StreamPiece { key, origin, begins: std::mem::take(&mut self.begins), lost, bytes });
    }

    /// Delivers waiting segments up to the next gap. Returns the number of segments without new bytes.
    fn drain(&mut self, key: StreamKey, deliver: &mut impl FnMut(&StreamPiece<'_>)) -> u64 {
        let mut repeated = 0;
        while let Some(first) = self.waiting.first_entry()
            && *first.key() <= self.consumed
        {
            let (at, (origin, bytes)) = first.remove_entry();
            self.held_bytes -= bytes.len();
            let known = usize::try_from(self.consumed - at).unwrap_or(usize::MAX);
            match bytes.get(known..).filter(|new| !new.is_empty()) {
                Some(new) => self.deliver((key, origin), 0, new, deliver),
                None => repeated += 1,
            }
        }
        repeated
    }

    /// Declares the bytes before the first waiting segment as lost.
    fn jump(&mut self, key: StreamKey, deliver: &mut impl FnMut(&StreamPiece<'_>)) {
        if let Some((at, (origin, bytes))) = self.waiting.pop_first() {
            self.held_bytes -= bytes.len();
            let lost = u32::try_from(at.saturating_sub(self.consumed)).unwrap_or(u32::MAX);
            self.deliver((key, origin), lost, &bytes, deliver);
        }
    }

    fn skip(&mut self, key: StreamKey, deliver: &mut impl FnMut(&StreamPiece<'_>)) {
        while !self.waiting.is_empty() {
            self.jump(key, deliver);
            self.drain(key, deliver);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key() -> StreamKey {
        (0, "10.0.0.1:1".parse().unwrap(), "10.0.0.2:2".parse().unwrap())
    }

    /// Returns the reassembled pieces with the number of lost bytes before each piece.
    fn ordered(segments: &[(u32, &[u8])]) -> (Vec<(u64, u32, String)>, u64) {
        let mut streams = Streams::default();
        let mut all = Vec::new();
        let mut deliver = |ordered: &StreamPiece<'_>| {
            all.push((ordered.origin.0, ordered.lost, String::from_utf8_lossy(ordered.bytes).into_owned()));
        };
        for (number, (sequence, bytes)) in (1..).zip(segments) {
            let segment = Segment { sequence: *sequence, opens: false, bytes };
            streams.take(key(), &segment, (number, Duration::ZERO, false), &mut deliver);
        }
        streams.finish(&mut deliver);
        (all, streams.repeated())
    }

    fn rows(rows: &[(u64, u32, &str)]) -> Vec<(u64, u32, String)> {
        rows.iter().map(|(number, lost, text)| (*number, *lost, (*text).to_owned())).collect()
    }

    #[test]
    fn delivers_segments_in_order_and_once() {
        let near_wrap = u32::MAX - 2;
        let (all, repeated) =
            ordered(&[(near_wrap, b"abcd"), (3, b"gh"), (1, b"ef"), (near_wrap, b"abcd"), (1, b"efgh"), (3, b"ghi")]);
        assert_eq!(all, rows(&[(1, 0, "abcd"), (3, 0, "ef"), (2, 0, "gh"), (6, 0, "i")]));
        assert_eq!(repeated, 2);
    }

    #[test]
    fn limits_waiting_segments() {
        let mut streams = Streams::default();
        let mut all = 0;
        let bytes = vec![0; 60_000];
        for number in 0..3000u32 {
            let key = (usize::try_from(number).unwrap(), key().1, key().2);
            // The first segment opens the stream. The second segment waits, because the bytes before it are missing.
            for (sequence, bytes) in [(1, &bytes[..1]), (9, &bytes[..])] {
                let segment = Segment { sequence, opens: false, bytes };
                let origin = (number.into(), Duration::ZERO, false);
                streams.take(key, &segment, origin, &mut |ordered| all += ordered.bytes.len());
                assert!(streams.held_bytes <= MAX_HELD_BYTES + bytes.len());
            }
        }
        streams.finish(&mut |ordered| all += ordered.bytes.len());
        assert_eq!(all, 3000 * 60_001, "nothing is lost for that");
    }

    #[test]
    fn reports_gaps() {
        let (all, _) = ordered(&[(1, b"ab"), (5, b"ef"), (7, b"gh")]);
        assert_eq!(all, rows(&[(1, 0, "ab"), (2, 2, "ef"), (3, 0, "gh")]));
    }
}
