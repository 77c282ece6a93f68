//! Character ports: a serial port, or an in-process slave behind a simulated line.

use std::fmt;
use std::io;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use armctl_files as files;
use serialport::{DataBits, Parity, SerialPort, StopBits};

use super::error::ProfibusError;
use super::rates::Rate;
use super::settings::Settings;
use crate::closed_error;
use crate::fault::LineFaultSpec;
use crate::line::Wire;
use crate::serial::{self, Line, OpenError};
use crate::sim::Peer;

/// Maximum deviation of the bit rate that the bus allows, in thousandths.
const MAX_BAUD_DEVIATION: u32 = 3;
/// Longest latency timer of a USB adapter, in ms, that is acceptable. A longer timer can delay an answer by more than
/// the slot time.
const LATENCY: u32 = 1;

/// Size limit of the file that contains the latency timer.
const MAX_LATENCY_MS: u64 = 64;

/// A port with blocking reads.
pub trait Port: fmt::Debug + Send {
    /// Sends characters. The characters may still be in transit when this function returns.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the port is gone.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()>;

    /// Waits for characters, at most for `wait`. Returns 0 after a timeout.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the port is gone.
    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize>;
}

/// A serial port: 8 data bits, even parity, 1 stop bit.
#[derive(Debug)]
pub struct Serial {
    port: Box<dyn SerialPort>,
}

impl Serial {
    /// Opens the port.
    pub fn open(path: &str, rate: Rate) -> Result<Self, ProfibusError> {
        let line = Line {
            path: path.to_owned(),
            baud: rate.baud,
            data_bits: DataBits::Eight,
            parity: Parity::Even,
            stop_bits: StopBits::One,
        };
        let port = serial::open(&line, MAX_BAUD_DEVIATION).map_err(|error| {
            let text = match error {
                OpenError::Unsupported(what) => {
                    format!("the adapter does not support {} with even parity: {what}", rate.name)
                }
                other => other.to_string(),
            };
            ProfibusError::Port { port: path.to_owned(), text }
        })?;
        Ok(Self { port })
    }
}

impl Port for Serial {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        io::Write::write_all(&mut self.port, bytes).map_err(closed_error)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        // A timeout of 0 is avoided, because some drivers then wait without limit.
        self.port.set_timeout(wait.max(Duration::from_micros(50))).map_err(closed_error)?;
        match io::Read::read(&mut self.port, buffer) {
            Ok(0) => Err(closed_error("the port was closed")),
            Ok(len) => Ok(len),
            Err(error)
                if matches!(
                    error.kind(),
                    io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted
                ) =>
            {
                Ok(0)
            }
            Err(error) => Err(closed_error(error)),
        }
    }
}

/// Latency timer of a USB adapter in ms, if it is too long. `None` if it is short enough, or if the adapter has no
/// timer that can be changed.
pub fn latency_timer(path: &str) -> Option<u32> {
    let path = std::fs::canonicalize(path).ok()?;
    let name = path.file_name()?;
    let file = Path::new("/sys/class/tty").join(name).join("device/latency_timer");
    let text = files::text(&file, MAX_LATENCY_MS).ok()?;
    text.trim().parse().ok().filter(|time| *time > LATENCY)
}

/// A peer in this process, behind a simulated line.
#[derive(Debug)]
pub struct InProcess<P> {
    peer: P,
    wire: Wire,
    start: Instant,
}

impl<P: Peer> InProcess<P> {
    /// Creates a peer on a line. The bit rate of the line is in the settings.
    pub fn new(peer: P, settings: &Settings, faults: Option<LineFaultSpec>) -> Self {
        Self { peer, wire: Wire::new(Some(settings.rate.pace()), faults), start: Instant::now() }
    }
}

impl<P: Peer + Send> Port for InProcess<P> {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let now = self.start.elapsed();
        self.wire.run(now, &mut self.peer);
        self.wire.send(now, bytes);
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let until = self.start.elapsed() + wait;
        loop {
            let now = self.start.elapsed();
            self.wire.run(now, &mut self.peer);
            let taken = self.wire.take(now, buffer);
            if taken > 0 || now >= until {
                return Ok(taken);
            }
            let due = self.wire.due(&self.peer).map_or(until, |due| due.min(until));
            thread::sleep(due.saturating_sub(now));
        }
    }
}
