//! `armctl sim toyo`: a TCP port, like a serial device server, or a pseudo-terminal, like a serial port.

use std::io;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::command::frame::interrupt::catch_interrupts;
use crate::command::serve::{self, Serving, Started, address, cannot_listen};
use crate::command::toyo::simulated::{self, Simulated};
use crate::failure::{Failure, plain};
use crate::transport::fault::LineFaultSpec;
use crate::transport::line::Pace;
use crate::transport::stream_server::StreamServer;

/// A Toyo controller on a TCP port, like a serial device server, or on a pseudo-terminal
#[derive(Debug, Args)]
#[command(after_help = "A line has one host: while a client is connected, others on the TCP port are let go at once.")]
pub struct Serve {
    /// Address to listen on, with the TCP port; port 0 lets the system choose
    #[arg(
        long,
        value_name = "ADDRESS[:PORT]",
        default_value = "127.0.0.1:4001",
        value_parser = |text: &str| address(text, PORT)
    )]
    bind: SocketAddr,
    /// Serve on a pseudo-terminal instead, whose path is printed (not on Windows)
    #[arg(long, conflicts_with = "bind")]
    pty: bool,
    /// Name the pseudo-terminal by a symbolic link, which is removed at the end
    #[arg(long, value_name = "PATH", requires = "pty")]
    link: Option<PathBuf>,
    /// Axes of the robot
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    axes: Option<u8>,
    /// Let characters take as long as on a line of so many bits a second, such as 9600; at once unless given
    #[arg(long, value_name = "BAUD", value_parser = clap::value_parser!(u32).range(50..=4_000_000))]
    baud: Option<u32>,
    /// Start state (TOML): modes, memory, inputs, errors, timed events
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Faults on the line, such as noise=1%,parity=1%,drop=1%,dup=1%,delay=0..50ms,busy=4%,echo,seed=7
    #[arg(long, value_name = "FAULTS")]
    fault: Option<LineFaultSpec>,
    /// Take lines on stdin; `help` lists them
    #[arg(long)]
    console: bool,
}

/// What device servers listen on, mostly.
const PORT: u16 = 4001;

/// Bits of a character with 8 data bits, parity and one stop bit (TO 1-2).
const BITS: u32 = 11;

impl serve::Serve for Serve {
    const ID: &'static str = "sim.toyo";
    type Report = Serving;
    type Server = Toyo;

    async fn start(self) -> Result<Started<Self>, Failure> {
        let start = simulated::start(self.state.as_deref(), self.axes, self.fault.as_ref())?;
        let speed = self.baud.map(|baud| Pace::new(baud, BITS));
        let settings = self.baud.map(|baud| format!("?baud={baud}")).unwrap_or_default();
        // From here on there may be a link to remove.
        catch_interrupts();
        let (server, endpoint, address, link) = if self.pty {
            let made = StreamServer::pseudo_terminal(speed, self.fault);
            let (server, path) = made.map_err(|error| no_terminal(&error))?;
            let link = self.link.map(|link| Link::make(&link, &path)).transpose()?;
            let name = link.as_ref().map_or_else(|| path.clone(), |link| link.name.display().to_string());
            (server, format!("serial://{name}"), None, link)
        } else {
            let made = StreamServer::tcp(self.bind, speed, self.fault).await;
            let (server, local) = made.map_err(|error| cannot_listen(&format!("TCP {}", self.bind), &error))?;
            (server, format!("tcp://{local}"), Some(local), None)
        };
        Ok(Started {
            report: Serving { family: "toyo", target: format!("{endpoint}{settings}") },
            server: Toyo { server, simulated: Simulated::new(start), _link: link },
            address,
            with_console: self.console,
        })
    }
}

/// A simulated controller on its line.
#[derive(Debug)]
pub struct Toyo {
    server: StreamServer,
    simulated: Simulated,
    /// Removed with it.
    _link: Option<Link>,
}

impl serve::Server for Toyo {
    async fn turn(&mut self) -> io::Result<()> {
        self.server.turn(&mut self.simulated).await
    }

    fn console(&mut self, line: &str) -> Result<String, String> {
        self.simulated.0.console(self.server.now(), line)
    }
}

fn no_terminal(error: &io::Error) -> Failure {
    let failure = Failure::local(format!("cannot make a pseudo-terminal: {}", plain(error)));
    failure.hint("leave --pty away, and reach the simulator over TCP")
}

/// A symbolic link to the pseudo-terminal, as long as it is served.
#[derive(Debug)]
struct Link {
    name: PathBuf,
    leads_to: PathBuf,
}

impl Link {
    /// Makes it. One that leads nowhere, of a simulator that was killed, is replaced; anything else is left alone.
    fn make(name: &Path, leads_to: &str) -> Result<Self, Failure> {
        let failed = |error: io::Error| {
            let failure = Failure::io(name.display(), &error);
            match error.kind() {
                io::ErrorKind::AlreadyExists => failure.hint("remove it, or choose another name for --link"),
                _ => failure,
            }
        };
        let name = std::path::absolute(name).map_err(failed)?;
        if name.is_symlink() && !name.exists() {
            std::fs::remove_file(&name).map_err(failed)?;
        }
        let leads_to = PathBuf::from(leads_to);
        symlink(&leads_to, &name).map_err(failed)?;
        Ok(Self { name, leads_to })
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        // Somebody else's is left alone; what cannot be removed is replaced the next time.
        if std::fs::read_link(&self.name).is_ok_and(|leads_to| leads_to == self.leads_to) {
            std::fs::remove_file(&self.name).unwrap_or_default();
        }
    }
}

#[cfg(unix)]
use std::os::unix::fs::symlink;

#[cfg(not(unix))]
fn symlink(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_link_is_there_as_long_as_it_is_served() {
        let folder = tempfile::tempdir().unwrap();
        let (name, port) = (folder.path().join("toyo"), folder.path().join("pts"));
        std::fs::write(&port, "").unwrap();
        let leads_to = port.to_str().unwrap();
        let link = Link::make(&name, leads_to).unwrap();
        assert_eq!(std::fs::read_link(&name).unwrap(), port);
        let second = Link::make(&name, leads_to).unwrap_err();
        assert!(second.hint.unwrap().contains("--link"), "one that leads somewhere is somebody's");
        drop(link);
        assert!(!name.is_symlink());
    }

    #[test]
    fn what_a_killed_simulator_left_is_replaced_and_what_is_not_ours_stays() {
        let folder = tempfile::tempdir().unwrap();
        let (name, port) = (folder.path().join("toyo"), folder.path().join("pts"));
        symlink(folder.path().join("gone"), &name).unwrap();
        let link = Link::make(&name, port.to_str().unwrap()).unwrap();
        assert_eq!(std::fs::read_link(&name).unwrap(), port);
        std::fs::remove_file(&name).unwrap();
        std::fs::write(&name, "mine").unwrap();
        drop(link);
        assert_eq!(std::fs::read_to_string(&name).unwrap(), "mine");
        assert!(Link::make(&name, port.to_str().unwrap()).is_err());
    }
}
