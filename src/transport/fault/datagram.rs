//! Fault injection for datagrams.
//!
//! The fault `corrupt` is limited on purpose. UDP's checksum detects nearly all damage that occurs on the network. The
//! damage that it does not detect comes from faulty network stacks, wrong senders and wrong ports. Therefore a corrupt
//! datagram is cut, extended, zeroed, changed in its first eight bytes (where protocols have identifiers and sizes) or
//! replaced by noise. A changed payload is not simulated, because a protocol without a checksum cannot detect it.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;
use std::time::Duration;

use fastrand::Rng;

use super::{
    DELAY_FORM, FaultSpecError, FaultText, Key, SEED_FORM, SHARE_FORM, Setter, Share, between, delay, parse_link,
    write_delay, write_shares,
};

/// Maximum number of noise bytes that replace a datagram.
const MAX_NOISE: usize = 600;
/// Maximum number of bytes added to a datagram.
const MAX_EXTRA: usize = 32;
/// Number of bytes at the start of a datagram that may be changed.
const HEAD: usize = 8;
/// Extra delay of a reordered datagram. The delay is longer than a fast answer takes, and may be longer than the usual
/// retry time. Therefore the datagram arrives during the next exchange, or after its own retransmission.
const HOLD_TIME: RangeInclusive<Duration> = Duration::from_millis(20)..=Duration::from_millis(400);

/// Fault rates. The text form is, for example, `drop=5%,dup=2%,delay=0..50ms,reorder=3%,corrupt=1%,busy=4%,seed=7`.
/// Every part is optional.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FaultSpec {
    /// Share of datagrams that are lost.
    pub drop: Share,
    /// Share of datagrams that are doubled. The copy has its own delay.
    pub dup: Share,
    /// Transmission time. Without `reorder`, a delay does not change the order of the datagrams.
    pub delay: RangeInclusive<Duration>,
    /// Share of datagrams that arrive after later datagrams.
    pub reorder: Share,
    /// Share of datagrams that are damaged.
    pub corrupt: Share,
    /// Share of requests that a simulated controller refuses as busy. The simulator itself applies this fault.
    pub busy: Share,
    /// Seed of the random sequence.
    pub seed: u64,
}

impl Default for FaultSpec {
    /// No faults.
    fn default() -> Self {
        Self {
            drop: Share::NONE,
            dup: Share::NONE,
            delay: Duration::ZERO..=Duration::ZERO,
            reorder: Share::NONE,
            corrupt: Share::NONE,
            busy: Share::NONE,
            seed: 0,
        }
    }
}

impl FaultText for FaultSpec {
    const KEYS: &'static [Key<Self>] = &[
        ("drop", Setter::Value(SHARE_FORM, |spec, text| Share::parse(text).map(|share| spec.drop = share))),
        ("dup", Setter::Value(SHARE_FORM, |spec, text| Share::parse(text).map(|share| spec.dup = share))),
        ("delay", Setter::Value(DELAY_FORM, |spec, text| delay(text).map(|delay| spec.delay = delay))),
        ("reorder", Setter::Value(SHARE_FORM, |spec, text| Share::parse(text).map(|share| spec.reorder = share))),
        ("corrupt", Setter::Value(SHARE_FORM, |spec, text| Share::parse(text).map(|share| spec.corrupt = share))),
        ("busy", Setter::Value(SHARE_FORM, |spec, text| Share::parse(text).map(|share| spec.busy = share))),
        ("seed", Setter::Value(SEED_FORM, |spec, text| text.parse().ok().map(|seed| spec.seed = seed))),
    ];
}

impl FromStr for FaultSpec {
    type Err = FaultSpecError;

    fn from_str(text: &str) -> Result<Self, FaultSpecError> {
        parse_link(text)
    }
}

impl fmt::Display for FaultSpec {
    /// Writes the seed and all rates that are not 0. Parsing the text gives the same specification.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_shares(f, &[("drop", self.drop), ("dup", self.dup)])?;
        write_delay(f, &self.delay)?;
        write_shares(f, &[("reorder", self.reorder), ("corrupt", self.corrupt), ("busy", self.busy)])?;
        write!(f, "seed={}", self.seed)
    }
}

/// Fault injection for one direction.
#[derive(Debug, Clone)]
pub struct Faults {
    spec: FaultSpec,
    rng: Rng,
    /// Time at which the last datagram that was not reordered arrives.
    last: Duration,
}

impl Faults {
    /// Creates the faults of one direction.
    pub fn new(spec: FaultSpec) -> Self {
        let rng = Rng::with_seed(spec.seed);
        Self { spec, rng, last: Duration::ZERO }
    }

    /// Creates the faults of both directions, each with its own random sequence.
    pub fn pair(spec: FaultSpec) -> (Self, Self) {
        let there = Self::new(spec);
        let mut back = there.clone();
        back.rng = back.rng.fork();
        (there, back)
    }

    /// Applies the faults to a datagram that is sent at `now`. Returns the arrival time and the bytes of each copy, in
    /// any order. Arrival times count from the same origin as `now`.
    pub fn pass(&mut self, now: Duration, bytes: &[u8]) -> Vec<(Duration, Vec<u8>)> {
        if self.spec.drop.occurs(&mut self.rng) {
            return Vec::new();
        }
        let mut copies = Vec::with_capacity(2);
        let at = now.saturating_add(self.apply_all());
        if self.spec.reorder.occurs(&mut self.rng) {
            let hold = between(&mut self.rng, &HOLD_TIME);
            copies.push((at.saturating_add(hold), self.content(bytes)));
        } else {
            self.last = self.last.max(at);
            copies.push((self.last, self.content(bytes)));
        }
        if self.spec.dup.occurs(&mut self.rng) {
            let at = at.saturating_add(self.apply_all());
            copies.push((at, self.content(bytes)));
        }
        copies
    }

    fn apply_all(&mut self) -> Duration {
        between(&mut self.rng, &self.spec.delay)
    }

    fn content(&mut self, bytes: &[u8]) -> Vec<u8> {
        if self.spec.corrupt.occurs(&mut self.rng) { damaged(&mut self.rng, bytes) } else { bytes.to_vec() }
    }
}

type Damage = fn(&mut Rng, Vec<u8>) -> Vec<u8>;

/// Kinds of damage. Each kind changes the length or the first bytes of a datagram.
const DAMAGES: [Damage; 5] = [
    |rng, mut bytes| {
        bytes.truncate(rng.usize(..bytes.len().max(1)));
        bytes
    },
    |rng, mut bytes| {
        let extra = rng.usize(1..=MAX_EXTRA);
        bytes.extend(noise(rng, extra));
        bytes
    },
    |_, bytes| vec![0; bytes.len()],
    |rng, mut bytes| {
        let at = rng.usize(..bytes.len().clamp(1, HEAD));
        if let Some(byte) = bytes.get_mut(at) {
            *byte ^= rng.u8(1..);
        }
        bytes
    },
    |rng, _| {
        let length = rng.usize(..=MAX_NOISE);
        noise(rng, length)
    },
];

fn damaged(rng: &mut Rng, bytes: &[u8]) -> Vec<u8> {
    let damage = DAMAGES[rng.usize(..DAMAGES.len())];
    damage(rng, bytes.to_vec())
}

fn noise(rng: &mut Rng, length: usize) -> Vec<u8> {
    let mut bytes = vec![0; length];
    rng.fill(&mut bytes);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spec(text: &str) -> FaultSpec {
        text.parse().unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    fn ms(millis: u64) -> Duration {
        Duration::from_millis(millis)
    }

    #[test]
    fn every_key_round_trips() {
        let text = "drop=5%,dup=2%,delay=0ms..50ms,reorder=3%,corrupt=1%,busy=4%,seed=7";
        let expected = FaultSpec {
            drop: Share(500),
            dup: Share(200),
            delay: ms(0)..=ms(50),
            reorder: Share(300),
            corrupt: Share(100),
            busy: Share(400),
            seed: 7,
        };
        assert_eq!(spec("drop=5%,dup=2%,delay=0..50ms,reorder=3%,corrupt=1%,busy=4%,seed=7"), expected);
        assert_eq!(expected.to_string(), text);
        assert_eq!(spec(text), expected);
    }

    #[test]
    fn display_and_parse_agree() {
        for text in [
            "seed=0",
            "drop=0.5%,seed=18446744073709551615",
            "dup=12.34%,seed=1",
            "corrupt=0.05%,seed=1",
            "drop=100%,delay=20ms,seed=3",
            "delay=1500us..2ms,seed=3",
            "delay=1s..60s,seed=3",
        ] {
            assert_eq!(spec(text).to_string(), text);
        }
        assert_eq!(spec("drop=0%"), FaultSpec::default());
        assert_eq!(spec("drop=2.50%, dup=1%").to_string(), "drop=2.5%,dup=1%,seed=0");
    }

    #[test]
    fn errors_name_the_key_and_the_form() {
        let share = "a percentage from 0% to 100% with at most two decimals, for example 2.5%";
        let time = "a time or range of up to 60s in us, ms or s, for example 20ms or 0..50ms";
        let names = "the faults are drop, dup, delay, reorder, corrupt, busy, seed";
        let cases: [(&str, &str); 15] = [
            ("", &format!("unknown fault ''; {names}")),
            ("drop", &format!("drop needs a value: {share}")),
            ("drop=5%,", &format!("unknown fault ''; {names}")),
            ("lose=5%", &format!("unknown fault 'lose'; {names}")),
            ("drop=1%,drop=2%", "drop appears twice"),
            ("drop=5", &format!("drop: '5' is not {share}")),
            ("dup=101%", &format!("dup: '101%' is not {share}")),
            ("dup=-1%", &format!("dup: '-1%' is not {share}")),
            ("busy=1.234%", &format!("busy: '1.234%' is not {share}")),
            ("busy=.%", &format!("busy: '.%' is not {share}")),
            ("delay=5", &format!("delay: '5' is not {time}")),
            ("delay=50..20ms", &format!("delay: '50..20ms' is not {time}")),
            ("delay=61s", &format!("delay: '61s' is not {time}")),
            ("delay=ä..é", &format!("delay: 'ä..é' is not {time}")),
            ("seed=-1", "seed: '-1' is not a whole number from 0 to 18446744073709551615"),
        ];
        for (text, message) in cases {
            assert_eq!(text.parse::<FaultSpec>().unwrap_err().to_string(), message, "{text}");
        }
    }

    #[test]
    fn without_faults_everything_arrives_once_at_once() {
        let mut faults = Faults::new(FaultSpec::default());
        for at in 0..100 {
            assert_eq!(faults.pass(ms(at), &[1, 2, 3]), [(ms(at), vec![1, 2, 3])]);
        }
    }

    #[test]
    fn the_seed_decides_and_the_directions_differ() {
        let run = |faults: &mut Faults| (0..200).map(|at| faults.pass(ms(at), &[7; 40])).collect::<Vec<_>>();
        let text = "drop=20%,dup=20%,delay=0..50ms,reorder=20%,corrupt=20%";
        let (mut there, mut back) = Faults::pair(spec(&format!("{text},seed=1")));
        let one = run(&mut there);
        assert!(one == run(&mut Faults::new(spec(&format!("{text},seed=1")))), "the same seed, other faults");
        assert!(one != run(&mut back), "both directions have the same faults");
        assert!(one != run(&mut Faults::new(spec(&format!("{text},seed=2")))), "another seed, the same faults");
    }

    #[test]
    fn fault_rates_are_met() {
        let (mut lost, mut doubled) = (0, 0);
        let mut faults = Faults::new(spec("drop=10%,dup=10%,seed=5"));
        for _ in 0..10_000 {
            match faults.pass(ms(0), &[0]).len() {
                0 => lost += 1,
                2 => doubled += 1,
                _ => {}
            }
        }
        assert!((900..1100).contains(&lost) && (810..1000).contains(&doubled), "{lost} lost, {doubled} doubled");
        assert!(Faults::new(spec("drop=100%")).pass(ms(0), &[0]).is_empty());
    }

    #[test]
    fn delay_keeps_the_order_and_reordering_breaks_it() {
        let arrivals = |text: &str| {
            let mut faults = Faults::new(spec(text));
            (0..200).map(|at| faults.pass(ms(at), &[0])[0].0).collect::<Vec<_>>()
        };
        let delayed = arrivals("delay=10..50ms,seed=3");
        assert!(delayed.is_sorted());
        assert!((0..).zip(&delayed).all(|(sent, at)| (ms(sent + 10)..=ms(sent + 50)).contains(at)), "{delayed:?}");
        assert!(!arrivals("reorder=10%,seed=3").is_sorted());
    }

    #[test]
    fn damage_never_yields_a_valid_datagram_with_another_payload() {
        let mut rng = Rng::with_seed(9);
        let whole: Vec<u8> = (1..=48).collect();
        for _ in 0..10_000 {
            let bytes = damaged(&mut rng, &whole);
            assert!(bytes.len() != whole.len() || bytes[..HEAD] != whole[..HEAD], "{bytes:?}");
        }
        for bytes in [&[][..], &[1]] {
            for _ in 0..100 {
                damaged(&mut rng, bytes);
            }
        }
    }
}
