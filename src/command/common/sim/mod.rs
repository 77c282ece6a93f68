//! `armctl sim`: the simulators as servers on real sockets and ports.

use std::io;
use std::net::{IpAddr, SocketAddr};

use clap::{Args, Subcommand};
use tokio::io::{AsyncBufReadExt as _, BufReader, Lines, Stdin};

use crate::command::interrupt::interruptible;
use crate::command::run::{Run, Stopped};
use crate::command::toyo::serve::SimToyo;
use crate::command::yerc::serve::SimYerc;
use crate::command::yrcx::serve::SimYrcx;
use crate::failure::{Failure, Kind, plain};

/// Which simulator to serve.
#[derive(Debug, Args)]
pub struct Sim {
    #[command(subcommand)]
    family: Option<SimFamily>,
}

/// Families with a simulator.
#[derive(Debug, Subcommand)]
enum SimFamily {
    /// An FS100 or DX200 on two UDP ports
    Yerc(SimYerc),
    /// A YRCX as an adapter of EtherNet/IP
    Yrcx(SimYrcx),
    /// A Toyo controller on a TCP port, like a serial device server, or on a pseudo-terminal
    Toyo(SimToyo),
}

impl Sim {
    pub(super) async fn run(self, run: &Run) -> Result<(), Stopped> {
        match self.family {
            Some(SimFamily::Yerc(yerc)) => yerc.run(run).await,
            Some(SimFamily::Yrcx(yrcx)) => yrcx.run(run).await,
            Some(SimFamily::Toyo(toyo)) => toyo.run(run).await,
            None => SimYerc::default().run(run).await,
        }
    }
}

/// A simulator behind what clients connect to.
pub trait Served {
    /// Serves until something arrives or is due, and all that follows from it. The future may be dropped.
    async fn turn(&mut self) -> io::Result<()>;
    /// Does what a line of the console says, and tells what was done, or why not.
    fn console(&mut self, line: &str) -> Result<String, String>;
}

/// Serves until Ctrl-C; `address` is where others may come from.
pub async fn serve(
    run: &Run,
    served: &mut impl Served,
    address: Option<SocketAddr>,
    with_console: bool,
) -> Result<(), Stopped> {
    if address.is_some_and(|address| !address.ip().is_loopback()) {
        run.screen.note("warning: others on the network can reach this simulator");
    }
    let mut console = with_console.then(|| BufReader::new(tokio::io::stdin()).lines());
    loop {
        let turn = interruptible(async {
            tokio::select! {
                turned = served.turn() => turned.map(|()| None).map_err(|error| Failure::io("simulator", &error)),
                line = next_line(&mut console) => Ok(Some(line)),
            }
        });
        let line = match turn.await {
            Ok(turned) => turned?,
            // This is how one ends a server.
            Err(_) => return Ok(()),
        };
        match line {
            None => {}
            Some(None) => console = None,
            Some(Some(line)) if line.trim().is_empty() => {}
            Some(Some(line)) => match served.console(&line) {
                Ok(text) => run.screen.note(&text),
                Err(why) => run.screen.failure(&Failure::usage(why).hint("`help` lists what the console takes")),
            },
        }
    }
}

/// The next line of the console; `None` at its end.
async fn next_line(console: &mut Option<Lines<BufReader<Stdin>>>) -> Option<String> {
    match console {
        Some(lines) => lines.next_line().await.unwrap_or(None),
        None => std::future::pending().await,
    }
}

/// An address with a port, or without one.
pub fn address(text: &str, usual_port: u16) -> Result<SocketAddr, String> {
    let address = text.parse().or_else(|_| text.parse::<IpAddr>().map(|ip| SocketAddr::new(ip, usual_port)));
    address.map_err(|_| format!("'{text}' is no address such as 127.0.0.1:{usual_port}"))
}

pub fn cannot_listen(on: &str, error: &io::Error) -> Failure {
    let hint = match error.kind() {
        io::ErrorKind::AddrInUse => "another simulator may run; choose a port with --bind 127.0.0.1:0",
        io::ErrorKind::PermissionDenied => "ports below 1024 need rights; choose a higher one",
        _ => "choose an address of this machine with --bind",
    };
    Failure::new(Kind::NoAnswer, format!("cannot listen on {on}: {}", plain(error))).hint(hint)
}
