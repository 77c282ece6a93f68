//! Server for a simulated controller as an EtherNet/IP adapter.

use std::net::SocketAddrV4;
use std::path::Path;

use clap::Args;

use super::simulated::{self, Controller, mischief};
use crate::command::serve::{address, cannot_listen};
use crate::command::yrcx::fieldbus::{Serve, Served};
use crate::command::yrcx::simulated::faults;
use crate::controller::yrcx::simulator::Start;
use crate::failure::Failure;
use crate::settings::target::eip::SCHEME;
use crate::transport::eip::adapter::AdapterFault;
use crate::transport::eip::adapter::server::{Listen, Server};
use crate::transport::eip::{IO_PORT, PORT};
use crate::transport::fault::FaultSpec;

/// Address and faults of the simulator.
#[derive(Debug, Args)]
#[group(skip)]
pub struct ServeArgs {
    /// EtherNet/IP: address to listen on, with the TCP port of sessions; port 0 lets the system choose
    #[arg(long, alias = "listen", value_name = "ADDRESS[:PORT]", default_value = "127.0.0.1:44818", value_parser = listen)]
    bind: SocketAddrV4,
    /// EtherNet/IP: UDP port of images; default: 2222, or a free port if the system chooses the session port
    #[arg(long, value_name = "PORT")]
    io_port: Option<u16>,
    /// EtherNet/IP: faults of images, such as drop=5%,dup=2%,delay=0..50ms,reorder=3%,corrupt=1%,seed=7
    #[arg(long, value_name = "FAULTS", value_parser = faults)]
    fault: Option<FaultSpec>,
    /// EtherNet/IP: fault of the adapter: drop, stall, stale, double, wrong-sequence, wrong-id, wrong-size, frozen,
    /// unreadable, reset, reset-set, mute, garbage, trailing, unowned
    #[arg(long, value_name = "WHAT", value_parser = mischief)]
    mischief: Option<AdapterFault>,
}

fn listen(text: &str) -> Result<SocketAddrV4, String> {
    match address(text, PORT)? {
        std::net::SocketAddr::V4(address) => Ok(address),
        std::net::SocketAddr::V6(_) => Err("EtherNet/IP needs an IPv4 address".to_owned()),
    }
}

impl Serve for ServeArgs {
    fn serve(&self, _simulator: Option<&str>, start: Start, _link: Option<&Path>) -> Result<Served, Failure> {
        let io_port = self.io_port.unwrap_or(if self.bind.port() == 0 { 0 } else { IO_PORT });
        let listen = Listen { address: *self.bind.ip(), port: self.bind.port(), io_port };
        let server = simulated::serve(start, listen, self.fault.clone()).map_err(|error| {
            let on = format!("TCP and UDP {}, and UDP {}", self.bind, io_port);
            cannot_listen(&on, &error).hint("stop the other simulator, or choose free ports with --bind 127.0.0.1:0")
        })?;
        server.with(|adapter, _| adapter.misbehave(self.mischief));
        let address = server.address();
        Ok(Served {
            target: format!("{}://{address}", SCHEME.name),
            address: Some(address.into()),
            console: Box::new(move |line| console(&server, line)),
        })
    }
}

fn console(server: &Server<Controller>, line: &str) -> Result<String, String> {
    server.with(|adapter, now| match line.trim().strip_prefix("mischief ").map(str::trim) {
        None => adapter.application().0.0.console(now, line),
        Some("off") => {
            adapter.misbehave(None);
            Ok("the adapter works normally".to_owned())
        }
        Some(name) => {
            adapter.misbehave(Some(mischief(name)?));
            Ok(format!("mischief: {name}"))
        }
    })
}
