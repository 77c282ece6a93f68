//! CAN frames with 11-bit identifiers, and the adapters that carry them.

use std::borrow::Cow;
use std::fmt;
use std::future::Future;
use std::pin::Pin;
use std::time::Duration;

pub mod bus;
pub mod pipe;
pub mod slcan;
pub mod slcan_port;
#[cfg(target_os = "linux")]
pub mod socketcan;

pub use self::slcan_port::SlcanPort;

/// Maximum number of data bytes of a frame.
pub const MAX_DATA: usize = 8;
/// Highest 11-bit identifier.
pub const HIGHEST_ID: u16 = 0x7FF;

/// A data frame with an 11-bit identifier.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Frame {
    id: u16,
    len: u8,
    data: [u8; MAX_DATA],
}

impl Frame {
    /// Creates a frame; `None` if the identifier has more than 11 bits or the data more than 8 bytes.
    pub fn new(id: u16, data: &[u8]) -> Option<Self> {
        if id > HIGHEST_ID || data.len() > MAX_DATA {
            return None;
        }
        let mut frame = Self { id, len: u8::try_from(data.len()).ok()?, data: [0; MAX_DATA] };
        frame.data[..data.len()].copy_from_slice(data);
        Some(frame)
    }

    /// The identifier.
    pub const fn id(&self) -> u16 {
        self.id
    }

    /// Data bytes.
    pub fn data(&self) -> &[u8] {
        self.data.get(..usize::from(self.len)).unwrap_or_default()
    }

    /// Length in bits, with stuff bits and the interframe space (ISO 11898-1).
    pub fn bits(&self) -> u32 {
        // Number of bits without stuffing: CRC delimiter, acknowledge slot and its delimiter, end of frame, interframe
        // space.
        const UNSTUFFED: u32 = 1 + 2 + 7 + 3;
        let mut stream = BitStuffing::default();
        // Bits with stuffing: start of frame, identifier, RTR, IDE, reserved bit, length.
        stream.push(u32::from(self.id), 12);
        stream.push(u32::from(self.len), 3 + 4);
        for byte in self.data() {
            stream.push(u32::from(*byte), 8);
        }
        let checksum = u32::from(stream.checksum);
        stream.push(checksum, 15);
        stream.bits + UNSTUFFED
    }

    /// Transmission time.
    pub fn time(&self, bitrate: Bitrate) -> Duration {
        Duration::from_nanos(u64::from(self.bits()) * 1_000_000_000 / u64::from(bitrate.bits_per_second()))
    }

    /// Encodes the frame for link type 227: identifier (big-endian), length, three zero bytes, data.
    pub fn to_capture(&self) -> Vec<u8> {
        let mut bytes = u32::from(self.id).to_be_bytes().to_vec();
        bytes.extend([self.len, 0, 0, 0]);
        bytes.extend(self.data());
        bytes
    }

    /// Decodes a frame of link type 227; `None` if it is not a data frame with an 11-bit identifier.
    pub fn from_capture(bytes: &[u8]) -> Option<Self> {
        let (head, data) = bytes.split_at_checked(8)?;
        let id = u32::from_be_bytes([head[0], head[1], head[2], head[3]]);
        Self::new(u16::try_from(id).ok()?, data.get(..usize::from(head[4]))?)
    }

    /// Parses a line of a `candump -l` log, for example `(1700000000.123456) can0 42D#0102`, or of `candump`, for
    /// example `can0 42D [2] 01 02`. Returns the frame, and the time if the line has one.
    pub fn from_candump(line: &str) -> Option<(Option<Duration>, Self)> {
        let mut words = line.split_whitespace().peekable();
        let time = words.next_if(|word| word.starts_with('(')).and_then(|word| {
            let seconds: f64 = word.trim_matches(['(', ')']).parse().ok()?;
            Duration::try_from_secs_f64(seconds).ok()
        });
        let _interface = words.next()?;
        let word = words.next()?;
        let (id, data) = if let Some((id, data)) = word.split_once('#') {
            (id, data.to_owned())
        } else {
            let len: usize = words.next()?.strip_prefix('[')?.strip_suffix(']')?.parse().ok()?;
            (word, words.take(len.min(MAX_DATA)).collect())
        };
        if id.len() != 3 || data.len() % 2 == 1 {
            return None;
        }
        let pairs = data.as_bytes().chunks(2);
        let bytes: Option<Vec<u8>> =
            pairs.map(|pair| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok()).collect();
        Some((time, Self::new(u16::from_str_radix(id, 16).ok()?, &bytes?)?))
    }
}

/// Formats a frame as candump does, for example `42D#0102`.
impl fmt::Display for Frame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:03X}#", self.id)?;
        self.data().iter().try_for_each(|byte| write!(f, "{byte:02X}"))
    }
}

impl fmt::Debug for Frame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

/// Bit counter with stuffing. After five equal bits, a node inserts one opposite bit.
#[derive(Debug, Default)]
struct BitStuffing {
    bits: u32,
    /// Value of the last bit, and the number of equal bits in a row.
    run: (bool, u8),
    checksum: u16,
}

impl BitStuffing {
    fn push(&mut self, value: u32, count: u32) {
        /// Polynomial of the 15-bit CRC of a frame.
        const POLYNOMIAL: u16 = 0x4599;
        for at in (0..count).rev() {
            let bit = value >> at & 1 == 1;
            let carry = (self.checksum >> 14 & 1 == 1) != bit;
            self.checksum = self.checksum << 1 & 0x7FFF;
            if carry {
                self.checksum ^= POLYNOMIAL;
            }
            self.bits += 1;
            self.run = if self.run.0 == bit && self.run.1 > 0 { (bit, self.run.1 + 1) } else { (bit, 1) };
            if self.run.1 == 5 {
                self.bits += 1;
                self.run = (!bit, 1);
            }
        }
    }
}

/// Bit rate of a DeviceNet bus.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Bitrate {
    /// 125 kbit/s.
    K125,
    /// 250 kbit/s.
    K250,
    /// 500 kbit/s.
    K500,
}

impl Bitrate {
    /// All bit rates, slowest first, in the order of attribute 2 of the DeviceNet object.
    pub const ALL: [Self; 3] = [Self::K125, Self::K250, Self::K500];

    /// Bits per second.
    pub const fn bits_per_second(self) -> u32 {
        match self {
            Self::K125 => 125_000,
            Self::K250 => 250_000,
            Self::K500 => 500_000,
        }
    }

    /// Name of the bit rate as on the rotary switches of devices, for example `125k`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::K125 => "125k",
            Self::K250 => "250k",
            Self::K500 => "500k",
        }
    }
}

impl fmt::Display for Bitrate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} kbit/s", self.bits_per_second() / 1000)
    }
}

/// Error state of an adapter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum BusState {
    /// Error active: no problem.
    #[default]
    Active,
    /// Error warning: the adapter has counted some errors.
    Warning,
    /// Error passive: the adapter has counted many errors. Often no other node is present to acknowledge frames.
    Passive,
    /// Bus-off: the adapter has disconnected from the bus.
    Off,
}

/// Health of an adapter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Health {
    /// Error state.
    pub state: BusState,
    /// Number of received frames that the adapter lost (overruns).
    pub overruns: u64,
    /// Number of frames that the adapter did not accept.
    pub rejected: u64,
}

/// Event of an adapter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PortEvent {
    /// A frame from the bus.
    Frame(Frame),
    /// The health changed.
    Health(Health),
}

/// Failure of an adapter.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PortError {
    /// The adapter could not be opened.
    #[error("{path}: {why}")]
    Open {
        /// Path of the adapter.
        path: String,
        /// Reason, as text.
        why: String,
        /// What the user can do.
        advice: Cow<'static, str>,
    },
    /// The device is not a CAN adapter, or it refuses a setting.
    #[error("{path}: {why}")]
    Setup {
        /// Path of the adapter.
        path: String,
        /// Reason, as text.
        why: String,
    },
    /// The adapter sends no answer.
    #[error("{0}: no answer from the adapter")]
    Mute(String),
    /// The adapter was disconnected.
    #[error("{path} was disconnected: {why}")]
    Gone {
        /// Path of the adapter.
        path: String,
        /// Reason, as text.
        why: String,
    },
    /// The adapter sends more data than a bus can carry.
    #[error("{0} sends data without a pause; it is not a CAN adapter")]
    Flooded(String),
    /// The adapter accepts no more frames.
    #[error("{0} accepts no more frames")]
    Stuck(String),
}

/// A boxed future.
pub type BoxedFuture<'a, T> = Pin<Box<dyn Future<Output = T> + Send + 'a>>;

/// An adapter on a bus: in-process, SLCAN or SocketCAN.
pub trait CanPort: fmt::Debug + Send {
    /// Queues a frame. Frames are sent in the order of the calls.
    ///
    /// # Errors
    /// The adapter is disconnected, or accepts no more frames.
    fn send(&mut self, frame: &Frame) -> Result<(), PortError>;

    /// Waits for the next event. The future is cancel safe.
    fn next(&mut self) -> BoxedFuture<'_, Result<PortEvent, PortError>>;

    /// Last known health.
    fn health(&self) -> Health;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(id: u16, data: &[u8]) -> Frame {
        Frame::new(id, data).unwrap()
    }

    #[test]
    fn rejects_frames_out_of_range() {
        assert_eq!(Frame::new(0x800, &[]), None);
        assert_eq!(Frame::new(0, &[0; 9]), None);
        assert_eq!(frame(0x42F, &[0, 0x7C, 2, 0xEE, 0xFF, 0xC0, 0]).to_string(), "42F#007C02EEFFC000");
    }

    /// A frame has 47 + 8n bits without stuffing, where n is the number of data bytes. It has at most (34 + 8n - 1) / 4
    /// stuff bits.
    #[test]
    fn frame_length_is_within_the_stuffing_limits() {
        for len in 0..=8usize {
            let least = 47 + 8 * u32::try_from(len).unwrap();
            let most = least + (34 + 8 * u32::try_from(len).unwrap() - 1) / 4;
            for fill in [0, 0xFF, 0x55, 0x3C, 0xF8] {
                for id in [0, 0x2AA, 0x42D, 0x7EF] {
                    let bits = frame(id, &vec![fill; len]).bits();
                    assert!((least..=most).contains(&bits), "{len} {fill:x} {id:x}: {bits}");
                }
            }
        }
        // All 34 bits up to the end of the CRC are zeros. So one stuff bit follows after every five bits.
        assert_eq!(frame(0, &[]).bits(), 47 + 34 / 5);
    }

    #[test]
    fn frames_round_trip_through_captures_and_logs() {
        let frame = frame(0x42D, &[0, 1, 2]);
        let bytes = frame.to_capture();
        assert_eq!(bytes, [0, 0, 4, 0x2D, 3, 0, 0, 0, 0, 1, 2]);
        assert_eq!(Frame::from_capture(&bytes), Some(frame));
        assert_eq!(Frame::from_capture(&bytes[..10]), None);
        assert_eq!(Frame::from_capture(&[0x80, 0, 4, 0x2D, 0, 0, 0, 0]), None, "an extended identifier");
        let time = Duration::from_millis(1500);
        assert_eq!(Frame::from_candump("(1.500000) can0 42D#000102"), Some((Some(time), frame)));
        assert_eq!(Frame::from_candump("  can0  42D   [3]  00 01 02"), Some((None, frame)));
        for wrong in ["", "can0", "can0 42D", "can0 42D#0", "can0 0000042D#00", "can0 42D#R", "can0 42D [x]", "can0 é#"]
        {
            assert_eq!(Frame::from_candump(wrong), None, "{wrong}");
        }
    }
}
