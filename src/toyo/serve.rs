//! Command `armctl sim toyo`: serves a simulated controller on a TCP port, as a device server does, or on a
//! pseudo-terminal.

use std::io;
use std::net::SocketAddr;

use crate::backup::twin;
use crate::prelude::basics::*;
use crate::simulated::{self, Simulated};
use armctl_controller::simulator::run_options::{RunOptions, Speed};
use armctl_frame::backup::recording::ReplayArguments;
use armctl_frame::backup::twin::note;
use armctl_frame::failure::plain;
use armctl_frame::interrupt::catch_interrupts;
use armctl_frame::serve::terminal_link::TerminalLink;
use armctl_frame::serve::{self, Serving, Started, address, bind_failure};
use armctl_transport::fault::LineFaultSpec;
use armctl_transport::line::Pace;
use armctl_transport::stream_server::StreamServer;

/// Simulate a Toyo controller on a TCP port, as a serial device server does, or on a pseudo-terminal
#[derive(Debug, Args)]
#[command(after_help = "A line has one host: while a client is connected, the simulator disconnects every other TCP \
                        client at once.")]
pub struct Serve {
    /// Address to listen on, with the TCP port; with port 0, the system chooses a port
    #[arg(
        long,
        alias = "listen",
        value_name = "ADDRESS[:PORT]",
        default_value = "127.0.0.1:4001",
        value_parser = |text: &str| address(text, PORT)
    )]
    bind: SocketAddr,
    /// Use a pseudo-terminal and print its path (not on Windows)
    #[arg(long, conflicts_with = "bind")]
    pty: bool,
    /// Create a symbolic link to the pseudo-terminal, and remove the link at the end
    #[arg(long, value_name = "PATH", requires = "pty")]
    link: Option<PathBuf>,
    /// Number of axes
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    axes: Option<u8>,
    /// Simulate the transmission time of a line with this baud rate, for example 9600 [default: no delay]
    #[arg(long, value_name = "BAUD", value_parser = clap::value_parser!(u32).range(50..=4_000_000))]
    baud: Option<u32>,
    /// File with the start state (TOML): modes, memory, inputs, errors, timed events
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Backup of a robot, whose data the simulator starts with
    #[arg(long, value_name = "FOLDER", conflicts_with = "state")]
    from: Option<PathBuf>,
    /// Faults, for example noise=1%,drop=1%,delay=0..50ms,seed=7. Other faults are parity, dup, busy and echo
    #[arg(long, value_name = "FAULTS")]
    fault: Option<LineFaultSpec>,
    /// Speed of the simulated time, such as 10x
    #[arg(long, value_name = "FACTOR", default_value_t)]
    speed: Speed,
    #[command(flatten)]
    replay: ReplayArguments,
    /// Read console lines on stdin; `help` lists them
    #[arg(long)]
    console: bool,
}

/// Usual port of device servers.
const PORT: u16 = 4001;

/// Number of bits of a character with 8 data bits, parity and one stop bit (TO 1-2).
const BITS: u32 = 11;

impl serve::Serve for Serve {
    const ID: &'static str = "sim.toyo";
    const TARGET: &'static str = "tcp://127.0.0.1:4001";
    type Report = Serving;
    type Server = Toyo;

    async fn start(self) -> Result<Started<Self>> {
        let start = simulated::start(self.state.as_deref(), self.from.as_deref(), self.axes, self.fault.as_ref())?;
        let start = start.with_options(RunOptions { speed: self.speed, motions: None });
        let (start, replay) = self.replay.apply(start, Family::Toyo)?;
        let pace = self.baud.map(|baud| Pace::new(baud, BITS));
        let settings = self.baud.map(|baud| format!("?baud={baud}")).unwrap_or_default();
        // From now on, Ctrl-C must remove the symbolic link.
        catch_interrupts();
        let (server, endpoint, address, link) = if self.pty {
            let made = StreamServer::pseudo_terminal(pace, self.fault);
            let (server, path) = made.map_err(|error| no_terminal(&error))?;
            let link = self.link.map(|link| TerminalLink::create(&link, &path)).transpose()?;
            let name = link.as_ref().map_or_else(|| path.clone(), |link| link.name().display().to_string());
            (server, format!("serial://{name}"), None, link)
        } else {
            let made = StreamServer::tcp(self.bind, pace, self.fault).await;
            let (server, local) = made.map_err(|error| bind_failure(&format!("TCP {}", self.bind), &error))?;
            (server, format!("tcp://{local}"), Some(local), None)
        };
        let target = format!("{endpoint}{settings}");
        Ok(Started {
            reach: serve::connect_hint("toyo", &target),
            target: target.clone(),
            report: Serving { family: "toyo", target },
            server: Toyo { server, simulated: Simulated::new(start), _link: link },
            address,
            with_console: self.console,
            replay,
            unknown: self.from.map(|folder| note(&folder, twin::UNKNOWN)).transpose()?,
        })
    }
}

/// A simulated controller and its server.
#[derive(Debug)]
pub struct Toyo {
    server: StreamServer,
    simulated: Simulated,
    /// The link is removed together with the server.
    _link: Option<TerminalLink>,
}

impl serve::Server for Toyo {
    fn run_until_change(&mut self) -> LocalBoxFuture<'_, io::Result<()>> {
        self.server.turn(&mut self.simulated).boxed_local()
    }

    fn console(&mut self, line: &str) -> Result<String, String> {
        self.simulated.0.console(self.server.now(), line)
    }

    fn set_faults(&mut self, faults: Option<&str>) -> Result<(), String> {
        let faults: Option<LineFaultSpec> = faults.map(str::parse).transpose().map_err(|error| format!("{error}"))?;
        self.simulated.0.set_busy(faults.as_ref().map_or(0.0, |faults| faults.busy.fraction()));
        self.server.set_faults(faults);
        Ok(())
    }
}

fn no_terminal(error: &io::Error) -> Failure {
    let failure = Failure::local(format!("cannot create a pseudo-terminal: {}", plain(error)));
    failure.hint("remove --pty, and use TCP")
}
