//! What a connection is to be.

use std::time::Duration;

use super::can::Bitrate;
use super::error::Error;
use super::wire::Mac;

/// Shortest and longest pause between two polls.
pub const CYCLES: std::ops::RangeInclusive<Duration> = Duration::from_millis(1)..=Duration::from_secs(10);
/// Shortest and longest packet rate: attribute 9 has 16 bits of milliseconds, and 0 would switch the watchdog off.
pub const RATES: std::ops::RangeInclusive<Duration> = Duration::from_millis(1)..=Duration::from_millis(65_535);
/// A shorter packet rate stops a robot for a hiccup of this machine.
const LEAST_RATE: Duration = Duration::from_millis(100);

/// What is wanted of a slave.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Settings {
    /// Its MAC.
    pub slave: Mac,
    /// What for.
    pub purpose: Purpose,
    /// How long to wait for an answer before a request is repeated once.
    pub timeout: Duration,
}

/// What a connection is for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Purpose {
    /// To command it: images both ways.
    Images(Images),
    /// To ask it; with the poll connection allocated, which is not brought up, or without.
    Messages {
        /// So that its sizes can be asked.
        with_poll: bool,
    },
}

/// Images both ways.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Images {
    /// The sizes that a slave may have.
    pub profiles: Vec<Profile>,
    /// From one poll to the next.
    pub cycle: Duration,
    /// The expected packet rate: the slave gives the connection up after four times that.
    pub rate: Duration,
}

/// A size that images may have, the same both ways.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Profile {
    /// What it is called.
    pub name: &'static str,
    /// The image that a connection begins with, and after every loss again; its length is the size.
    pub resting: Vec<u8>,
}

impl Images {
    /// With the cycle that suits this bit rate, and the packet rate that suits the cycle.
    pub fn usual(profiles: Vec<Profile>, bitrate: Option<Bitrate>) -> Self {
        let cycle = Duration::from_millis(if bitrate == Some(Bitrate::K125) { 50 } else { 20 });
        Self { profiles, cycle, rate: Self::rate_of(cycle) }
    }

    /// The packet rate that suits a cycle.
    pub fn rate_of(cycle: Duration) -> Duration {
        (cycle * 5).clamp(LEAST_RATE, *RATES.end())
    }
}

impl Settings {
    /// Whether a connection can be so, for a master with this MAC.
    pub fn check(&self, own: Mac) -> Result<(), Error> {
        let wrong = |text: String| Err(Error::Settings(text));
        if self.slave == own {
            return wrong(format!("MAC {own} is this master's own; the controller has another"));
        }
        let Purpose::Images(images) = &self.purpose else { return Ok(()) };
        if !CYCLES.contains(&images.cycle) {
            return wrong(format!("the cycle must be 1 ms to 10 s, not {:?}", images.cycle));
        }
        if !RATES.contains(&images.rate) || images.rate < images.cycle {
            return wrong(format!(
                "the rate must be {:?} (the cycle) to 65535 ms, not {:?}",
                images.cycle, images.rate
            ));
        }
        if images.profiles.iter().any(|profile| profile.resting.is_empty()) {
            return wrong("an image has one byte at least".to_owned());
        }
        Ok(())
    }
}
