//! Settings of a connection.

use std::fmt;
use std::time::Duration;

use super::error::ProfinetError;
use super::layout::{Direction, Layout};
use super::wire::Mac;
use super::wire::dcp::{self, IpSuite};
use super::wire::record::Parameter;

/// Send clock of 1 ms, in units of 31.25 us. Every device supports this send clock.
pub const SEND_CLOCK: u16 = 32;
/// Longest watchdog time.
pub const MAX_WATCHDOG: Duration = Duration::from_millis(1920);
/// Minimum watchdog time in cycles. The connection must survive a single lost frame.
const FEWEST_CYCLES: u128 = 3;

/// Identification of a device.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Station {
    /// By station name.
    Name(String),
    /// By MAC address.
    Mac(Mac),
}

impl fmt::Display for Station {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Name(name) => write!(f, "station '{name}'"),
            Self::Mac(mac) => write!(f, "station {mac}"),
        }
    }
}

/// Startup mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Startup {
    /// Advanced startup. Devices built since 2010 support it.
    #[default]
    Advanced,
    /// Legacy startup, for older devices.
    Legacy,
}

/// Settings of a connection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Settings {
    /// The device.
    pub station: Station,
    /// IP address that the device must have. If it has another address, the controller assigns this one. `None` keeps
    /// the address of the device.
    pub ip: Option<IpSuite>,
    /// Module layout.
    pub layout: Layout,
    /// Startup mode.
    pub startup: Startup,
    /// Cycle time in both directions: 1, 2, 4 and so on to 512 ms.
    pub cycle: Duration,
    /// Time without a frame after which the connection is lost, in both directions.
    pub watchdog: Duration,
    /// Parameter records that the controller writes at the start.
    pub parameters: Vec<Parameter>,
    /// Image that is sent first after every opening.
    pub resting: Vec<u8>,
    /// Number of bytes at the start of both images whose pairs are swapped on the network.
    pub swapped: usize,
    /// Station name of this controller.
    pub name: String,
}

impl Settings {
    /// Creates default settings: resting image of zeros, 16 ms cycle, 320 ms watchdog.
    pub fn new(station: Station, layout: Layout) -> Self {
        let resting = vec![0; layout.size(Direction::Output)];
        Self {
            station,
            ip: None,
            layout,
            startup: Startup::Advanced,
            cycle: Duration::from_millis(16),
            watchdog: Duration::from_millis(320),
            parameters: Vec::new(),
            resting,
            swapped: 0,
            name: "armctl".to_owned(),
        }
    }

    /// Checks the settings.
    pub fn check(&self) -> Result<(), ProfinetError> {
        let wrong = |text: String| Err(ProfinetError::Impossible(text));
        if let Station::Name(name) = &self.station
            && let Err(why) = dcp::check_name(name)
        {
            return wrong(format!("'{name}' is not a valid station name: {why}"));
        }
        if let Station::Mac(mac) = &self.station
            && mac.is_group()
        {
            return wrong(format!("{mac} is not the address of one network card"));
        }
        if let Some(ip) = &self.ip {
            let host = u32::from(ip.address) & !u32::from(ip.mask);
            let is_mask = (!u32::from(ip.mask)).wrapping_add(1).is_power_of_two() && !ip.mask.is_unspecified();
            if !is_mask || ip.address.is_multicast() || ip.address.is_loopback() || host == 0 {
                return wrong(format!("{} with mask {} is not a valid device address", ip.address, ip.mask));
            }
        }
        if self.ratio().is_none() {
            return wrong(format!("the cycle must be 1, 2, 4, 8, 16 … or 512 ms, not {:?}", self.cycle));
        }
        if self.watchdog.as_nanos() < self.cycle.as_nanos() * FEWEST_CYCLES || self.watchdog > MAX_WATCHDOG {
            let most = MAX_WATCHDOG.as_millis();
            return wrong(format!(
                "the watchdog must be {FEWEST_CYCLES} cycles to {most} ms, not {:?} with a cycle of {:?}",
                self.watchdog, self.cycle
            ));
        }
        let size = self.layout.size(Direction::Output);
        if self.resting.len() != size {
            return wrong(format!(
                "the resting image has {} bytes, but the output image has {size}",
                self.resting.len()
            ));
        }
        if self.swapped % 2 == 1 {
            return wrong("the number of bytes must be even".to_owned());
        }
        if dcp::check_name(&self.name).is_err() {
            return wrong(format!("'{}' is not a valid controller name", self.name));
        }
        Ok(())
    }

    /// Cycle time as a number of send clocks (reduction ratio).
    pub fn ratio(&self) -> Option<u16> {
        let millis = u16::try_from(self.cycle.as_millis()).ok()?;
        let is_whole = self.cycle == Duration::from_millis(millis.into());
        (is_whole && millis.is_power_of_two() && millis <= 512).then_some(millis)
    }

    /// Watchdog time in cycles. It is rounded up, but not above the longest watchdog time.
    pub fn watchdog_factor(&self) -> u16 {
        let cycle = self.cycle.as_nanos().max(1);
        let up = self.watchdog.as_nanos().div_ceil(cycle);
        let most = MAX_WATCHDOG.as_nanos() / cycle;
        u16::try_from(up.min(most)).unwrap_or(u16::MAX)
    }

    /// Watchdog time that results from [`watchdog_factor`](Self::watchdog_factor).
    pub fn watchdog_time(&self) -> Duration {
        self.cycle * u32::from(self.watchdog_factor())
    }
}

/// Swaps the byte pairs in the first `count` bytes of an image.
pub fn swap(image: &mut [u8], count: usize) {
    let count = count.min(image.len());
    for pair in image[..count].chunks_exact_mut(2) {
        pair.swap(0, 1);
    }
}

#[cfg(test)]
mod tests {
    use std::net::Ipv4Addr;

    use super::*;

    fn settings() -> Settings {
        Settings::new(Station::Name("yrcx-sim".to_owned()), Layout::two_modules(0x101, 0x102))
    }

    #[test]
    fn rejects_invalid_settings() {
        assert_eq!(settings().check(), Ok(()));
        let suite = |address| {
            let (mask, gateway) = (Ipv4Addr::new(255, 255, 255, 0), Ipv4Addr::UNSPECIFIED);
            Some(IpSuite { address, mask, gateway })
        };
        let ms = Duration::from_millis;
        let cases = [
            Settings { station: Station::Name("Robot".to_owned()), ..settings() },
            Settings { station: Station::Mac(Mac::DCP_IDENTIFY), ..settings() },
            Settings { ip: suite(Ipv4Addr::new(192, 168, 1, 0)), ..settings() },
            Settings { ip: suite(Ipv4Addr::new(224, 0, 0, 1)), ..settings() },
            Settings { cycle: ms(20), ..settings() },
            Settings { cycle: Duration::from_micros(1500), ..settings() },
            Settings { cycle: ms(1024), watchdog: ms(1920), ..settings() },
            Settings { watchdog: ms(32), ..settings() },
            Settings { watchdog: ms(1921), ..settings() },
            Settings { resting: vec![0; 47], ..settings() },
            Settings { swapped: 3, ..settings() },
        ];
        for settings in cases {
            assert!(matches!(settings.check(), Err(ProfinetError::Impossible(_))), "{settings:?}");
        }
    }

    #[test]
    fn converts_times_to_factors() {
        assert_eq!((settings().ratio(), settings().watchdog_factor()), (Some(16), 20));
        let odd = Settings { cycle: Duration::from_millis(128), watchdog: MAX_WATCHDOG, ..settings() };
        assert_eq!((odd.watchdog_factor(), odd.watchdog_time()), (15, MAX_WATCHDOG));
    }

    #[test]
    fn swaps_only_leading_byte_pairs() {
        let mut image = [1, 2, 3, 4, 5, 6];
        swap(&mut image, 4);
        assert_eq!(image, [2, 1, 4, 3, 5, 6]);
        swap(&mut image, 100);
        assert_eq!(image, [1, 2, 3, 4, 6, 5]);
    }
}
