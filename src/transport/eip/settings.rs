//! What a connection is to be.

use std::time::Duration;

use super::error::EipError;
use super::wire::{Flow, Key, Net, Path, Segment};

/// Bytes of the sequence count before what a packet carries.
const COUNT: u16 = 2;
/// Bytes of the run/idle header to the target.
const HEADER: u16 = 4;
/// Most bytes of an image: with the rest it fits a datagram.
pub const MOST_IMAGE: u16 = 65_000;
/// Most bytes of configuration data: with the rest of the path it fits the 255 words of its length.
const MOST_CONFIGURATION: usize = 400;
/// Shortest interval.
pub const SHORTEST: Duration = Duration::from_millis(1);
/// Longest interval.
pub const LONGEST: Duration = Duration::from_secs(10);
/// Before the first packet a watchdog waits at least this long (volume 1, 3-4.6).
pub const FIRST_PACKET: Duration = Duration::from_secs(10);
/// Priority "scheduled", which cyclic data has.
const SCHEDULED: u8 = 2;

/// What is wanted of the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Role {
    /// To set its outputs, as one of one, and see its inputs.
    ExclusiveOwner,
    /// To see its inputs; the output instance is the one for heartbeats.
    InputOnly,
    /// To see its inputs as long as another connection has them sent; likewise.
    ListenOnly,
}

/// How many intervals without a packet make a connection lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Multiplier(u8);

impl Multiplier {
    /// 4, 8, 16, 32, 64, 128, 256 or 512 intervals.
    pub fn of(intervals: u32) -> Option<Self> {
        (0..8).map(Self).find(|multiplier| multiplier.intervals() == intervals)
    }

    /// From its code in a request; codes above 7 are reserved.
    pub const fn from_code(code: u8) -> Option<Self> {
        if code < 8 { Some(Self(code)) } else { None }
    }

    /// Its code in a request.
    pub const fn code(self) -> u8 {
        self.0
    }

    /// How many intervals.
    pub const fn intervals(self) -> u32 {
        4 << self.0
    }
}

/// Assemblies, sizes, times and manners of a connection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Settings {
    /// What is wanted.
    pub role: Role,
    /// The assembly that the device takes, or the one for heartbeats.
    pub output: u32,
    /// The assembly that the device sends.
    pub input: u32,
    /// The configuration assembly, for devices that want one named.
    pub configuration: Option<u32>,
    /// What the device is to be configured with; mostly nothing.
    pub configuration_data: Vec<u8>,
    /// Bytes of the image to the device; 0 for heartbeats.
    pub output_size: u16,
    /// Bytes of the image from the device.
    pub input_size: u16,
    /// The interval that is asked for, both ways; the device answers with those it keeps.
    pub rpi: Duration,
    /// After how many intervals without a packet the connection is lost, both ways.
    pub multiplier: Multiplier,
    /// Whether the device is to send to a group instead of to us.
    pub multicast: bool,
    /// Which device is expected, if that is to be checked.
    pub key: Option<Key>,
    /// The image that a connection begins with, after every loss again, and idle.
    pub resting: Vec<u8>,
    /// How long to wait for a TCP connection and for an answer on it.
    pub timeout: Duration,
}

impl Default for Settings {
    /// An exclusive owner of no bytes each way: instances 150, 100 and 1, 20 ms, 16 intervals.
    fn default() -> Self {
        Self {
            role: Role::ExclusiveOwner,
            output: 150,
            input: 100,
            configuration: Some(1),
            configuration_data: Vec::new(),
            output_size: 0,
            input_size: 0,
            rpi: Duration::from_millis(20),
            multiplier: Multiplier(2),
            multicast: false,
            key: None,
            resting: Vec::new(),
            timeout: Duration::from_secs(3),
        }
    }
}

impl Settings {
    /// Whether a connection can be so.
    pub fn check(&self) -> Result<(), EipError> {
        let wrong = |text: String| Err(EipError::Impossible(text));
        if self.output_size.max(self.input_size) > MOST_IMAGE {
            return wrong(format!("an image has {MOST_IMAGE} bytes at most"));
        }
        if self.role != Role::ExclusiveOwner && self.output_size != 0 {
            return wrong("a connection that only listens has no output image".to_owned());
        }
        if self.resting.len() != usize::from(self.output_size) {
            let (len, size) = (self.resting.len(), self.output_size);
            return wrong(format!("the resting image has {len} bytes, the output image {size}"));
        }
        if !(SHORTEST..=LONGEST).contains(&self.rpi) {
            return wrong(format!("the rpi must be {SHORTEST:?} to {LONGEST:?}, not {:?}", self.rpi));
        }
        if self.configuration_data.len() > MOST_CONFIGURATION || self.configuration_data.len() % 2 == 1 {
            return wrong(format!("configuration data has an even number of bytes, {MOST_CONFIGURATION} at most"));
        }
        Ok(())
    }

    /// The connection path: key, assembly class, configuration, output, input.
    pub fn path(&self) -> Path {
        let mut segments: Vec<Segment> = self.key.map(Segment::Key).into_iter().collect();
        segments.push(Segment::Class(super::ASSEMBLY));
        segments.extend(self.configuration.map(Segment::Instance));
        segments.extend([Segment::Point(self.output), Segment::Point(self.input)]);
        Path(segments)
    }

    /// The path with configuration data behind it, which goes with the opening only.
    pub fn opening_path(&self) -> Path {
        let mut path = self.path();
        if !self.configuration_data.is_empty() {
            path.0.push(Segment::Data(self.configuration_data.clone()));
        }
        path
    }

    /// To the device: count, and for an owner header and image.
    pub fn o_t(&self) -> Flow {
        let size = match self.role {
            Role::ExclusiveOwner => COUNT + HEADER + self.output_size.min(MOST_IMAGE),
            Role::InputOnly | Role::ListenOnly => COUNT,
        };
        self.flow(Net::PointToPoint, size)
    }

    /// From the device: count and image.
    pub fn t_o(&self) -> Flow {
        let net = if self.multicast { Net::Multicast } else { Net::PointToPoint };
        self.flow(net, COUNT + self.input_size.min(MOST_IMAGE))
    }

    fn flow(&self, net: Net, size: u16) -> Flow {
        let rpi_us = u32::try_from(self.rpi.as_micros()).unwrap_or(u32::MAX);
        Flow { rpi_us, net, size, variable: false, priority: SCHEDULED, redundant: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_on_the_wire_are_those_of_two_accepted_connections() {
        let settings = Settings { output_size: 48, input_size: 48, resting: vec![0; 48], ..Settings::default() };
        assert_eq!((settings.o_t().size, settings.t_o().size), (54, 50));
        assert_eq!(settings.path().emit(), [0x20, 4, 0x24, 1, 0x2C, 150, 0x2C, 100]);
        assert_eq!(settings.check(), Ok(()));
        let listener = Settings { role: Role::ListenOnly, input_size: 48, ..Settings::default() };
        assert_eq!((listener.o_t().size, listener.check()), (2, Ok(())));
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let cases = [
            Settings { output_size: 48, ..Settings::default() },
            Settings { rpi: Duration::from_micros(500), ..Settings::default() },
            Settings { input_size: 65_001, ..Settings::default() },
            Settings { configuration_data: vec![1], ..Settings::default() },
            Settings { role: Role::InputOnly, output_size: 1, resting: vec![0], ..Settings::default() },
        ];
        for settings in cases {
            assert!(matches!(settings.check(), Err(EipError::Impossible(_))), "{settings:?}");
        }
    }

    #[test]
    fn multipliers_are_powers_of_two() {
        let all: Vec<u32> = (0..=9).filter_map(Multiplier::from_code).map(Multiplier::intervals).collect();
        assert_eq!(all, [4, 8, 16, 32, 64, 128, 256, 512]);
        assert_eq!(Multiplier::of(16).map(Multiplier::code), Some(2));
        assert_eq!(Multiplier::of(5), None);
    }
}
