//! Serial port of this computer.
//!
//! The port is opened exclusively, without flow control. On Unix, a character with a parity or framing error reads as
//! NUL (`INPCK` on, `PARMRK` and `IGNPAR` off). Windows delivers the damaged character unchanged. Only the protocol can
//! detect such a character.

use std::io;
use std::time::Duration;

use serialport::{ClearBuffer, ErrorKind, FlowControl, SerialPort};
pub use serialport::{DataBits, Parity, StopBits};
use thiserror::Error;
use tokio::time::Instant;

use super::line::Pace;
use super::port::{READ_TIMEOUT, Threaded};

/// Time limit for a blocked write, in addition to the transmission time.
const WRITE_TIMEOUT: Duration = Duration::from_secs(2);
/// Maximum deviation of the baud rate in thousandths. A receiver fails at a deviation of about 40.
pub(super) const MAX_BAUD_DEVIATION: u32 = 30;

/// A port and its settings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// Name of the port, for example `/dev/ttyUSB0` or `COM3`.
    pub path: String,
    /// Bits per second.
    pub baud: u32,
    /// Data bits per character.
    pub data_bits: DataBits,
    /// Parity bit.
    pub parity: Parity,
    /// Stop bits per character.
    pub stop_bits: StopBits,
}

impl Line {
    /// Speed of the line in characters per time.
    pub fn pace(&self) -> Pace {
        let parity = u32::from(self.parity != Parity::None);
        let bits = 1 + u32::from(u8::from(self.data_bits)) + parity + u32::from(u8::from(self.stop_bits));
        Pace::new(self.baud, bits)
    }
}

/// Reason why a port cannot be opened.
#[derive(Debug, Error)]
pub enum OpenError {
    /// The device or its hardware does not exist.
    #[error("no such port")]
    Absent,
    /// Another program has the port open.
    #[error("another program uses the port")]
    Busy,
    /// The user has no permission.
    #[error("no permission to open the port")]
    Forbidden,
    /// The path is not a serial port, for example a file.
    #[error("this is not a serial port")]
    NotSerial,
    /// The port does not support the settings.
    #[error("the port does not support these settings: {0}")]
    Unsupported(String),
    /// Any other error.
    #[error("{0}")]
    Io(#[from] io::Error),
}

/// An open port. Its futures are cancel safe: received bytes are not lost, and a started send is completed.
#[derive(Debug)]
pub struct Serial {
    port: Threaded,
    pace: Pace,
}

impl Serial {
    /// Opens a port, and discards bytes that were received before.
    pub fn open(line: &Line) -> Result<Self, OpenError> {
        Ok(Self { port: Threaded::new(open(line, MAX_BAUD_DEVIATION)?), pace: line.pace() })
    }

    /// Sends bytes. The driver may still be sending when this function returns.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the port is gone, [`TimedOut`](io::ErrorKind::TimedOut) if the
    /// port accepts no bytes for two seconds.
    pub async fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.port.send(bytes, self.pace.time(bytes.len()) + WRITE_TIMEOUT).await
    }

    /// Waits until `until` for bytes. Returns `None` after a timeout.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the port is gone.
    pub async fn receive(&mut self, buffer: &mut [u8], until: Instant) -> io::Result<Option<usize>> {
        self.port.receive(buffer, until).await
    }

    /// Drops all received bytes.
    pub fn discard(&mut self) {
        self.port.discard();
    }
}

/// Opens a port, and discards bytes that were received before. `most_off` is the maximum deviation of the baud rate in
/// thousandths.
pub(super) fn open(line: &Line, most_off: u32) -> Result<Box<dyn SerialPort>, OpenError> {
    let port = serialport::new(&line.path, nominal_baud(line))
        .data_bits(line.data_bits)
        .parity(line.parity)
        .stop_bits(line.stop_bits)
        .flow_control(FlowControl::None)
        // Converters without their own power supply take power from DTR. Unix always raises DTR.
        .dtr_on_open(true)
        .timeout(READ_TIMEOUT)
        .open()
        .map_err(|error| open_error(&error, &line.path))?;
    check(port.as_ref(), line, most_off)?;
    port.clear(ClearBuffer::Input).map_err(io::Error::from)?;
    Ok(port)
}

/// The baud rate with which to open the port. macOS fails to set the baud rate of a pseudo-terminal.
fn nominal_baud(line: &Line) -> u32 {
    if cfg!(target_os = "macos") && is_pseudo_terminal(&line.path) { 0 } else { line.baud }
}

/// Whether the port is a pseudo-terminal, so that its settings have no effect.
fn is_pseudo_terminal(path: &str) -> bool {
    let path = std::fs::canonicalize(path).unwrap_or_default();
    path.starts_with("/dev/pts") || (cfg!(target_os = "macos") && path.to_string_lossy().starts_with("/dev/ttys"))
}

/// Compares the settings of the port with the requested settings. Some drivers accept unsupported settings without an
/// error.
fn check(port: &dyn SerialPort, line: &Line, most_off: u32) -> Result<(), OpenError> {
    if is_pseudo_terminal(&line.path) {
        return Ok(());
    }
    let unsupported = |what: String| Err(OpenError::Unsupported(what));
    let baud = port.baud_rate().map_err(io::Error::from)?;
    if u64::from(baud.abs_diff(line.baud)) * 1000 > u64::from(line.baud) * u64::from(most_off) {
        return unsupported(format!("{} baud (the driver set {baud})", line.baud));
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
        ErrorKind::NoDevice => no_device(error, path),
        ErrorKind::Io(io::ErrorKind::Other) if cfg!(windows) => no_device(error, path),
        ErrorKind::Io(io::ErrorKind::NotFound) => OpenError::Absent,
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => OpenError::Forbidden,
        // The crate `serialport` has no error kinds for these errors, but its error texts are fixed and not translated.
        // The text "I/O error" means a port of the mainboard that does not exist.
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

impl OpenError {
    /// Advice for a user without permission to open a port.
    pub const PERMISSION: &str = if cfg!(target_os = "linux") {
        "add your user to the group of the port, usually dialout (`sudo usermod -aG dialout $USER`), and log in again"
    } else {
        "close other programs that use the port, and check that your user has access to the port"
    };
}

/// Another program has locked the port.
#[cfg(unix)]
fn no_device(_: &serialport::Error, _: &str) -> OpenError {
    OpenError::Busy
}

/// Reason why Windows did not open a port. The crate `serialport` has one error kind for a busy and for an absent port,
/// and translated texts, so the port is opened once more for the error code.
#[cfg(windows)]
fn no_device(error: &serialport::Error, path: &str) -> OpenError {
    use std::os::windows::fs::OpenOptionsExt as _;

    /// `GENERIC_READ | GENERIC_WRITE`.
    const READ_AND_WRITE: u32 = 0xC000_0000;

    let device = if path.starts_with('\\') { path.to_owned() } else { format!(r"\\.\{path}") };
    let opened = std::fs::OpenOptions::new().access_mode(READ_AND_WRITE).share_mode(0).open(device);
    match opened {
        Err(error) => error_of_code(error.raw_os_error()).unwrap_or(OpenError::Io(error)),
        // The other program has closed the port in this moment.
        Ok(_) if error.kind == ErrorKind::NoDevice => OpenError::Busy,
        Ok(_) => OpenError::Unsupported(error.description.clone()),
    }
}

/// Meaning of an error code of Windows at the opening of a port; `None` if it has no special meaning.
#[cfg(any(windows, test))]
fn error_of_code(code: Option<i32>) -> Option<OpenError> {
    const ERROR_FILE_NOT_FOUND: i32 = 2;
    const ERROR_PATH_NOT_FOUND: i32 = 3;
    const ERROR_ACCESS_DENIED: i32 = 5;
    const ERROR_SHARING_VIOLATION: i32 = 32;
    const ERROR_LOCK_VIOLATION: i32 = 33;
    const ERROR_BUSY: i32 = 170;
    const ERROR_DEVICE_NOT_CONNECTED: i32 = 1167;

    match code? {
        ERROR_FILE_NOT_FOUND | ERROR_PATH_NOT_FOUND | ERROR_DEVICE_NOT_CONNECTED => Some(OpenError::Absent),
        // Most drivers deny access to a port that another program has open.
        ERROR_ACCESS_DENIED | ERROR_SHARING_VIOLATION | ERROR_LOCK_VIOLATION | ERROR_BUSY => Some(OpenError::Busy),
        _ => None,
    }
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

    /// A pseudo-terminal, the port at its other end, and the path of the port.
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
    async fn opening_drops_earlier_bytes() {
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
    async fn port_has_one_owner() {
        let (_master, serial, path) = pair();
        assert!(matches!(Serial::open(&line(&path)), Err(OpenError::Busy)));
        assert_eq!(crate::port_list::user(&path), None, "this process is no other");
        drop(serial);
        Serial::open(&line(&path)).unwrap();
    }

    #[test]
    fn missing_port_does_not_open() {
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
    fn distinguishes_errors_of_opening() {
        for (kind, text, message) in [
            (ErrorKind::Io(io::ErrorKind::NotFound), "", "no such port"),
            (ErrorKind::Unknown, "No such device or address", "no such port"),
            (ErrorKind::NoDevice, "Device or resource busy", "another program uses the port"),
            (ErrorKind::Io(io::ErrorKind::PermissionDenied), "", "no permission to open the port"),
            (
                ErrorKind::Unknown,
                "Invalid argument",
                "the port does not support these settings: the driver refuses them",
            ),
            (ErrorKind::Unknown, "Out of memory", "Out of memory"),
        ] {
            let error = open_error(&serialport::Error::new(kind, text), "/dev/ttyUSB0");
            assert_eq!(error.to_string(), message);
        }
    }

    #[test]
    fn distinguishes_busy_and_absent_ports_of_windows() {
        let error = |code| error_of_code(Some(code)).map(|error| error.to_string());
        assert_eq!([5, 32, 33, 170].map(error), ["another program uses the port"; 4].map(|text| Some(text.to_owned())));
        assert_eq!([2, 3, 1167].map(error), ["no such port"; 3].map(|text| Some(text.to_owned())));
        assert_eq!(error(87), None, "the settings");
    }

    #[test]
    fn a_port_with_other_settings_is_refused() {
        let (_master, slave) = TTYPort::pair().unwrap();
        let usual = Line { parity: Parity::None, ..line("/dev/ttyUSB0") };
        let settings = |line: Line| check(&slave, &line, MAX_BAUD_DEVIATION).err().map(|error| error.to_string());
        assert_eq!(settings(Line { baud: 38_400, ..usual.clone() }), None);
        for (line, what) in [
            (Line { baud: 40_000, ..usual.clone() }, "40000 baud (the driver set 38400)"),
            (Line { parity: Parity::Even, baud: 38_400, ..usual.clone() }, "parity even"),
            (Line { data_bits: DataBits::Seven, baud: 38_400, ..usual.clone() }, "7 data bits"),
            (Line { stop_bits: StopBits::Two, baud: 38_400, ..usual }, "2 stop bits"),
        ] {
            assert_eq!(settings(line), Some(format!("the port does not support these settings: {what}")));
        }
        // The deviation is 5 thousandths. This is less than the limit of 6, but more than the limit of 3.
        let near = Line { parity: Parity::None, baud: 38_600, ..line("/dev/ttyUSB0") };
        assert!(check(&slave, &near, 6).is_ok() && check(&slave, &near, 3).is_err());
    }
}
