//! Settings of a connection to a slave.

use std::time::Duration;

use super::can::Bitrate;
use super::error::Error;
use super::wire::Mac;

/// Valid poll intervals.
pub const CYCLES: std::ops::RangeInclusive<Duration> = Duration::from_millis(1)..=Duration::from_secs(10);
/// Valid packet rates. Attribute 9 contains the rate as 16 bits of milliseconds. A rate of 0 would switch the watchdog
/// off.
pub const RATES: std::ops::RangeInclusive<Duration> = Duration::from_millis(1)..=Duration::from_millis(65_535);
/// Minimum of the default packet rate. With a shorter rate, the robot could stop if this computer is busy for a short
/// time.
const MIN_RATE: Duration = Duration::from_millis(100);

/// Settings of a connection to a slave.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Settings {
    /// MAC of the slave.
    pub slave: Mac,
    /// Purpose of the connection.
    pub purpose: Purpose,
    /// Time limit for an answer. After this time, the request is sent once more.
    pub timeout: Duration,
}

/// Purpose of a connection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Purpose {
    /// Control: images in both directions.
    Images(Images),
    /// Explicit messages only. The poll connection can be allocated, but it is never established.
    Messages {
        /// Whether to allocate the poll connection, so that its image sizes can be read.
        with_poll: bool,
    },
}

/// Settings of the image exchange.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Images {
    /// Image sizes that the slave can have.
    pub profiles: Vec<Profile>,
    /// Interval of polls.
    pub cycle: Duration,
    /// Expected packet rate. The slave closes the connection after four times this time without a poll.
    pub rate: Duration,
}

/// An image size, the same in both directions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Profile {
    /// Name of the profile.
    pub name: &'static str,
    /// Image that the master sends first after every opening of the connection. Its length is the image size.
    pub resting: Vec<u8>,
}

impl Images {
    /// Default settings of the image exchange for a bit rate.
    pub fn usual(profiles: Vec<Profile>, bitrate: Option<Bitrate>) -> Self {
        let cycle = Duration::from_millis(if bitrate == Some(Bitrate::K125) { 50 } else { 20 });
        Self { profiles, cycle, rate: Self::rate_of(cycle) }
    }

    /// Default packet rate for a poll interval.
    pub fn rate_of(cycle: Duration) -> Duration {
        (cycle * 5).clamp(MIN_RATE, *RATES.end())
    }
}

impl Settings {
    /// Checks the settings for a master with this MAC.
    pub fn check(&self, own: Mac) -> Result<(), Error> {
        let wrong = |text: String| Err(Error::Settings(text));
        if self.slave == own {
            return wrong(format!("MAC {own} is the MAC of this master; the controller must have a different MAC"));
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
            return wrong("an image must have at least one byte".to_owned());
        }
        Ok(())
    }
}
