//! Fault injection for a serial line.

use std::collections::VecDeque;
use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;
use std::time::Duration;

use fastrand::Rng;

use super::{
    DELAY_FORM, FaultSpecError, FaultText, Key, SEED_FORM, SHARE_FORM, Setter, Share, between, delay, parse_link,
    write_delay, write_shares,
};

/// Fault rates. The text form is, for example, `noise=1%,parity=1%,drop=1%,dup=1%,delay=0..50ms,busy=4%,echo,seed=7`.
/// Every part is optional. Rates are per character.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LineFaultSpec {
    /// Share of characters with noise: the character is changed, or a random character is inserted before it.
    pub noise: Share,
    /// Share of characters with a parity error. The receiver detects the error.
    pub parity: Share,
    /// Share of characters that are lost.
    pub drop: Share,
    /// Share of characters that are doubled.
    pub dup: Share,
    /// Delay of each write. The writes keep their order.
    pub delay: RangeInclusive<Duration>,
    /// Share of requests that a simulated controller refuses as busy. The simulator itself applies this fault.
    pub busy: Share,
    /// Whether the host receives an echo of the bytes that it sends. For example, some RS-485 adapters and a loop-back
    /// plug cause such an echo.
    pub echo: bool,
    /// Seed of the random sequence.
    pub seed: u64,
}

impl Default for LineFaultSpec {
    /// No faults.
    fn default() -> Self {
        Self {
            noise: Share::NONE,
            parity: Share::NONE,
            drop: Share::NONE,
            dup: Share::NONE,
            delay: Duration::ZERO..=Duration::ZERO,
            busy: Share::NONE,
            echo: false,
            seed: 0,
        }
    }
}

impl FaultText for LineFaultSpec {
    const KEYS: &'static [Key<Self>] = &[
        ("noise", Setter::Value(SHARE_FORM, |spec, text| Share::parse(text).map(|share| spec.noise = share))),
        ("parity", Setter::Value(SHARE_FORM, |spec, text| Share::parse(text).map(|share| spec.parity = share))),
        ("drop", Setter::Value(SHARE_FORM, |spec, text| Share::parse(text).map(|share| spec.drop = share))),
        ("dup", Setter::Value(SHARE_FORM, |spec, text| Share::parse(text).map(|share| spec.dup = share))),
        ("delay", Setter::Value(DELAY_FORM, |spec, text| delay(text).map(|delay| spec.delay = delay))),
        ("busy", Setter::Value(SHARE_FORM, |spec, text| Share::parse(text).map(|share| spec.busy = share))),
        ("echo", Setter::Flag(|spec| spec.echo = true)),
        ("seed", Setter::Value(SEED_FORM, |spec, text| text.parse().ok().map(|seed| spec.seed = seed))),
    ];
}

impl FromStr for LineFaultSpec {
    type Err = FaultSpecError;

    fn from_str(text: &str) -> Result<Self, FaultSpecError> {
        parse_link(text)
    }
}

impl fmt::Display for LineFaultSpec {
    /// Writes the seed and all rates that are not 0. Parsing the text gives the same specification.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shares = [("noise", self.noise), ("parity", self.parity), ("drop", self.drop), ("dup", self.dup)];
        write_shares(f, &shares)?;
        write_delay(f, &self.delay)?;
        write_shares(f, &[("busy", self.busy)])?;
        if self.echo {
            f.write_str("echo,")?;
        }
        write!(f, "seed={}", self.seed)
    }
}

/// Fault injection for one direction.
#[derive(Debug, Clone)]
pub struct LineFaults {
    spec: LineFaultSpec,
    rng: Rng,
}

/// Characters of one write, as they arrive after the faults.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FaultedCharacters {
    /// Delay of the write.
    pub delay: Duration,
    /// Characters that arrive.
    pub bytes: Vec<u8>,
    /// Positions of the characters with a parity error, in ascending order.
    pub damaged: VecDeque<usize>,
}

impl LineFaults {
    /// Creates the faults of one direction.
    pub fn new(spec: LineFaultSpec) -> Self {
        let rng = Rng::with_seed(spec.seed);
        Self { spec, rng }
    }

    /// Creates the faults of both directions, each with its own random sequence.
    pub fn pair(spec: LineFaultSpec) -> (Self, Self) {
        let there = Self::new(spec);
        let mut back = there.clone();
        back.rng = back.rng.fork();
        (there, back)
    }

    /// Applies the faults to the characters of one write.
    pub fn pass(&mut self, bytes: &[u8]) -> FaultedCharacters {
        let delay = between(&mut self.rng, &self.spec.delay);
        let mut passed = FaultedCharacters { delay, bytes: Vec::with_capacity(bytes.len()), damaged: VecDeque::new() };
        for &byte in bytes {
            if self.occurs(self.spec.drop) {
                continue;
            }
            let copies = if self.occurs(self.spec.dup) { 2 } else { 1 };
            for _ in 0..copies {
                self.arrive(byte, &mut passed);
            }
        }
        passed
    }

    fn arrive(&mut self, byte: u8, passed: &mut FaultedCharacters) {
        let is_noisy = self.occurs(self.spec.noise);
        if is_noisy {
            passed.bytes.push(self.rng.u8(..));
        }
        // In half of the cases, the noise replaces the character. In the other cases, it is inserted before the
        // character.
        if is_noisy && self.rng.bool() {
            return;
        }
        if self.occurs(self.spec.parity) {
            passed.damaged.push_back(passed.bytes.len());
        }
        passed.bytes.push(byte);
    }

    /// Whether a fault with this rate occurs now. For a rate of 0, no random number is drawn, so a line without faults
    /// costs nothing.
    fn occurs(&mut self, share: Share) -> bool {
        share != Share::NONE && share.occurs(&mut self.rng)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spec(text: &str) -> LineFaultSpec {
        text.parse().unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    fn pass(text: &str, bytes: &[u8]) -> FaultedCharacters {
        LineFaults::new(spec(text)).pass(bytes)
    }

    #[test]
    fn every_key_round_trips() {
        let text = "noise=1%,parity=2%,drop=3%,dup=4%,delay=0ms..50ms,busy=5%,echo,seed=7";
        let expected = LineFaultSpec {
            noise: Share(100),
            parity: Share(200),
            drop: Share(300),
            dup: Share(400),
            delay: Duration::ZERO..=Duration::from_millis(50),
            busy: Share(500),
            echo: true,
            seed: 7,
        };
        assert_eq!(spec(text), expected);
        assert_eq!(expected.to_string(), text);
        assert_eq!(spec("seed=0"), LineFaultSpec::default());
    }

    #[test]
    fn errors_name_the_key_and_the_form() {
        for (text, message) in [
            ("echo=on", "echo takes no value, but has the value 'on'"),
            ("echo,echo", "echo appears twice"),
            ("noise", "noise needs a value: a percentage from 0% to 100% with at most two decimals, for example 2.5%"),
            ("reorder=1%", "unknown fault 'reorder'; the faults are noise, parity, drop, dup, delay, busy, echo, seed"),
            ("noise=1", "noise: '1' is not a percentage from 0% to 100% with at most two decimals, for example 2.5%"),
        ] {
            assert_eq!(text.parse::<LineFaultSpec>().unwrap_err().to_string(), message, "{text}");
        }
    }

    #[test]
    fn without_faults_everything_arrives_at_once() {
        let passed = pass("seed=3", b"@STAS\r\n");
        assert_eq!(passed, FaultedCharacters { bytes: b"@STAS\r\n".to_vec(), ..FaultedCharacters::default() });
    }

    #[test]
    fn each_fault_has_its_effect() {
        assert_eq!(pass("drop=100%", b"abc").bytes, b"");
        assert_eq!(pass("dup=100%", b"abc").bytes, b"aabbcc");
        let damaged = pass("parity=100%", b"abc");
        assert_eq!((damaged.bytes, damaged.damaged), (b"abc".to_vec(), VecDeque::from([0, 1, 2])));
        assert_eq!(pass("delay=20ms", b"abc").delay, Duration::from_millis(20));

        let noise = pass("noise=100%,seed=1", &[b'x'; 1000]).bytes;
        let kept = noise.split(|byte| *byte == b'x').count();
        assert!((450..550).contains(&kept), "about half of the characters stay behind the noise: {kept}");
        assert!((1450..1550).contains(&noise.len()), "{}", noise.len());
    }

    #[test]
    fn the_seed_decides_and_the_directions_differ() {
        let run = |faults: &mut LineFaults| (0..50).map(|_| faults.pass(&[7; 40])).collect::<Vec<_>>();
        let text = "noise=5%,parity=5%,drop=5%,dup=5%,delay=0..50ms";
        let (mut there, mut back) = LineFaults::pair(spec(&format!("{text},seed=1")));
        let one = run(&mut there);
        assert!(one == run(&mut LineFaults::new(spec(&format!("{text},seed=1")))), "the same seed, other faults");
        assert!(one != run(&mut back), "both directions have the same faults");
        assert!(one != run(&mut LineFaults::new(spec(&format!("{text},seed=2")))), "another seed, the same faults");
    }

    #[test]
    fn fault_rates_are_met() {
        let bytes = vec![0; 100_000];
        let length = |text: &str| pass(text, &bytes).bytes.len();
        assert!((89_000..91_000).contains(&length("drop=10%,seed=5")));
        assert!((109_000..111_000).contains(&length("dup=10%,seed=5")));
        assert!((9_000..11_000).contains(&pass("parity=10%,seed=5", &bytes).damaged.len()));
    }
}
