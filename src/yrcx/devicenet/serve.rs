//! Server for a simulated controller behind SLCAN adapters.

use std::iter;
use std::net::SocketAddr;

use super::simulated;
use super::simulated::{Controller, FAULTS, size};
use crate::fieldbus::{Operator, RunningSimulation, Serve, ServeOptions};
use crate::prelude::basics::*;
use crate::simulated::{faults, faults_of_option};
use armctl_frame::serve::{address, bind_failure};
use armctl_frame::settings::target::devicenet::SLCAN;
use armctl_transport::devicenet::can::Bitrate;
use armctl_transport::devicenet::device::Setup;
use armctl_transport::devicenet::hub::{Hub, Listen};
use armctl_transport::devicenet::wire::Mac;

#[cfg(unix)]
use armctl_frame::serve::terminal_link::TerminalLink;

/// Arguments for the SLCAN adapters and the node of the simulator.
#[derive(Debug, Args)]
#[group(skip)]
pub struct ServeArgs {
    /// DeviceNet: address of the SLCAN adapters; each TCP client gets its own adapter; with port 0, the system chooses
    /// a port
    #[arg(long, value_name = "ADDRESS[:PORT]", default_value = "127.0.0.1:0", value_parser = listen)]
    slcan_bind: SocketAddr,
    /// DeviceNet: MAC ID of the controller
    #[arg(long, value_name = "MAC", default_value = "5")]
    mac: Mac,
    /// DeviceNet: bit rate of the bus
    #[arg(long, value_name = "RATE", default_value = "500k", value_parser = bitrate)]
    bitrate: Bitrate,
}

fn listen(text: &str) -> Result<SocketAddr, String> {
    address(text, 0)
}

fn bitrate(text: &str) -> Result<Bitrate, String> {
    let found = Bitrate::ALL.into_iter().find(|bitrate| bitrate.name() == text);
    found.ok_or_else(|| format!("the bit rates are {}, not '{text}'", Bitrate::ALL.map(Bitrate::name).join(", ")))
}

impl Serve for ServeArgs {
    fn has_terminal(&self) -> bool {
        cfg!(unix)
    }

    fn serve(&self, ServeOptions { simulator, start, link, faults }: ServeOptions<'_>) -> Result<RunningSimulation> {
        let setup = Setup::sample_controller(self.mac, self.bitrate, size(simulator));
        #[cfg(unix)]
        let terminal = link.map(|_| Listen::Pty);
        #[cfg(not(unix))]
        let terminal = None;
        let listen: Vec<Listen> = iter::once(Listen::Tcp(self.slcan_bind)).chain(terminal).collect();
        let hub = simulated::serve(start, setup, &listen, faults_of_option(faults, &FAULTS)?);
        let hub = hub.map_err(|error| bind_failure(&format!("TCP {}", self.slcan_bind), &error))?;
        let place = hub.endpoint_addresses.first().map(String::as_str).unwrap_or_default();
        let address: Option<SocketAddr> = place.parse().ok();
        let mut target = format!("{}://{place}?mac={}", SLCAN.name, self.mac);
        if self.bitrate != Bitrate::K500 {
            target.push_str(&format!("&bitrate={}", self.bitrate.name()));
        }
        let link = terminal_link(link, &hub)?;
        Ok(RunningSimulation { target, address, operator: Box::new(Adapters { hub, _link: link }) })
    }
}

/// Creates the symbolic link to the pseudo-terminal, if requested.
#[cfg(unix)]
fn terminal_link(path: Option<&Path>, hub: &Hub<Controller>) -> Result<Link> {
    let (Some(path), Some(terminal)) = (path, hub.endpoint_addresses.get(1)) else { return Ok(None) };
    TerminalLink::create(path, terminal).map(Some)
}

#[cfg(not(unix))]
fn terminal_link(_path: Option<&Path>, _hub: &Hub<Controller>) -> Result<Link> {
    Ok(None)
}

/// Symbolic link to the pseudo-terminal.
#[cfg(unix)]
type Link = Option<TerminalLink>;
#[cfg(not(unix))]
type Link = Option<()>;

/// SLCAN adapters. When they are dropped, the symbolic link is removed.
struct Adapters {
    hub: Hub<Controller>,
    _link: Link,
}

impl Operator for Adapters {
    fn console(&self, line: &str) -> Result<String, String> {
        let result = self.hub.with(|device, now| device.application.0.0.console(now, line));
        result.unwrap_or_else(|| Err("no controller is connected".to_owned()))
    }

    fn set_faults(&self, text: Option<&str>) -> Result<(), String> {
        simulated::set_faults(&self.hub, faults(text, &FAULTS)?);
        Ok(())
    }
}
