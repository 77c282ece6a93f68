//! Endpoint of a controller, and the transport to it.

use std::fmt;
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::time::Duration;

use armctl_controller::toyo::simulator::Start;
use armctl_transport::fault::LineFaultSpec;
use armctl_transport::line::{InProcessLine, Pace};
use armctl_transport::serial::{self, DataBits, Parity, Serial, StopBits};
use armctl_transport::sim::Peer;
use armctl_transport::stream::Stream;
use armctl_transport::tcp::Tcp;
use tokio::time::Instant;

use super::error::Error;
use super::simulated::Simulated;
use crate::{AddressPair, LONGEST_TIMEOUT, Plan};

/// An open line to a controller.
///
/// Example: [`Endpoint`]
pub type Line = Stream<Box<dyn Peer + Send>>;

pub(super) struct Opener(pub Box<dyn Fn() -> Opening + Send>);

/// A future that opens a line.
#[doc(hidden)]
pub type Opening = Pin<Box<dyn Future<Output = Result<Line, Error>> + Send>>;

impl fmt::Debug for Opener {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Opener")
    }
}

/// Address of a controller.
///
/// ```
/// use std::time::Duration;
///
/// use armctl_client::toyo::{Client, Endpoint, Line, Options, Start};
/// use armctl_client::units::Millimetres;
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let start = Box::new(Start::parse("origin = true\nposition = [12.5, 0.0, 0.0, 0.0]")?);
/// let endpoint = Endpoint::Simulator { start, baud: Some(9600), faults: None };
/// let line: Line = endpoint.open(Duration::from_secs(3)).await?;
/// let mut robot = Client::over(line, endpoint.character(), Options::default());
/// let x = robot.read_position().await?.millimetres("x");
/// assert_eq!(x, Some(Millimetres::from_steps(12_500)));
/// let serial = Endpoint::serial("/dev/ttyUSB0"); // 9600 baud, 8E1
/// let server = Endpoint::tcp("192.0.2.20", 4001);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub enum Endpoint {
    /// A serial port of this machine.
    Serial(serial::Line),
    /// A serial line behind a device server. The device server passes the bytes on unchanged.
    Tcp {
        /// Host name or address of the device server.
        host: String,
        /// TCP port of the device server.
        port: u16,
        /// Baud rate of the serial line behind the device server.
        baud: u32,
    },
    /// A simulator in this process; it starts when a client connects.
    Simulator {
        /// Start state of the simulator.
        start: Box<Start>,
        /// Baud rate. Without a baud rate, the transmission of characters takes no time.
        baud: Option<u32>,
        /// Line faults to simulate.
        faults: Option<LineFaultSpec>,
    },
}

/// Factory baud rate of a controller (TO 1-2).
pub const BAUD: u32 = 9600;

/// Bits per character: 1 start bit, 8 data bits, 1 parity bit, 1 stop bit (TO 1-2).
pub const BITS: u32 = 11;

/// Retry interval for a busy port.
const BUSY_RETRY_INTERVAL: Duration = Duration::from_millis(20);

/// Shortest time limit for opening a connection: a device server may be slower than a controller.
const MIN_CONNECT_TIMEOUT: Duration = Duration::from_secs(3);

impl Endpoint {
    /// A serial port with the factory settings: 9600 baud, 8 data bits, even parity, 1 stop bit (TO 1-2).
    pub fn serial(path: impl Into<String>) -> Self {
        let (data_bits, parity, stop_bits) = (DataBits::Eight, Parity::Even, StopBits::One);
        Self::Serial(serial::Line { path: path.into(), baud: BAUD, data_bits, parity, stop_bits })
    }

    /// A device server with a serial line of 9600 baud.
    pub fn tcp(host: impl Into<String>, port: u16) -> Self {
        Self::Tcp { host: host.into(), port, baud: BAUD }
    }

    /// A new simulator on a line without faults or transmission time.
    pub fn simulator() -> Self {
        Self::Simulator { start: Box::default(), baud: None, faults: None }
    }

    /// Transmission time of one character.
    pub fn character(&self) -> Duration {
        match self {
            Self::Serial(line) => line.pace().time(1),
            Self::Tcp { baud, .. } => pace(*baud).time(1),
            Self::Simulator { baud, .. } => baud.map_or(Duration::ZERO, |baud| pace(baud).time(1)),
        }
    }

    /// Opens the line. The time limit for the connection to a device server is `timeout`, but at least 3 s.
    ///
    /// # Errors
    /// [`Error::Port`] and [`Error::DeviceServer`].
    pub async fn open(&self, timeout: Duration) -> Result<Line, Error> {
        match self {
            Self::Serial(line) => open_port(line, timeout)
                .await
                .map(Stream::Serial)
                .map_err(|error| Error::Port { path: line.path.clone(), error: Arc::new(error) }),
            Self::Tcp { host, port, .. } => {
                let until = Instant::now() + timeout.clamp(MIN_CONNECT_TIMEOUT, LONGEST_TIMEOUT);
                let opened = Tcp::open(host, *port, until).await.map(Stream::Tcp);
                opened.map_err(|error| Error::DeviceServer { host: host.clone(), port: *port, error: Arc::new(error) })
            }
            Self::Simulator { start, baud, faults } => {
                let controller: Box<dyn Peer + Send> = Box::new(Simulated::new((**start).clone()));
                let line = InProcessLine::new(controller, baud.map(pace), faults.clone());
                Ok(Stream::InProcess(Box::new(line)))
            }
        }
    }
}

/// Opens a port. If the port is busy, waits up to `timeout`: another armctl command may use the port for a short time.
async fn open_port(line: &serial::Line, timeout: Duration) -> Result<Serial, serial::OpenError> {
    let until = Instant::now() + timeout.min(LONGEST_TIMEOUT);
    loop {
        match Serial::open(line) {
            Err(serial::OpenError::Busy) if Instant::now() + BUSY_RETRY_INTERVAL <= until => {
                tokio::time::sleep(BUSY_RETRY_INTERVAL).await;
            }
            opened => return opened,
        }
    }
}

fn pace(baud: u32) -> Pace {
    Pace::new(baud, BITS)
}

#[derive(Debug)]
pub(super) enum Transport {
    /// A serial line.
    Line(Box<Line>),
    /// A dry run: requests are only planned.
    DryRun(Plan),
}

impl Transport {
    /// The line; `None` in a dry run.
    pub(super) fn line(&mut self) -> Option<&mut Line> {
        match self {
            Self::Line(line) => Some(line),
            Self::DryRun(_) => None,
        }
    }

    pub(super) fn notes(&mut self) -> Option<&mut Plan> {
        match self {
            Self::DryRun(plan) => Some(plan),
            Self::Line(_) => None,
        }
    }

    pub(super) fn has_notes(&self) -> bool {
        matches!(self, Self::DryRun(plan) if !plan.frames.is_empty())
    }

    /// Whether a session owns the line, so that other clients may use the line too.
    pub(super) fn is_shared(&self) -> bool {
        matches!(self, Self::Line(line) if matches!(**line, Stream::Session(_)))
    }

    /// Local and remote address of a TCP connection.
    pub(super) fn address_pair(&self) -> Option<AddressPair> {
        match self {
            Self::Line(line) => match &**line {
                Stream::Tcp(tcp) => tcp.address_pair().ok(),
                Stream::Serial(_) | Stream::InProcess(_) | Stream::Session(_) => None,
            },
            Self::DryRun(_) => None,
        }
    }
}

pub(super) fn no_addresses() -> AddressPair {
    let nowhere = SocketAddr::from(([0, 0, 0, 0], 0));
    (nowhere, nowhere)
}
