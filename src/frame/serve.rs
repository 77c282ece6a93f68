//! Simulators as servers on real sockets and ports, for all families. `FAMILY/serve.rs` has the family-specific part;
//! `armctl sim` combines both.

pub mod terminal_link;

use std::io;
use std::net::{IpAddr, SocketAddr};

use anyhow::Context as _;
use schemars::JsonSchema;
use serde::Serialize;
use tokio::io::{AsyncBufReadExt as _, AsyncRead, AsyncReadExt as _, BufReader};

use super::{Report, SchemaEntry};
use crate::failure::{Failure, Kind, plain};
use crate::interrupt::interruptible;
use crate::output::view::View;
use crate::run::{Run, RunError};
use armctl_controller::simulator::console::help_line;

/// Arguments of `armctl sim FAMILY`.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Serve: Sized {
    /// `sim.yerc`: name in envelopes and schemas.
    const ID: &'static str;
    /// URL of a simulator that is started without arguments.
    const TARGET: &'static str;
    /// Report with the address of the simulator.
    type Report: Report + 'static;
    /// Simulator.
    type Server: Server;

    /// Starts to listen.
    async fn start(self) -> Result<Started<Self>, Failure>;
}

/// A simulator that listens.
#[derive(Debug)]
pub struct Started<S: Serve> {
    /// Report.
    pub report: S::Report,
    /// Command line that connects to the simulator.
    pub reach: String,
    /// Simulator.
    pub server: S::Server,
    /// Address that the simulator listens on; `None` for a terminal.
    pub address: Option<SocketAddr>,
    /// Whether the simulator reads console lines on stdin.
    pub with_console: bool,
    /// What the simulator of a backup does not know about its robot.
    pub unknown: Option<String>,
}

/// A simulator with its server.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Server {
    /// Serves until an event arrives or is due, and handles the event. The future may be dropped.
    async fn run_until_change(&mut self) -> io::Result<()>;
    /// Executes a console line and returns the result or the reason for a failure.
    fn console(&mut self, line: &str) -> Result<String, String>;
    /// Sets the faults of link and device in the form of `--fault`; `None` removes all faults.
    fn set_faults(&mut self, faults: Option<&str>) -> Result<(), String>;
}

/// Schema of the report of a simulator that listens.
pub fn schema<S: Serve>() -> SchemaEntry {
    SchemaEntry::of::<S::Report>(S::ID)
}

/// A simulator that listens.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Serving {
    /// Family.
    pub family: &'static str,
    /// URL.
    pub target: String,
}

impl Report for Serving {
    fn view(&self) -> View {
        View::text(format!("{} at {}", self.family, self.target))
    }
}

/// Starts a simulator, prints its address, and serves it until Ctrl-C.
pub async fn run<S: Serve>(arguments: S, run: &Run) -> Result<(), RunError> {
    let Started { report, reach, mut server, address, with_console, unknown } = arguments.start().await?;
    run.local(S::ID, &report)?;
    if address.is_some_and(|address| !address.ip().is_loopback()) {
        run.screen.note("warning: other computers on the network can reach this simulator");
    }
    if let Some(unknown) = unknown {
        run.screen.note(&unknown);
    }
    // A program reads the address from the report, and needs no instructions.
    if !run.screen.is_json() {
        let console = if with_console { " or `quit`; `help` lists the console commands" } else { "" };
        run.screen.note(&format!("reach it: {reach}\nend it:   Ctrl-C{console}"));
    }
    let mut console = with_console.then(|| Console::new(tokio::io::stdin()));
    loop {
        let turn = interruptible(async {
            tokio::select! {
                outcome = server.run_until_change() => outcome.map(|()| None).map_err(|error| Failure::io("simulator", &error)),
                line = next_line(&mut console) => line.map(Some),
            }
        });
        let line = match turn.await {
            Ok(outcome) => outcome?,
            // Ctrl-C is the normal end of a server.
            Err(_) => return Ok(()),
        };
        match line {
            None => {}
            Some(None) => console = None,
            Some(Some(line)) if line.trim().is_empty() => {}
            Some(Some(line)) if line.trim() == "quit" => return Ok(()),
            Some(Some(line)) => match console_line(&mut server, &line) {
                Ok(text) => run.screen.note(&text),
                Err(why) => run.screen.failure(&Failure::usage(why).hint("use `help` to list the console commands")),
            },
        }
    }
}

/// Executes a console line: `fault` is common to all simulators, the other lines belong to the family.
fn console_line(server: &mut impl Server, line: &str) -> Result<String, String> {
    let line = line.trim();
    if line == "help" {
        let fault = help_line("fault FAULTS|off", "set or remove faults, as with --fault: fault delay=50ms");
        return Ok(format!("{}\n{fault}", server.console(line)?));
    }
    let (word, faults) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    match (word, faults.trim()) {
        ("fault", "off") => server.set_faults(None).map(|()| "no faults".to_owned()),
        ("fault", faults) => server.set_faults(Some(faults)).map(|()| format!("faults: {faults}")),
        _ => server.console(line),
    }
}

/// Console lines of a simulator.
struct Console<R> {
    input: BufReader<R>,
    /// Received bytes of the next line. They are kept here, so that they are not lost while the simulator handles an
    /// event.
    buffered: Vec<u8>,
}

impl<R: AsyncRead + Unpin> Console<R> {
    /// Maximum length of a line.
    const MAX_LINE_LEN: usize = 1 << 16;

    fn new(from: R) -> Self {
        Self { input: BufReader::new(from), buffered: Vec::new() }
    }

    /// Next line; `None` at the end.
    async fn next(&mut self) -> Result<Option<String>, Failure> {
        let room = u64::try_from(Self::MAX_LINE_LEN.saturating_sub(self.buffered.len())).unwrap_or_default();
        (&mut self.input).take(room).read_until(b'\n', &mut self.buffered).await.context("stdin")?;
        if self.buffered.len() >= Self::MAX_LINE_LEN {
            return Err(Failure::usage("the console line is longer than 64 KiB")
                .hint("use `help` to list the console commands"));
        }
        let line = std::mem::take(&mut self.buffered);
        Ok((!line.is_empty()).then(|| String::from_utf8_lossy(&line).trim_end_matches(['\n', '\r']).to_owned()))
    }
}

/// Next line of the console, if there is a console.
async fn next_line<R: AsyncRead + Unpin>(console: &mut Option<Console<R>>) -> Result<Option<String>, Failure> {
    match console {
        Some(console) => console.next().await,
        None => std::future::pending().await,
    }
}

/// Command line that connects to a simulator of a family at a URL.
pub fn connect_hint(family: &str, target: &str) -> String {
    format!("armctl -t '{target}' {family} status")
}

/// Parses an address with or without a port.
pub fn address(text: &str, usual_port: u16) -> Result<SocketAddr, String> {
    let address = text.parse().or_else(|_| text.parse::<IpAddr>().map(|ip| SocketAddr::new(ip, usual_port)));
    address.map_err(|_| format!("'{text}' is not a valid address, such as 127.0.0.1:{usual_port}"))
}

/// Failure of a server that cannot start.
pub fn bind_failure(on: &str, error: &io::Error) -> Failure {
    let hint = match error.kind() {
        io::ErrorKind::AddrInUse => "stop the other simulator, or choose a free port with --bind 127.0.0.1:0",
        io::ErrorKind::PermissionDenied => "use a higher port: ports below 1024 need privileges",
        _ => "use an address of this computer with --bind",
    };
    Failure::new(Kind::NoAnswer, format!("cannot listen on {on}: {}", plain(error))).hint(hint)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn console_limits_the_length_of_a_line() {
        let mut console = Console::new(&b"state\r\nquit"[..]);
        assert_eq!(console.next().await.unwrap().as_deref(), Some("state"));
        assert_eq!(console.next().await.unwrap().as_deref(), Some("quit"), "the last one needs no end");
        assert_eq!(console.next().await.unwrap(), None);
        let failure = Console::new(tokio::io::repeat(b'x')).next().await.unwrap_err();
        assert!(failure.message.contains("64 KiB"), "{failure:?}");
    }
}
