//! Settings of a connection.

use std::time::Duration;

use super::error::EipError;
use super::wire::{Flow, Key, Net, Path, Segment};

/// Size in bytes of the sequence count, which comes before the data.
const COUNT: u16 = 2;
/// Size in bytes of the run/idle header, which comes before the data to the target.
const HEADER: u16 = 4;
/// Maximum size of an image in bytes, so that the image fits into a datagram.
pub const MAX_IMAGE_SIZE: u16 = 65_000;
/// Maximum length of the configuration data in bytes, so that the path fits into 255 words.
const MAX_CONFIGURATION_LEN: usize = 400;
/// Shortest interval.
pub const MIN_INTERVAL: Duration = Duration::from_millis(1);
/// Longest interval.
pub const MAX_INTERVAL: Duration = Duration::from_secs(10);
/// Minimum timeout before the first packet (volume 1, 3-4.6).
pub const FIRST_PACKET: Duration = Duration::from_secs(10);
/// Priority "scheduled" for cyclic data.
const SCHEDULED: u8 = 2;

/// Type of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Role {
    /// The originator receives the inputs. It is the only originator that sets the outputs.
    ExclusiveOwner,
    /// The originator receives the inputs. Its output instance is a heartbeat without data.
    InputOnly,
    /// The originator receives the inputs, but only while another connection to the device exists. Its output instance
    /// is a heartbeat without data.
    ListenOnly,
}

/// Connection timeout multiplier: number of intervals without a packet after which the connection times out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Multiplier(u8);

impl Multiplier {
    /// Creates a multiplier from a number of intervals: 4, 8, 16, 32, 64, 128, 256 or 512.
    pub fn of(intervals: u32) -> Option<Self> {
        (0..8).map(Self).find(|multiplier| multiplier.intervals() == intervals)
    }

    /// Decodes the code of a multiplier. Returns `None` for codes above 7, which are reserved.
    pub const fn from_code(code: u8) -> Option<Self> {
        if code < 8 { Some(Self(code)) } else { None }
    }

    /// Code of the multiplier.
    pub const fn code(self) -> u8 {
        self.0
    }

    /// Number of intervals.
    pub const fn intervals(self) -> u32 {
        4 << self.0
    }
}

/// Settings of a connection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Settings {
    /// Type of a connection.
    pub role: Role,
    /// Assembly that the device consumes. For connections without outputs, the heartbeat instance.
    pub output: u32,
    /// Assembly that the device produces.
    pub input: u32,
    /// Configuration assembly, for devices that need one.
    pub configuration: Option<u32>,
    /// Configuration data; usually empty.
    pub configuration_data: Vec<u8>,
    /// Size of the image to the device in bytes; 0 for heartbeats.
    pub output_size: u16,
    /// Size of the image from the device in bytes.
    pub input_size: u16,
    /// Requested packet interval in both directions. The device answers with the actual intervals.
    pub rpi: Duration,
    /// Timeout multiplier in both directions.
    pub multiplier: Multiplier,
    /// Whether the device sends its images to a multicast group.
    pub multicast: bool,
    /// Electronic key. `None` if the device need not check the identity.
    pub key: Option<Key>,
    /// Image that is sent first after every opening, in idle mode.
    pub resting: Vec<u8>,
    /// Time limit for the TCP connection and for each answer.
    pub timeout: Duration,
}

impl Default for Settings {
    /// Exclusive owner with empty images. Output 150, input 100, configuration 1, an interval of 20 ms, and a timeout
    /// of 16 intervals.
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
    /// Checks the settings.
    pub fn check(&self) -> Result<(), EipError> {
        let wrong = |text: String| Err(EipError::Impossible(text));
        if self.output_size.max(self.input_size) > MAX_IMAGE_SIZE {
            return wrong(format!("an image can have at most {MAX_IMAGE_SIZE} bytes"));
        }
        if self.role != Role::ExclusiveOwner && self.output_size != 0 {
            return wrong("a listen-only connection has no output image".to_owned());
        }
        if self.resting.len() != usize::from(self.output_size) {
            let (len, size) = (self.resting.len(), self.output_size);
            return wrong(format!("the resting image has {len} bytes, but the output image has {size}"));
        }
        if !(MIN_INTERVAL..=MAX_INTERVAL).contains(&self.rpi) {
            return wrong(format!("the rpi must be {MIN_INTERVAL:?} to {MAX_INTERVAL:?}, not {:?}", self.rpi));
        }
        if self.configuration_data.len() > MAX_CONFIGURATION_LEN || self.configuration_data.len() % 2 == 1 {
            return wrong(format!(
                "configuration data must have an even number of bytes, at most {MAX_CONFIGURATION_LEN}"
            ));
        }
        Ok(())
    }

    /// Connection path: key, assembly class, configuration, output, input.
    pub fn path(&self) -> Path {
        let mut segments: Vec<Segment> = self.key.map(Segment::Key).into_iter().collect();
        segments.push(Segment::Class(super::ASSEMBLY));
        segments.extend(self.configuration.map(Segment::Instance));
        segments.extend([Segment::Point(self.output), Segment::Point(self.input)]);
        Path(segments)
    }

    /// Connection path with configuration data, for ForwardOpen only.
    pub fn opening_path(&self) -> Path {
        let mut path = self.path();
        if !self.configuration_data.is_empty() {
            path.0.push(Segment::Data(self.configuration_data.clone()));
        }
        path
    }

    /// Parameters of the direction to the device. The size includes the sequence count. For an owner, the size also
    /// includes the run/idle header and the image.
    pub fn o_t(&self) -> Flow {
        let size = match self.role {
            Role::ExclusiveOwner => COUNT + HEADER + self.output_size.min(MAX_IMAGE_SIZE),
            Role::InputOnly | Role::ListenOnly => COUNT,
        };
        self.connection_flow(Net::PointToPoint, size)
    }

    /// Parameters of the direction from the device. The size includes the sequence count and the image.
    pub fn t_o(&self) -> Flow {
        let net = if self.multicast { Net::Multicast } else { Net::PointToPoint };
        self.connection_flow(net, COUNT + self.input_size.min(MAX_IMAGE_SIZE))
    }

    fn connection_flow(&self, net: Net, size: u16) -> Flow {
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
    fn rejects_invalid_settings() {
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
