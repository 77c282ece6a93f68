//! Server for a simulated controller behind SLCAN adapters.

use std::iter;
use std::net::SocketAddr;
use std::path::Path;

use clap::Args;

use super::simulated::{self, Controller, fault, faults, size};
#[cfg(unix)]
use crate::command::serve::terminal_link::TerminalLink;
use crate::command::serve::{address, cannot_listen};
use crate::command::yrcx::fieldbus::{Serve, Served};
use crate::controller::yrcx::simulator::Start;
use crate::failure::Failure;
use crate::settings::target::devicenet::SLCAN;
use crate::transport::devicenet::can::Bitrate;
use crate::transport::devicenet::device::{DeviceFault, Setup};
use crate::transport::devicenet::hub::{Hub, Listen};
use crate::transport::devicenet::wire::Mac;
use crate::transport::fault::FaultSpec;

/// SLCAN adapters and faults of the simulator.
#[derive(Debug, Args)]
#[group(skip)]
pub struct ServeArgs {
    /// DeviceNet: address of the SLCAN adapters, one for each TCP client; port 0 lets the system choose
    #[arg(long, value_name = "ADDRESS[:PORT]", default_value = "127.0.0.1:0", value_parser = listen)]
    slcan_bind: SocketAddr,
    /// DeviceNet: MAC ID of the controller
    #[arg(long, value_name = "MAC", default_value = "5")]
    mac: Mac,
    /// DeviceNet: bit rate of the bus
    #[arg(long, value_name = "RATE", default_value = "500k", value_parser = bitrate)]
    bitrate: Bitrate,
    /// DeviceNet: faults of frames, such as drop=1%,delay=0..5ms,seed=7
    #[arg(long, value_name = "FAULTS", value_parser = faults)]
    frame_fault: Option<FaultSpec>,
    /// DeviceNet: fault of the controller's node: no-acknowledge, lost-fragment, wrong-count, other-size,
    /// foreign-owner, duplicate-mac, silence, bus-off
    #[arg(long, value_name = "WHAT", value_parser = fault)]
    node_fault: Option<DeviceFault>,
}

fn listen(text: &str) -> Result<SocketAddr, String> {
    address(text, 0)
}

fn bitrate(text: &str) -> Result<Bitrate, String> {
    let found = Bitrate::ALL.into_iter().find(|bitrate| bitrate.name() == text);
    found.ok_or_else(|| format!("there are {}, not '{text}'", Bitrate::ALL.map(Bitrate::name).join(", ")))
}

impl Serve for ServeArgs {
    fn has_terminal(&self) -> bool {
        cfg!(unix)
    }

    fn serve(&self, simulator: Option<&str>, start: Start, link: Option<&Path>) -> Result<Served, Failure> {
        let setup = Setup::stand_in(self.mac, self.bitrate, size(simulator));
        #[cfg(unix)]
        let terminal = link.map(|_| Listen::Pty);
        #[cfg(not(unix))]
        let terminal = None;
        let listen: Vec<Listen> = iter::once(Listen::Tcp(self.slcan_bind)).chain(terminal).collect();
        let hub = simulated::serve(start, setup, &listen, self.frame_fault.clone(), self.node_fault);
        let hub = hub.map_err(|error| cannot_listen(&format!("TCP {}", self.slcan_bind), &error))?;
        let place = hub.places().first().map(String::as_str).unwrap_or_default();
        let address: Option<SocketAddr> = place.parse().ok();
        let mut target = format!("{}://{place}?mac={}", SLCAN.name, self.mac);
        if self.bitrate != Bitrate::K500 {
            target.push_str(&format!("&bitrate={}", self.bitrate.name()));
        }
        let link = terminal_link(link, &hub)?;
        Ok(Served {
            target,
            address,
            console: Box::new(move |line| {
                // The symbolic link exists as long as the console.
                let _ = &link;
                console(&hub, line)
            }),
        })
    }
}

/// Creates the symbolic link to the pseudo-terminal, if requested.
#[cfg(unix)]
fn terminal_link(path: Option<&Path>, hub: &Hub<Controller>) -> Result<Option<TerminalLink>, Failure> {
    let (Some(path), Some(terminal)) = (path, hub.places().get(1)) else { return Ok(None) };
    TerminalLink::make(path, terminal).map(Some)
}

#[cfg(not(unix))]
fn terminal_link(_path: Option<&Path>, _hub: &Hub<Controller>) -> Result<Option<()>, Failure> {
    Ok(None)
}

fn console(hub: &Hub<Controller>, line: &str) -> Result<String, String> {
    let answer = hub.with(|device, now| match line.trim().strip_prefix("mischief ").map(str::trim) {
        None => device.application().0.0.console(now, line),
        Some("off") => {
            device.misbehave(None);
            Ok("the node works normally".to_owned())
        }
        Some(name) => {
            device.misbehave(Some(fault(name)?));
            Ok(format!("mischief: {name}"))
        }
    });
    answer.unwrap_or_else(|| Err("no controller is connected".to_owned()))
}
