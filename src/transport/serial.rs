//! A serial port of this machine.
//!
//! The port is opened for this process alone, without flow control. A character that arrives with the wrong parity or
//! without its stop bit reads as NUL on Unix (`INPCK` is on, `PARMRK` and `IGNPAR` are off); Windows hands it on as it
//! came. Nothing tells it from one that was sent so: it takes a protocol to notice.

use std::io;
use std::time::Duration;

use serialport::{ClearBuffer, ErrorKind, FlowControl, SerialPort};
pub use serialport::{DataBits, Parity, StopBits};
use thiserror::Error;
use tokio::time::Instant;

use super::line::Pace;
use super::port::{SLICE, Threaded};
use super::ports::ports;

/// How long a port may take no byte, beyond the time that the bytes need.
const STUCK: Duration = Duration::from_secs(2);
/// How far the speed of a port may be off, in thousandths: a receiver loses track of the bits at about 40.
pub(super) const MOST_OFF: u32 = 30;

/// A port and how it is set.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// `/dev/ttyUSB0`, `COM3`.
    pub path: String,
    /// Bits a second.
    pub baud: u32,
    /// Data bits of a character.
    pub data_bits: DataBits,
    /// Parity bit of a character.
    pub parity: Parity,
    /// Stop bits of a character.
    pub stop_bits: StopBits,
}

impl Line {
    /// How fast characters follow each other on it.
    pub fn pace(&self) -> Pace {
        let parity = u32::from(self.parity != Parity::None);
        let bits = 1 + u32::from(u8::from(self.data_bits)) + parity + u32::from(u8::from(self.stop_bits));
        Pace::new(self.baud, bits)
    }
}

/// Why a port does not open.
#[derive(Debug, Error)]
pub enum OpenError {
    /// There is no such device, or no hardware behind it.
    #[error("there is no such port")]
    Absent,
    /// Somebody else has it open.
    #[error("another program uses the port")]
    Busy,
    /// This user may not open it.
    #[error("this user may not open the port")]
    Forbidden,
    /// Something else than a serial port, such as a file.
    #[error("this is not a serial port")]
    NotSerial,
    /// The port cannot be set as it should.
    #[error("the port does not take these settings: {0}")]
    Unsupported(String),
    /// Anything else.
    #[error("{0}")]
    Io(#[from] io::Error),
}

/// An open port. Its futures may be dropped: nothing that was received is lost, nothing that was sent is cut.
#[derive(Debug)]
pub struct Serial {
    port: Threaded,
    pace: Pace,
}

impl Serial {
    /// Opens a port, and drops what arrived on it before.
    ///
    /// # Errors
    /// [`OpenError`] tells why not.
    pub fn open(line: &Line) -> Result<Self, OpenError> {
        Ok(Self { port: Threaded::new(open(line, MOST_OFF)?), pace: line.pace() })
    }

    /// Hands bytes to the port, whose driver goes on sending after this has returned.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the port is gone, [`TimedOut`](io::ErrorKind::TimedOut) if it
    /// takes no bytes for two seconds.
    pub async fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.port.send(bytes, self.pace.time(bytes.len()) + STUCK).await
    }

    /// Waits for bytes, but not longer than `until`; `None` after silence.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the port is gone.
    pub async fn receive(&mut self, buffer: &mut [u8], until: Instant) -> io::Result<Option<usize>> {
        self.port.receive(buffer, until).await
    }

    /// Drops what has arrived and was not received.
    pub fn discard(&mut self) {
        self.port.discard();
    }
}

/// Opens a port whose speed is off by so many thousandths at most, and drops what arrived on it before.
pub(super) fn open(line: &Line, most_off: u32) -> Result<Box<dyn SerialPort>, OpenError> {
    let port = serialport::new(&line.path, nominal_baud(line))
        .data_bits(line.data_bits)
        .parity(line.parity)
        .stop_bits(line.stop_bits)
        .flow_control(FlowControl::None)
        // Converters without a supply of their own draw it from DTR; Unix raises it anyway.
        .dtr_on_open(true)
        .timeout(SLICE)
        .open()
        .map_err(|error| open_error(&error, &line.path))?;
    check(port.as_ref(), line, most_off)?;
    port.clear(ClearBuffer::Input).map_err(io::Error::from)?;
    Ok(port)
}

/// macOS cannot set the speed of a pseudo-terminal, and refuses to try.
fn nominal_baud(line: &Line) -> u32 {
    if cfg!(target_os = "macos") && is_pseudo_terminal(&line.path) { 0 } else { line.baud }
}

/// Whether there are no wires behind the port, so that its settings mean nothing.
fn is_pseudo_terminal(path: &str) -> bool {
    let path = std::fs::canonicalize(path).unwrap_or_default();
    path.starts_with("/dev/pts") || (cfg!(target_os = "macos") && path.to_string_lossy().starts_with("/dev/ttys"))
}

/// Some drivers take what they cannot do without a word, and say so only when asked.
fn check(port: &dyn SerialPort, line: &Line, most_off: u32) -> Result<(), OpenError> {
    if is_pseudo_terminal(&line.path) {
        return Ok(());
    }
    let unsupported = |what: String| Err(OpenError::Unsupported(what));
    let baud = port.baud_rate().map_err(io::Error::from)?;
    if u64::from(baud.abs_diff(line.baud)) * 1000 > u64::from(line.baud) * u64::from(most_off) {
        return unsupported(format!("{} baud (it has set {baud})", line.baud));
    }
    if port.data_bits().map_err(io::Error::from)? != line.data_bits {
        return unsupported(format!("{} data bits", u8::from(line.data_bits)));
    }
    if port.parity().map_err(io::Error::from)? != line.parity {
        return unsupported(format!("parity {}", line.parity.to_string().to_lowercase()));
    }
    if port.stop_bits().map_err(io::Error::from)? != line.stop_bits {
        return unsupported(format!("{} stop bits", u8::from(line.stop_bits)));
    }
    Ok(())
}

fn open_error(error: &serialport::Error, path: &str) -> OpenError {
    match error.kind {
        // On Unix this is a lock that somebody else has; Windows does not tell that from a port that is absent.
        ErrorKind::NoDevice if cfg!(unix) || is_listed(path) => OpenError::Busy,
        ErrorKind::NoDevice | ErrorKind::Io(io::ErrorKind::NotFound) => OpenError::Absent,
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => OpenError::Forbidden,
        // The crate has no kinds for these, but their texts are its own and the same in every language. An I/O error
        // is of a port that a board could have and has not.
        _ => match error.description.as_str() {
            "No such device" | "No such device or address" | "I/O error" => OpenError::Absent,
            "Operation not permitted" => OpenError::Forbidden,
            "Not a typewriter" | "Is a directory" => OpenError::NotSerial,
            "Invalid argument" => OpenError::Unsupported("the driver refuses them".to_owned()),
            "Settings did not apply correctly" => OpenError::Unsupported("the driver ignores them".to_owned()),
            _ => OpenError::Io(error.clone().into()),
        },
    }
}

fn is_listed(path: &str) -> bool {
    let name = path.trim_start_matches(r"\\.\");
    ports().is_ok_and(|ports| ports.iter().any(|port| port.name.eq_ignore_ascii_case(name)))
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use std::io::{Read as _, Write as _};

    use serialport::TTYPort;

    use super::super::testing::soon;
    use super::*;

    fn line(path: &str) -> Line {
        Line {
            path: path.to_owned(),
            baud: 9600,
            data_bits: DataBits::Eight,
            parity: Parity::Even,
            stop_bits: StopBits::One,
        }
    }

    /// A pseudo-terminal with the port at its end, and the path of the port.
    fn pair() -> (TTYPort, Serial, String) {
        let (mut master, slave) = TTYPort::pair().unwrap();
        master.set_timeout(Duration::from_secs(60)).unwrap();
        let path = slave.name().unwrap();
        let serial = Serial::open(&line(&path)).unwrap();
        (master, serial, path)
    }

    async fn receive(serial: &mut Serial, count: usize) -> Vec<u8> {
        let (mut bytes, mut buffer) = (Vec::new(), [0; 64]);
        while bytes.len() < count {
            let len = serial.receive(&mut buffer, soon()).await.unwrap().expect("bytes come");
            bytes.extend(&buffer[..len]);
        }
        bytes
    }

    #[test]
    fn a_character_has_start_data_parity_and_stop_bits() {
        let usual = line("COM3");
        assert_eq!(usual.pace(), Pace::new(9600, 11));
        let short = Line { data_bits: DataBits::Seven, parity: Parity::None, ..usual.clone() };
        assert_eq!(short.pace(), Pace::new(9600, 9));
        assert_eq!(Line { stop_bits: StopBits::Two, ..usual }.pace(), Pace::new(9600, 12));
    }

    #[tokio::test]
    async fn every_byte_goes_both_ways_as_it_is() {
        let (mut master, mut serial, _) = pair();
        let all: Vec<u8> = (0..=255).collect();
        serial.send(&all).await.unwrap();
        let mut got = [0; 256];
        master.read_exact(&mut got).unwrap();
        assert_eq!(got.as_slice(), all);
        master.write_all(&all).unwrap();
        assert_eq!(receive(&mut serial, 256).await, all);
    }

    #[tokio::test]
    async fn what_arrived_before_is_dropped() {
        let (mut master, slave) = TTYPort::pair().unwrap();
        master.write_all(b"old").unwrap();
        while slave.bytes_to_read().unwrap() < 3 {
            std::thread::yield_now();
        }
        let mut serial = Serial::open(&line(&slave.name().unwrap())).unwrap();
        master.write_all(b"new").unwrap();
        assert_eq!(receive(&mut serial, 3).await, b"new");
    }

    #[tokio::test]
    async fn only_one_has_a_port() {
        let (_master, serial, path) = pair();
        assert!(matches!(Serial::open(&line(&path)), Err(OpenError::Busy)));
        assert_eq!(crate::ports::user(&path), None, "this process is no other");
        drop(serial);
        Serial::open(&line(&path)).unwrap();
    }

    #[test]
    fn what_is_no_port_does_not_open() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        std::fs::write(&file, "").unwrap();
        let open = |path: &str| Serial::open(&line(path)).unwrap_err();
        assert!(matches!(open("/dev/there-is-no-such-port"), OpenError::Absent));
        for path in ["/dev/null", file.to_str().unwrap(), folder.path().to_str().unwrap()] {
            let error = open(path);
            assert!(matches!(error, OpenError::NotSerial), "{path}: {error:?}");
        }
    }

    #[test]
    fn errors_of_opening_are_told_apart() {
        for (kind, text, message) in [
            (ErrorKind::Io(io::ErrorKind::NotFound), "", "there is no such port"),
            (ErrorKind::Unknown, "No such device or address", "there is no such port"),
            (ErrorKind::NoDevice, "Device or resource busy", "another program uses the port"),
            (ErrorKind::Io(io::ErrorKind::PermissionDenied), "", "this user may not open the port"),
            (ErrorKind::Unknown, "Invalid argument", "the port does not take these settings: the driver refuses them"),
            (ErrorKind::Unknown, "Out of memory", "Out of memory"),
        ] {
            let error = open_error(&serialport::Error::new(kind, text), "/dev/ttyUSB0");
            assert_eq!(error.to_string(), message);
        }
    }

    #[test]
    fn a_port_with_other_settings_is_refused() {
        let (_master, slave) = TTYPort::pair().unwrap();
        let usual = Line { parity: Parity::None, ..line("/dev/ttyUSB0") };
        let settings = |line: Line| check(&slave, &line, MOST_OFF).err().map(|error| error.to_string());
        assert_eq!(settings(Line { baud: 38_400, ..usual.clone() }), None);
        for (line, what) in [
            (Line { baud: 40_000, ..usual.clone() }, "40000 baud (it has set 38400)"),
            (Line { parity: Parity::Even, baud: 38_400, ..usual.clone() }, "parity even"),
            (Line { data_bits: DataBits::Seven, baud: 38_400, ..usual.clone() }, "7 data bits"),
            (Line { stop_bits: StopBits::Two, baud: 38_400, ..usual }, "2 stop bits"),
        ] {
            assert_eq!(settings(line), Some(format!("the port does not take these settings: {what}")));
        }
        // Near enough for one bus, and too far off for another.
        let near = Line { parity: Parity::None, baud: 38_600, ..line("/dev/ttyUSB0") };
        assert!(check(&slave, &near, 6).is_ok() && check(&slave, &near, 3).is_err());
    }
}
