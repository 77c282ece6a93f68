//! In-process serial line with character timing and fault injection.

use std::collections::VecDeque;
use std::time::Duration;

use tokio::task::coop::consume_budget;
use tokio::time::Instant;

use super::fault::{FaultedCharacters, LineFaultSpec, LineFaults};
use super::sim::Peer;

/// Speed of a line in characters per time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pace {
    /// Bits per second, at least 1.
    baud: u32,
    /// Bits per character, including start, parity and stop bits.
    bits: u32,
}

impl Pace {
    /// Creates a pace of `baud` bits per second, with `bits` bits per character. For example, 8 data bits with parity
    /// and one stop bit are 11 bits per character.
    pub fn new(baud: u32, bits: u32) -> Self {
        Self { baud: baud.max(1), bits: bits.max(1) }
    }

    /// Duration of `characters` without gaps.
    pub fn time(self, characters: usize) -> Duration {
        let nanos = (characters as u128 * u128::from(self.bits) * NANOS).div_ceil(u128::from(self.baud));
        Duration::from_nanos(u64::try_from(nanos).unwrap_or(u64::MAX))
    }

    /// Number of complete characters within `time`.
    fn characters(self, time: Duration) -> usize {
        let characters = time.as_nanos() * u128::from(self.baud) / (u128::from(self.bits) * NANOS);
        usize::try_from(characters).unwrap_or(usize::MAX)
    }
}

const NANOS: u128 = 1_000_000_000;

/// A peer behind an in-process line. It uses tokio's clock, which tests can pause and advance.
#[derive(Debug)]
pub struct InProcessLine<P> {
    peer: P,
    wire: Wire,
    start: Instant,
}

impl<P: Peer> InProcessLine<P> {
    /// Creates a line to a peer. Without a pace, characters take no time.
    pub fn new(peer: P, pace: Option<Pace>, faults: Option<LineFaultSpec>) -> Self {
        Self { peer, wire: Wire::new(pace, faults), start: Instant::now() }
    }

    /// The peer, in its state after the last send or receive. Later events of the peer are not included.
    pub fn peer(&self) -> &P {
        &self.peer
    }

    /// Sends bytes to the peer. Returns at once, while the bytes are in transit.
    pub fn send(&mut self, bytes: &[u8]) {
        let now = self.start.elapsed();
        // Events before `now` must be handled before the new bytes are sent.
        self.wire.run(now, &mut self.peer);
        self.wire.send(now, bytes);
    }

    /// Waits until `until` for bytes of the peer. Returns `None` after a timeout.
    pub async fn receive(&mut self, buffer: &mut [u8], until: Instant) -> Option<usize> {
        // If a peer always answers at once, this call gives the runtime time to handle Ctrl-C.
        consume_budget().await;
        loop {
            let now = self.start.elapsed();
            self.wire.run(now, &mut self.peer);
            let delivered = self.wire.take(now, buffer);
            if delivered > 0 {
                return Some(delivered);
            }
            let now = self.start + now;
            if now >= until {
                return None;
            }
            let due = self.wire.due(&self.peer).map_or(until, |due| (self.start + due).min(until));
            tokio::time::sleep_until(due.max(now)).await;
        }
    }

    /// Drops bytes that have arrived. Bytes in transit still arrive.
    pub fn discard(&mut self) {
        let now = self.start.elapsed();
        self.wire.run(now, &mut self.peer);
        while self.wire.take(now, &mut [0; 256]) > 0 {}
    }
}

/// Both directions of a line between host and peer. The line has no clock: the caller passes the time.
#[derive(Debug)]
pub struct Wire {
    to_peer: Direction,
    to_host: Direction,
    has_echo: bool,
    /// Time of the last call of `run`.
    time: Duration,
}

impl Wire {
    /// Creates an idle line.
    pub fn new(pace: Option<Pace>, faults: Option<LineFaultSpec>) -> Self {
        let has_echo = faults.as_ref().is_some_and(|spec| spec.echo);
        let (to_peer, to_host) = faults.map(LineFaults::pair).unzip();
        Self {
            to_peer: Direction::new(pace, to_peer),
            to_host: Direction::new(pace, to_host),
            has_echo,
            time: Duration::ZERO,
        }
    }

    /// Changes the faults. Bytes that are already in transit keep the old faults.
    pub fn set_faults(&mut self, faults: Option<LineFaultSpec>) {
        self.has_echo = faults.as_ref().is_some_and(|spec| spec.echo);
        (self.to_peer.faults, self.to_host.faults) = faults.map(LineFaults::pair).unzip();
    }

    /// Sends bytes of the host at `now`.
    pub fn send(&mut self, now: Duration, bytes: &[u8]) {
        self.to_peer.queue_bytes(now, bytes);
        if self.has_echo {
            self.to_host.queue_bytes(now, bytes);
        }
    }

    /// Executes all events up to `now`, each at its own time.
    pub fn run(&mut self, now: Duration, peer: &mut impl Peer) {
        loop {
            let due = earliest(self.to_peer.due(), peer.wake());
            let at = due.filter(|due| *due > self.time && *due < now).unwrap_or(now);
            self.time = at;
            while let Some(piece) = self.to_peer.next(at, usize::MAX) {
                match piece {
                    ReceivedCharacters::Whole(bytes) => peer.receive(at, 0, bytes),
                    ReceivedCharacters::Damaged => peer.damaged(at, 0),
                }
            }
            while let Some((_, bytes)) = peer.transmit(at) {
                self.to_host.queue_bytes(at, &bytes);
            }
            if at >= now {
                return;
            }
        }
    }

    /// Reads the bytes that the host has received by `now`. A character with a parity error reads as NUL, as with the
    /// driver of a serial port.
    pub fn take(&mut self, now: Duration, buffer: &mut [u8]) -> usize {
        let mut delivered = 0;
        while let Some(piece) = self.to_host.next(now, buffer.len() - delivered) {
            let bytes = match piece {
                ReceivedCharacters::Whole(bytes) => bytes,
                ReceivedCharacters::Damaged => &[0],
            };
            buffer[delivered..delivered + bytes.len()].copy_from_slice(bytes);
            delivered += bytes.len();
        }
        delivered
    }

    /// Time of the next event.
    pub fn due(&self, peer: &impl Peer) -> Option<Duration> {
        earliest(earliest(self.to_peer.due(), self.to_host.due()), peer.wake())
    }

    /// Drops all bytes that are in transit to the host.
    pub fn lose(&mut self, now: Duration) {
        self.to_host.runs.clear();
        self.to_host.idle_at = now;
    }
}

fn earliest(one: Option<Duration>, other: Option<Duration>) -> Option<Duration> {
    one.into_iter().chain(other).min()
}

#[derive(Debug)]
struct Direction {
    pace: Option<Pace>,
    faults: Option<LineFaults>,
    /// Writes of which characters are in transit, in order.
    runs: VecDeque<Run>,
    /// Time at which the last written character ends.
    idle_at: Duration,
}

/// The characters of one write. There are no gaps between them.
#[derive(Debug)]
struct Run {
    /// Start of the first character.
    start: Duration,
    passed: FaultedCharacters,
    /// Number of characters already delivered.
    delivered: usize,
}

/// Received characters.
enum ReceivedCharacters<'a> {
    Whole(&'a [u8]),
    /// One character with a parity error.
    Damaged,
}

impl Direction {
    const fn new(pace: Option<Pace>, faults: Option<LineFaults>) -> Self {
        Self { pace, faults, runs: VecDeque::new(), idle_at: Duration::ZERO }
    }

    fn queue_bytes(&mut self, now: Duration, bytes: &[u8]) {
        let passed = match &mut self.faults {
            Some(faults) => faults.pass(bytes),
            None => FaultedCharacters { bytes: bytes.to_vec(), ..FaultedCharacters::default() },
        };
        if passed.bytes.is_empty() {
            return;
        }
        let start = now.saturating_add(passed.delay).max(self.idle_at);
        self.idle_at = start.saturating_add(self.pace.map_or(Duration::ZERO, |pace| pace.time(passed.bytes.len())));
        self.runs.push_back(Run { start, passed, delivered: 0 });
    }

    /// Time at which the next character ends.
    fn due(&self) -> Option<Duration> {
        let run = self.runs.iter().find(|run| run.delivered < run.passed.bytes.len())?;
        Some(run.start.saturating_add(self.pace.map_or(Duration::ZERO, |pace| pace.time(run.delivered + 1))))
    }

    /// Returns at most `most` characters that are complete at `now`.
    fn next(&mut self, now: Duration, most: usize) -> Option<ReceivedCharacters<'_>> {
        while self.runs.front().is_some_and(|run| run.delivered == run.passed.bytes.len()) {
            self.runs.pop_front();
        }
        let pace = self.pace;
        let Run { start, passed, delivered } = self.runs.front_mut()?;
        let arrived = match (now.checked_sub(*start), pace) {
            (None, _) => 0,
            (Some(_), None) => passed.bytes.len(),
            (Some(time), Some(pace)) => pace.characters(time).min(passed.bytes.len()),
        };
        let from = *delivered;
        let end = arrived.min(from.saturating_add(most));
        if from >= end {
            return None;
        }
        if passed.damaged.front() == Some(&from) {
            passed.damaged.pop_front();
            *delivered += 1;
            return Some(ReceivedCharacters::Damaged);
        }
        *delivered = passed.damaged.front().map_or(end, |damaged| end.min(*damaged));
        passed.bytes.get(from..*delivered).map(ReceivedCharacters::Whole)
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::Mirror;
    use super::*;

    /// 9600 baud, 8 data bits, even parity, 1 stop bit.
    const USUAL: Pace = Pace { baud: 9600, bits: 11 };

    fn with_faults(text: &str) -> InProcessLine<Mirror> {
        let faults = text.parse().unwrap_or_else(|error| panic!("{text}: {error}"));
        InProcessLine::new(Mirror::default(), Some(USUAL), Some(faults))
    }

    /// Returns everything received until a silence of one minute, and the time of the last byte.
    async fn all(line: &mut InProcessLine<Mirror>) -> (Vec<u8>, Duration) {
        let (start, mut end, mut bytes) = (Instant::now(), Duration::ZERO, Vec::new());
        let mut buffer = [0; 4096];
        while let Some(len) = line.receive(&mut buffer, Instant::now() + Duration::from_secs(60)).await {
            bytes.extend(&buffer[..len]);
            end = start.elapsed();
        }
        (bytes, end)
    }

    fn before_next(time: Duration) -> Duration {
        time.saturating_sub(Duration::from_nanos(1))
    }

    #[test]
    fn characters_take_their_transmission_time() {
        assert_eq!(USUAL.time(128), Duration::from_nanos(146_666_667));
        assert_eq!(USUAL.time(0), Duration::ZERO);
        for count in 0..2000 {
            assert_eq!(USUAL.characters(USUAL.time(count)), count);
            assert_eq!(USUAL.characters(before_next(USUAL.time(count + 1))), count);
        }
        assert_eq!(Pace::new(0, 0).time(1), Duration::from_secs(1), "no division by zero");
    }

    #[test]
    fn line_delays_both_directions() {
        let (mut wire, mut peer) = (Wire::new(Some(USUAL), None), Mirror::default());
        let mut line = vec![b'x'; 127];
        line.push(b'\n');
        wire.send(Duration::ZERO, &line);
        // The line runs one second later, but each event must happen at its own time.
        wire.run(Duration::from_secs(1), &mut peer);
        assert_eq!(peer.heard, [(USUAL.time(128), line)]);
        let mut buffer = [0; 256];
        let to_peer = USUAL.time(128);
        for count in 1..=128 {
            assert_eq!(wire.take(before_next(to_peer + USUAL.time(count)), &mut buffer), 0);
            assert_eq!(wire.take(to_peer + USUAL.time(count), &mut buffer), 1);
        }
        assert_eq!(wire.due(&peer), None);
    }

    #[tokio::test(start_paused = true)]
    async fn exchange_takes_as_long_as_on_a_real_line() {
        let mut line = InProcessLine::new(Mirror::default(), Some(USUAL), None);
        line.send(&[[b'x'; 127].as_slice(), b"\n"].concat());
        let (bytes, took) = all(&mut line).await;
        assert_eq!(bytes.len(), 128);
        let exact = USUAL.time(256);
        // Tokio's timers have a resolution of one millisecond.
        assert!((exact..exact + Duration::from_millis(2)).contains(&took), "{took:?}");
    }

    #[tokio::test(start_paused = true)]
    async fn without_a_pace_nothing_takes_time() {
        let mut line = InProcessLine::new(Mirror::default(), None, None);
        line.send(b"abc\n");
        assert_eq!(all(&mut line).await, (b"\ncba".to_vec(), Duration::ZERO));
    }

    #[tokio::test(start_paused = true)]
    async fn silence_ends_at_its_time() {
        let mut line = InProcessLine::new(Mirror::default(), None, None);
        let until = Instant::now() + Duration::from_millis(1200);
        assert_eq!(line.receive(&mut [0; 8], until).await, None);
        assert_eq!(Instant::now(), until);
    }

    #[tokio::test(start_paused = true)]
    async fn a_million_bytes_come_in_order() {
        let mut line = InProcessLine::new(Mirror::default(), Some(Pace::new(11_000_000, 11)), None);
        let sent: Vec<u8> =
            (0..1_000_000_u32).map(|at| if at == 999_999 { b'\n' } else { b'a' + (at % 26) as u8 }).collect();
        line.send(&sent);
        let (mut bytes, took) = all(&mut line).await;
        bytes.reverse();
        assert!(bytes == sent);
        assert!((2000..2010).contains(&took.as_millis()), "{took:?}");
    }

    #[tokio::test(start_paused = true)]
    async fn discards_only_earlier_bytes() {
        let mut line = InProcessLine::new(Mirror::default(), Some(USUAL), None);
        line.send(b"abc\n");
        tokio::time::sleep(USUAL.time(6)).await;
        line.discard();
        assert_eq!(all(&mut line).await.0, b"ba");
    }

    #[tokio::test(start_paused = true)]
    async fn damaged_character_is_reported_and_reads_as_nul() {
        let mut line = with_faults("parity=100%");
        line.send(b"abc\n");
        assert_eq!(all(&mut line).await.0, b"");
        assert_eq!((line.peer.damaged, line.peer.heard.len()), (4, 0));
        line.peer.answers.push_back(b"@OK".to_vec());
        assert_eq!(all(&mut line).await.0, [0; 3]);
    }

    #[tokio::test(start_paused = true)]
    async fn damaged_characters_keep_their_position() {
        let mut line = with_faults("parity=30%,seed=4");
        line.peer.answers.push_back((1..=40).collect());
        let bytes = all(&mut line).await.0;
        let expected: Vec<u8> = (1..=40).zip(&bytes).map(|(byte, got)| if *got == 0 { 0 } else { byte }).collect();
        assert_eq!(bytes, expected);
        assert!((5..20).contains(&bytes.split(|byte| *byte == 0).count()), "{bytes:?}");
    }

    #[tokio::test(start_paused = true)]
    async fn delay_applies_to_a_complete_write() {
        let mut line = with_faults("delay=20ms");
        line.send(b"a\n");
        let (bytes, took) = all(&mut line).await;
        assert_eq!((bytes.as_slice(), took.as_millis()), (b"\na".as_slice(), 45));
    }

    #[tokio::test(start_paused = true)]
    async fn an_echo_comes_before_the_answer() {
        let mut line = with_faults("echo");
        line.send(b"abc\n");
        assert_eq!(all(&mut line).await.0, b"abc\n\ncba");
    }

    #[tokio::test(start_paused = true)]
    async fn the_seed_decides_what_arrives() {
        let run = async |seed: u32| {
            let mut line = with_faults(&format!("noise=5%,parity=5%,drop=5%,dup=5%,delay=0..50ms,seed={seed}"));
            for _ in 0..20 {
                line.send(b"@STAS SNO=0\r\n");
            }
            let bytes = all(&mut line).await;
            (bytes, line.peer.heard)
        };
        assert_eq!(run(1).await, run(1).await);
        assert_ne!(run(1).await, run(2).await);
    }
}
