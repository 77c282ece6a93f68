//! `armctl sim yrcx`: an EtherNet/IP adapter with TCP and UDP ports, like a controller.

use std::io;
use std::net::SocketAddrV4;
use std::path::PathBuf;

use clap::Args;

use crate::command::serve::{self, Serving, Started, address, cannot_listen};
use crate::command::yrcx::simulated::{self, Controller, faults, mischief};
use crate::failure::Failure;
use crate::transport::eip::adapter::Mischief;
use crate::transport::eip::adapter::server::{Listen, Server};
use crate::transport::eip::{IO_PORT, PORT};
use crate::transport::fault::FaultSpec;

/// A YRCX as an adapter of EtherNet/IP
#[derive(Debug, Args)]
#[command(
    after_help = "One connection owns the outputs; others may only listen (role=input_only with out=238, listen_only with \
    out=237). The console takes `mischief stall` and `mischief off`, too."
)]
pub struct Serve {
    /// Address to listen on, with the TCP port of sessions; port 0 lets the system choose
    #[arg(long, value_name = "ADDRESS[:PORT]", default_value = "127.0.0.1:44818", value_parser = listen)]
    bind: SocketAddrV4,
    /// UDP port of images, 2222 unless given; any where the system chooses that of sessions
    #[arg(long, value_name = "PORT")]
    io_port: Option<u16>,
    /// Start state (TOML): robots, memory, programs, alarms, timed events
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Faults of images on their way, such as drop=5%,dup=2%,delay=0..50ms,reorder=3%,corrupt=1%,seed=7
    #[arg(long, value_name = "FAULTS", value_parser = faults)]
    fault: Option<FaultSpec>,
    /// What the adapter does wrong: drop, stall, stale, double, wrong-sequence, wrong-id, wrong-size, frozen, unreadable,
    /// reset, mute, garbage, trailing, unowned
    #[arg(long, value_name = "WHAT", value_parser = mischief)]
    mischief: Option<Mischief>,
    /// Take lines on stdin; `help` lists them
    #[arg(long)]
    console: bool,
}

fn listen(text: &str) -> Result<SocketAddrV4, String> {
    match address(text, PORT)? {
        std::net::SocketAddr::V4(address) => Ok(address),
        std::net::SocketAddr::V6(_) => Err("EtherNet/IP has IPv4 addresses".to_owned()),
    }
}

impl serve::Serve for Serve {
    const ID: &'static str = "sim.yrcx";
    type Report = Serving;
    type Server = Yrcx;

    async fn start(self) -> Result<Started<Self>, Failure> {
        let start = simulated::start(self.state.as_deref())?;
        let io_port = self.io_port.unwrap_or(if self.bind.port() == 0 { 0 } else { IO_PORT });
        let listen = Listen { address: *self.bind.ip(), port: self.bind.port(), io_port };
        let server = simulated::serve(start, listen, self.fault).map_err(|error| {
            let on = format!("TCP and UDP {}, and UDP {}", self.bind, io_port);
            cannot_listen(&on, &error).hint("another simulator may run; choose ports with --bind 127.0.0.1:0")
        })?;
        server.with(|adapter, _| adapter.misbehave(self.mischief));
        let address = server.address();
        Ok(Started {
            report: Serving { family: "yrcx", target: format!("eip://{address}") },
            server: Yrcx(server),
            address: Some(address.into()),
            with_console: self.console,
        })
    }
}

/// A simulated controller on its sockets, which have threads of their own.
#[derive(Debug)]
pub struct Yrcx(Server<Controller>);

impl serve::Server for Yrcx {
    async fn turn(&mut self) -> io::Result<()> {
        std::future::pending().await
    }

    fn console(&mut self, line: &str) -> Result<String, String> {
        self.0.with(|adapter, now| match line.trim().strip_prefix("mischief ").map(str::trim) {
            None => adapter.application().0.0.console(now, line),
            Some("off") => {
                adapter.misbehave(None);
                Ok("the adapter does as it should".to_owned())
            }
            Some(name) => {
                adapter.misbehave(Some(mischief(name)?));
                Ok(format!("mischief: {name}"))
            }
        })
    }
}
