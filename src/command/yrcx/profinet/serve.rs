//! Server for a simulated controller as an IO device on a network interface.

use std::path::Path;

use clap::Args;

use super::simulated::{Controller, NAME, controller, fault, layout, setup};
use crate::command::yrcx::fieldbus::{Serve, Served};
use crate::command::yrcx::link_error::not_open;
use crate::controller::yrcx::simulator::Start;
use crate::failure::Failure;
use crate::settings::target::profinet::{self, SCHEME};
use crate::transport::image::LinkError;
use crate::transport::profinet::device::Fault;
use crate::transport::profinet::device::server::Server;
use crate::transport::profinet::interface::Interface;
use crate::transport::profinet::layout::Layout;

/// Options and faults of the simulated device.
#[derive(Debug, Args)]
#[group(skip)]
pub struct ServeArgs {
    /// PROFINET: Ethernet interface of the device; the device uses its address
    #[arg(long, value_name = "IFACE")]
    interface: Option<String>,
    /// PROFINET: name of the station
    #[arg(long, value_name = "NAME", default_value = NAME, value_parser = profinet::name)]
    station_name: String,
    /// PROFINET: modules of the device, as in 1:0x101:i48,2:0x102:o48
    #[arg(long, value_name = "LAYOUT")]
    layout: Option<Layout>,
    /// PROFINET: fault of the device: never-ready, wrong-module, silent, diagnosis, restart, abort, stop, mute, owned
    /// and others
    #[arg(long, value_name = "WHAT", value_parser = fault)]
    device_fault: Option<Fault>,
}

impl Serve for ServeArgs {
    fn serve(&self, _simulator: Option<&str>, start: Start, _link: Option<&Path>) -> Result<Served, Failure> {
        let Some(interface) = &self.interface else {
            return Err(Failure::usage("a PROFINET device needs an Ethernet interface")
                .hint("add --interface IFACE; `ip link` lists the interfaces"));
        };
        let layout = self.layout.clone().unwrap_or_else(layout);
        let target = format!("{}://{}@IFACE?layout={layout}", SCHEME.name, self.station_name);
        let setup = setup(&self.station_name, layout);
        let started = Interface::find(interface).and_then(|found| Server::start(&found, setup, controller(start)));
        let server = started.map_err(|error| not_open("simulator", &SCHEME, &LinkError::from(error)))?;
        server.with(|device, _| device.set_fault(self.device_fault));
        Ok(Served { target, address: None, console: Box::new(move |line| console(&server, line)) })
    }
}

fn console(server: &Server<Controller>, line: &str) -> Result<String, String> {
    server.with(|device, now| match line.trim() {
        "restart" => {
            device.restart(now);
            Ok("the device was switched off and on".to_owned())
        }
        "mischief off" => {
            device.set_fault(None);
            Ok("the device works normally".to_owned())
        }
        line => match line.strip_prefix("mischief ").map(str::trim) {
            None => device.application_mut().0.0.console(now, line),
            Some(name) => {
                device.set_fault(Some(fault(name)?));
                Ok(format!("mischief: {name}"))
            }
        },
    })
}
