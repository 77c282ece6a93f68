//! Server for a simulated controller as an EtherNet/IP adapter.

use std::net::SocketAddrV4;

use super::simulated::{self, Controller, FAULTS};
use crate::fieldbus::{Operator, RunningSimulation, Serve, ServeOptions};
use crate::prelude::basics::*;
use crate::simulated::{faults, faults_of_option};
use armctl_frame::serve::{address, bind_failure};
use armctl_frame::settings::target::eip::SCHEME;
use armctl_transport::eip::adapter::server::{AdapterAddresses, Server};
use armctl_transport::eip::{IO_PORT, PORT};

/// Addresses of the simulator.
#[derive(Debug, Args)]
#[group(skip)]
pub struct ServeArgs {
    /// EtherNet/IP: address to listen on, with the TCP port of sessions; with port 0, the system chooses a port
    #[arg(long, alias = "listen", value_name = "ADDRESS[:PORT]", default_value = "127.0.0.1:44818", value_parser = listen)]
    bind: SocketAddrV4,
    /// EtherNet/IP: UDP port of images [default: 2222, or a free port if the system chooses the session port]
    #[arg(long, value_name = "PORT")]
    io_port: Option<u16>,
}

fn listen(text: &str) -> Result<SocketAddrV4, String> {
    match address(text, PORT)? {
        std::net::SocketAddr::V4(address) => Ok(address),
        std::net::SocketAddr::V6(_) => Err("EtherNet/IP needs an IPv4 address".to_owned()),
    }
}

impl Serve for ServeArgs {
    fn serve(&self, ServeOptions { start, faults, .. }: ServeOptions<'_>) -> Result<RunningSimulation> {
        let io_port = self.io_port.unwrap_or(if self.bind.port() == 0 { 0 } else { IO_PORT });
        let listen = AdapterAddresses { address: *self.bind.ip(), port: self.bind.port(), io_port };
        let server = simulated::serve(start, listen, faults_of_option(faults, &FAULTS)?).map_err(|error| {
            let on = format!("TCP and UDP {}, and UDP {}", self.bind, io_port);
            bind_failure(&on, &error).hint("stop the other simulator, or choose free ports with --bind 127.0.0.1:0")
        })?;
        let address = server.address();
        Ok(RunningSimulation {
            target: format!("{}://{address}", SCHEME.name),
            address: Some(address.into()),
            operator: Box::new(server),
        })
    }
}

impl Operator for Server<Controller> {
    fn console(&self, line: &str) -> Result<String, String> {
        self.with(|adapter, now| adapter.application.0.0.console(now, line))
    }

    fn set_faults(&self, text: Option<&str>) -> Result<(), String> {
        simulated::set_faults(self, faults(text, &FAULTS)?);
        Ok(())
    }
}
