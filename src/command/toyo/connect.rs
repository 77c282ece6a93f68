//! How a controller is connected to: a serial port, a device server, the simulator.

use std::time::Duration;

use tokio::time::Instant;

use super::link::Toyo;
use super::overview::overview;
use super::simulated::{self, Simulated};
use crate::command::frame::attach::attach;
use crate::command::{Access, Family as _};
use crate::failure::{Failure, Kind, plain};
use crate::output::Screen;
use crate::settings::target::{self, Place};
use crate::settings::{Robot, Sessions};
use crate::transport::fault::LineFaultSpec;
use crate::transport::line::{InProcessLine, Pace};
use crate::transport::serial::{Line, OpenError, Serial};
use crate::transport::session::host::held;
use crate::transport::sim::Peer;
use crate::transport::stream::Stream;
use crate::transport::tcp::{ConnectError, Tcp};

/// Bits of a character with 8 data bits, parity and one stop bit (TO 1-2).
const BITS: u32 = 11;

/// How a robot is reached.
#[derive(Debug)]
pub enum Endpoint<'a> {
    /// A serial port of this machine.
    Serial(Line),
    /// A serial line behind a device server.
    Tcp(&'a target::Tcp),
    /// The built-in simulator.
    Sim(&'a target::Sim),
}

/// What a robot's target names.
pub fn endpoint(robot: &Robot) -> Result<Endpoint<'_>, Failure> {
    match &robot.target.value.place {
        Place::Serial(target::Serial { path, baud, data_bits, parity, stop_bits }) => Ok(Endpoint::Serial(Line {
            path: path.clone(),
            baud: *baud,
            data_bits: *data_bits,
            parity: *parity,
            stop_bits: *stop_bits,
        })),
        Place::Tcp(tcp) => Ok(Endpoint::Tcp(tcp)),
        Place::Sim(sim) => Ok(Endpoint::Sim(sim)),
        Place::Udp(_) | Place::Bus(_) => {
            Err(Failure::usage(format!("toyo is not reached over {}:", robot.target.value.scheme()))
                .hint("use serial://, tcp:// or sim:"))
        }
    }
}

impl Endpoint<'_> {
    /// How long one character is on the line.
    pub fn character(&self) -> Duration {
        match self {
            Self::Serial(line) => line.pace().time(1),
            Self::Tcp(tcp) => Pace::new(tcp.baud, BITS).time(1),
            Self::Sim(sim) => sim.baud.map_or(Duration::ZERO, |baud| Pace::new(baud, BITS).time(1)),
        }
    }

    /// Opens it.
    pub async fn open(&self, robot: &Robot) -> Result<Stream<Box<dyn Peer>>, Failure> {
        match self {
            Self::Serial(line) => match Serial::open(line) {
                Ok(serial) => Ok(Stream::Serial(serial)),
                Err(error) => Err(not_open(&robot.label(), line, &error)),
            },
            Self::Tcp(tcp) => {
                let until = Instant::now() + robot.timeout.value.max(CONNECT_WITHIN);
                match Tcp::open(&tcp.host, tcp.port, until).await {
                    Ok(tcp) => Ok(Stream::Tcp(tcp)),
                    Err(error) => Err(not_connected(&robot.label(), tcp, &error)),
                }
            }
            Self::Sim(sim) => {
                let faults = sim.fault.as_deref().map(str::parse::<LineFaultSpec>).transpose().map_err(|error| {
                    Failure::usage(format!("{}: {error}", robot.target.value)).hint("write % as %25 in a URL")
                })?;
                let pace = sim.baud.map(|baud| Pace::new(baud, BITS));
                let controller = simulated::start(sim.state.as_deref(), sim.axes, faults.as_ref())?;
                let line = InProcessLine::new(Box::new(Simulated::new(controller)) as Box<dyn Peer>, pace, faults);
                Ok(Stream::InProcess(Box::new(line)))
            }
        }
    }
}

/// Opens it, or joins the session that holds it.
pub async fn open(robot: &Robot, access: &Access, screen: &Screen) -> Result<Stream<Box<dyn Peer>>, Failure> {
    match Box::pin(attach(robot, access, screen)).await? {
        Some(attached) => Ok(Stream::Session(attached)),
        None => endpoint(robot)?.open(robot).await,
    }
}

/// Opens it for a session to hold, which opens it again when it is gone. The controller is asked something first: a line
/// says nothing by itself.
pub async fn hold(robot: &Robot, access: &Access, screen: &Screen) -> Result<held::Line, Failure> {
    let robot = Robot { sessions: Sessions::None, ..robot.clone() };
    let mut link = Toyo::connect(&robot, access.clone(), screen).await?;
    overview(&mut link).await?;
    // Over the same connection: a device server may take another one only after a while.
    let stream = link.into_stream().ok_or_else(|| Failure::local("a dry run holds no line"))?;
    Ok(held::Line::new(stream, move || {
        let robot = robot.clone();
        Box::pin(async move {
            let opened = match endpoint(&robot) {
                Ok(endpoint) => endpoint.open(&robot).await,
                Err(failure) => Err(failure),
            };
            opened.map_err(|failure| failure.message)
        })
    }))
}

/// A device server may take longer to accept than a controller to answer.
const CONNECT_WITHIN: Duration = Duration::from_secs(3);

fn not_open(label: &str, line: &Line, error: &OpenError) -> Failure {
    let (kind, what, hint) = match error {
        OpenError::Absent => (
            Kind::NoAnswer,
            format!("there is no port {}", line.path),
            "plug the adapter in; `armctl toyo ports` lists the ports there are",
        ),
        OpenError::Busy => (
            Kind::NoAnswer,
            format!("another program uses {}", line.path),
            "close it: a line can have one host at a time",
        ),
        OpenError::Forbidden => (
            Kind::Local,
            format!("this user may not open {}", line.path),
            "add the user to the group of the port, mostly dialout (`sudo usermod -aG dialout $USER`), and log in again",
        ),
        OpenError::NotSerial => {
            (Kind::Usage, format!("{} is no serial port", line.path), "`armctl toyo ports` lists the ports there are")
        }
        OpenError::Unsupported(why) => (
            Kind::Usage,
            format!("{} does not take these settings: {why}", line.path),
            "choose others in the target URL",
        ),
        OpenError::Io(error) => (
            Kind::NoAnswer,
            format!("{}: {}", line.path, plain(error)),
            "`armctl toyo ports` lists the ports there are",
        ),
    };
    Failure::new(kind, format!("{label}: {what}")).hint(hint)
}

fn not_connected(label: &str, tcp: &target::Tcp, error: &ConnectError) -> Failure {
    let target::Tcp { host, port, .. } = tcp;
    let (what, hint) = match error {
        ConnectError::NotFound => {
            (format!("cannot find host '{host}'"), "check the name, or use the address of the device server")
        }
        ConnectError::Refused => (
            format!("nothing listens on TCP port {port}"),
            "check the port, and that the device server passes bytes on as they are (raw TCP)",
        ),
        ConnectError::Unreachable => {
            ("the host cannot be reached".to_owned(), "check the address and this machine's own network settings")
        }
        ConnectError::TimedOut => {
            ("the device server does not answer".to_owned(), "check that it is on, and its address")
        }
        ConnectError::Io(error) => (plain(error), "check the network"),
    };
    Failure::new(Kind::NoAnswer, format!("{label}: {what}")).hint(hint)
}
