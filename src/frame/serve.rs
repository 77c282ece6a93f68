//! Simulators as servers on real sockets and ports, for all families. `FAMILY/serve.rs` has the family-specific part;
//! `armctl sim` combines both.

pub mod terminal_link;

use std::fmt::Write as _;
use std::io;
use std::net::{IpAddr, SocketAddr};

use futures_util::future::select_all;
use tokio::io::{AsyncBufReadExt as _, AsyncRead, AsyncReadExt as _, BufReader};

use super::SchemaEntry;
use crate::failure::plain;
use crate::interrupt::interruptible;
use crate::prelude::basics::*;
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
    type Server: Server + 'static;

    /// Starts to listen.
    async fn start(self) -> Result<Started<Self>>;
}

/// A simulator that listens.
#[derive(Debug)]
pub struct Started<S: Serve> {
    /// Report.
    pub report: S::Report,
    /// Command line that connects to the simulator.
    pub reach: String,
    /// URL of the simulator.
    pub target: String,
    /// Simulator.
    pub server: S::Server,
    /// Address that the simulator listens on; `None` for a terminal.
    pub address: Option<SocketAddr>,
    /// Whether the simulator reads console lines on stdin.
    pub with_console: bool,
    /// What the simulator of a backup does not know about its robot.
    pub unknown: Option<String>,
    /// What the simulator replays.
    pub replay: Option<String>,
}

/// A simulator with its server.
pub trait Server {
    /// Serves until an event arrives or is due, and handles the event. The future may be dropped.
    fn run_until_change(&mut self) -> LocalBoxFuture<'_, io::Result<()>>;
    /// Executes a console line and returns the result or the reason for a failure.
    fn console(&mut self, line: &str) -> Result<String, String>;
    /// Sets the faults of link and device in the form of `--fault`; `None` removes all faults.
    fn set_faults(&mut self, faults: Option<&str>) -> Result<(), String>;
}

/// A simulator of any family that listens.
pub struct NamedServer {
    /// First word of its console lines; empty if there is only one simulator.
    pub name: String,
    /// URL of the simulator.
    pub target: String,
    /// Simulator.
    pub server: Box<dyn Server>,
    /// What the simulator replays.
    pub replay: Option<String>,
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
    let Started { report, reach, target, server, address, with_console, unknown, replay } = arguments.start().await?;
    run.local(S::ID, &report)?;
    if address.is_some_and(|address| !address.ip().is_loopback()) {
        run.screen.note("warning: other computers on the network can reach this simulator");
    }
    for text in [&unknown, &replay].into_iter().flatten() {
        run.screen.note(text);
    }
    // A program reads the address from the report, and needs no instructions.
    if !run.screen.is_json() {
        let console = if with_console { " or `quit`; `help` lists the console commands" } else { "" };
        run.screen.note(&format!("reach it: {reach}\nend it:   Ctrl-C{console}"));
    }
    let server = NamedServer { name: String::new(), target, server: Box::new(server), replay };
    serve(vec![server], with_console, run).await
}

/// Serves simulators until Ctrl-C, or until `quit` on the console.
pub async fn serve(mut servers: Vec<NamedServer>, with_console: bool, run: &Run) -> Result<(), RunError> {
    let mut console = with_console.then(|| Console::new(tokio::io::stdin()));
    let mut first = 0;
    loop {
        // Each simulator is the first one in turn, so that a busy simulator does not delay the others.
        first = (first + 1) % servers.len().max(1);
        let (later, earlier) = servers.split_at_mut(first);
        let changes = earlier.iter_mut().chain(later).map(|named| {
            let change = named.server.run_until_change();
            async { change.await.map_err(|error| Failure::io(format!("simulator {}", named.name).trim_end(), &error)) }
                .boxed_local()
        });
        let turn = interruptible(async {
            tokio::select! {
                (outcome, _, _) = select_all(changes) => outcome.map(|()| None),
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
            Some(Some(line)) => match named_line(&mut servers, line.trim()) {
                Ok(text) => run.screen.note(&text),
                Err(why) => run.screen.failure(&Failure::usage(why).hint("use `help` to list the console commands")),
            },
        }
    }
}

/// Executes a console line. With several simulators, the line begins with the name of a simulator.
fn named_line(servers: &mut [NamedServer], line: &str) -> Result<String, String> {
    if let [NamedServer { name, server, .. }] = &mut *servers
        && name.is_empty()
    {
        return console_line(&mut **server, line);
    }
    if line == "help" {
        let lines = servers.iter().map(|named| help_line(&format!("{} COMMAND", named.name), &named.target));
        let mut text: String = lines.flat_map(|line| [line, "\n".to_owned()]).collect();
        let _ = write!(text, "{}", help_line("quit", "end the simulators; `NAME help` lists the commands of a robot"));
        return Ok(text);
    }
    let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    match servers.iter_mut().find(|named| named.name == word) {
        Some(_) if rest.trim() == "quit" => Err("`quit` ends all simulators; type it without a name".to_owned()),
        Some(named) => console_line(&mut *named.server, rest),
        None => {
            let near = nearest(word, servers.iter().map(|named| named.name.as_str()));
            let near = near.map_or(String::new(), |near| format!("; did you mean {near}?"));
            Err(format!("no robot is called '{word}': begin the line with the name of a robot{near}"))
        }
    }
}

/// Executes a console line: `fault` is common to all simulators, the other lines belong to the family.
fn console_line(server: &mut dyn Server, line: &str) -> Result<String, String> {
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
    async fn next(&mut self) -> Result<Option<String>> {
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
async fn next_line<R: AsyncRead + Unpin>(console: &mut Option<Console<R>>) -> Result<Option<String>> {
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
