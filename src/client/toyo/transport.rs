//! Where a controller is, and how the characters travel there.

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
use crate::{Ends, Plan};

/// An open line to a controller.
pub type Line = Stream<Box<dyn Peer + Send>>;

/// Opens a line again that is gone.
pub(super) struct Opener(pub Box<dyn Fn() -> Opening + Send>);

/// A line that is being opened.
pub type Opening = Pin<Box<dyn Future<Output = Result<Line, Error>> + Send>>;

impl fmt::Debug for Opener {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Opener")
    }
}

/// Where a controller is.
#[derive(Debug, Clone)]
pub enum Endpoint {
    /// At a serial port of this machine.
    Serial(serial::Line),
    /// At a serial line behind a device server, which passes bytes on as they are.
    Tcp {
        /// Name or address.
        host: String,
        /// Its TCP port.
        port: u16,
        /// Bits a second of the line behind it.
        baud: u32,
    },
    /// In this process: a simulator, which starts when it is connected to.
    Simulator {
        /// How it starts.
        start: Box<Start>,
        /// Bits a second; characters take no time without.
        baud: Option<u32>,
        /// What is wrong with the line to it.
        faults: Option<LineFaultSpec>,
    },
}

/// Bits a second that a controller has from the factory (TO 1-2).
pub const BAUD: u32 = 9600;

/// Bits of a character with 8 data bits, parity and one stop bit (TO 1-2).
pub const BITS: u32 = 11;

/// From one try to open a port that is busy to the next.
const BUSY_EVERY: Duration = Duration::from_millis(20);

/// A device server may take longer to accept than a controller to answer.
const CONNECT_WITHIN: Duration = Duration::from_secs(3);

impl Endpoint {
    /// A controller at a serial port with the usual settings: 9600 baud, 8 data bits, even parity, 1 stop bit (TO 1-2).
    pub fn serial(path: impl Into<String>) -> Self {
        let (data_bits, parity, stop_bits) = (DataBits::Eight, Parity::Even, StopBits::One);
        Self::Serial(serial::Line { path: path.into(), baud: BAUD, data_bits, parity, stop_bits })
    }

    /// A controller behind a device server, whose line has 9600 baud.
    pub fn tcp(host: impl Into<String>, port: u16) -> Self {
        Self::Tcp { host: host.into(), port, baud: BAUD }
    }

    /// A fresh simulator, on a line without faults where characters take no time.
    pub fn simulator() -> Self {
        Self::Simulator { start: Box::default(), baud: None, faults: None }
    }

    /// How long one character is on the line.
    pub fn character(&self) -> Duration {
        match self {
            Self::Serial(line) => line.pace().time(1),
            Self::Tcp { baud, .. } => pace(*baud).time(1),
            Self::Simulator { baud, .. } => baud.map_or(Duration::ZERO, |baud| pace(baud).time(1)),
        }
    }

    /// Opens it; a device server may take so long to accept, and 3 s at least.
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
                let until = Instant::now() + timeout.max(CONNECT_WITHIN);
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

/// Opens a port. One that another program uses is waited for, so long at most: a short command gives it back soon.
async fn open_port(line: &serial::Line, timeout: Duration) -> Result<Serial, serial::OpenError> {
    let until = Instant::now() + timeout;
    loop {
        match Serial::open(line) {
            Err(serial::OpenError::Busy) if Instant::now() + BUSY_EVERY <= until => {
                tokio::time::sleep(BUSY_EVERY).await;
            }
            opened => return opened,
        }
    }
}

fn pace(baud: u32) -> Pace {
    Pace::new(baud, BITS)
}

/// How the characters travel.
#[derive(Debug)]
pub(super) enum Transport {
    /// Over a line.
    Line(Box<Line>),
    /// A dry run: what would be sent is noted.
    Notes(Plan),
}

impl Transport {
    /// The line; `None` in a dry run.
    pub(super) fn line(&mut self) -> Option<&mut Line> {
        match self {
            Self::Line(line) => Some(line),
            Self::Notes(_) => None,
        }
    }

    /// The notes of a dry run.
    pub(super) fn notes(&mut self) -> Option<&mut Plan> {
        match self {
            Self::Notes(plan) => Some(plan),
            Self::Line(_) => None,
        }
    }

    /// Whether something was noted in a dry run.
    pub(super) fn has_notes(&self) -> bool {
        matches!(self, Self::Notes(plan) if !plan.frames.is_empty())
    }

    /// Whether a session holds the line, and others may use it at the same time.
    pub(super) fn is_shared(&self) -> bool {
        matches!(self, Self::Line(line) if matches!(**line, Stream::Session(_)))
    }

    /// The addresses of a TCP connection, the own one first.
    pub(super) fn ends(&self) -> Option<Ends> {
        match self {
            Self::Line(line) => match &**line {
                Stream::Tcp(tcp) => tcp.ends().ok(),
                Stream::Serial(_) | Stream::InProcess(_) | Stream::Session(_) => None,
            },
            Self::Notes(_) => None,
        }
    }
}

/// What stands for the addresses of a line that has none.
pub(super) fn no_ends() -> Ends {
    let nowhere = SocketAddr::from(([0, 0, 0, 0], 0));
    (nowhere, nowhere)
}
